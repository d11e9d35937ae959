"""Scenes of spheres, rendered with a known error for every pixel.

    import marbles

    scene = marbles.Scene(
        image=dict(width=300, height=200),
        lens=marbles.Fov(40),
        camera=marbles.LookAt(position=(0, 3, -10), target=(0, 0.7, 0)),
        lights=[marbles.Directional(toward=(-1, 1.5, -1))],
        spheres=marbles.Spheres(center=[(0, -1000, 0), (0, 1, 0)], radius=[1000, 1], color=[(1, 1, 1), (0.6, 0, 0.1)]),
    )
    picture = scene.render(tolerance=1e-3, channels=("depth", "normal"))
    print(picture.light.shape, picture.largest_error, picture.over, picture["depth"].min())
    picture.save("ball.png")

Names, defaults, units and axes are those of scene files: lengths in scene units, angles in degrees, x right, y up, z
forward. A value `Name(a: 1)` of a file is `marbles.Name(a=1)`, and a dict with the same keys does as well.
"""

from ._native import VERSION as __version__
from ._native import RenderError, SceneError
from .camera import Camera
from .cloud import Spheres
from .columns import Between, Constant, Diverging, Every, Exponential, Is, Length, Percentile, Power
from .comparison import Comparison, compare
from .data import dataset
from .faults import SceneWarning
from .lights import Directional, Point, Sky, Surface, Units
from .motion import Keyframes, Turntable
from .picture import Picture
from .scene import Scene, load, loads, spheres
from .sequence import Frames
from .variant import Variant
from .view import Fov, Frame, Free, LookAt, Matrix, Orbit, Parallel, Pose, Retina

__all__ = [
    "Between",
    "Camera",
    "Comparison",
    "Constant",
    "Directional",
    "Diverging",
    "Every",
    "Exponential",
    "Fov",
    "Frame",
    "Frames",
    "Free",
    "Is",
    "Keyframes",
    "Length",
    "LookAt",
    "Matrix",
    "Orbit",
    "Parallel",
    "Percentile",
    "Picture",
    "Point",
    "Pose",
    "Power",
    "RenderError",
    "Retina",
    "Scene",
    "SceneError",
    "SceneWarning",
    "Sky",
    "Spheres",
    "Surface",
    "Turntable",
    "Units",
    "Variant",
    "__version__",
    "compare",
    "dataset",
    "load",
    "loads",
    "spheres",
]
