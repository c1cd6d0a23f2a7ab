"""What one torque can do to a motion: a bound, before anything is integrated."""

from __future__ import annotations

from typing import Literal, NamedTuple

from .. import _core
from .._attitude.arrays import is_whole
from .._keywords import checked
from .._scene.scene import Scene, refuse_controllers


class Effect(NamedTuple):
    """Bounds on what one torque changes, at any time of the scene's span."""

    omega: float                                # of the angular velocity [rad/s]; infinite if refused
    attitude: float                             # of the attitude [rad]; infinite if refused
    first_order: tuple[float, float]            # both to first order in the torque: estimates, no bounds
    kind: Literal["bounded", "refused"]
    reason: str                                 # why there is no bound; empty if there is one


@checked
def effect(scene: Scene, torque: int = 0) -> Effect:
    """Bound what one torque changes over the scene's span, against the motion without it.

    All other torques stay. What remains must be a free body, whose closed form gives the bound: no step is taken.
    The effect of several small torques together is in the plan: see `Plan.left_out`.

    Parameters
    ----------
    scene : Scene
    torque : int
        Its number among the scene's torques.

    Returns
    -------
    Effect
        `omega` [rad/s] and `attitude` [rad] hold at every time between the start and the scene's times. `kind` is
        "bounded", or "refused" with the reason.

    Raises
    ------
    InvalidInput
        For a number that is no torque of the scene.

    Notes
    -----
    The nonlinear variation of constants (Alekseev 1961; Groebner 1960): `docs/theory/left_out.md`.
    """
    if not isinstance(scene, Scene):
        raise _core.InvalidInput(f"scene: must be a polhode.Scene, got {type(scene).__name__}")
    refuse_controllers(scene, "effect")
    if not is_whole(torque):
        raise _core.InvalidInput(f"torque: must be a whole number, got {torque!r}")
    if not 0 <= torque < len(scene.torques):
        raise _core.InvalidInput(f"torque: must be the number of one of {len(scene.torques)} torques, got {torque}")
    return Effect(**_core.effect(scene, int(torque)))
