"""A link: what its file says of its inertia, and the geometry that this is compared with."""

from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np

from ..._attitude.rotation import Rotation
from ..._core import InvalidInput
from ..._xml import Node, Wrong
from .. import evidence as ev
from ..corruptions import Cause
from ..findings import Diagnosis
from . import meshes
from .geometry import Array, Assembly, Part, Pose, mesh
from .judgement import conclude, study
from .paths import Search


@dataclasses.dataclass
class Source:
    """The elements that hold a link's numbers, for the line of a finding and for a repair."""

    inertial: Node | None = None
    mass: Node | None = None
    tensor: Node | None = None
    pose: Node | None = None


@dataclasses.dataclass
class Link:
    """One link. `matrix` is in the axes of `pose`, about its origin, the centre of mass.

    `trouble` is the reason why its numbers cannot be read. `unread` lists what of its geometry was not read, each with
    the kind of the reason. `fixed`: the model is static, so that nothing uses its inertia.
    """

    name: str
    mass: float | None = None
    pose: Pose = dataclasses.field(default_factory=Pose)
    matrix: Array | None = None
    visual: Assembly = dataclasses.field(default_factory=Assembly)
    collision: Assembly = dataclasses.field(default_factory=Assembly)
    notes: list[str] = dataclasses.field(default_factory=list)
    unjudged: str = ""
    line: int | None = None
    file: str = ""
    trouble: Wrong | None = None
    unread: list[tuple[str, str]] = dataclasses.field(default_factory=list)
    from_geoms: bool = False
    fixed: bool = False
    source: Source = dataclasses.field(default_factory=Source)
    _known: ev.Geometry | None = None

    def diagnose(self) -> Diagnosis | None:
        """Judge the link alone, its numbers as they stand in the file; None where there are none.

        The other links of the file may show more: see `check`.
        """
        case = study(self)
        return None if case is None else conclude(case, {})

    def geometry(self) -> ev.Geometry:
        """What the tensor is compared with, in its own axes."""
        if self._known is None:
            self._known = self._compute_geometry()
        return self._known

    def _compute_geometry(self) -> ev.Geometry:
        back = Rotation.from_matrix(self.pose.rotation.T)
        sets = [assembly for assembly in (self.visual, self.collision) if assembly.parts and assembly.whole]
        solids = [solid for assembly in sets if (solid := assembly.solid()) is not None]
        corners = [part.corners @ self.pose.rotation for assembly in sets for part in assembly.parts]
        box = np.concatenate(corners) if corners else None
        whole = self.visual.whole and self.collision.whole   # else what could not be read may reach further
        return ev.Geometry(tuple(ev.reference(solid.moved(back)) for solid in solids),
                           None if box is None else np.array([box.min(0), box.max(0)]),
                           max(solid.mass for solid in solids) if len(solids) == len(sets) > 0 and whole else None,
                           0.1 if whole else 1.0)

    def rotation_causes(self) -> list[Cause]:
        """Rotations of the inertial frame that should not be there, or the other way round."""
        turn, matrix = self.pose.rotation, self.matrix
        assert matrix is not None and self.mass is not None
        com = turn.T @ self.pose.place
        once = turn.T @ matrix @ turn
        text = "the rotation of the inertial frame is "
        return [Cause("axes", text + "superfluous: the tensor is in the link's axes", 2.0,
                      ev.single(self.mass, com, once)),
                Cause("axes", text + "the wrong way round (transposed)", 2.0,
                      ev.single(self.mass, com, turn.T @ once @ turn))]

    def leave_out(self, into: Assembly, kind: str, note: str) -> None:
        """Note that a part of the geometry is not known."""
        into.whole = False
        self.unread.append((kind, note))
        self.notes.append(note)

    def add(self, into: Assembly, what: str, make: Callable[[], Part]) -> None:
        """Put a shape to the link's parts, or a note why it is not there."""
        try:
            into.parts.append(make())
        except InvalidInput as error:
            self.leave_out(into, "no size", f"{what} not compared: {error}")

    def add_mesh(self, into: Assembly, uri: str, scale: Array, pose: Pose, beside: pathlib.Path,
                 search: Search) -> None:
        """Put a mesh to the link's parts, or a note why it is not there."""
        try:
            file = search.find(uri, beside)
        except InvalidInput as error:
            self.leave_out(into, "outside", f"mesh {error}")
            return
        if file is None:
            self.leave_out(into, "not found", f"mesh {uri!r} not found: not compared with it")
            return
        try:
            self.add_surface(into, uri, meshes.surface(file), scale, pose)
        except InvalidInput as error:
            needs = "pip install" in str(error)
            self.leave_out(into, "needs an extra" if needs else "unreadable", f"mesh not compared: {error}")

    def add_surface(self, into: Assembly, name: str, surface: meshes.Surface, scale: Array, pose: Pose) -> None:
        """Put a mesh that was read to the link's parts."""
        into.parts.append(mesh(surface, scale, pose))
        if surface.solid is None:
            known = "its extent is" if into.parts[-1].solid is None else "its convex hull is"
            self.notes.append(f"mesh {name!r} is not closed: only {known} compared")

    @contextmanager
    def shielded(self, into: Assembly) -> Iterator[None]:
        """Turn an error in a part of the geometry into a note."""
        try:
            yield
        except InvalidInput as error:
            self.leave_out(into, "malformed", f"not compared: {error}")


@dataclasses.dataclass
class Robot:
    """The links of a file, and what of the file was not read."""

    kind: str
    name: str
    links: list[Link]
    notes: list[str]
    file: str = ""


def read_link(name: str, node: Node, fill: Callable[[Link], None]) -> Link:
    """Read one link; an error is its own verdict."""
    link = Link(name, line=node.line, file=node.file)
    try:
        fill(link)
    except InvalidInput as error:
        link.trouble = error if isinstance(error, Wrong) else Wrong(str(error), node.line)
    except (ArithmeticError, ValueError, TypeError, LookupError, AttributeError, RecursionError) as error:
        link.trouble = node.wrong(f"cannot be judged: {type(error).__name__}: {error}")
    return link
