"""A link: what its file says of its inertia, and the parts of its geometry."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import urllib.parse
import warnings
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from ... import shapes
from ..._core import InvalidInput, MassProperties
from ...attitude import Rotation
from .. import evidence as ev
from ..corruptions import Cause
from ..diagnosis import judge
from ..findings import Diagnosis

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
class Parts:
    """What a link looks like, or what it collides with; `whole` unless something of it could not be read."""

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


@dataclasses.dataclass
class Link:
    """One link. `matrix` is in the axes of `pose`, about its origin, the centre of mass."""

    name: str
    mass: float | None = None
    pose: Pose = dataclasses.field(default_factory=Pose)
    matrix: Array | None = None
    visual: Parts = dataclasses.field(default_factory=Parts)
    collision: Parts = dataclasses.field(default_factory=Parts)
    notes: list[str] = dataclasses.field(default_factory=list)
    unjudged: str = ""

    def diagnose(self) -> Diagnosis | None:
        """Judge the numbers as they stand in the file, in their own axes: there they go wrong. None: there are none."""
        if self.matrix is None or self.mass is None:
            return None
        turn = self.pose.turn
        with np.errstate(all="ignore"):
            return judge(self.mass, turn.T @ self.pose.place, self.matrix, self.geometry(), self._turned())

    def geometry(self) -> ev.Geometry:
        """What the tensor is compared with, in its own axes."""
        back = Rotation.from_matrix(self.pose.turn.T)
        sets = [parts for parts in (self.visual, self.collision) if parts.parts and parts.whole]
        solids = [solid for parts in sets if (solid := parts.solid()) is not None]
        corners = [part.corners @ self.pose.turn for parts in sets for part in parts.parts]
        box = np.concatenate(corners) if corners else None
        whole = self.visual.whole and self.collision.whole   # else what could not be read may reach further
        return ev.Geometry(tuple(ev.reference(solid.moved(back)) for solid in solids),
                           None if box is None else np.array([box.min(0), box.max(0)]),
                           max(solid.mass for solid in solids) if len(solids) == len(sets) > 0 and whole else None,
                           0.1 if whole else 1.0)

    def _turned(self) -> list[Cause]:
        """Rotations of the inertial frame that should not be there, or the other way round."""
        turn, matrix = self.pose.turn, self.matrix
        assert matrix is not None and self.mass is not None
        if np.abs(turn - np.eye(3)).max() < 1e-9:
            return []
        com = turn.T @ self.pose.place
        once = turn.T @ matrix @ turn
        text = "the rotation of the inertial frame is "
        return [Cause("axes", text + "superfluous: the tensor is in the link's axes", 2.0,
                      ev.one(self.mass, com, once)),
                Cause("axes", text + "the wrong way round (transposed)", 2.0,
                      ev.one(self.mass, com, turn.T @ once @ turn))]


@dataclasses.dataclass
class Robot:
    """The links of a file, and what of the file was not read."""

    kind: str
    name: str
    links: list[Link]
    notes: list[str]


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
    from ... import mesh as files

    vertices, faces = files.read(file)
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


def add(link: Link, into: Parts, what: str, make: Callable[[], Part]) -> None:
    """Put a shape to a link's parts, or a note why it is not there."""
    try:
        into.parts.append(make())
    except InvalidInput as error:
        into.whole = False
        link.notes.append(f"{what} not compared: {error}")


def add_mesh(link: Link, parts: Parts, uri: str, scale: Array, pose: Pose, beside: pathlib.Path) -> None:
    """Put a mesh to a link's parts, or a note why it is not there."""
    file = find(uri, beside)
    if file is None:
        parts.whole = False
        link.notes.append(f"mesh {uri!r} not found: not compared with it")
        return
    try:
        parts.parts.append(mesh(file, scale, pose))
    except InvalidInput as error:
        parts.whole = False
        link.notes.append(f"mesh not compared: {error}")
    else:
        if parts.parts[-1].solid is None:
            link.notes.append(f"mesh {uri!r} is not closed: only its extent is compared")


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
    return next((file for file in candidates if file.is_file()), None)
