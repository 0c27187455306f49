"""A scene as plain arrays, between Blender and the core. No bpy in here.

World space is Blender's: metres, Z up. Rows run bottom-up, colours are scene-linear Rec.709.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from hashlib import sha256
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float32]
DoubleArray = NDArray[np.float64]
IntArray = NDArray[np.int32]
UIntArray = NDArray[np.uint32]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class MeshKey:
    """What a shape was made from: digests of its geometry (which decides where rays hit) and of
    its shading. Two shapes with the same geometry share a tree."""

    geometry: bytes
    shading: bytes


@dataclass(frozen=True, slots=True)
class Attribute:
    """A named array on a shape, with a row an element of its domain."""

    domain: str  # POINT, CORNER, FACE or CURVE
    values: FloatArray  # [elements, 1 to 4]; colours are linear


@dataclass(slots=True)
class MeshData:
    """One mesh in its own space; face f has corners face_offsets[f] to face_offsets[f + 1] − 1."""

    name: str
    positions: FloatArray  # [vertices, 3]
    corner_verts: IntArray  # [corners]
    face_offsets: IntArray  # [faces + 1]
    tri2corner: IntArray | None = None  # [triangles, 3]; None: no face has more than 4 corners
    tri2face: IntArray | None = None  # [triangles]; with tri2corner
    corner_normals: FloatArray | None = None  # [corners, 3]
    vertex_normals: FloatArray | None = None  # [vertices, 3]; with neither all faces are flat
    smooth_faces: BoolArray | None = None  # [faces]; None: all smooth if there are normals
    face_materials: IntArray | None = None  # [faces]; None: all slot 0
    corner_uvs: FloatArray | None = None  # [corners, 2]; None: no UV map, or no pass that shows it
    # Of a mesh that deforms while the shutter is open: as `positions` and whichever normals there
    # are, at the other times in their order; with `positions` in the middle at even ones.
    motion_positions: FloatArray | None = None  # [2k, vertices, 3]
    motion_normals: FloatArray | None = None  # [2k, corners or vertices, 3]; None: always the same
    # For the pass Vector alone: positions one frame before and after, of a mesh that stands still.
    step_positions: FloatArray | None = None  # [2, vertices, 3]
    attributes: dict[str, Attribute] = field(default_factory=dict)
    key: MeshKey | None = None

    @property
    def primitive_count(self) -> int:
        return len(self.corner_verts) - 2 * (len(self.face_offsets) - 1)


@dataclass(slots=True)
class CurveData:
    """Hair and other curves in their own space, through keys by Catmull and Rom; curve c has keys
    curve_offsets[c] to curve_offsets[c + 1] − 1."""

    name: str
    positions: FloatArray  # [keys, 3]
    radii: FloatArray  # [keys], half a curve's width, not negative
    curve_offsets: IntArray  # [curves + 1]
    shape: str = "RIBBONS"  # or THICK, or THICK_LINEAR: straight from key to key
    subdivisions: int = 2  # a ribbon's segment is drawn by 2 ** subdivisions + 1 pieces
    curve_materials: IntArray | None = None  # [curves], material slots; None: all the first
    curve_uvs: FloatArray | None = None  # [curves, 2]; None: no UV map, or no pass that shows it
    # As of MeshData, keys in place of vertices.
    motion_positions: FloatArray | None = None  # [2k, keys, 3]
    motion_radii: FloatArray | None = None  # [2k, keys]; None: always the same
    step_positions: FloatArray | None = None  # [2, keys, 3]
    attributes: dict[str, Attribute] = field(default_factory=dict)
    key: MeshKey | None = None

    @property
    def primitive_count(self) -> int:
        return len(self.radii)


@dataclass(slots=True)
class PointData:
    """A point cloud in its own space: a sphere a point."""

    name: str
    positions: FloatArray  # [points, 3]
    radii: FloatArray  # [points], not negative
    # As of MeshData, points in place of vertices.
    motion_positions: FloatArray | None = None  # [2k, points, 3]
    motion_radii: FloatArray | None = None  # [2k, points]; None: always the same
    step_positions: FloatArray | None = None  # [2, points, 3]
    attributes: dict[str, Attribute] = field(default_factory=dict)
    key: MeshKey | None = None

    @property
    def primitive_count(self) -> int:
        return len(self.radii)


@dataclass(slots=True)
class KnownShape:
    """A shape that the core has already, and whose arrays were not read again."""

    name: str
    key: MeshKey
    mesh: Any  # core.Mesh

    @property
    def primitive_count(self) -> int:
        return int(self.mesh.primitive_count)


AnyMesh = MeshData | CurveData | PointData | KnownShape


@dataclass(slots=True)
class InstanceData:
    """All copies of one mesh. Matrices are world_from_object, mathematics' row-major (M @ p)."""

    mesh: int  # index into SceneData.meshes
    name: str
    matrices: FloatArray  # [count, 4, 4], single precision as Blender has them
    object_index: UIntArray  # [count], index into SceneData.objects
    mask: UIntArray | None = None  # [count], bits RAY_*; None: seen by every ray
    flags: UIntArray | None = None  # [count], bits FLAG_*; None: none
    material_slots: UIntArray | None = None  # [count], index into Materials.slots; None: all 0
    random: FloatArray | None = None  # [count], from 0 to 1; None: no surface asks for it
    # At an odd number of even times from the opening of the shutter to the closing; `matrices` are
    # the middle ones. None: all of them stand still.
    motion: DoubleArray | None = None  # [count, 2k + 1, 4, 4]

    def take(self, rows: NDArray[Any]) -> InstanceData:
        """Some of the instances, by index or by a mask [count]."""
        chosen = {
            name: None if array is None else array[rows]
            for name in ("mask", "flags", "material_slots", "random", "motion")
            for array in (getattr(self, name),)
        }
        return replace(
            self, matrices=self.matrices[rows], object_index=self.object_index[rows], **chosen
        )


