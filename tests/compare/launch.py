"""Runs one engine's job in a Blender of its own, so that nothing of one engine can reach the
other's pictures."""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
JOB_SCRIPT = Path(__file__).resolve().parent / "inside" / "job.py"
DEFAULT_BLENDER = "/usr/bin/blender"


class BlenderFailed(RuntimeError):
    """Blender ended without pictures; the message says what it said last and where its log is."""


@dataclass(frozen=True)
class Job:
    """All that decides the pictures of one engine (see inside/job.py)."""

    file: str
    engine: str
    mode: str
    samples: int
    seeds: list[int]
    longest: int
    view_layer: str | None = None
    flat: bool = False
    world_image: str | None = None
    lamps: bool = True  # in world mode
    frame: int | None = None
    camera: str | None = None
    stereo: str | None = None
    bounces: int = 0
    materials: bool = False
    fast_gi: str | None = None
    ao_bounces: int = 1
    ao_distance: float | None = None


@dataclass(frozen=True)
class Host:
    """The Blender to use: a program, or a Python that has the bpy module."""

    blender: str = DEFAULT_BLENDER
    python: str | None = None
    timeout: float = 3600.0

    def command(self, job_file: Path) -> list[str]:
        """The command line for one job; scripts inside .blend files stay disabled."""
        if self.python is not None:
            return [self.python, str(JOB_SCRIPT), "--", str(job_file)]
        options = ["-b", "--factory-startup", "--disable-autoexec", "--python-exit-code", "3"]
        return [self.blender, *options, "-P", str(JOB_SCRIPT), "--", str(job_file)]


@dataclass
class Pictures:
    """What one engine rendered: float32 [seed, row, column, RGBA], and the job's report.

    `bent`, bool [row, column], marks pixels where this Cycles computes something else.
    """

    pixels: np.ndarray
    notes: list[str] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    blender: str = ""
    view_layer: str = ""
    bent: np.ndarray | None = None


def environment() -> dict[str, str]:
    """The system's programs first and no Python settings; add-ons from the project's own Blender
    user folder."""
    kept = {
        k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "CONDA", "VIRTUAL_ENV"))
    }
    kept["PATH"] = "/usr/local/sbin:/usr/sbin:/usr/bin:/sbin:/bin"
    user = Path(os.environ.get("KOMOREBI_USER") or PROJECT / "build" / "user")
    for name in ("CONFIG", "SCRIPTS", "DATAFILES"):
        kept[f"BLENDER_USER_{name}"] = str(user / name.lower())
    kept["PYTHONDONTWRITEBYTECODE"] = "1"
    return kept


def complaint(log: Path) -> str:
    """The line of Blender's log that says most about a failure."""
    lines = [line.strip() for line in log.read_text(errors="replace").splitlines() if line.strip()]
    told = [
        k
        for k in lines
        if "Error" in k and "script failed" not in k and "Python: Traceback" not in k
    ]
    return (told or lines or ["it said nothing"])[-1]


def load(folder: Path) -> Pictures:
    """Read back what a job has written into `folder`."""
    report: dict[str, Any] = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    mask = folder / "bent.npy"
    bent = np.load(mask) if mask.is_file() else None
    return Pictures(pixels=np.load(folder / "pixels.npy"), bent=bent, **report)


def run(job: Job, host: Host, folder: Path, reuse: bool = False) -> Pictures:
    """Render `job` and read its pictures. With `reuse`, those of an earlier equal job in `folder`
    are taken.

    Raises BlenderFailed when Blender ends with an error, is killed, or takes longer than the
    host's limit.
    """
    folder.mkdir(parents=True, exist_ok=True)
    job_file, log = folder / "job.json", folder / "blender.log"
    text = json.dumps({**asdict(job), "out": str(folder), "host": asdict(host)}, indent=1)
    if (
        reuse
        and job_file.is_file()
        and job_file.read_text(encoding="utf-8") == text
        and (folder / "report.json").is_file()
    ):
        return load(folder)
    for name in ("report.json", "pixels.npy", "bent.npy"):
        (folder / name).unlink(missing_ok=True)
    job_file.write_text(text, encoding="utf-8")
    with log.open("wb") as sink:
        try:
            code = subprocess.run(
                host.command(job_file),
                stdout=sink,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                env=environment(),
                timeout=host.timeout,
            ).returncode
        except subprocess.TimeoutExpired as error:
            raise BlenderFailed(
                f"{job.engine} took longer than {host.timeout:g} s ({log})"
            ) from error
        except FileNotFoundError as error:
            raise BlenderFailed(f"there is no program {error.filename}") from error
    if code != 0 or not (folder / "report.json").is_file():
        how = f"crashed (signal {-code})" if code < 0 else f"ended with exit code {code}"
        raise BlenderFailed(f"{job.engine}: Blender {how}: {complaint(log)} ({log})")
    return load(folder)
