"""Denoising by Open Image Denoise (OIDN), where a library of it is found.

`library.py` looks for one, `worker.py` calls it in a process of its own, `run.py` feeds that
process from the film.
"""
