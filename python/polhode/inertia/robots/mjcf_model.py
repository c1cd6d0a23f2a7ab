"""What the bodies of an MJCF file refer to: included files, compiler settings, defaults, meshes, attached models."""

from __future__ import annotations

import dataclasses
import pathlib

import numpy as np

from ..._attitude.rotation import Rotation
from ..._core import InvalidInput
from ..._xml import Node, parse
from .geometry import Array, Pose
from .paths import Search

MOST_FILES = 1000     # that one model includes
DEEPEST = 50          # includes in includes

Defaults = dict[str, dict[str, dict[str, str]]]


@dataclasses.dataclass(frozen=True)
class Compiler:
    """What <compiler> says of inertia, and where the meshes are."""

    degrees: bool
    euler: str
    from_geometry: str
    balance: bool
    least_mass: float
    least_inertia: float
    meshes: str
    strip: bool
    groups: tuple[float, float]


@dataclasses.dataclass(frozen=True)
class Model:
    """What the geometry of a body refers to."""

    file: pathlib.Path
    search: Search
    compiler: Compiler
    defaults: Defaults
    meshes: dict[str, Node]
    attached: dict[str, Node]
    depth: int = 0


def gather(root: Node, file: pathlib.Path, search: Search, depth: int = 0) -> tuple[Model, list[str]]:
    """Put included files in their places, and read what stands outside of the bodies."""
    notes: list[str] = []
    _include(root, file, search, notes, [0], 0)
    compiler, more = _compiler(root)
    defaults: Defaults = {"main": {}}
    for node in root.children("default"):
        _defaults(node, node.get("class") or "main", defaults.get("main", {}), defaults)
    assets = [node for asset in root.children("asset") for node in asset.children()]
    meshes = {m.get("name") or pathlib.PurePosixPath((m.get("file") or "").replace("\\", "/")).stem: m
              for m in assets if m.tag == "mesh"}
    attached = {m.get("name") or pathlib.PurePosixPath(m.get("file") or "").stem: m for m in assets if m.tag == "model"}
    return Model(file, search, compiler, defaults, meshes, attached, depth), notes + more


def _include(node: Node, main: pathlib.Path, search: Search, notes: list[str], count: list[int], depth: int) -> None:
    """Replace each <include> by what stands in the root of its file, in place."""
    nodes: list[Node] = []
    for child in node.nodes:
        if child.tag != "include":
            nodes.append(child)
            _include(child, main, search, notes, count, depth)
            continue
        name, count[0] = child.get("file") or "", count[0] + 1
        if depth >= DEEPEST or count[0] > MOST_FILES:
            raise child.wrong(f"<include> is nested more than {DEEPEST} deep, or names more than {MOST_FILES} files")
        try:
            found = search.find(name, main) or search.find(name, pathlib.Path(child.file))
            if found is None:
                notes.append(f"<include> is not read: {name!r} not found")
                continue
            inside = parse(found)
        except InvalidInput as error:
            notes.append(f"<include> is not read: {error}")
            continue
        _include(inside, main, search, notes, count, depth + 1)
        for part in inside.nodes:
            part.parent = node
        nodes += inside.nodes
    node.nodes = nodes


