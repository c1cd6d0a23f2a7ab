"""SDFormat: http://sdformat.org/spec."""

from __future__ import annotations

import dataclasses
import pathlib

import numpy as np

from ..._core import InvalidInput
from ..._xml import Node, Wrong, parse
from . import geometry
from .format import Format, NoRobot
from .geometry import Assembly, Pose
from .link import Link, Robot, Source, read_link
from .paths import Search
from .sdf_frames import Frames, entry, pose_of

DEEPEST = 20        # models in models
MOST_LINKS = 100_000


@dataclasses.dataclass
class _Reading:
    file: pathlib.Path
    search: Search
    links: list[Link] = dataclasses.field(default_factory=list)
    notes: list[str] = dataclasses.field(default_factory=list)
    seen: dict[pathlib.Path, int] = dataclasses.field(default_factory=dict)


@dataclasses.dataclass(frozen=True)
class _Place:
    """Where an element stands: the names of the models around it, its file, and whether they are static."""

    path: str
    file: pathlib.Path
    fixed: bool
    frames: Frames | None
    depth: int = 0


def read(root: Node, file: pathlib.Path, search: Search) -> Robot:
    """Read the links of all models of the file: nested ones, and included ones where they are found."""
    state = _Reading(file, search)
    _walk(root, _Place("", file, False, None), state)
    if not state.links and not state.notes:
        raise NoRobot(root, "<link> is missing")
    again = sum(count - 1 for count in state.seen.values())
    if again:
        state.notes.append(f"{again} further <include> of the same models: judged once")
    return Robot("SDF", file.stem, state.links, state.notes, str(file))


def _walk(parent: Node, place: _Place, state: _Reading) -> None:
    for node in parent.children():
        if len(state.links) > MOST_LINKS:
            raise parent.wrong(f"holds more than {MOST_LINKS} links")
        if node.tag in ("world", "population"):
            _walk(node, place, state)
        elif node.tag == "model":
            _model(node, place, state, node.get("name") or "model")
        elif node.tag == "include":
            _include(node, place, state)
        elif node.tag == "link":
            path = place.path.partition("::")[2] if place.path.count("::") == 1 else place.path
            name = node.get("name") or f"link {len(state.links) + 1}"
            link = read_link(path + name, node, lambda link: _fill(link, node, place, state.search))
            link.fixed = place.fixed
            state.links.append(link)


def _model(node: Node, place: _Place, state: _Reading, name: str) -> None:
    if place.depth >= DEEPEST:
        raise node.wrong(f"models are nested more than {DEEPEST} deep")
    static = node.child("static")
    fixed = place.fixed or (static is not None and static.text in ("true", "1"))
    _walk(node, dataclasses.replace(place, path=f"{place.path}{name}::", fixed=fixed, frames=Frames(node),
                                    depth=place.depth + 1), state)


def _include(node: Node, place: _Place, state: _Reading) -> None:
    uri = entry(node, "uri") or node.text or node.get("filename") or ""
    try:
        found = state.search.find_model(uri, place.file)
        model = None if found is None else _model_file(found)
        if model is None:
            state.notes.append(f"<include> {uri!r} is not read: not found")
            return
        model = model.resolve()
        state.seen[model] = state.seen.get(model, 0) + 1
        if state.seen[model] > 1:
            return
        if place.depth >= DEEPEST:
            raise node.wrong(f"models are nested more than {DEEPEST} deep")
        root = parse(state.search.check(model, place.file))
    except InvalidInput as error:
        state.notes.append(f"<include> {uri!r} is not read: {error}")
        return
    inside = dataclasses.replace(place, file=model, frames=None)
    static = entry(node, "static")
    if static is not None:
        inside = dataclasses.replace(inside, fixed=static in ("true", "1"))
    for part in root.children("model") if root.tag in ("sdf", "gazebo") else ():
        if (node.get("merge") or "") in ("true", "1") and place.path:   # its links become the model's own
            _walk(part, dataclasses.replace(inside, depth=place.depth + 1, frames=Frames(part)), state)
        else:
            _model(part, inside, state, entry(node, "name") or part.get("name") or "model")


def _model_file(found: pathlib.Path) -> pathlib.Path | None:
    """The description in the folder of a model: the one of the newest version that model.config names."""
    if found.is_file():
        return found
    config = next((found / name for name in ("model.config", "manifest.xml") if (found / name).is_file()), None)
    if config is not None:
        named = [node for node in parse(config).children("sdf") if node.text]
        named.sort(key=_version)
        for node in reversed(named):
            if (found / node.text).is_file():
                return found / node.text
    return next((found / name for name in ("model.sdf", f"{found.name}.sdf") if (found / name).is_file()), None)


