"""What a figure depends on beside the code: written into every result."""

from __future__ import annotations

import os
import platform
import re
import subprocess
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from bench.meshes import PROJECT


def said(*command: str) -> str:
    """What a program prints, or nothing when it cannot be run."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, cwd=PROJECT, check=False)
    except OSError:
        return ""
    return done.stdout.strip()


def cpu() -> str:
    """The processor's name."""
    text = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    found = re.search(r"model name\s*:\s*(.*)", text)
    return found[1] if found else platform.processor()


def memory_bytes() -> int:
    """All of the machine's memory."""
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")


def compiler() -> str:
    """The compiler that CMake chose."""
    cache = PROJECT / "build" / "release" / "CMakeCache.txt"
    text = cache.read_text() if cache.is_file() else ""
    found = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", text, re.MULTILINE)
    return said(found[1], "--version").split("\n")[0] if found else "unknown"


def describe() -> dict[str, Any]:
    """Machine, compiler, revision and how busy the machine was when the bench began."""
    return {
        "time": datetime.now(timezone.utc).isoformat(timespec="seconds"),
        "machine": platform.node(),
        "system": platform.platform(),
        "cpu": cpu(),
        "cores": os.cpu_count(),
        "memory_bytes": memory_bytes(),
        "compiler": compiler(),
        "instruction_set": said(str(PROJECT / "build/release/komorebi_bench"), "instructions"),
        "revision": said("git", "describe", "--always", "--dirty", "--abbrev=12"),
        "load_average": os.getloadavg()[0],
    }
