"""Checks what no other tool does: the top level, the length of files, and the links in documents.

Prints one line per fault and exits 1 if there is any. Run from the root of the clone.
"""

import re
import subprocess
import sys
from pathlib import Path

FOLDERS_AND_FILES = {"addon", "native", "tests", "blend_scenes", "docs", "run"} | {
    "CMakeLists.txt", "CMakePresets.json", "README.md", "CHANGELOG.md", "LICENSE", "pyproject.toml"
}  # fmt: skip
MAX_LINES = 400
CODE = {".h", ".cpp", ".py", ".cmake", ".sh", ""}
LINK = re.compile(r"!?\[[^\]]*\]\(([^)#\s]+)[^)]*\)|<img[^>]*src=\"([^\"]+)\"")


def tracked_files() -> list[Path]:
    names = subprocess.run(["git", "ls-files", "-z"], check=True, capture_output=True, text=True)
    return [Path(name) for name in names.stdout.split("\0") if name and Path(name).exists()]


def layout_faults(files: list[Path]) -> list[str]:
    """Names at the top level that are neither agreed on nor a tool's dot file."""
    names = {file.parts[0] for file in files}
    strangers = sorted(n for n in names - FOLDERS_AND_FILES if not n.startswith("."))
    return [f"{name}: does not belong at the top level" for name in strangers]


def length_faults(files: list[Path]) -> list[str]:
    faults = []
    for file in files:
        if file.suffix in CODE and file.name != "LICENSE":
            lines = len(file.read_bytes().splitlines())
            if lines > MAX_LINES:
                faults.append(f"{file}: {lines} lines, more than {MAX_LINES}")
    return faults


def link_faults(files: list[Path]) -> list[str]:
    """Links in documents to files that are not in the repository."""
    faults = []
    known = {str(file) for file in files} | {str(p) for file in files for p in file.parents}
    for file in files:
        if file.suffix != ".md":
            continue
        for groups in LINK.findall(file.read_text(encoding="utf-8")):
            target = groups[0] or groups[1]
            if "://" in target:
                continue
            resolved = (Path.cwd() / file.parent / target).resolve()
            if str(resolved.relative_to(Path.cwd())) not in known:
                faults.append(f"{file}: links to {target}, which is not in the repository")
    return faults


def main() -> int:
    files = tracked_files()
    faults = layout_faults(files) + length_faults(files) + link_faults(files)
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
