"""The modules as files: what they show to Blender, and what they make Blender load."""

import subprocess
import sys

import komorebi_core._image
import komorebi_core._komorebi
import pytest

MODULES = {"_komorebi": komorebi_core._komorebi, "_image": komorebi_core._image}


def binutils(name: str, *command: str) -> list[str]:
    file = MODULES[name].__file__
    return subprocess.run(
        [*command, file], check=True, capture_output=True, text=True
    ).stdout.splitlines()


def needed(name: str) -> str:
    return " ".join(line for line in binutils(name, "objdump", "-p") if "NEEDED" in line)


@pytest.mark.parametrize("name", MODULES)
def test_only_the_init_function_is_exported(name):
    exported = [line.split()[-1] for line in binutils(name, "nm", "-D", "--defined-only")]
    assert exported == [f"PyInit_{name}"]


@pytest.mark.parametrize("name", MODULES)
def test_no_library_that_clashes_with_blenders_own_is_linked(name):
    assert "libc.so" in needed(name)
    for library in ("tbb", "gomp", "omp", "embree", "python"):
        assert library not in needed(name)


def test_image_libraries_are_loaded_only_for_an_image_file():
    assert "OpenImageIO" not in needed("_komorebi")
    assert "OpenImageIO" in needed("_image")
    code = "import sys, komorebi_core; print('komorebi_core._image' in sys.modules)"
    package = str(komorebi_core.__path__[0]).rsplit("/", 1)[0]
    said = subprocess.run(
        [sys.executable, "-c", code],
        check=True, capture_output=True, text=True, env={"PYTHONPATH": package},
    ).stdout  # fmt: skip
    assert said == "False\n"


@pytest.mark.parametrize("name", MODULES)
def test_no_folder_of_the_build_is_searched_for_libraries(name):
    lines = binutils(name, "objdump", "-p")
    assert not [line for line in lines if "RPATH" in line or "RUNPATH" in line]
