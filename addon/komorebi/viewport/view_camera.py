"""Where a 3D viewport looks from, as a camera of the core."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..export.camera import KINDS, camera_pose, read_lens
from ..export.lens import lens_numbers
from ..export.panorama import panorama_numbers
from ..scene_data import DoubleArray

Rect = tuple[int, int, int, int]  # x_min, y_min, x_max, y_max, half open


@dataclass(frozen=True, slots=True)
class ViewCamera:
    """A camera whose film lies somewhere in a region; equal ones show the same."""

    kind: str
    matrix: tuple[float, ...]  # [4, 4], as the core's Camera takes it
    clip_start: float
    clip_end: float
    film: Rect  # pixels of the region that the matrix' picture covers
    region: Rect  # pixels of the region that are rendered, within the film
    lens: tuple[tuple[str, float], ...] | None = None
    panorama: tuple[tuple[str, Any], ...] | None = None

    @property
    def width(self) -> int:
        return self.region[2] - self.region[0]

    @property
    def height(self) -> int:
        return self.region[3] - self.region[1]


@dataclass(frozen=True, slots=True)
class CoarseView:
    """A view rendered by pixels that are `pixel` wide and high on the screen."""

    columns: int  # of the picture
    rows: int
    camera: Any  # core.Camera
    region: Rect  # of its own pixels


def coarse_view(core: Any, view: ViewCamera, pixel: int) -> CoarseView:
    """Pixels are whole: where they do not fill the film, the last ones stick out of it."""
    width, height = view.film[2] - view.film[0], view.film[3] - view.film[1]
    columns, rows = -(-width // pixel), -(-height // pixel)
    matrix = np.array(view.matrix, np.float64).reshape(4, 4)
    if view.panorama is None and pixel > 1:
        fit = np.eye(4)
        fit[0, 0], fit[1, 1] = width / (columns * pixel), height / (rows * pixel)
        fit[0, 3], fit[1, 3] = fit[0, 0] - 1.0, fit[1, 1] - 1.0
        matrix = fit @ matrix
    camera = core.Camera(
        view.kind, matrix, view.clip_start, view.clip_end, columns, rows,
        lens=None if view.lens is None else dict(view.lens),
        panorama=None if view.panorama is None else dict(view.panorama),
    )  # fmt: skip
    x, y = view.region[0] - view.film[0], view.region[1] - view.film[1]
    first = (x // pixel, y // pixel)
    last = (-(-(x + view.width) // pixel), -(-(y + view.height) // pixel))
    return CoarseView(columns, rows, camera, (*first, min(last[0], columns), min(last[1], rows)))


def view_camera(engine: Any, context: Any, depsgraph: Any) -> ViewCamera | None:
    """The camera of the context's region; None when nothing of it is to be rendered."""
    region, space = context.region, context.space_data
    view = context.region_data
    whole = (0, 0, region.width, region.height)
    film, lens, panorama = whole, None, None
    matrix = np.array(view.window_matrix, np.float64) @ np.array(view.view_matrix, np.float64)
    kind = "PERSPECTIVE" if view.is_perspective else "ORTHOGRAPHIC"
    near, far = _clip(np.array(view.window_matrix, np.float64), view.is_perspective)
    border = _border(space, view, whole)
    if view.view_perspective == "CAMERA" and space.camera is not None:
        camera = space.camera.evaluated_get(depsgraph)
        if camera.type == "CAMERA":
            shape = read_lens(camera)
            pose = camera_pose(engine, camera, "")
            numbers = lens_numbers(camera, depsgraph, pose)
            lens = None if numbers is None else tuple(numbers.items())
            frame = _camera_frame(context, camera)
            if context.scene.render.use_border:
                border = _within(frame, context.scene.render)
            elif camera.data.show_passepartout and camera.data.passepartout_alpha == 1.0:
                # Nothing is seen of what lies outside; the frame may end within a pixel.
                border = (frame[0] - 1, frame[1] - 1, frame[2] + 1, frame[3] + 1)
            if shape.kind == "PANO":
                kind, matrix, film = KINDS["PANO"], pose, frame
                near, far = shape.clip_start, shape.clip_end
                size = (frame[2] - frame[0], frame[3] - frame[1])
                aspect = (1.0, 1.0)  # the frame on the screen has it already
                numbers = panorama_numbers(camera, *size, aspect, (shape.shift_x, shape.shift_y))
                panorama = tuple(numbers.items())
    shown = _common(_common(film, border), whole)
    if shown is None:
        return None
    return ViewCamera(kind, tuple(matrix.ravel().tolist()), near, far, film, shown, lens, panorama)


def _clip(window: DoubleArray, is_perspective: bool) -> tuple[float, float]:
    """The clip distances that a projection was made of."""
    a, b = window[2, 2], window[2, 3]
    if is_perspective:
        return float(b / (a - 1.0)), float(b / (a + 1.0))
    # What is near may lie behind the eye; only the length of the interval counts for the core.
    return 1.0, 1.0 + float(-2.0 / a)


def _border(space: Any, view: Any, whole: Rect) -> Rect:
    """The viewport's own render region (Ctrl B outside of the camera view)."""
    if view.view_perspective == "CAMERA" or not space.use_render_border:
        return whole
    return _fraction(whole, (space.render_border_min_x, space.render_border_min_y,
                             space.render_border_max_x, space.render_border_max_y))  # fmt: skip


def _within(frame: Rect, render: Any) -> Rect:
    return _fraction(frame, (render.border_min_x, render.border_min_y,
                             render.border_max_x, render.border_max_y))  # fmt: skip


def _fraction(rect: Rect, part: tuple[float, float, float, float]) -> Rect:
    x, y, width, height = rect[0], rect[1], rect[2] - rect[0], rect[3] - rect[1]
    return (
        round(x + part[0] * width), round(y + part[1] * height),
        round(x + part[2] * width), round(y + part[3] * height),
    )  # fmt: skip


def _common(a: Rect | None, b: Rect) -> Rect | None:
    if a is None:
        return None
    both = (max(a[0], b[0]), max(a[1], b[1]), min(a[2], b[2]), min(a[3], b[3]))
    return both if both[0] < both[2] and both[1] < both[3] else None


def _camera_frame(context: Any, camera: Any) -> Rect:
    """The frame of a camera that is looked through, in pixels of the region."""
    from bpy_extras.view3d_utils import location_3d_to_region_2d

    corners = camera.data.view_frame(scene=context.scene)
    matrix = camera.matrix_world.normalized()
    places = [
        location_3d_to_region_2d(context.region, context.region_data, matrix @ corner)
        for corner in corners
    ]
    xs = [p.x for p in places if p is not None]
    ys = [p.y for p in places if p is not None]
    if len(xs) < 4:
        return (0, 0, context.region.width, context.region.height)
    return round(min(xs)), round(min(ys)), round(max(xs)), round(max(ys))
