"""Embree 3: streams of rays against its own spheres. NumPy makes the rays and shades; only Embree's calls are timed."""

import ctypes
from ctypes import c_char_p, c_float, c_int, c_size_t, c_uint, c_void_p
from pathlib import Path

import numpy as np

from compared.program import Clock, Method, Program, Rendered, averaged, grids
from compared.scenes import Scene

STREAMS = Method(
    "Embree, rays only",
    "rtcIntersect1M, rtcOccluded1M, threads=1, RTC_GEOMETRY_TYPE_SPHERE_POINT",
    **grids([1, 2, 4, 8, 16, 32]),
)
# Numbers of embree3/rtcore_*.h.
SPHERE_POINT, VERTEX_BUFFER, FLOAT4, COHERENT, INVALID = 50, 1, 0x9004, 1, 0xFFFFFFFF
RAY_AND_HIT = np.dtype(
    [("origin", "<f4", 3), ("near", "<f4"), ("direction", "<f4", 3), ("time", "<f4"), ("far", "<f4")]
    + [("mask", "<u4"), ("id", "<u4"), ("flags", "<u4"), ("normal", "<f4", 3), ("uv", "<f4", 2)]
    + [("primitive", "<u4"), ("geometry", "<u4"), ("instance", "<u4")]
)
# Shadow rays begin this far from the surface: some units in the last place of coordinates in single precision.
NEAR = 1e-3
ROWS_OF_SAMPLES = 256


class Context(ctypes.Structure):
    _fields_ = [("flags", c_int), ("filter", c_void_p), ("instance", c_uint)]


class Embree(Program):
    name = "Embree"
    methods = [STREAMS]

    def __init__(self, library):
        self.library, self.loaded = library, (None, None)
        for name in ["rtcNewDevice", "rtcNewScene", "rtcNewGeometry", "rtcSetNewGeometryBuffer"]:
            getattr(library, name).restype = c_void_p
        library.rtcNewDevice.argtypes = [c_char_p]
        library.rtcGetDeviceProperty.restype = ctypes.c_ssize_t
        library.rtcGetDeviceProperty.argtypes = [c_void_p, c_int]
        self.device = library.rtcNewDevice(b"threads=1")
        major, minor, patch = (library.rtcGetDeviceProperty(self.device, field) for field in (1, 2, 3))
        self.version = f"{major}.{minor}.{patch}"

    @staticmethod
    def find() -> "Embree | None":
        try:
            return Embree(ctypes.CDLL("libembree3.so.3"))
        except OSError:
            return None

    def render(self, scene: Scene, method: Method, setting, folder: Path) -> Rendered:
        if self.loaded[0] is not scene:
            self.loaded = (scene, self.build(scene))
        centers = np.array([sphere.center for sphere in scene.spheres])
        radii = np.array([sphere.radius for sphere in scene.spheres])
        albedos = np.array([sphere.albedo for sphere in scene.spheres])
        viewpoint = np.array([0.0, 0.0, -scene.distance])
        light = np.array(scene.toward_light) / np.linalg.norm(scene.toward_light)
        side = setting * scene.side
        places = ((np.arange(side) + 0.5) / side - 0.5) * scene.retina
        # Whole pixels, and neighbors in a stream.
        rows, clock, bands = max(ROWS_OF_SAMPLES // setting, 1) * setting, Clock(), []
        for first in range(0, side, rows):
            y, x = np.meshgrid(-places[first : first + rows], places, indexing="ij")
            directions = np.stack([x, y, np.ones_like(x)], axis=-1).reshape(-1, 3)
            hits = self.trace(self.library.rtcIntersect1M, viewpoint, directions, 0.0, clock)
            seen = np.flatnonzero(hits["geometry"] != INVALID)
            spheres = hits["primitive"][seen]
            points, normals = nearest(viewpoint, directions[seen], centers[spheres], radii[spheres])
            facing = normals @ light
            lit = np.flatnonzero(facing > 0)
            to_light = np.tile(light, (len(lit), 1))
            shadows = self.trace(self.library.rtcOccluded1M, points[lit], to_light, NEAR, clock)
            lit = lit[shadows["far"] >= 0]
            band = np.zeros_like(directions)
            band[seen[lit]] = albedos[spheres[lit]] * facing[lit, None]
            bands.append(averaged(band.reshape(-1, side, 3), setting))
        return Rendered(np.concatenate(bands), clock.seconds)

    def build(self, scene: Scene) -> int:
        library = self.library
        world = library.rtcNewScene(c_void_p(self.device))
        geometry = library.rtcNewGeometry(c_void_p(self.device), SPHERE_POINT)
        library.rtcSetNewGeometryBuffer.argtypes = [c_void_p, c_int, c_uint, c_int, c_size_t, c_size_t]
        count = len(scene.spheres)
        buffer = library.rtcSetNewGeometryBuffer(geometry, VERTEX_BUFFER, 0, FLOAT4, 16, count)
        numbers = np.ctypeslib.as_array(ctypes.cast(buffer, ctypes.POINTER(c_float)), (count, 4))
        numbers[:] = [(*sphere.center, sphere.radius) for sphere in scene.spheres]
        library.rtcCommitGeometry(c_void_p(geometry))
        library.rtcAttachGeometry(c_void_p(world), c_void_p(geometry))
        library.rtcCommitScene(c_void_p(world))
        return world

    def trace(self, function, origins: np.ndarray, directions: np.ndarray, near: float, clock) -> np.ndarray:
        """The rays after Embree has followed them."""
        rays = aligned(len(directions))
        rays["origin"], rays["direction"], rays["near"], rays["far"] = origins, directions, near, np.inf
        rays["mask"], rays["geometry"], rays["instance"] = INVALID, INVALID, INVALID
        context = Context(COHERENT, None, INVALID)
        function.argtypes = [c_void_p, c_void_p, c_void_p, c_uint, c_size_t]
        function.restype = None
        with clock:
            function(self.loaded[1], ctypes.byref(context), rays.ctypes.data, len(rays), RAY_AND_HIT.itemsize)
        return rays


def aligned(count: int) -> np.ndarray:
    """Rays at an address that Embree takes."""
    memory = np.zeros(count * RAY_AND_HIT.itemsize + 64, dtype=np.uint8)
    start = -memory.ctypes.data % 64
    return memory[start : start + count * RAY_AND_HIT.itemsize].view(RAY_AND_HIT)


def nearest(viewpoint, directions, centers, radii) -> tuple[np.ndarray, np.ndarray]:
    """Where rays from the viewpoint meet the spheres that Embree found, in double precision, and the normals there."""
    units = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    centers = centers - viewpoint
    along = (units * centers).sum(axis=1, keepdims=True)
    foot = along * units - centers
    inside = np.maximum(radii[:, None] ** 2 - (foot**2).sum(axis=1, keepdims=True), 0)
    normals = (foot - np.sqrt(inside) * units) / radii[:, None]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return viewpoint + centers + radii[:, None] * normals, normals
