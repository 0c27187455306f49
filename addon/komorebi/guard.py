"""The one place where exceptions of a render end: each becomes a sentence for the user.

Blender swallows a Python exception in an engine and saves a black picture with exit code 0, so
nothing may leave `run` but by `failure.fail`.
"""

from __future__ import annotations

import sys
import traceback
from typing import Any

from . import failure
from .errors import RenderCancelled, RenderError


def run(engine: Any, depsgraph: Any, step: str, *args: Any) -> Any:
    """Calls `driver.<step>(engine, depsgraph, *args)`; None when it failed or was cancelled."""
    try:
        # Late, so that the add-on can be enabled, and can say what is wrong, without NumPy.
        from . import driver

        return getattr(driver, step)(engine, depsgraph, *args)
    except RenderCancelled:
        return None
    except RenderError as error:
        failure.fail(engine, depsgraph, str(error))
    except MemoryError:
        failure.fail(engine, depsgraph, "Out of memory: the scene is too large for this machine")
    except KeyboardInterrupt:
        failure.fail(engine, depsgraph, "Interrupted from the keyboard")
    except ModuleNotFoundError as error:
        failure.fail(engine, depsgraph, _missing_module(error))
    except BaseException as error:
        traceback.print_exc()
        failure.fail(engine, depsgraph, f"Unexpected {type(error).__name__}: {error}")
    return None


def _missing_module(error: ModuleNotFoundError) -> str:
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    if error.name == "numpy":
        return (
            f"NumPy is missing in the Python {version} of this Blender "
            "(on Debian: apt-get install python3-numpy)"
        )
    return f"The Python module {error.name} is missing in the Python {version} of this Blender"
