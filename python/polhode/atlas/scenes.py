"""The problems that the families sweep. The stored truth is made from the same definitions."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from .._core import Rotor
from .._scene.scene import Scene
from ..torques import Constant, Damping, Gravity
from .case import S1_MOMENTS, Case

RACKET_SPAN = 200.0
RACKET = (1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
GIMBAL = (0.5, 0.1, 0.03, 0.01, 3e-3, 1e-3)
LONG = (1e2, 1e3, 1e4, 1e5, 1e6)
STIFF = (1e1, 1e2, 1e3, 1e4, 1e5, 1e6)
SPIN_UP = (1e2, 1e3, 1e4)
NEAR = (1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-15, 0.0)
CHAOS_SPAN, CHAOS_SAMPLES = 400.0, 401
SLEEPING = (0.1, 0.01, 0.001, 1e-4, 1e-5, 1e-6, 0.0, -1e-6, -1e-5, -1e-4, -0.001, -0.01, -0.1)
WHEEL = SLEEPING
WHEEL_RATE = 5.0   # rad/s about the intermediate axis
CRITICAL_WHEEL = (S1_MOMENTS[2] - S1_MOMENTS[1]) * WHEEL_RATE
CRITICAL_SPIN = 2 * math.sqrt(2.0) / 0.5   # 2 sqrt(I1 M) / I3 of (1, 1, 0.5) under M = 2


def _tilted(theta: float) -> tuple[float, ...]:
    return (math.sin(theta / 2), 0.0, 0.0, math.cos(theta / 2))


def racket(closeness: float, times: npt.ArrayLike | None = None) -> Case:
    """S1's block thrown about its intermediate axis, missed by `closeness` rad/s."""
    when = np.linspace(0, RACKET_SPAN, 101) if times is None else times
    return Case(closeness, Scene(inertia=S1_MOMENTS, omega=(closeness, 5.0, closeness), times=when))


def gimbal(kind: str, least: float) -> Case:
    """A free disk ("free") or a heavy top ("top") whose axis starts, and is least tilted, at theta = `least`."""
    times, attitude = np.linspace(0, 20, 41), _tilted(least)
    if kind == "free":
        scene = Scene(inertia=(0.4, 0.4, 0.2), omega=(0.0, 2.0, 4.0), attitude=attitude, times=times)
    else:
        scene = Scene(inertia=(1.0, 1.0, 0.5), omega=(0.0, 0.5, 6.0), attitude=attitude, times=times,
                      torques=[Gravity(2.0, (0.0, 0.0, 1.0))])
    return Case(least, scene, kind)


def long(turns: float) -> Case:
    """S1 after many turns, at five times on the way.

    Not after whole turns, when a wrong model may be back where it was, but at ends of steps of a 40th of a turn:
    between them it would be the continuous extension that is seen.
    """
    times = (turns * np.array([0.2, 0.4, 0.6, 0.8, 1.0]) + 15 / 40) * 2 * math.pi / math.sqrt(14.0)
    return Case(turns, Scene(inertia=S1_MOMENTS, omega=(1.0, 2.0, 3.0), times=times), grows=True)


def damped(strength: float) -> Case:
    """A brick damped hard about one axis: its rates are slow, one of them is slaved within a moment."""
    torque = Damping(np.diag([strength, 0.01, 0.01]))
    scene = Scene(inertia=(1.0, 2.0, 2.5), omega=(1.0, 2.0, 3.0), torques=[torque], times=np.linspace(0, 10, 21))
    return Case(strength, scene, grows=True)


def spin_up(span: float) -> Case:
    """S9's thruster, left on: |omega| grows as t, turns as t^2."""
    scene = Scene(inertia=S1_MOMENTS, omega=(0.1, 0.2, 0.3), times=np.linspace(0, span, 11),
                  torques=[Constant((0.01, -0.02, 0.03), frame="body")])
    return Case(span, scene, grows=True)


def chaos() -> Scene:
    """S5c, nearly seven times as long."""
    return Scene(inertia=(1.0, 2.0, 2.5), omega=(0.3, 0.2, 2.0), attitude=_tilted(0.5),
                 torques=[Gravity(2.0, (0.3, 0.2, 0.5))], times=np.linspace(0, CHAOS_SPAN, CHAOS_SAMPLES))


def near(kind: str, gap: float) -> Case:
    """Bodies close to a sphere ("sphere") or to a symmetric one ("symmetric"), through 1000 of S1's turns."""
    moments = (1.0, 1.0 + gap, 1.0 + 2 * gap) if kind == "sphere" else (1.0, 1.0 + gap, 0.5)
    span = 1000 * 2 * math.pi / math.sqrt(14.0)
    scene = Scene(inertia=moments, omega=(1.0, 2.0, 3.0), times=span * np.array([0.3, 0.7, 1.0]))
    return Case(gap, scene, kind)


def sleeping(excess: float) -> Case:
    """A top spun upright at (1 + excess) of the critical rate, tilted by 1e-6."""
    scene = Scene(inertia=(1.0, 1.0, 0.5), omega=(0.0, 0.0, CRITICAL_SPIN * (1 + excess)), attitude=_tilted(1e-6),
                  torques=[Gravity(2.0, (0.0, 0.0, 1.0))], times=np.linspace(0, 200, 2001))
    return Case(excess, scene)


def wheel(excess: float) -> Case:
    """S1's block about its intermediate axis, with a wheel on it at (1 + excess) of the critical momentum.

    The momentum is 1e-6 rad off the axis.
    """
    momentum = CRITICAL_WHEEL * (1 + excess)
    kick = 1e-6 * (S1_MOMENTS[1] * WHEEL_RATE + momentum) / S1_MOMENTS[0]
    scene = Scene(inertia=S1_MOMENTS, omega=(kick, WHEEL_RATE, 0.0), rotors=[Rotor((0.0, 1.0, 0.0), momentum=momentum)],
                  times=np.linspace(0, 200, 2001))
    return Case(excess, scene)


def lean(attitude: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """The angle between the body's y axis and space y, where it was at the start; right where it is small [rad]."""
    x, y, z, w = np.moveaxis(attitude, -1, 0)
    return np.asarray(2 * np.arctan2(np.hypot(x, z), np.hypot(y, w)))


def tilt(attitude: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """The angle between the body's z axis and the vertical, right where it is small [rad]."""
    x, y, z, w = np.moveaxis(attitude, -1, 0)
    return np.asarray(2 * np.arctan2(np.hypot(x, y), np.hypot(z, w)))
