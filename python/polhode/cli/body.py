"""Mass properties of a body in a TOML file, or the reason why it cannot exist."""

from __future__ import annotations

from typing import Any

from .._core import InertiaTensor, InvalidInput
from .._scene.bodies import body_inertia, body_properties, is_solid
from .._scene.files import load_body


def find_mesh(source: str) -> str | None:
    """Return the mesh file of a scene's body, or None."""
    mesh: str | None = load_body(source).mesh
    return mesh


def examine(source: str) -> dict[str, Any]:
    """Return moments, axes, symmetry and verdict of a [body] table.

    A tensor that breaks the triangle inequality is a finding, not an error: `valid` is False, and `verdict` says why.
    """
    body = load_body(source)
    finding: dict[str, Any] = {"file": str(source), "valid": True, "verdict": "a body can have this tensor"}
    if is_solid(body):
        properties = body_properties(body)
        finding |= {"shape": body.shape, "mesh": body.mesh, "parts": body.parts and len(body.parts)}
        finding |= {"mass": properties.mass, "com": list(properties.com)}
    tensor: InertiaTensor | None
    try:
        tensor = body_inertia(body)
    except InvalidInput as error:
        finding |= {"valid": False, "verdict": str(error)}
        tensor = _loosely(body)
    if tensor is not None:
        if not tensor.physical:
            finding["valid"] = False
            if finding["verdict"].startswith("a body"):
                finding["verdict"] = _verdict(tensor)
        principal = tensor.principal()
        finding |= {"matrix": tensor.matrix.tolist(), "moments": tensor.moments.tolist(), "axes": tensor.axes.tolist(),
                    "symmetry": tensor.symmetry, "arbitrary": principal.arbitrary}
    return finding


def _loosely(body: Any) -> InertiaTensor | None:
    """Return the tensor without the check of the triangle inequality; None if it fails other checks."""
    try:
        return body_inertia(body.model_copy(update={"physical": False}))
    except InvalidInput:
        return None


def _verdict(tensor: InertiaTensor) -> str:
    """Return the reason why `InertiaTensor` would refuse a tensor that has `physical = false`."""
    try:
        InertiaTensor(tensor.matrix)
    except InvalidInput as error:
        return str(error)
    return "a body can have this tensor"
