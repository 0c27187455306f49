"""What the bench says while it works."""

from __future__ import annotations

import sys


def say(text: str) -> None:
    """One line of progress; results go to standard output, this does not."""
    print(text, file=sys.stderr, flush=True)
