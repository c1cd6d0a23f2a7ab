"""SDFormat: http://sdformat.org/spec."""

from __future__ import annotations

import pathlib

import numpy as np

from ..._attitude.rotation import Rotation
from . import geometry
from .geometry import Assembly, Pose
from .link import Link, Robot
from .xml import Node


def read(root: Node, file: pathlib.Path) -> Robot:
    """Read the links of all models of the file, nested ones included."""
    links: list[Link] = []
    notes: list[str] = []
    left = [(node, "") for node in root.children()]
    while left:
        node, path = left.pop(0)
        if node.tag == "model":
            path += f"{node.word('name')}::"
        if node.tag == "include":
            notes.append(f"<include> {(node.child('uri') or node).text!r} is not read")
        elif node.tag == "link":
            links.append(_link(node, path.partition("::")[2] if path.count("::") == 1 else path, file))
        if node.tag in ("model", "world"):
            left = [(child, path) for child in node.children()] + left
    if not links:
        raise root.wrong("<link> is missing")
    return Robot("SDF", file.stem, links, notes)


def _link(node: Node, path: str, file: pathlib.Path) -> Link:
    link = Link(path + node.word("name"))
    for tag, into in (("visual", link.visual), ("collision", link.collision)):
        for shown in node.children(tag):
            _geometry(link, into, shown, file)
    inertial = node.child("inertial")
    if inertial is None:
        link.unjudged = "no <inertial>: SDF takes 1 kg and 1 kg m^2 about each axis"
        return link
    if inertial.get("auto") in ("true", "1"):
        link.unjudged = "<inertial auto>: computed from the collisions when it is loaded"
        return link
    link.pose, _ = _pose(inertial)
    mass, tensor = inertial.child("mass"), inertial.child("inertia")
    if mass is None:
        link.notes.append("no <mass>: SDF takes 1 kg")
    link.mass = 1.0 if mass is None else float(mass.content(1)[0])
    values = {}
    for name, default in (("ixx", 1), ("iyy", 1), ("izz", 1), ("ixy", 0), ("ixz", 0), ("iyz", 0)):
        entry = None if tensor is None else tensor.child(name)
        if entry is None and default:
            link.notes.append(f"no <{name}>: SDF takes 1 kg m^2")
        values[name] = float(default) if entry is None else float(entry.content(1, finite=False)[0])
    xx, yy, zz, xy, xz, yz = values.values()
    link.matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    return link


def _pose(node: Node) -> tuple[Pose, bool]:
    """Return the pose, and whether it is relative to the link's frame."""
    pose = node.child("pose")
    if pose is None or not pose.text:
        return Pose(), True
    here = not pose.get("relative_to")
    if pose.get("rotation_format") == "quat_xyzw":
        values = pose.content(7)
        return Pose(Rotation.from_quat(values[3:]).as_matrix(), values[:3]), here
    values = pose.content(6)
    turn = Rotation.from_euler("xyz", np.deg2rad(values[3:]) if pose.get("degrees") in ("true", "1") else values[3:])
    return Pose(turn.as_matrix(), values[:3]), here


def _geometry(link: Link, into: Assembly, node: Node, file: pathlib.Path) -> None:
    pose, here = _pose(node)
    if not here:
        into.whole = False
        link.notes.append(f"<{node.tag}> relative to another frame is not read: not compared with it")
        return
    for shape in node.need("geometry").children():
        if shape.tag in ("box", "ellipsoid"):
            lengths = shape.need("size").content(3) / 2 if shape.tag == "box" else shape.need("radii").content(3)
            solid = geometry.block if shape.tag == "box" else geometry.ellipsoid
            link.add(into, shape.tag, lambda: solid(lengths, pose))
        elif shape.tag in ("cylinder", "capsule"):
            make = geometry.cylinder if shape.tag == "cylinder" else geometry.capsule
            radius, length = (float(shape.need(name).content(1)[0]) for name in ("radius", "length"))
            link.add(into, shape.tag, lambda: make(radius, length, pose))
        elif shape.tag == "sphere":
            radius = float(shape.need("radius").content(1)[0])
            link.add(into, "sphere", lambda: geometry.ball(radius, pose))
        elif shape.tag == "mesh":
            scale = shape.child("scale")
            factors = np.ones(3) if scale is None else scale.content(3)
            link.add_mesh(into, shape.need("uri").text, factors, pose, file)
        elif shape.tag != "empty":
            into.whole = False
            link.notes.append(f"<{shape.tag}> is not read: not compared with it")
