"""Scenes whose torques are formulas: what a user's own torques get, on scenes whose motion is known."""

from __future__ import annotations

from typing import Any

from .._scene.scene import Scene
from ..torques import Custom, During

Torque = object


def why_no_formulas(scene: Scene) -> str:
    """Return why the torques of a scene cannot be formulas, or ""."""
    if not scene.torques:
        return "needs a torque, to write it as a formula"
    lasting = [torque.torque if isinstance(torque, During) else torque for torque in scene.torques]
    return "Custom torques are no formulas" if any(isinstance(torque, Custom) for torque in lasting) else ""


def to_formulas(scene: Scene) -> Scene:
    """Return the scene with each torque as a formula of its own law, which `solve` does not replace."""
    def write(torque: Torque) -> Torque:
        if isinstance(torque, During):
            return During(write(torque.torque), torque.windows)
        lasting: Any = torque
        return lasting.as_formula(scene.inertia)

    return scene.replace(torques=[write(torque) for torque in scene.torques])