def _compiler(root: Node) -> tuple[Compiler, list[str]]:
    attributes: dict[str, str] = {}
    for node in root.children("compiler"):
        attributes |= node.attrib
    notes = []

    def numbers(name: str, count: int, default: str) -> Array:
        return root.convert(attributes.get(name, default), count, f"<compiler>: {name}")

    if numbers("settotalmass", 1, "-1")[0] > 0:
        notes.append(f"settotalmass={attributes['settotalmass']}: MuJoCo scales masses and tensors; judged as written")
    if attributes.get("coordinate", "local") != "local":
        raise root.wrong("coordinate='global' is not read (nor by MuJoCo since 2.3.4)")
    if sorted(attributes.get("eulerseq", "xyz").lower()) != list("xyz") and len(attributes["eulerseq"]) != 3:
        raise root.wrong(f"<compiler>: eulerseq: must be three letters, got {attributes['eulerseq'][:20]!r}")
    low, high = numbers("inertiagrouprange", 2, "0 5")
    return Compiler(attributes.get("angle", "degree") == "degree", attributes.get("eulerseq", "xyz"),
                    attributes.get("inertiafromgeom", "auto"), attributes.get("balanceinertia") == "true",
                    float(numbers("boundmass", 1, "0")[0]), float(numbers("boundinertia", 1, "0")[0]),
                    attributes.get("meshdir", attributes.get("assetdir", "")), attributes.get("strippath") == "true",
                    (float(low), float(high))), notes


def _defaults(node: Node, name: str, inherited: dict[str, dict[str, str]], into: Defaults) -> None:
    """Attributes of geoms and meshes by class, each with its parents'."""
    own = {tag: {**inherited.get(tag, {}), **(child.attrib if (child := node.child(tag)) else {})}
           for tag in ("geom", "mesh")}
    into[name] = own
    for child in node.children("default"):
        _defaults(child, child.get("class") or name, own, into)


def orientation(node: Node, compiler: Compiler, attributes: dict[str, str] | None = None) -> Array:
    """The rotation that an element gives in one of MuJoCo's five ways."""
    attributes = node.attrib if attributes is None else attributes

    def numbers(name: str, count: int) -> Array:
        return node.convert(attributes[name], count, name)

    radians = np.pi / 180 if compiler.degrees else 1.0
    if "quat" in attributes:
        w, x, y, z = unit(numbers("quat", 4), node)   # MuJoCo's scalar comes first
        rotation = Rotation.from_quat((x, y, z, w))
    elif "axisangle" in attributes:
        axis, angle = numbers("axisangle", 4)[:3], numbers("axisangle", 4)[3]
        rotation = Rotation.from_rotvec(unit(axis, node) * angle * radians)
    elif "euler" in attributes:   # MuJoCo's lower case rotates with the body, as SciPy's upper case does
        angles = numbers("euler", 3) * radians
        if compiler.euler.islower() or compiler.euler.isupper():
            rotation = Rotation.from_euler(compiler.euler.swapcase(), angles)
        else:
            rotation = Rotation.from_quat((0, 0, 0, 1))
            for letter, angle in zip(compiler.euler, angles):
                single = Rotation.from_rotvec(np.eye(3)["xyz".index(letter.lower())] * angle)
                rotation = rotation * single if letter.islower() else single * rotation
    elif "xyaxes" in attributes:
        x, y = np.split(numbers("xyaxes", 6), 2)
        x = unit(x, node)
        y = unit(y - x * (x @ y), node)
        return np.column_stack([x, y, np.cross(x, y)])
    elif "zaxis" in attributes:
        return onto(unit(numbers("zaxis", 3), node))
    else:
        return np.eye(3)
    return np.asarray(rotation.as_matrix())


def pose(node: Node, compiler: Compiler, attributes: dict[str, str] | None = None) -> Pose:
    """The pose that an element gives in its parent's frame."""
    attributes = node.attrib if attributes is None else attributes
    return Pose(orientation(node, compiler, attributes), node.convert(attributes.get("pos", "0 0 0"), 3, "pos"))


def unit(v: Array, node: Node) -> Array:
    length = float(np.linalg.norm(v))
    if not length > 0:
        raise node.wrong("a direction, quaternion or line must not have the length zero")
    return np.asarray(v / length)


def onto(z: Array) -> Array:
    """The smallest rotation that takes the z axis onto this unit vector."""
    v, c = np.cross((0, 0, 1), z), z[2]
    if c < -1 + 1e-12:
        return np.diag([1.0, -1.0, -1.0])
    k = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.asarray(np.eye(3) + k + k @ k / (1 + c))
