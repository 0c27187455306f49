"""Runs test files inside Blender: every function test_* of each, with a fresh startup scene.

    blender -b --factory-startup --python-exit-code 1 -P tests/blender/run_in_blender.py -- FILE...
    python tests/blender/run_in_blender.py FILE...          (with the `bpy` module)

FILE may be followed by ::NAME for one function. The add-on and the core are found in the folder
that BLENDER_USER_SCRIPTS names. Prints one line a test and a summary; exits with 1 if one failed.
"""

import importlib.util
import inspect
import sys
import time
import traceback
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
sys.dont_write_bytecode = True

import support  # noqa: E402


def load(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def run(name, function):
    """ "ok", "FAILED" or "skipped: why"."""
    start = time.monotonic()
    try:
        support.fresh_scene()
        with support.folder() as folder:
            function(folder) if inspect.signature(function).parameters else function()
        outcome = "ok"
    except support.Skip as reason:
        outcome = f"skipped: {reason}"
    except BaseException:
        traceback.print_exc()
        outcome = "FAILED"
    print(f"[test] {name}: {outcome} ({time.monotonic() - start:.2f} s)", flush=True)
    return outcome


def main(arguments):
    support.enable()
    outcomes = []
    for argument in arguments:
        file, _, only = argument.partition("::")
        module = load(Path(file))
        for name, function in list(vars(module).items()):
            if name.startswith("test_") and callable(function) and only in ("", name):
                outcomes.append(run(f"{Path(file).stem}.{name}", function))
    failed = outcomes.count("FAILED")
    print(f"[test] Blender {bpy.app.version_string}: {len(outcomes)} tests, {failed} failed, "
          f"{sum(o.startswith('skipped') for o in outcomes)} skipped")  # fmt: skip
    return 1 if failed or not outcomes else 0


if __name__ == "__main__":
    inside = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    sys.exit(main(inside))
