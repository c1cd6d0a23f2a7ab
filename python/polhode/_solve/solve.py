"""Solve a scene: the least model and the cheapest method that answer it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._scene.scene import Scene
from .costs import factors
from .motion import Floats, Motion
from .plan import Plan


class Event:
    """A function of time and state whose zeros are wanted.

    Parameters
    ----------
    function : callable
        ``function(t, omega, attitude) -> float``.
    direction : {-1, 0, 1}
        1: only zeros where it rises along the integration, -1: where it falls, 0: both.
    terminal : bool
        The run ends at its first zero.
    """

    __slots__ = ("direction", "function", "terminal")

    def __init__(self, function: Callable[..., float], direction: int = 0, terminal: bool = False) -> None:
        if not callable(function):
            raise _core.InvalidInput(f"Event.function: must be callable, got {type(function).__name__}")
        if direction not in (-1, 0, 1):
            raise _core.InvalidInput(f"Event.direction: must be -1, 0 or 1, got {direction!r}")
        self.function, self.direction, self.terminal = function, int(direction), bool(terminal)


def _event(item: Any) -> tuple[Any, int, bool]:
    event = item if isinstance(item, Event) else Event(
        item, getattr(item, "direction", 0), bool(getattr(item, "terminal", False)))
    return event.function, event.direction, event.terminal


def _take(plan: Plan, accuracy: float | None, method: str | None, rtol: float | None, atol: float | None,
          step: float | None, certify: bool, formulation: str) -> tuple[float, str | None, bool, str]:
    """What a plan asks for, where nothing contradicts it."""
    if not isinstance(plan, Plan):
        raise _core.InvalidInput(f"plan: must be what polhode.plan() made, got {type(plan).__name__}")
    for name, value in (("accuracy", accuracy), ("rtol", rtol), ("atol", atol), ("step", step)):
        if value is not None:
            raise _core.InvalidInput(f"{name}: must be left out beside plan=, which has its own, got {value!r}")
    if math.isnan(plan.accuracy):
        raise _core.InvalidInput("plan: must be made for an accuracy; this one is of a run by tolerances")
    asked = plan.wishes.get("formulation", "euler")
    if formulation not in ("euler", asked):
        raise _core.InvalidInput(f"formulation: must be left out beside plan=, which has {asked!r}, got "
                                 f"{formulation!r}")
    own = plan.wishes.get("method") if plan.pieces else plan.method   # pieces: each has its own
    return plan.accuracy, method if method is not None else own, certify and plan.certify, asked


def solve(
    scene: Scene,
    accuracy: float | None = None,
    *,
    plan: Plan | None = None,
    method: str | None = None,
    certify: bool = True,
    rtol: float | None = None,
    atol: float | None = None,
    step: float | None = None,
    max_steps: int = 10_000_000,
    dense: bool = False,
    formulation: str = "euler",
    events: Iterable[Any] = (),
    progress: Callable[[float, float], object] | None = None,
) -> Motion:
    """Turn the body of a scene.

    Parameters
    ----------
    scene : Scene
    accuracy : float, optional
        Of every sample: the larger of the error in omega, relative to the largest omega, and the angle of the
        attitude's error [rad]. 0 < accuracy <= 1; 1e-9 when no tolerance is given either. `motion.error` bounds the
        error that was got, and `motion.success` says whether that is within the accuracy. Excludes rtol and atol.
    plan : Plan, optional
        What `plan()` made: its accuracy, method and certificate are taken. A method given beside it overrides its own.
    method : str, optional
        A name of `methods()`, or "exact" for the closed form alone; without it the plan's choice.
    certify : bool
        Bound the error of a stepped motion: carried along by the run itself, or by a second, coarser run. False saves
        that: `motion.error` is then what is expected, and `motion.error_kind` says so.
    rtol, atol : float, optional
        Tolerances of a step, for those who want to choose: the error is then not estimated. Rates are measured against
        their own size, the quaternion against 1; atol is added, in rad/s and in quaternion components.
    step : float, optional
        Of fixed-step methods [s], which ask for it and refuse accuracy, rtol and atol.
    max_steps : int
        Give up after so many steps; the result says so.
    dense : bool
        Keep the continuous extension, for ``motion(t)``.
    formulation : {"euler", "lagrangian"}
        Euler's equations with a quaternion, or Lagrange's in the textbook's z-x-z angles, which fail at theta = 0 or
        pi.
    events : iterable of Event or callables
        Zeros to be found; a callable may carry `direction` and `terminal` as attributes.
    progress : callable, optional
        ``progress(reached, last)``, about twenty times a second; False ends the run, and what was computed is returned.

    Returns
    -------
    Motion

    Raises
    ------
    InvalidInput
        For options that contradict each other or have no effect. What a torque or event raises comes through.
    """
    if not isinstance(scene, Scene):
        raise _core.InvalidInput(f"scene: must be a polhode.Scene, got {type(scene).__name__}")
    if callable(events) or isinstance(events, Event):
        events = (events,)
    if not isinstance(events, (tuple, list, Iterable)):
        raise _core.InvalidInput(f"events: must be events or callables, got {events!r}")
    if not isinstance(max_steps, (int, np.integer)):
        raise _core.InvalidInput(f"max_steps: must be a whole number, got {max_steps!r}")
    if plan is not None:
        accuracy, method, certify, formulation = _take(plan, accuracy, method, rtol, atol, step, certify, formulation)
    options = None if method is None and formulation == "euler" else {"method": method, "formulation": formulation}
    answer = _core.solve(scene, accuracy, method, rtol, atol, step, bool(certify), int(max_steps), bool(dense),
                         str(formulation), [_event(item) for item in events], progress, factors())
    return Motion(scene, answer, options)


def methods() -> list[dict[str, Any]]:
    """Return every method, a dict each.

    name; order, and driven_order where a torque acts; dense_order, between the steps; adaptive (by rtol and atol, else
    by `step=`); implicit; cheap (a game engine's step); keeps, of a free body; needs, of a scene; doc and source.
    """
    return list(_core.method_records())


def generalised_forces(torque: npt.ArrayLike, angles: npt.ArrayLike) -> Floats:
    """Return Q_phi, Q_theta, Q_psi of a torque, for the textbook's z-x-z angles.

    Parameters
    ----------
    torque : array_like, shape (3,)
        In body axes [N m].
    angles : array_like, shape (3,)
        phi, theta, psi [rad].

    Returns
    -------
    ndarray, shape (3,)
        Q_psi is the torque's component along body z, Q_phi that along space z, Q_theta that along the line of nodes.
    """
    return _core.generalised_forces(torque, angles)
