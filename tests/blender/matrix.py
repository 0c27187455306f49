"""Runs test files in several Blenders, and prints a table: `./run matrix` calls it.

    python3 tests/blender/matrix.py PROGRAM=USER_FOLDER... [FILE.py[::NAME]...]

PROGRAM is a Blender or a python that has the module bpy; the add-on and the core for its Python are
in USER_FOLDER/scripts. Without FILEs all of tests/blender run, each in a process of its own. What a
process says is kept in build/matrix/. Exits with 1 if a test failed or a process broke off.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
LOGS = HERE.parents[1] / "build" / "matrix"
SUMMARY = re.compile(r"^\[test\] Blender (.+): (\d+) tests, (\d+) failed, (\d+) skipped$", re.M)
FAILED = re.compile(r"^\[test\] (\S+): FAILED", re.M)
LIMIT = 900  # seconds a file, as in tests/blender/CMakeLists.txt


class Row:
    """One Blender: how many of its tests ended how."""

    def __init__(self, program: str, user: Path) -> None:
        self.program, self.user = program, user
        self.release = "?"
        self.tests = self.failed = self.skipped = 0

    def run(self, file: str, log: Path) -> None:
        """Runs one test file, and counts; a process that breaks off is one failed test."""
        code = self._process(file, log)
        said = log.read_text(errors="replace")
        names = FAILED.findall(said)
        summary = SUMMARY.search(said)
        if summary:
            self.release = summary[1]
            self.tests += int(summary[2])
            self.failed += int(summary[3])
            self.skipped += int(summary[4])
        if not summary or (code != 0 and not names):
            self.tests += 1
            self.failed += 1
            names.append(f"{file} broke off ({code})")
        for name in names:
            print(f"{self.program}: {name} FAILED: {log}", flush=True)

    def _process(self, file: str, log: Path) -> int | str:
        runner = str(HERE / "run_in_blender.py")
        if Path(self.program).name.startswith("python"):
            command = [self.program, runner]
        else:
            command = [self.program, "-b", "--factory-startup", "--python-exit-code", "1", "-P", runner, "--"]  # fmt: skip
        folders = {
            f"BLENDER_USER_{name.upper()}": str(self.user / name)
            for name in ("config", "scripts", "datafiles")
        }
        environment = {**os.environ, **folders, "PATH": "/usr/bin:/bin"}
        environment["PYTHONDONTWRITEBYTECODE"] = "1"
        with log.open("w") as output:
            try:
                return subprocess.run(
                    [*command, file], env=environment, timeout=LIMIT, check=False,
                    stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
                ).returncode  # fmt: skip
            except subprocess.TimeoutExpired:
                return f"after {LIMIT} s"


def main(arguments: list[str]) -> int:
    files = [a for a in arguments if ".py" in a.rpartition("/")[2] and "=" not in a]
    files = files or sorted(str(path) for path in HERE.glob("test_*.py"))
    rows = []
    shutil.rmtree(LOGS, ignore_errors=True)
    for number, argument in enumerate(a for a in arguments if "=" in a):
        program, _, user = argument.rpartition("=")
        row = Row(program, Path(user))
        for file in files:
            name = Path(file.partition("::")[0]).stem
            log = LOGS / str(number + 1) / f"{name}.log"
            log.parent.mkdir(parents=True, exist_ok=True)
            row.run(file, log)
        rows.append(row)
    print(f"{'release':<12} {'passed':>6} {'failed':>6} {'skipped':>7}  program")
    for row in rows:
        passed = row.tests - row.failed - row.skipped
        print(f"{row.release:<12} {passed:>6} {row.failed:>6} {row.skipped:>7}  {row.program}")
    return 1 if any(row.failed for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