def _version(node: Node) -> list[int]:
    return [int(part) if part.isdigit() else 0 for part in (node.get("version") or "").split(".")]


def _fill(link: Link, node: Node, place: _Place, search: Search) -> None:
    node.word("name")
    for tag, into in (("visual", link.visual), ("collision", link.collision)):
        for shown in node.children(tag):
            with link.shielded(into):
                _geometry(link, into, shown, node, place, search)
    inertial = node.child("inertial")
    if inertial is None:
        link.unjudged = "no <inertial>: SDF takes 1 kg and 1 kg m^2 about each axis"
        return
    link.line = inertial.line
    if inertial.get("auto") in ("true", "1"):
        link.unjudged = "<inertial auto>: computed from the collisions when it is loaded"
        return
    link.pose = _placed(inertial, node, place)
    mass, tensor = inertial.child("mass"), inertial.child("inertia")
    weight = entry(inertial, "mass")   # an attribute before version 1.2
    if weight is None:
        link.notes.append("no <mass>: SDF takes 1 kg")
    link.mass = 1.0 if weight is None else float(inertial.convert(weight, 1, "mass")[0])
    values, assumed = {}, []
    for name, default in (("ixx", 1), ("iyy", 1), ("izz", 1), ("ixy", 0), ("ixz", 0), ("iyz", 0)):
        given = None if tensor is None else entry(tensor, name)
        if given is None and default:
            assumed.append(name)
        values[name] = float(default) if given is None else float((tensor or node).convert(given, 1, name, False)[0])
    if assumed:
        link.notes.append(f"no <{'>, <'.join(assumed)}>: SDF takes 1 kg m^2")
    xx, yy, zz, xy, xz, yz = values.values()
    link.matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    link.source = Source(inertial, mass, tensor, inertial.child("pose"))


def _placed(node: Node, link: Node, place: _Place) -> Pose:
    """The pose of a part in its link's frame."""
    pose, relative = pose_of(node)
    if not relative or relative == link.get("name"):
        return pose
    if place.frames is None:
        raise node.wrong(f"is relative to {relative!r}, which is not known")
    try:
        return place.frames.find(link.word("name")).inverse() @ place.frames.find(relative) @ pose
    except KeyError:
        raise node.wrong(f"is relative to {relative!r}, which is not known") from None


def _geometry(link: Link, into: Assembly, node: Node, owner: Node, place: _Place, search: Search) -> None:
    pose = _placed(node, owner, place)

    def numbers(shape: Node, name: str, count: int) -> geometry.Array:
        if (text := entry(shape, name)) is None:
            raise Wrong(f"{shape.where}: <{name}> is missing", shape.line)
        return shape.convert(text, count, name)

    for shape in node.need("geometry").children():
        if shape.tag in ("box", "ellipsoid"):
            lengths = numbers(shape, "size", 3) / 2 if shape.tag == "box" else numbers(shape, "radii", 3)
            solid = geometry.block if shape.tag == "box" else geometry.ellipsoid
            link.add(into, shape.tag, lambda: solid(lengths, pose))
        elif shape.tag in ("cylinder", "capsule", "cone"):
            make = {"cylinder": geometry.cylinder, "capsule": geometry.capsule, "cone": geometry.cone}[shape.tag]
            radius, length = (float(numbers(shape, name, 1)[0]) for name in ("radius", "length"))
            link.add(into, shape.tag, lambda: make(radius, length, pose))
        elif shape.tag == "sphere":
            radius = float(numbers(shape, "radius", 1)[0])
            link.add(into, "sphere", lambda: geometry.ball(radius, pose))
        elif shape.tag == "mesh" and shape.child("submesh") is not None:
            link.leave_out(into, "submesh", "<submesh> is not read: not compared with it")
        elif shape.tag == "mesh":
            factors = np.ones(3) if entry(shape, "scale") is None else numbers(shape, "scale", 3)
            uri = entry(shape, "uri") or shape.get("filename")
            if not uri:
                raise shape.wrong("<uri> is missing")
            link.add_mesh(into, uri, factors, pose, place.file, search)
        elif shape.tag not in ("empty", "plane"):   # a plane has no inside
            link.leave_out(into, "kind of shape", f"<{shape.tag}> is not read: not compared with it")


FORMAT = Format("SDF", ("sdf", "gazebo"), (".sdf",), read)
