"""Pieces of geometry in the frame of a link: simple shapes, and meshes from files."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import urllib.parse
import warnings

import numpy as np
import numpy.typing as npt

from ... import _files
from ... import mesh as mesh_files
from ... import shapes
from ..._attitude.rotation import Rotation
from ..._core import InvalidInput, MassProperties

Array = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Pose:
    """Axes and origin of one frame in another: x_B = turn @ x_A + place."""

    turn: Array = dataclasses.field(default_factory=lambda: np.eye(3))
    place: Array = dataclasses.field(default_factory=lambda: np.zeros(3))

    def __matmul__(self, other: Pose) -> Pose:
        return Pose(self.turn @ other.turn, self.turn @ other.place + self.place)


@dataclasses.dataclass(frozen=True)
class Part:
    """A piece of geometry in the link's frame: the body of unit density, where there is one, and a box's corners."""

    solid: MassProperties | None
    corners: Array


@dataclasses.dataclass
class Assembly:
    """The parts of what a link looks like, or collides with; `whole` unless something of it could not be read."""

    parts: list[Part] = dataclasses.field(default_factory=list)
    whole: bool = True

    def solid(self) -> MassProperties | None:
        """All parts as one uniform body of unit density; where they overlap, they count twice."""
        if not self.parts or not self.whole:
            return None
        total: MassProperties | None = None
        for part in self.parts:
            if part.solid is None:
                return None
            total = part.solid if total is None else total + part.solid
        return total


def ball(radius: float, pose: Pose) -> Part:
    return _part(shapes.sphere(1.0, radius), np.full(3, radius), 4 / 3 * np.pi * radius**3, pose)


def ellipsoid(axes: Array, pose: Pose) -> Part:
    return _part(shapes.ellipsoid(1.0, axes), axes, 4 / 3 * np.pi * axes.prod(), pose)


def block(half: Array, pose: Pose) -> Part:
    return _part(shapes.box(1.0, half), half, 8 * half.prod(), pose)


def cylinder(radius: float, height: float, pose: Pose) -> Part:
    return _part(shapes.cylinder(1.0, radius, height), np.array([radius, radius, height / 2]),
                 np.pi * radius**2 * height, pose)


def capsule(radius: float, height: float, pose: Pose) -> Part:
    return _part(shapes.capsule(1.0, radius, height), np.array([radius, radius, height / 2 + radius]),
                 np.pi * radius**2 * (height + 4 / 3 * radius), pose)


def _part(unit: MassProperties, half: Array, volume: float, pose: Pose) -> Part:
    solid = MassProperties(volume, unit.com, np.asarray(unit.inertia.matrix) * volume)
    signs = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    return Part(solid.moved(Rotation.from_matrix(pose.turn), pose.place), (signs * half) @ pose.turn.T + pose.place)


def mesh(file: pathlib.Path, scale: Array, pose: Pose) -> Part:
    """A mesh: the body inside where it is closed, and the box round it in any case."""
    vertices, faces = mesh_files.read(file)
    vertices = vertices * scale @ pose.turn.T + pose.place
    used = vertices[np.unique(faces)]
    signs = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    low, high = used.min(0), used.max(0)
    try:
        with warnings.catch_warnings():   # of its size, which is compared here, and of a mirrored scale's winding
            warnings.simplefilter("ignore")
            solid = MassProperties.from_mesh(vertices, faces, density=1.0, repair="flip")
    except InvalidInput:
        solid = None   # open, as many visual meshes are
    return Part(solid, low + signs * (high - low))


def find(uri: str, beside: pathlib.Path) -> pathlib.Path | None:
    """Find a mesh file: a path, or package://, model:// and file:// as ROS and Gazebo mean them."""
    scheme, _, rest = uri.rpartition("://")
    rest = urllib.parse.unquote(rest) if scheme else rest
    if scheme in ("", "file"):
        candidates = [beside.parent / rest]
    elif scheme in ("package", "model"):
        package, _, inside = rest.partition("/")
        roots = [pathlib.Path(p) for variable in ("ROS_PACKAGE_PATH", "GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH")
                 for p in os.environ.get(variable, "").split(os.pathsep) if p]
        folders = list(beside.resolve().parents)
        candidates = [folder / inside for folder in folders if folder.name == package]
        candidates += [folder / rest for folder in [*folders, *roots]]
        candidates += [root / "share" / rest for root in roots] + [folders[0] / inside]
    else:
        return None
    return next((file for file in candidates if _files.is_file(file)), None)
