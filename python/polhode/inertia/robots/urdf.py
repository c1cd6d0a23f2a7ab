"""URDF: http://wiki.ros.org/urdf/XML/link."""

from __future__ import annotations

import pathlib

import numpy as np

from ..._attitude.rotation import Rotation
from . import geometry
from .geometry import Assembly, Pose
from .link import Link, Robot
from .xml import Node


def read(root: Node, file: pathlib.Path) -> Robot:
    """Read the links."""
    if any("xacro" in element.tag for element in root.element.iter() if isinstance(element.tag, str)):
        raise root.wrong("holds xacro's macros: expand them first (xacro robot.xacro > robot.urdf)")
    links = [_link(node, file) for node in root.children("link")]
    if not links:
        raise root.wrong("<link> is missing")
    return Robot("URDF", root.get("name") or file.stem, links, [])


def _link(node: Node, file: pathlib.Path) -> Link:
    link = Link(node.word("name"))
    for tag, into in (("visual", link.visual), ("collision", link.collision)):
        for shown in node.children(tag):
            _geometry(link, into, shown, file)
    inertial = node.child("inertial")
    if inertial is None:
        link.unjudged = "no <inertial>"
        return link
    link.pose = _pose(inertial)
    link.mass = inertial.need("mass").number("value")
    tensor = inertial.need("inertia")
    xx, xy, xz, yy, yz, zz = (tensor.number(name, finite=False) for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    link.matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return link


def _pose(node: Node) -> Pose:
    origin = node.child("origin")
    if origin is None:
        return Pose()
    turn = Rotation.from_euler("xyz", origin.numbers("rpy", 3, "0 0 0"))   # roll, pitch, yaw about fixed axes
    return Pose(turn.as_matrix(), origin.numbers("xyz", 3, "0 0 0"))


def _geometry(link: Link, into: Assembly, node: Node, file: pathlib.Path) -> None:
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
            link.add_mesh(into, shape.word("filename"), shape.numbers("scale", 3, "1 1 1"), pose, file)
        else:
            into.whole = False
            link.notes.append(f"<{shape.tag}> is not read: not compared with it")
