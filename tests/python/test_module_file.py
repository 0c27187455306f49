"""The module as a file: what it shows to Blender, and what it makes Blender load."""

import subprocess

import komorebi_core._komorebi as module


def binutils(*command: str) -> list[str]:
    output = subprocess.run([*command, module.__file__], check=True, capture_output=True, text=True)
    return output.stdout.splitlines()


def test_only_the_init_function_is_exported():
    exported = [line.split()[-1] for line in binutils("nm", "-D", "--defined-only")]
    assert exported == ["PyInit__komorebi"]


def test_no_library_that_clashes_with_blenders_own_is_linked():
    needed = " ".join(line for line in binutils("objdump", "-p") if "NEEDED" in line)
    assert "libc.so" in needed
    for library in ("tbb", "gomp", "omp", "embree", "python"):
        assert library not in needed


def test_no_folder_of_the_build_is_searched_for_libraries():
    assert not [line for line in binutils("objdump", "-p") if "RPATH" in line or "RUNPATH" in line]
