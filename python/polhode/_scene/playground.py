"""The address of a scene on the playground: its fields as words behind the page's name, which web/page/app.js reads."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any
from urllib.parse import urlencode

import numpy as np

from .. import torques
from .._core import InvalidInput

if TYPE_CHECKING:
    from .scene import Scene


def _refuse(what: str, got: Any) -> InvalidInput:
    return InvalidInput(f"show_url: must have {what}, got {got}")


def _find_torques(scene: Scene) -> dict[str, Any]:
    words: dict[str, Any] = {}
    for torque in scene.torques:
        name = type(torque).__name__
        if isinstance(torque, torques.Gravity) and "weight" not in words:
            arm = np.asarray(torque.arm)
            if arm[:2].any():
                raise _refuse("the centre of mass on axis c of the body", f"the arm {arm.tolist()}")
            words |= {"weight": float(torque.weight), "arm": float(arm[2])}
        elif isinstance(torque, torques.Formula) and "torque" not in words:
            if torque.text is None or torque.parameters or torque.states or torque.orbits:
                raise _refuse("a formula of a torque, without parameters and states", repr(torque))
            text = torque.text
            for name, part in reversed(torque.let.items()):   # each may have names that were given before it
                text = re.sub(rf"\b{name}\b", f"({part})", text)
            words["torque"] = text
        else:
            raise _refuse("one weight on a pivot and one formula at most", name)
    return words


def show_url(scene: Scene, page: str = "playground.html") -> str:
    """Return the address; see `Scene.show_url`."""
    matrix = np.asarray(scene.inertia.matrix)
    for what, found in (("a constant body", scene.changing or scene.momentum), ("no damper", scene.damper),
                        ("no controllers", scene.controllers or None)):
        if found is not None:
            raise _refuse(what, type(found).__name__)
    if (matrix != np.diag(np.diag(matrix))).any():
        raise _refuse("its principal axes as body axes", matrix.tolist())
    if scene.t0 != 0:
        raise _refuse("its start at t0 = 0", f"{scene.t0:g} s")
    words: dict[str, Any] = _find_torques(scene)
    for rotor in scene.rotors:
        axis = np.asarray(rotor.axis)
        if "wheel" in words or rotor.free or rotor.during is not None or axis[:2].any():
            raise _refuse("one held rotor about axis c at most", repr(rotor))
        words["wheel"] = float(rotor.momentum) * float(axis[2])
    moments = np.diag(matrix)
    spreads = np.maximum(moments.sum() / 2 - moments, 0.0)    # of each side: spread = side^2 m / 12
    sides = np.sqrt(spreads / spreads.max())                  # the box that is drawn; its size has no meaning
    words |= {name: f"{max(0.02, 0.7 * side):.3f}" for name, side in zip("abc", sides)}
    words |= {f"w{k + 1}": float(value) for k, value in enumerate(scene.omega)}
    words["moments"] = ",".join(repr(float(value)) for value in moments)
    words["attitude"] = ",".join(repr(float(value)) for value in scene.attitude)
    return f"{page}#{urlencode(words)}"
