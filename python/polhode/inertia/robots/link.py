"""A link as its format reads it."""

from __future__ import annotations

import dataclasses
import pathlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ..._core import InvalidInput
from ..._xml import Node, Wrong
from ..findings import Diagnosis
from . import meshes
from .geometry import Array, Assembly, Part, Pose, mesh
from .judgement import conclude, study
from .paths import Search
from .record import LinkRecord
from .record import Source as Source


@dataclasses.dataclass
class Link(LinkRecord):
    """One link. `matrix` is in the axes of `pose`, about its origin, the centre of mass.

    `trouble` is the reason why its numbers cannot be read. `unread` lists what of its geometry was not read, each with
    the kind of the reason. `fixed`: the model is static, so that nothing uses its inertia.
    """

    def diagnose(self) -> Diagnosis | None:
        """Judge the link alone, its numbers as they stand in the file; None where there are none.

        The other links of the file may show more: see `check`.
        """
        case = study(self)
        return None if case is None else conclude(case, {})

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
