"""MJCF, MuJoCo's format: https://mujoco.readthedocs.io/en/stable/XMLreference.html."""

from __future__ import annotations

import pathlib
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..._attitude.rotation import Rotation
from ..._core import MassProperties
from . import geometry
from .geometry import Assembly, Pose
from .link import Link, Robot
from .xml import Node, to_numbers

Array = npt.NDArray[np.float64]

UNREAD = ("include", "attach", "replicate", "composite", "flexcomp")


class Compiler(NamedTuple):
    """What <compiler> says of inertia, and where the meshes are."""

    degrees: bool
    euler: str
    from_geometry: str
    balance: bool
    least_mass: float
    least_inertia: float
    meshes: str


class Model(NamedTuple):
    """What the geometry of a body refers to."""

    file: pathlib.Path
    compiler: Compiler
    defaults: dict[str, dict[str, dict[str, str]]]
    meshes: dict[str, Node]


def read(root: Node, file: pathlib.Path) -> Robot:
    """Read the bodies, in the order of the file."""
    compiler, notes = _compiler(root)
    defaults: dict[str, dict[str, dict[str, str]]] = {"main": {}}
    for node in root.children("default"):
        _defaults(node, node.get("class") or "main", {}, defaults)
    meshes = {m.get("name") or pathlib.Path(m.get("file") or "").stem: m for asset in root.children("asset")
              for m in asset.children("mesh")}
    model = Model(file, compiler, defaults, meshes)
    found = {element.tag for element in root.element.iter()} & set(UNREAD)
    notes += [f"<{tag}> is not read: its additions are not judged" for tag in UNREAD if tag in found]
    links: list[Link] = []
    left = [(node, "main") for world in root.children("worldbody") for node in world.children()]
    while left:
        node, style = left.pop(0)
        style = node.get("childclass") or style
        if node.tag == "body":
            links.append(_body(node, style, model, len(links)))
        if node.tag in ("body", "frame"):
            left = [(child, style) for child in node.children() if child.tag in ("body", "frame")] + left
    if not links:
        raise root.wrong("<worldbody> holds no <body>")
    return Robot("MJCF", root.get("model") or file.stem, links, notes)


def _compiler(root: Node) -> tuple[Compiler, list[str]]:
    told: dict[str, str] = {}
    for node in root.children("compiler"):
        told |= node.element.attrib
    notes = []

    def number(name: str) -> float:
        return float(to_numbers(told.get(name, "0"), 1, f"{root.where} <compiler>: {name}")[0])

    if number("settotalmass") > 0:
        notes.append(f"settotalmass={told['settotalmass']}: MuJoCo scales masses and tensors; judged as written")
    if told.get("coordinate", "local") != "local":
        raise root.wrong("coordinate='global' is not read (nor by MuJoCo since 2.3.4)")

    return Compiler(told.get("angle", "degree") == "degree", told.get("eulerseq", "xyz"),
                    told.get("inertiafromgeom", "auto"), told.get("balanceinertia") == "true", number("boundmass"),
                    number("boundinertia"), told.get("meshdir", told.get("assetdir", ""))), notes


def _defaults(node: Node, name: str, inherited: dict[str, dict[str, str]],
              into: dict[str, dict[str, dict[str, str]]]) -> None:
    """Attributes of geoms and meshes by class, each with its parents'."""
    own = {tag: {**inherited.get(tag, {}), **(child.element.attrib if (child := node.child(tag)) else {})}
           for tag in ("geom", "mesh")}
    into[name] = own
    for child in node.children("default"):
        _defaults(child, child.word("class"), own, into)


