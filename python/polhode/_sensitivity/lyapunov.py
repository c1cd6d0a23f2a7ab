"""The largest Lyapunov exponent of a motion."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from .. import _core
from .._attitude.arrays import to_number
from .._core import InvalidInput
from .._scene.scene import Scene
from .driven import differentiate
from .sensitivity import Array

PARTS = 200   # of the span, at least
TURN = 2.0    # revolutions at most in a part


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Lyapunov:
    """How fast neighbours of a motion leave it.

    Attributes
    ----------
    exponent : float
        log(growth) over the span [1/s].
    t : ndarray, shape (n,)
        Times since the start [s].
    log_growth : ndarray, shape (n,)
        The logarithm of the length of a tangent vector, which is 1 at the start. A chaotic motion has a straight line,
        a regular one log(t).
    """

    exponent: float
    t: Array
    log_growth: Array

    def __repr__(self) -> str:
        return f"Lyapunov(exponent={self.exponent:.4g} per second over {self.t[-1]:.6g} s)"


def _held(scene: Scene) -> tuple[_core.Rotor, ...]:
    """The rotors with the momenta that they have at the start, which later starts of the body must not change."""
    def hold(rotor: _core.Rotor) -> _core.Rotor:
        if not rotor.free or rotor.momentum is not None:
            return rotor
        assert rotor.inertia is not None and rotor.speed is not None
        momentum = rotor.inertia * (rotor.speed + float(np.dot(rotor.axis, scene.omega)))
        return _core.Rotor(axis=rotor.axis, momentum=momentum, inertia=rotor.inertia, free=True)

    return tuple(hold(rotor) for rotor in scene.rotors)


def _of_loop(scene: Scene, length: float, parts: int, accuracy: float) -> Lyapunov:
    """Carry a tangent vector through one run: its parts in the memory of controllers and in delays go on."""
    times = scene.t0 + length * np.arange(1, parts + 1) / parts
    made = _core.sensitivity(scene.replace(times=times, want=("omega", "attitude")), ["omega", "attitude"], accuracy,
                             False, "space", 10_000_000, rescale=True)
    rates = np.maximum.accumulate(np.linalg.norm(np.concatenate([scene.omega[None], made.omega]), axis=1))
    rates = np.where(rates > 0, rates, parts / length)
    vector = np.full(6, 1 / math.sqrt(6)) * np.repeat([rates[0], 1.0], 3)
    displaced = np.concatenate([made.d_omega @ vector / rates[1:, None], made.d_attitude @ vector], axis=1)
    with np.errstate(divide="ignore"):
        grown = np.log(np.linalg.norm(displaced, axis=1)) + math.log(2) * np.array(made.scale)
    log_growth = np.concatenate([[0.0], grown])
    return Lyapunov(float(log_growth[-1] / length), np.concatenate([[0.0], times - scene.t0]), log_growth)


def lyapunov(scene: Scene, span: float | None = None, *, accuracy: float = 1e-9) -> Lyapunov:
    """Compute the largest Lyapunov exponent of a motion over a span of time.

    A tangent vector is carried by the derivatives of :func:`solve`, and scaled to length 1 at the end of each part of
    the span. Its length is that of (d omega / rate, d theta). The rate is the largest of the motion so far.

    Parameters
    ----------
    scene : Scene
        With torques of the library, rotors, windows and controllers; no Custom torque. Its times matter only for the
        span. The memory of controllers and the commands on their way carry a part of the tangent vector, which is not
        in its length.
    span : float, optional
        From the start [s]; by default to the scene's last time.
    accuracy : float
        Of the columns in each part.

    Returns
    -------
    Lyapunov

    Raises
    ------
    InvalidInput
        For a span that is not positive and finite, and what `solve(sensitivity=)` refuses.

    Notes
    -----
    An exponent over a finite span is an estimate. Tangent vectors of regular motions grow like t, which gives
    log(t) / t: near 0, but not 0. Benettin, Galgani, Giorgilli & Strelcyn 1980, Meccanica 15, 9.
    """
    if not isinstance(scene, Scene):
        raise InvalidInput(f"scene: must be a polhode.Scene, got {type(scene).__name__}")
    length = float(np.max(scene.times)) - scene.t0 if span is None else to_number(span, "span")
    if not (length > 0 and math.isfinite(length)):
        raise InvalidInput(f"span: must be positive and finite, got {length}")
    accuracy = to_number(accuracy, "accuracy")
    rate = float(np.linalg.norm(scene.omega))
    parts = int(min(max(PARTS, length * rate / (2 * math.pi * TURN)), 1_000_000))
    if scene.changing is not None or scene.momentum is not None:
        raise InvalidInput("lyapunov: must be of a scene whose body is constant, got one that changes")
    inner = scene.damper is not None or any(name.startswith("rotor_momentum_") for name in scene.states)
    if inner and not scene.controllers:
        raise InvalidInput("lyapunov: must be of a scene without a damper and without motors or friction of rotors, "
                                 "got one with them; their momenta are states, which it does not carry")
    if scene.controllers:
        return _of_loop(scene, length, parts, accuracy)
    now = scene.replace(rotors=_held(scene), want=("omega", "attitude"))
    times = scene.t0 + length * np.arange(1, parts + 1) / parts
    vector, log_growth = np.full(6, 1 / math.sqrt(6)), np.zeros(parts + 1)
    rate = rate or parts / length
    for k, t in enumerate(times):
        s = differentiate(now.replace(times=[t]), ("omega", "attitude"), accuracy, certify=False)
        displaced = s.transition[0] @ (vector * np.repeat([rate, 1.0], 3))
        rate = max(rate, float(np.linalg.norm(s.omega[0])))
        displaced[:3] /= rate
        grown = float(np.linalg.norm(displaced))
        log_growth[k + 1] = log_growth[k] + math.log(grown)
        vector = displaced / grown
        now = now.replace(omega=s.omega[0], attitude=s.attitude[0], t0=t)
    return Lyapunov(float(log_growth[-1] / length), np.concatenate([[0.0], times - scene.t0]), log_growth)
