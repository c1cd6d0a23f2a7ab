"""What a file says of a link's inertia, and the geometry that this is compared with."""

from __future__ import annotations

import dataclasses

import numpy as np

from ..._attitude.rotation import Rotation
from ..._xml import Node, Wrong
from .. import evidence as ev
from ..corruptions import Cause
from .geometry import Array, Assembly, Pose


@dataclasses.dataclass
class Source:
    """The elements that hold a link's numbers, for the line of a finding and for a repair."""

    inertial: Node | None = None
    mass: Node | None = None
    tensor: Node | None = None
    pose: Node | None = None


@dataclasses.dataclass
class LinkRecord:
    """The numbers of a link. `matrix` is in the axes of `pose`, about its origin, the centre of mass.

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
        rotation, matrix = self.pose.rotation, self.matrix
        assert matrix is not None and self.mass is not None
        com = rotation.T @ self.pose.place
        once = rotation.T @ matrix @ rotation
        text = "the rotation of the inertial frame is "
        return [Cause("axes", text + "superfluous: the tensor is in the link's axes", 2.0,
                      ev.single(self.mass, com, once)),
                Cause("axes", text + "the wrong way round (transposed)", 2.0,
                      ev.single(self.mass, com, rotation.T @ once @ rotation))]
