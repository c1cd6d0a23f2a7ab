"""MJCF, MuJoCo's format: https://mujoco.readthedocs.io/en/stable/XMLreference.html."""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Iterator

import numpy as np

from ..._core import InvalidInput, MassProperties
from ..._xml import Node, parse
from . import geometry, meshes
from .by_mujoco import complete
from .format import Format, NoRobot
from .geometry import Array, Assembly, Part, Pose
from .link import Link, Robot, Source, read_link
from .mjcf_model import Compiler, Model, gather, onto, orientation, pose, unit
from .paths import Search

UNREAD = ("composite", "flexcomp", "plugin")
GROUPS = ("frame", "replicate")   # their children belong to what is around them
MOST_COPIES = 1000
MOST_LINKS = 100_000
DEEPEST_ATTACHED = 10

Solids = list[tuple[Part, float]]   # parts with their masses


def read(root: Node, file: pathlib.Path, search: Search) -> Robot:
    """Read the bodies, in the order of the file."""
    model, notes = gather(root, file, search)
    links: list[Link] = []
    for world in root.children("worldbody"):
        _bodies(world, "main", model, "", links, notes)
    found = {node.tag for node in root.walk()} & set(UNREAD)
    before = len(links)
    complete(file, root, links, notes, search, bool(found & set(UNREAD[:2])))
    if len(links) == before:
        notes += [f"<{tag}> is not read: its additions are not judged" for tag in UNREAD[:2] if tag in found]
    if not links and not notes:
        raise NoRobot(root, "<worldbody> holds no <body>")
    return Robot("MJCF", root.get("model") or file.stem, links, notes, str(file))


def _bodies(parent: Node, style: str, model: Model, prefix: str, links: list[Link], notes: list[str]) -> None:
    for node in parent.children():
        if len(links) > MOST_LINKS:
            raise parent.wrong(f"holds more than {MOST_LINKS} bodies")
        inside = node.get("childclass") or style
        if node.tag == "body":
            name = prefix + (node.get("name") or f"body {len(links) + 1}")
            links.append(read_link(name, node, lambda link: _fill(link, node, inside, model)))
        elif node.tag == "attach":
            _attach(node, model, prefix, links, notes)
        if node.tag == "body" or node.tag in GROUPS:
            _bodies(node, inside, model, prefix, links, notes)


def _attach(node: Node, model: Model, prefix: str, links: list[Link], notes: list[str]) -> None:
    """Read the body of another file that is attached here."""
    name = node.get("model") or ""
    asset = model.attached.get(name)
    try:
        if asset is None:
            raise InvalidInput("no such asset")
        if model.depth >= DEEPEST_ATTACHED:
            raise InvalidInput(f"models are attached more than {DEEPEST_ATTACHED} deep")
        file = model.search.find(asset.word("file"), model.file)
        if file is None:
            raise InvalidInput(f"{asset.get('file')!r} not found")
        root = parse(file)
        other, more = gather(root, file, model.search, model.depth + 1)
    except InvalidInput as error:
        notes.append(f"<attach> of {name!r} is not read: {error}")
        return
    notes += more
    inside = prefix + (node.get("prefix") or "")
    for world in root.children("worldbody"):
        wanted = node.get("body")
        found = world if wanted is None else next(
            (part for part in world.walk() if part.tag == "body" and part.get("name") == wanted), None)
        if found is world:
            _bodies(world, "main", other, inside, links, notes)
        elif found is not None:
            holder = Node("worldbody", {}, root, found.file, found.line, found.start)
            holder.nodes = [found]
            _bodies(holder, "main", other, inside, links, notes)


def _fill(link: Link, node: Node, style: str, model: Model) -> None:
    compiler = model.compiler
    inertial = node.child("inertial")
    from_geoms = compiler.from_geometry == "true" or (compiler.from_geometry == "auto" and inertial is None)
    solids: Solids = []
    for geom, inside, frame in _geoms(node, style, Pose(), compiler):
        if from_geoms:
            solids += _geom(geom, inside, frame, model, link, True)
        else:
            with link.shielded(link.visual):
                _geom(geom, inside, frame, model, link, False)
    if from_geoms:
        if inertial is not None:
            link.notes.append("inertiafromgeom: MuJoCo ignores the given <inertial>")
        _from_geoms(link, solids)
        return
    if inertial is None:
        link.unjudged = "no <inertial>, and inertiafromgeom is false"
        return
    _inertial(link, inertial, compiler)


