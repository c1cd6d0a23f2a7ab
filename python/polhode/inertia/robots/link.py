"""A link: what its file says of its inertia, and the geometry that this is compared with."""

from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Callable

import numpy as np

from ..._attitude.rotation import Rotation
from ..._core import InvalidInput
from .. import evidence as ev
from ..corruptions import Cause
from ..diagnosis import judge
from ..findings import Diagnosis
from .geometry import Array, Assembly, Part, Pose, find, mesh


@dataclasses.dataclass
class Link:
    """One link. `matrix` is in the axes of `pose`, about its origin, the centre of mass."""

    name: str
    mass: float | None = None
    pose: Pose = dataclasses.field(default_factory=Pose)
    matrix: Array | None = None
    visual: Assembly = dataclasses.field(default_factory=Assembly)
    collision: Assembly = dataclasses.field(default_factory=Assembly)
    notes: list[str] = dataclasses.field(default_factory=list)
    unjudged: str = ""

    def diagnose(self) -> Diagnosis | None:
        """Judge the numbers as they stand in the file, in their own axes: there they go wrong. None: there are none."""
        if self.matrix is None or self.mass is None:
            return None
        turn = self.pose.turn
        with np.errstate(all="ignore"):
            return judge(self.mass, turn.T @ self.pose.place, self.matrix, self.geometry(), self._rotation_causes())

    def geometry(self) -> ev.Geometry:
        """What the tensor is compared with, in its own axes."""
        back = Rotation.from_matrix(self.pose.turn.T)
        sets = [assembly for assembly in (self.visual, self.collision) if assembly.parts and assembly.whole]
        solids = [solid for assembly in sets if (solid := assembly.solid()) is not None]
        corners = [part.corners @ self.pose.turn for assembly in sets for part in assembly.parts]
        box = np.concatenate(corners) if corners else None
        whole = self.visual.whole and self.collision.whole   # else what could not be read may reach further
        return ev.Geometry(tuple(ev.reference(solid.moved(back)) for solid in solids),
                           None if box is None else np.array([box.min(0), box.max(0)]),
                           max(solid.mass for solid in solids) if len(solids) == len(sets) > 0 and whole else None,
                           0.1 if whole else 1.0)

    def _rotation_causes(self) -> list[Cause]:
        """Rotations of the inertial frame that should not be there, or the other way round."""
        turn, matrix = self.pose.turn, self.matrix
        assert matrix is not None and self.mass is not None
        if np.abs(turn - np.eye(3)).max() < 1e-9:
            return []
        com = turn.T @ self.pose.place
        once = turn.T @ matrix @ turn
        text = "the rotation of the inertial frame is "
        return [Cause("axes", text + "superfluous: the tensor is in the link's axes", 2.0,
                      ev.single(self.mass, com, once)),
                Cause("axes", text + "the wrong way round (transposed)", 2.0,
                      ev.single(self.mass, com, turn.T @ once @ turn))]

    def add(self, into: Assembly, what: str, make: Callable[[], Part]) -> None:
        """Put a shape to the link's parts, or a note why it is not there."""
        try:
            into.parts.append(make())
        except InvalidInput as error:
            into.whole = False
            self.notes.append(f"{what} not compared: {error}")

    def add_mesh(self, into: Assembly, uri: str, scale: Array, pose: Pose, beside: pathlib.Path) -> None:
        """Put a mesh to the link's parts, or a note why it is not there."""
        file = find(uri, beside)
        if file is None:
            into.whole = False
            self.notes.append(f"mesh {uri!r} not found: not compared with it")
            return
        before = len(into.parts)
        self.add(into, "mesh", lambda: mesh(file, scale, pose))
        if len(into.parts) > before and into.parts[-1].solid is None:
            self.notes.append(f"mesh {uri!r} is not closed: only its extent is compared")


@dataclasses.dataclass
class Robot:
    """The links of a file, and what of the file was not read."""

    kind: str
    name: str
    links: list[Link]
    notes: list[str]