RAY_CAMERA = 1 << 0
RAY_DIFFUSE = 1 << 1
RAY_SHADOW = 1 << 2
RAY_ALL = 0xFFFFFFFF
FLAG_HOLDOUT = 1 << 0
FLAG_SHADOW_CATCHER = 1 << 1


@dataclass(slots=True)
class CameraData:
    """A camera, full frame in pixels. `matrix` is projection × view (clip space as OpenGL's), of a
    panorama the camera's pose: world from camera, its axes right, up, back.

    `lens`, `panorama` and `stereo` hold numbers by the names that the core knows
    (native/render/camera_fields.h); None: a pinhole, no panorama, no eye that turns. `shutter` and
    `motion` likewise, as the core's set_camera takes them; None: plain, and it stands still.
    """

    name: str
    kind: str  # PERSPECTIVE, ORTHOGRAPHIC, PANORAMA
    matrix: DoubleArray  # [4, 4]
    clip_start: float  # metres along the view axis, of a panorama along the ray
    clip_end: float
    width: int
    height: int
    lens: dict[str, float] | None = None
    panorama: dict[str, Any] | None = None
    stereo: dict[str, float] | None = None
    shutter: dict[str, Any] | None = None
    motion: dict[str, Any] | None = None


# What a node of a shader tree works on: a number, or (index of an operation, which of its outputs).
Operand = float | tuple[int, int]
Value = tuple[Operand, ...]  # one operand for a number, three for a colour or vector


@dataclass(slots=True)
class Op:
    """An operation of core.Program."""

    op: str
    operands: Value = ()
    numbers: tuple[float, ...] = ()
    table: FloatArray | None = None
    name: str = ""
    texture: Any = None  # TextureImage


@dataclass(slots=True)
class ProgramData:
    """What core.Program is made of."""

    name: str
    ops: list[Op] = field(default_factory=list)
    outputs: Value = ()

    def key(self) -> bytes:
        """The same for programs that do the same."""
        said = [
            (
                o.op, o.operands, o.numbers,
                b"" if o.table is None else sha256(o.table.tobytes()).digest(), o.name,
                None if o.texture is None else o.texture.key,
            )
            for o in self.ops
        ]  # fmt: skip
        return repr((said, self.outputs)).encode()


@dataclass(frozen=True, slots=True)
class Lobe:
    """A part of a surface's light: matt reflection, or passing through to the other side."""

    transmits: bool
    has_normal: bool  # of its own, three outputs after its weight


@dataclass(slots=True)
class SurfacePrograms:
    """A surface for one kind of ray. Outputs: emission, transparency (weight of what goes straight
    through), holdout (1), then of each lobe its weight and, if it has one, its normal."""

    program: ProgramData
    lobes: tuple[Lobe, ...]


@dataclass(slots=True)
class SurfaceData:
    """A material's surface."""

    camera: SurfacePrograms
    bounce: SurfacePrograms | None = None  # for rays that bounce light; None: the same
    clear: ProgramData | None = None  # transparency to rays that look for light; None: opaque
    notes: set[str] = field(default_factory=set)  # what is rendered as something simpler

    def programs(self) -> list[ProgramData]:
        """All that it is made of."""
        surfaces = [self.camera, *([self.bounce] if self.bounce else [])]
        return [s.program for s in surfaces] + ([self.clear] if self.clear else [])