def _geoms(node: Node, style: str, frame: Pose, compiler: Compiler) -> Iterator[tuple[Node, str, Pose]]:
    """The geoms of a body, with their class and the frame that they stand in."""
    for child in node.children():
        inside = child.get("childclass") or style
        if child.tag == "geom":
            yield child, style, frame
        elif child.tag == "frame":
            yield from _geoms(child, inside, frame @ pose(child, compiler), compiler)
        elif child.tag == "replicate" and any(part.tag == "geom" for part in child.walk()):
            count = int(child.number("count"))
            if not 0 <= count <= MOST_COPIES:
                raise child.wrong(f"count: must be from 0 to {MOST_COPIES} to be read, got {count}")
            offset, angles = child.numbers("offset", 3, "0 0 0"), child.numbers("euler", 3, "0 0 0")
            place = np.zeros(3)
            for i in range(count):   # the angles are multiplied, each offset is in the axes of the copy before
                rotation = orientation(child, compiler, {"euler": " ".join(map(repr, (i * angles).tolist()))})
                yield from _geoms(child, inside, frame @ Pose(rotation, place), compiler)
                place = place + rotation @ offset


def _inertial(link: Link, node: Node, compiler: Compiler) -> None:
    link.line = node.line
    link.file = node.file
    link.mass = node.number("mass")
    link.pose = Pose(orientation(node, compiler), node.numbers("pos", 3, "0 0 0"))
    full = node.get("fullinertia")
    if full is not None:
        if set(node.attrib) & {"diaginertia", "quat", "axisangle", "xyaxes", "zaxis", "euler"}:
            raise node.wrong("fullinertia goes with neither diaginertia nor an orientation")
        xx, yy, zz, xy, xz, yz = node.numbers("fullinertia", 6, finite=False)
        link.matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    elif node.get("diaginertia") is not None:
        link.matrix = np.diag(node.numbers("diaginertia", 3, finite=False))
    else:
        raise node.wrong("diaginertia or fullinertia is missing")
    link.source = Source(node, node, node, node)
    moments = np.linalg.eigvalsh(link.matrix) if np.isfinite(link.matrix).all() else np.zeros(3)
    if compiler.balance and moments[2] > moments[0] + moments[1]:
        link.notes.append(f"balanceinertia: MuJoCo silently makes all three moments {moments.mean():.4g}")
    if 0 <= link.mass < compiler.least_mass:
        link.notes.append(f"boundmass: MuJoCo takes {compiler.least_mass:g} kg")
    if moments[0] < compiler.least_inertia:
        link.notes.append(f"boundinertia: MuJoCo raises moments to {compiler.least_inertia:g} kg m^2")


def _from_geoms(link: Link, solids: Solids) -> None:
    """Mass and tensor as MuJoCo computes them when it is left to."""
    link.from_geoms = True
    if any(part.solid is None for part, mass in solids if mass != 0) or (
            link.unread and not (link.visual.whole and link.collision.whole)):
        link.unjudged = "from its geoms, which were not all read"
        return
    total: MassProperties | None = None
    for part, mass in solids:
        if mass > 0 and part.solid is not None:
            unit_tensor = np.asarray(part.solid.inertia.matrix) / part.solid.mass
            scaled = MassProperties(mass, part.solid.com, unit_tensor * mass)
            total = scaled if total is None else total + scaled
    if total is None:
        link.unjudged = "no <inertial>, and no geoms with mass"
        return
    link.mass, link.matrix = total.mass, np.asarray(total.inertia.matrix)
    link.pose = Pose(np.eye(3), np.asarray(total.com))
    link.notes.append("from its geoms")
    link.visual, link.collision = Assembly(), Assembly()   # compared with what it was made from, it says nothing


def _geom(node: Node, style: str, frame: Pose, model: Model, link: Link, from_geoms: bool) -> Solids:
    """Add a geom; returns it with its mass as MuJoCo computes it, or nothing when it has none or was not read."""
    attributes = {**model.defaults.get(node.get("class") or style, {}).get("geom", {}), **node.attrib}
    kind = attributes.get("type", "sphere")
    if kind in ("plane", "hfield"):
        return []
    # What nothing can touch is there to be seen.
    into = link.visual if attributes.get("contype") == attributes.get("conaffinity") == "0" else link.collision
    size = node.convert(attributes.get("size", ""), None, "size")
    if "fromto" in attributes:
        ends = node.convert(attributes["fromto"], 6, "fromto")
        along = ends[3:] - ends[:3]
        size = np.concatenate([size[:1] if kind in ("capsule", "cylinder") else np.repeat(size[:1], 2),
                               [float(np.linalg.norm(along)) / 2]])
        place = frame @ Pose(onto(unit(along, node)), (ends[:3] + ends[3:]) / 2)
    else:
        place = frame @ pose(node, model.compiler, attributes)
    before = len(into.parts)
    if "mesh" in attributes:
        _mesh(node, attributes, kind, model, link, into, place, from_geoms)
    else:
        _primitive(node, kind, size, place, link, into)
    if len(into.parts) == before:
        return []
    part = into.parts[-1]
    low, high = model.compiler.groups
    if not low <= float(node.convert(attributes.get("group", "0"), 1, "group")[0]) <= high:
        return [(part, 0.0)]
    mass = attributes.get("mass")
    density = float(node.convert(attributes.get("density", "1000"), 1, "density")[0])
    shell = attributes.get("shellinertia") == "true" or part.bound
    if from_geoms and shell and (density if mass is None else mass != "0"):
        link.leave_out(into, "shell", "mass of a shell or an open mesh is not read")
    if mass is not None:
        return [(part, float(node.convert(mass, 1, "mass")[0]))]
    return [(part, density * (part.solid.mass if part.solid is not None else 0.0))]


