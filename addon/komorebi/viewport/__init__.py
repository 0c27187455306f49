"""The rendered viewport. `viewport.py` is what the engine calls, on Blender's thread: it exports
what has changed and draws the picture that is there. `worker.py` renders meanwhile, on a thread of
its own; `view_camera.py` is where the view looks from, and `drawing.py` the way onto the screen.
"""