def _orientation(node: Node, compiler: Compiler, attributes: dict[str, str] | None = None) -> Array:
    told = node.element.attrib if attributes is None else attributes

    def numbers(name: str, count: int) -> Array:
        return to_numbers(told[name], count, f"{node.where}: {name}")

    def unit(v: Array) -> Array:
        return _unit(v, node)

    radians = np.pi / 180 if compiler.degrees else 1.0
    if "quat" in told:
        w, x, y, z = unit(numbers("quat", 4))   # MuJoCo's scalar comes first
        turn = Rotation.from_quat((x, y, z, w))
    elif "axisangle" in told:
        axis, angle = numbers("axisangle", 4)[:3], numbers("axisangle", 4)[3]
        turn = Rotation.from_rotvec(unit(axis) * angle * radians)
    elif "euler" in told:   # MuJoCo's lower case turns with the body, as SciPy's upper case does
        turn = Rotation.from_euler(compiler.euler.swapcase(), numbers("euler", 3) * radians)
    elif "xyaxes" in told:
        x, y = np.split(numbers("xyaxes", 6), 2)
        x = unit(x)
        y = unit(y - x * (x @ y))
        return np.column_stack([x, y, np.cross(x, y)])
    elif "zaxis" in told:
        return _onto(unit(numbers("zaxis", 3)))
    else:
        return np.eye(3)
    return np.asarray(turn.as_matrix())


def _unit(v: Array, node: Node) -> Array:
    length = float(np.linalg.norm(v))
    if not length > 0:
        raise node.wrong("a direction, quaternion or line must not have the length zero")
    return np.asarray(v / length)


def _onto(z: Array) -> Array:
    """The smallest turn that takes the z axis onto this unit vector."""
    v, c = np.cross((0, 0, 1), z), z[2]
    if c < -1 + 1e-12:
        return np.diag([1.0, -1.0, -1.0])
    k = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.asarray(np.eye(3) + k + k @ k / (1 + c))


def _body(node: Node, style: str, model: Model, index: int) -> Link:
    compiler = model.compiler
    link = Link(node.get("name") or f"body {index + 1}")
    solids: list[tuple[geometry.Part, float]] = []
    for child in node.children():
        if child.tag == "geom":
            solids += _geom(child, style, model, link)
        elif child.tag == "frame" and child.child("geom") is not None:
            link.visual.whole = link.collision.whole = False
            link.notes.append("geoms within <frame> are not read: not compared with them")
    inertial = node.child("inertial")
    if compiler.from_geometry == "true" or (compiler.from_geometry == "auto" and inertial is None):
        if inertial is not None:
            link.notes.append("inertiafromgeom: MuJoCo ignores the given <inertial>")
        _from_geoms(link, solids)
        return link
    if inertial is None:
        link.unjudged = "no <inertial>, and inertiafromgeom is false"
        return link
    _inertial(link, inertial, compiler)
    return link


def _inertial(link: Link, node: Node, compiler: Compiler) -> None:
    link.mass = node.number("mass")
    link.pose = Pose(_orientation(node, compiler), node.numbers("pos", 3))
    full = node.get("fullinertia")
    if full is not None:
        if set(node.element.attrib) & {"diaginertia", "quat", "axisangle", "xyaxes", "zaxis", "euler"}:
            raise node.wrong("fullinertia goes with neither diaginertia nor an orientation")
        xx, yy, zz, xy, xz, yz = node.numbers("fullinertia", 6, finite=False)
        link.matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    elif node.get("diaginertia") is not None:
        link.matrix = np.diag(node.numbers("diaginertia", 3, finite=False))
    else:
        raise node.wrong("diaginertia or fullinertia is missing")
    moments = np.linalg.eigvalsh(link.matrix) if np.isfinite(link.matrix).all() else np.zeros(3)
    if compiler.balance and moments[2] > moments[0] + moments[1]:
        link.notes.append(f"balanceinertia: MuJoCo silently makes all three moments {moments.mean():.4g}")
    if 0 <= link.mass < compiler.least_mass:
        link.notes.append(f"boundmass: MuJoCo takes {compiler.least_mass:g} kg")
    if moments[0] < compiler.least_inertia:
        link.notes.append(f"boundinertia: MuJoCo raises moments to {compiler.least_inertia:g} kg m^2")


