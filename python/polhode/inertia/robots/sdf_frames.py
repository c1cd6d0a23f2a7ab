"""Frames of SDFormat models: poses that are relative to others."""

from __future__ import annotations

import numpy as np

from ..._attitude.rotation import Rotation
from ..._xml import Node
from .geometry import Pose

FRAMES = ("link", "frame", "joint", "model")
DEEPEST = 100   # frames that refer to others in turn


def entry(node: Node, name: str) -> str | None:
    """The text of a child, or else the attribute that stood for it before version 1.2."""
    child = node.child(name)
    if child is None:
        return node.get(name)
    return child.text or child.get("value") or child.text


def pose_of(node: Node) -> tuple[Pose, str]:
    """Return the pose that stands in an element, and the frame it is relative to; "" for the usual one."""
    pose = node.child("pose")
    if pose is None or not pose.text:
        origin = node.child("origin")   # before version 1.2
        if origin is None or origin.get("pose") is None:
            return Pose(), "" if pose is None else pose.get("relative_to") or ""
        values = origin.numbers("pose", 6)
        return Pose(Rotation.from_euler("xyz", values[3:]).as_matrix(), values[:3]), ""
    relative = pose.get("relative_to") or pose.get("frame") or ""
    if pose.get("rotation_format") == "quat_xyzw":
        values = pose.content(7)
        if not np.linalg.norm(values[3:]) > 0:
            raise pose.wrong("a quaternion must not have the length zero")
        return Pose(Rotation.from_quat(values[3:]).as_matrix(), values[:3]), relative
    values = pose.content(6)
    angles = np.deg2rad(values[3:]) if pose.get("degrees") in ("true", "1") else values[3:]
    return Pose(Rotation.from_euler("xyz", angles).as_matrix(), values[:3]), relative


class Frames:
    """The frames of one model, each in the model's frame; found when they are needed."""

    def __init__(self, model: Node) -> None:
        self._nodes = {node.get("name") or "": node for node in model.nodes if node.tag in FRAMES}

    def find(self, name: str, depth: int = 0) -> Pose:
        """Return the pose of a frame in the model's frame; KeyError where it is not known."""
        if name in ("__model__", ""):
            return Pose()
        if depth > DEEPEST:
            raise KeyError(name)
        outer, _, inner = name.partition("::")
        node = self._nodes[outer]
        pose, relative = pose_of(node)
        if not relative and node.tag == "joint":
            relative = entry(node, "child") or ""
        if not relative and node.tag == "frame":
            relative = node.get("attached_to") or ""
        found = self.find(relative, depth + 1) @ pose
        return found @ Frames(node).find(inner, depth + 1) if inner else found
