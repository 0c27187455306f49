"""A display of one's own (Xvfb), whose pixels are a file."""

import contextlib
import os
import subprocess


@contextlib.contextmanager
def screen(size="960x540x24", frame_buffer=None):
    """The name of a display that ends with the block. Its pixels are the file Xvfb_screen0 in the
    folder `frame_buffer`, if given. FileNotFoundError where Xvfb is not installed."""
    reading, writing = os.pipe()
    try:
        server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writing), "-screen", "0", size, "-nocursor",
             "-nolisten", "tcp",
             *(["-fbdir", str(frame_buffer)] if frame_buffer else [])],
            pass_fds=(writing,), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
    except OSError:
        os.close(reading)
        raise
    finally:
        os.close(writing)
    try:
        with os.fdopen(reading) as numbers:
            yield ":" + numbers.readline().strip()
    finally:
        server.terminate()
        server.wait()