def _from_geoms(link: Link, solids: list[tuple[geometry.Part, float]]) -> None:
    """Mass and tensor as MuJoCo computes them when it is left to."""
    if not (link.visual.whole and link.collision.whole) or any(part.solid is None for part, _ in solids):
        link.unjudged = "from its geoms, which were not all read"
        return
    total: MassProperties | None = None
    for part, mass in solids:
        if mass > 0 and part.solid is not None:
            unit = np.asarray(part.solid.inertia.matrix) / part.solid.mass
            scaled = MassProperties(mass, part.solid.com, unit * mass)
            total = scaled if total is None else total + scaled
    if total is None:
        link.unjudged = "no <inertial>, and no geoms with mass"
        return
    link.mass, link.matrix = total.mass, np.asarray(total.inertia.matrix)
    link.pose = Pose(np.eye(3), np.asarray(total.com))
    link.notes.append("from its geoms")
    link.visual, link.collision = Assembly(), Assembly()   # compared with what it was made from, it says nothing


def _geom(node: Node, style: str, model: Model, link: Link) -> list[tuple[geometry.Part, float]]:
    """Add a geom; returns it with its mass as MuJoCo computes it, or nothing when it has none or was not read."""
    told = {**model.defaults.get(node.get("class") or style, {}).get("geom", {}), **node.element.attrib}
    kind = told.get("type", "sphere")
    if kind in ("plane", "hfield"):
        return []
    # What nothing can touch is there to be seen.
    into = link.visual if told.get("contype") == told.get("conaffinity") == "0" else link.collision
    size = to_numbers(told.get("size", ""), None, f"{node.where}: size")
    pose = Pose(_orientation(node, model.compiler, told), to_numbers(told.get("pos", "0 0 0"), 3, f"{node.where}: pos"))
    if "fromto" in told:
        ends = to_numbers(told["fromto"], 6, f"{node.where}: fromto")
        along = ends[3:] - ends[:3]
        size = np.concatenate([size[:1] if kind in ("capsule", "cylinder") else np.repeat(size[:1], 2),
                               [float(np.linalg.norm(along)) / 2]])
        pose = Pose(_onto(_unit(along, node)), (ends[:3] + ends[3:]) / 2)
    makers: dict[str, tuple[int, Callable[[], geometry.Part]]] = {
        "sphere": (1, lambda: geometry.ball(size[0], pose)),
        "capsule": (2, lambda: geometry.capsule(size[0], 2 * size[1], pose)),
        "cylinder": (2, lambda: geometry.cylinder(size[0], 2 * size[1], pose)),
        "ellipsoid": (3, lambda: geometry.ellipsoid(size[:3], pose)),
        "box": (3, lambda: geometry.block(size[:3], pose)),
    }
    before = len(into.parts)
    if "mesh" in told:
        _mesh(node, told, kind, model, link, into, pose)
    elif kind in makers:
        count, make = makers[kind]
        if len(size) < count:
            raise node.wrong(f"size: a {kind} has {count}, got {len(size)}")
        link.add(into, f"geom {kind}", make)
    else:
        into.whole = False
        link.notes.append(f"geom of type {kind!r} is not read: not compared with it")
    if len(into.parts) == before:
        return []
    part = into.parts[-1]
    if (mass := told.get("mass")) is not None:
        return [(part, float(to_numbers(mass, 1, f"{node.where}: mass")[0]))]
    density = float(to_numbers(told.get("density", "1000"), 1, f"{node.where}: density")[0])
    return [(part, density * (part.solid.mass if part.solid is not None else 0.0))]


def _mesh(node: Node, told: dict[str, str], kind: str, model: Model, link: Link, into: Assembly, pose: Pose) -> None:
    asset = model.meshes.get(told["mesh"])
    if kind != "mesh" or asset is None or asset.get("file") is None or asset.get("refpos") or asset.get("refquat"):
        into.whole = False
        why = ("no such asset" if asset is None else f"a {kind} fitted to it" if kind != "mesh" else
               "it is no plain file")
        link.notes.append(f"mesh {told['mesh']!r} is not read ({why}): not compared with it")
        return
    settings = {**model.defaults.get(asset.get("class") or "main", {}).get("mesh", {}), **asset.element.attrib}
    scale = to_numbers(settings.get("scale", "1 1 1"), 3, f"{asset.where}: scale")
    path = pathlib.PurePosixPath(model.compiler.meshes) / asset.word("file")
    link.add_mesh(into, str(path), scale, pose, model.file)