def _primitive(node: Node, kind: str, size: Array, place: Pose, link: Link, into: Assembly) -> None:
    makers: dict[str, tuple[int, Callable[[], Part]]] = {
        "sphere": (1, lambda: geometry.ball(size[0], place)),
        "capsule": (2, lambda: geometry.capsule(size[0], 2 * size[1], place)),
        "cylinder": (2, lambda: geometry.cylinder(size[0], 2 * size[1], place)),
        "ellipsoid": (3, lambda: geometry.ellipsoid(size[:3], place)),
        "box": (3, lambda: geometry.block(size[:3], place)),
    }
    if kind not in makers:
        link.leave_out(into, "kind of shape", f"geom of type {kind!r} is not read: not compared with it")
        return
    count, make = makers[kind]
    if len(size) < count:
        raise node.wrong(f"size: a {kind} has {count}, got {len(size)}")
    link.add(into, f"geom {kind}", make)


def _mesh(node: Node, attributes: dict[str, str], kind: str, model: Model, link: Link, into: Assembly, place: Pose,
          from_geoms: bool) -> None:
    name = attributes["mesh"]
    asset = model.meshes.get(name)
    if asset is None or asset.get("builtin") or asset.child("plugin") is not None:
        why = "no such asset" if asset is None else "made by MuJoCo"
        link.leave_out(into, "asset", f"mesh {name!r} is not read ({why}): not compared with it")
        return
    settings = {**model.defaults.get(asset.get("class") or "main", {}).get("mesh", {}), **asset.attrib}
    scale = asset.convert(settings.get("scale", "1 1 1"), 3, "scale")
    if "refpos" in settings or "refquat" in settings:   # the mesh's own frame, in the file's axes
        quat = asset.convert(settings.get("refquat", "1 0 0 0"), 4, "refquat")
        rotation = orientation(asset, model.compiler, {"quat": " ".join(map(repr, quat.tolist()))}).T
        shift = asset.convert(settings.get("refpos", "0 0 0"), 3, "refpos")
        if np.ptp(scale) and np.abs(rotation - np.eye(3)).max() > 1e-9:
            link.leave_out(into, "asset", f"mesh {name!r} is not read (turned and stretched): not compared with it")
            return
        place = place @ Pose(rotation, -(rotation @ (scale * shift)))
    if "vertex" in settings:
        with link.shielded(into):
            numbers = asset.convert(settings["vertex"], None, "vertex")
            corners = asset.convert(settings["face"], None, "face").astype(np.int64) if "face" in settings else None
            if len(numbers) < 12 or len(numbers) % 3 or (corners is not None and len(corners) % 3):
                raise asset.wrong("vertex, face: must be threes of numbers")
            surface = meshes.inline(numbers.reshape(-1, 3), None if corners is None else corners.reshape(-1, 3))
            link.add_surface(into, name, surface, scale, place)
    else:
        link.add_mesh(into, _mesh_file(asset, model), scale, place, model.file, model.search)
    if kind != "mesh" and into.parts:
        note = f"a {kind} fitted to mesh {name!r}: compared with the mesh"
        if from_geoms:
            link.leave_out(into, "fitted", note)
        else:
            link.notes.append(note)


def _mesh_file(asset: Node, model: Model) -> str:
    """The path of a mesh relative to the model; relative to the file that names it, if it is only there."""
    file = asset.word("file").replace("\\", "/")
    if model.compiler.strip:
        file = pathlib.PurePosixPath(file).name
    choices = [str(pathlib.PurePosixPath(model.compiler.meshes) / file), file]
    for beside in (model.file.parent, pathlib.Path(asset.file).parent):
        for choice in choices:
            if (beside / choice).is_file():
                return choice if beside == model.file.parent else str(beside.absolute() / choice)
    return choices[0]


FORMAT = Format("MJCF", ("mujoco",), (".mjcf",), read, parts=("mujocoinclude",), mass="mass", centre="pos")