@dataclass(slots=True)
class TextureImage:
    """A picture for an Image Texture: a file, a packed file's bytes, pixels, or tiles (UDIM)."""

    name: str
    key: bytes  # the same for pictures that look the same
    color_space: str = "LINEAR"  # or SRGB, NON_COLOR
    alpha_mode: str = "STRAIGHT"  # or PREMUL, CHANNEL_PACKED, NONE
    matrix: DoubleArray | None = None  # [3, 3] linear Rec. 709 from other primaries
    path: str | None = None
    packed: bytes | None = None
    # [height, width, 4] uint8, straight, or [height, width, 1 or 4] float32, weighed by alpha
    pixels: Any = None
    tiles: dict[int, TextureImage] | None = None  # by UDIM number


@dataclass(slots=True)
class EnvironmentImage:
    """An equirectangular picture: either a file for the core to read, or pixels."""

    name: str
    path: str | None = None
    color_space: str = "LINEAR"  # of the file: LINEAR, SRGB
    pixels: FloatArray | None = None  # [height, width, 3], linear, row 0 at the bottom


@dataclass(slots=True)
class SunData:
    """The disc of a sky's sun, which no map of the world holds."""

    direction: tuple[float, float, float]  # towards it, unit
    radius: float  # of the disc, an angle in radians
    program: ProgramData  # the world's with the disc's radiance everywhere


@dataclass(slots=True)
class WorldData:
    """What lights the scene: one colour (radiance, its strength included), a map times `strength`,
    or a program that a map is made from."""

    color: tuple[float, float, float] = (0.0, 0.0, 0.0)
    image: EnvironmentImage | None = None
    strength: float = 1.0
    texture_from_world: DoubleArray = field(default_factory=lambda: np.eye(3))  # [3, 3]
    program: ProgramData | None = None  # three outputs, radiance
    program_size: int = 0  # columns of pixels that its images have; 0: it has none
    resolution: int = 0  # columns of pixels of the map that is made from the program; 0: automatic
    camera_program: ProgramData | None = None  # what camera rays see; None: the same
    suns: list[SunData] = field(default_factory=list)  # besides `program`
    max_bounces: int = 1024  # of the suns


@dataclass(slots=True)
class LampData:
    """Light besides the world, as the core's add_lamp takes it."""

    name: str
    kind: str  # SUN, TANGENT_SUN, DIRECTION, SPHERE, DISK, POINT, RECTANGLE, ELLIPSE
    radiance: DoubleArray  # [3], or irradiance or intensity where the kind has no solid angle
    matrix: DoubleArray  # [4, 4] world from lamp, M @ p
    sizes: dict[str, float] = field(default_factory=dict)  # by the core's names
    casts_shadow: bool = True
    lights_catchers: bool = True
    spot_scales_by_cosine: bool = False
    program: ProgramData | None = None  # of what its light is multiplied by, three outputs
    uneven: str = ""  # the warning if that varies over the lamp


@dataclass(slots=True)
class ObjectData:
    """An object as passes tell of it."""

    name: str
    pass_index: int
    asset: str  # the name of the object that it hangs on in the end, itself without a parent
    # Shadow terminator: the cosine below which rays leave above coarse smooth faces; how much of
    # the cosine's end is cut off, 0 to 1.
    terminator_geometry_offset: float = 0.0
    terminator_shading_offset: float = 0.0
    color: tuple[float, ...] = (1.0, 1.0, 1.0, 1.0)  # of the viewport display, for Object Info


@dataclass(slots=True)
class MaterialData:
    """A material as passes tell of it."""

    name: str
    pass_index: int
    surface: SurfaceData | None = None
    values: ProgramData | None = None  # an output for each of passes.value_columns; None: all 0

    def programs(self) -> list[ProgramData]:
        """All that are run at its surfaces."""
        of_surface = [] if self.surface is None else self.surface.programs()
        return of_surface + ([self.values] if self.values else [])


@dataclass(slots=True)
class Materials:
    """The materials in use, and the lists of slots that instances have."""

    materials: list[MaterialData] = field(default_factory=list)
    slots: list[tuple[int, ...]] = field(default_factory=list)  # indices of materials
    value_count: int = 0  # outputs of MaterialData.values


@dataclass(slots=True)
class SceneData:
    """Everything that a view layer of a frame shows."""

    cameras: dict[str, CameraData]  # by view, "" where there is only one; the first one's first
    world: WorldData
    meshes: list[AnyMesh] = field(default_factory=list)
    instances: list[InstanceData] = field(default_factory=list)
    objects: list[ObjectData] = field(default_factory=list)
    lamps: list[LampData] = field(default_factory=list)
    materials: Materials = field(default_factory=Materials)
    world_values: ProgramData | None = None  # as MaterialData.values, where there is only world
    texture_limit: int = 1 << 30  # bytes of all textures together
    ignored: dict[str, int] = field(default_factory=dict)  # kind of object → how many

    @property
    def camera(self) -> CameraData:
        return next(iter(self.cameras.values()))
