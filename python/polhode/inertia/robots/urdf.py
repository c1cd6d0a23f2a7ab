"""URDF: http://wiki.ros.org/urdf/XML/link."""

from __future__ import annotations

import pathlib

import numpy as np

from ..._attitude.rotation import Rotation
from ..._xml import Node
from . import geometry
from .format import Format, NoRobot
from .geometry import Assembly, Pose
from .link import Link, Robot, Source, read_link
from .paths import Search


def read(root: Node, file: pathlib.Path, search: Search) -> Robot:
    """Read the links."""
    macros = sorted({node.tag for node in root.walk() if node.tag.startswith("xacro:")})
    nodes = list(root.children("link"))
    if not nodes:
        if macros:
            raise NoRobot(root, "holds xacro's macros and no link: expand it first (xacro robot.xacro > robot.urdf), "
                                "or install xacro")
        raise NoRobot(root, "<link> is missing")
    links = [read_link(node.get("name") or f"link {i + 1}", node, lambda link: _fill(link, node, file, search))
             for i, node in enumerate(nodes)]
    notes = [f"<{macros[0]}> is left over from xacro: what it stands for is not judged"] if macros else []
    return Robot("URDF", root.get("name") or file.stem, links, notes, str(file))


def _fill(link: Link, node: Node, file: pathlib.Path, search: Search) -> None:
    node.word("name")
    for tag, into in (("visual", link.visual), ("collision", link.collision)):
        for shown in node.children(tag):
            with link.shielded(into):
                _geometry(link, into, shown, file, search)
    inertial = node.child("inertial")
    if inertial is None:
        link.unjudged = "no <inertial>"
        return
    link.line = inertial.line
    link.pose = _pose(inertial)
    mass = inertial.need("mass")
    link.mass = mass.number("value")
    tensor = inertial.need("inertia")
    xx, xy, xz, yy, yz, zz = (tensor.number(name, finite=False) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    link.matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    link.source = Source(inertial, mass, tensor, inertial.child("origin"))


def _pose(node: Node) -> Pose:
    origin = node.child("origin")
    if origin is None:
        return Pose()
    rotation = Rotation.from_euler("xyz", origin.numbers("rpy", 3, "0 0 0"))   # roll, pitch, yaw about fixed axes
    return Pose(rotation.as_matrix(), origin.numbers("xyz", 3, "0 0 0"))


def _geometry(link: Link, into: Assembly, node: Node, file: pathlib.Path, search: Search) -> None:
    pose = _pose(node)
    for shape in node.need("geometry").children():
        if shape.tag == "box":
            half = shape.numbers("size", 3) / 2
            link.add(into, "box", lambda: geometry.block(half, pose))
        elif shape.tag in ("cylinder", "capsule"):
            make = geometry.cylinder if shape.tag == "cylinder" else geometry.capsule
            radius, length = shape.number("radius"), shape.number("length")
            link.add(into, shape.tag, lambda: make(radius, length, pose))
        elif shape.tag == "sphere":
            radius = shape.number("radius")
            link.add(into, "sphere", lambda: geometry.ball(radius, pose))
        elif shape.tag == "mesh":
            scale = shape.numbers("scale", None, "1 1 1")
            if len(scale) not in (1, 3):
                raise shape.wrong(f"scale: must be 3 numbers, got {shape.get('scale')!r}")
            link.add_mesh(into, shape.word("filename"), np.resize(scale, 3), pose, file, search)
        elif ":" not in shape.tag and shape.tag != "plane":   # a plane has no inside
            link.leave_out(into, "kind of shape", f"<{shape.tag}> is not read: not compared with it")


FORMAT = Format("URDF", ("robot",), (".urdf",), read, mass="value", centre="xyz")
