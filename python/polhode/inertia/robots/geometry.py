"""Pieces of geometry in the frame of a link: simple shapes and meshes."""

from __future__ import annotations

import contextlib
import dataclasses

import numpy as np
import numpy.typing as npt

from ... import shapes
from ..._attitude.rotation import Rotation
from ..._core import InvalidInput, MassProperties
from . import meshes

Array = npt.NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Pose:
    """Axes and origin of one frame in another: x_B = rotation @ x_A + place."""

    rotation: Array = dataclasses.field(default_factory=lambda: np.eye(3))
    place: Array = dataclasses.field(default_factory=lambda: np.zeros(3))

    def __matmul__(self, other: Pose) -> Pose:
        return Pose(self.rotation @ other.rotation, self.rotation @ other.place + self.place)

    def inverse(self) -> Pose:
        return Pose(self.rotation.T, -self.rotation.T @ self.place)


@dataclasses.dataclass(frozen=True)
class Part:
    """A piece of geometry in the link's frame: the body of unit density, where there is one, and a box's corners.

    `bound`: the body is the convex hull of an open mesh, which is larger than what it shows.
    """

    solid: MassProperties | None
    corners: Array
    bound: bool = False


@dataclasses.dataclass
class Assembly:
    """The parts of what a link looks like, or collides with; `whole` unless something of it could not be read."""

    parts: list[Part] = dataclasses.field(default_factory=list)
    whole: bool = True

    @property
    def bound(self) -> bool:
        """True if some part is known by its hull alone."""
        return any(part.bound for part in self.parts)

    def solid(self) -> MassProperties | None:
        """All parts as one uniform body of unit density; where they overlap, they count twice."""
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


def cone(radius: float, height: float, pose: Pose) -> Part:
    """With its base at -height/2 along z, as SDFormat has it."""
    unit = shapes.cone(1.0, radius, height).moved(translation=(0, 0, -height / 2))
    return _part(unit, np.array([radius, radius, height / 2]), np.pi * radius**2 * height / 3, pose)


def capsule(radius: float, height: float, pose: Pose) -> Part:
    return _part(shapes.capsule(1.0, radius, height), np.array([radius, radius, height / 2 + radius]),
                 np.pi * radius**2 * (height + 4 / 3 * radius), pose)


def _part(unit: MassProperties, half: Array, volume: float, pose: Pose) -> Part:
    solid = MassProperties(volume, unit.com, np.asarray(unit.inertia.matrix) * volume)
    signs = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    return Part(solid.moved(Rotation.from_matrix(pose.rotation), pose.place),
                (signs * half) @ pose.rotation.T + pose.place)


def mesh(surface: meshes.Surface, scale: Array, pose: Pose) -> Part:
    """A mesh: the body inside where it is closed, else its convex hull; and the box round it in any case."""
    signs = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
    axes = np.abs(pose.rotation).max(1) > 1 - 1e-9
    vertices = signs * (surface.high - surface.low) + surface.low if axes.all() else surface.corners
    vertices = (vertices * scale) @ pose.rotation.T + pose.place   # along the axes the box of the file rotates with it
    low, high = vertices.min(0), vertices.max(0)
    bound = surface.solid is None
    moments = surface.hull if surface.solid is None else surface.solid
    solid = None
    if moments is not None and scale.all():
        with contextlib.suppress(InvalidInput):   # a body that is all but flat
            solid = meshes.placed(moments, scale, pose.rotation, pose.place)
    return Part(solid, low + signs * (high - low), bound)
