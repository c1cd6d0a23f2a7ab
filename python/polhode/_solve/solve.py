"""Solve a scene by the simplest model and the cheapest method that reach the accuracy."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.arrays import is_whole, require_bool, require_text, to_items
from .._keywords import checked
from .._scene.scene import Scene
from .._scene.wanted import At, Om
from .._sensitivity.driven import differentiate
from .costs import factors
from .motion import Floats, Motion
from .plan import Plan
from .progress import shown


class Event:
    """A function of time and state whose zeros are located.

    Parameters
    ----------
    function : callable
        ``function(t, omega, attitude) -> float``. Of a scene whose formulas have states it may take a fourth
        argument, a dict of them by name.
    direction : {-1, 0, 1}
        1: zeros where it rises along the integration, -1: where it falls, 0: both.
    terminal : bool
        The run ends at its first zero.
    """

    __slots__ = ("direction", "function", "terminal")

    def __init__(self, function: Callable[..., float], direction: int = 0, terminal: bool = False) -> None:
        if not callable(function):
            raise _core.InvalidInput(f"Event.function: must be callable, got {type(function).__name__}")
        if not (is_whole(direction) or isinstance(direction, float)) or direction not in (-1, 0, 1):
            raise _core.InvalidInput(f"Event.direction: must be -1, 0 or 1, got {direction!r}")
        self.function, self.direction = function, int(direction)
        self.terminal = require_bool(terminal, "Event.terminal")


def _event(item: Any) -> Event:
    if isinstance(item, Event):
        return item
    return Event(item, getattr(item, "direction", 0), bool(getattr(item, "terminal", False)))


def _takes_states(function: Callable[..., float]) -> bool:
    try:
        inspect.signature(function).bind(0, 0, 0, 0)
    except TypeError:
        return False
    except ValueError:   # a builtin without a signature
        return False
    return True


def _with_states(event: Event, scene: Scene) -> Event:
    """Return an event whose function takes the numbers of all states, as the core gives them."""
    function, takes = event.function, _takes_states(event.function)
    shapes = {name: np.shape(start) for name, start in scene.states.items()}

    def call(t: float, omega: Any, attitude: Any, numbers: list[float]) -> float:
        if not takes:
            return function(t, omega, attitude)
        states, begin = {}, 0
        for name, shape in shapes.items():
            end = begin + math.prod(shape)
            states[name], begin = np.array(numbers[begin:end]) if shape else numbers[begin], end
        return function(t, omega, attitude, states)

    return Event(call, event.direction, event.terminal)


def _check_plan(plan: Plan, scene: Scene, given: dict[str, Any], certify: bool | Literal["proof"],
                formulation: str) -> None:
    """Refuse options that contradict a plan."""
    if not isinstance(plan, Plan):
        raise _core.InvalidInput(f"plan: must be what polhode.plan() made, got {type(plan).__name__}")
    for name in ("accuracy", "rtol", "atol", "step"):
        if given[name] is not None:
            raise _core.InvalidInput(f"{name}: must be left out with plan=, which has its own, got {given[name]!r}")
    if math.isnan(plan.accuracy):
        raise _core.InvalidInput("plan: must be made for an accuracy, got one for tolerances")
    asked = plan.wishes.get("formulation", "euler")
    if formulation not in ("euler", asked):
        raise _core.InvalidInput(f"formulation: must be left out with plan=, which has {asked!r}, got "
                                 f"{formulation!r}")
    if certify == "proof" and plan.certify != "proof":
        raise _core.InvalidInput("certify: must be left out with a plan made without certify='proof', got 'proof'")
    if plan.certify == "proof" and not certify:
        raise _core.InvalidInput("certify: must be left out with a plan made with certify='proof', got False")
    if scene is not plan.scene and scene != plan.scene:
        raise _core.InvalidInput("plan: must be made for this scene, got that of another")


DEFAULT_STEPS = 10_000_000, 1_000_000   # of a run, and of a proof


def to_body(body: Any) -> int:
    """Return the number of a body."""
    if not is_whole(body) or not 0 <= body < 2**62:
        raise _core.InvalidInput(f"body: must be a whole number from 0 to 2^62 - 1, got {body!r}")
    return int(body)


def check_max_steps(max_steps: int) -> int:
    """Return the number as an int that the core can take."""
    if not is_whole(max_steps) or not -(2**63) <= max_steps < 2**63:
        raise _core.InvalidInput(f"max_steps: must be a whole number below 2^63, got {max_steps!r}")
    return int(max_steps)


@checked
def solve(
    scene: Scene[Om, At],
    accuracy: float | None = None,
    *,
    plan: Plan | None = None,
    method: str | None = None,
    certify: bool | Literal["proof"] = True,
    rtol: float | None = None,
    atol: float | None = None,
    step: float | None = None,
    max_steps: int | None = None,
    dense: bool = False,
    formulation: str = "euler",
    leave_out: bool = True,
    events: Iterable[Event | Callable[..., float]] | Event | Callable[..., float] = (),
    progress: Callable[[float, float], object] | bool | None = None,
    sensitivity: str | Sequence[str] | None = None,
    side: str = "space",
    body: int = 0,
) -> Motion[Om, At]:
    """Compute the rotational motion of a scene at its sample times.

    Parameters
    ----------
    scene : Scene
    accuracy : float, optional
        The largest error of any sample, 0 < accuracy <= 1. The error of a sample is the larger of two: the error of
        omega relative to the largest rate of the start and the samples (`motion.omega_scale`), and the angle of the
        attitude's error [rad]. The default is 1e-9 if no tolerance is given. `motion.error` bounds the error, and
        `motion.success` compares it with the accuracy. Excludes rtol and atol.
    plan : Plan, optional
        A result of `plan()`. It sets accuracy, method and certificate. An additional `method` replaces its method.
    method : str, optional
        "taylor", "dop853", "rk45", "radau", or with `step` "symplectic", "midpoint", "rk4"; "exact" for a closed form.
        The planner chooses if it is left out. `methods()` has the records, and the steps for comparison.
    certify : bool or "proof"
        Bound the error of an integrated motion. The run itself propagates its error, or a second, coarser run measures
        it. With False one run aims at a tenth of the accuracy. `motion.error` is then the median error of such scenes,
        which no answer is promised to keep, and `motion.error_kind` is "expected". With "proof" the bounds are
        theorems: the exact motion lies between `motion.omega_lower` and `motion.omega_upper`, and `motion.error_kind`
        is "proved". A proof costs tens of runs. It refuses Custom torques, events and dense output.
    rtol : float, optional
        Relative tolerance of a step, instead of an accuracy. Rates are measured relative to their size, the quaternion
        relative to 1. The error of the samples is then not estimated.
    atol : float, optional
        Absolute tolerance of a step, added to the relative one, in rad/s and in quaternion components.
    step : float, optional
        The step of a fixed-step method [s]. These methods require it, and refuse accuracy, rtol and atol.
    max_steps : int, optional
        Stop after this number of steps. `motion.status` is then "max_steps". The default is 10 million, and one million
        of a proof, whose step costs about a hundred others.
    dense : bool
        Keep dense output, for ``motion(t)``.
    formulation : {"euler", "lagrangian"}
        Euler's equations with a quaternion, or Lagrange's in the textbook's z-x-z angles. The latter fail at theta = 0
        and pi.
    leave_out : bool
        Leave out torques whose effect on every sample is proved to be within a third of the accuracy, all together.
        The closed form of the free body then answers, and `motion.error` includes the bound: see `effect`. Events and
        `motion.sensitivity` differ: events see the motion without these torques, derivatives include them.
    events : iterable of Event or callables
        Functions whose zeros are located. A callable may have attributes `direction` and `terminal`. The errors of
        their times are not bounded.
    progress : callable or bool, optional
        ``progress(reached, last)`` is called about twenty times a second. If it returns False, the run ends, and the
        samples so far are returned. True shows a bar on stderr, or lines, of a run that takes more than a second.
    sensitivity : str or sequence of str, optional
        What to differentiate the motion by, for `motion.sensitivity`: "omega" and "attitude" (the start), "inertia"
        (principal moments), "axes" (a small rotation of the principal axes in the body), numbers of torques and rotors
        such as "torques.0.weight", "torques.1.matrix", "torques.0.windows" (the ends of windows), "rotors.0.momentum",
        or "gravity.weight" where only one is there, and "controllers.0.kp" (a parameter or the start of a state). Its
        error is relative to the size of each column. It is not measured with certify=False.
    side : {"space", "body"}
        The axes of small rotations in `motion.sensitivity`.
    body : int
        The number of a body among many, which decides what its controllers draw: see `solve_many` and `ensemble`.

    Returns
    -------
    Motion

    Raises
    ------
    InvalidInput
        For options that contradict each other or have no effect. Exceptions of a torque or an event pass through.
    """
    if not isinstance(scene, Scene):
        raise _core.InvalidInput(f"scene: must be a polhode.Scene, got {type(scene).__name__}")
    if callable(events) or isinstance(events, Event):
        events = (events,)
    found = [_event(item) for item in to_items(events, "events", "events or callables")]
    require_text(method, "method")
    require_text(certify, "certify")
    require_text(formulation, "formulation")
    if not isinstance(certify, str):
        certify = require_bool(certify, "certify")
    leave_out = require_bool(leave_out, "leave_out")
    body = to_body(body)
    given: dict[str, Any] = {"accuracy": accuracy, "method": method, "rtol": rtol, "atol": atol, "step": step}
    planned = None
    if plan is not None:
        _check_plan(plan, scene, given, certify, formulation)
        accuracy, formulation = plan.accuracy, plan.wishes.get("formulation", "euler")
        if leave_out != plan.wishes.get("leave_out", True):
            if not leave_out:
                raise _core.InvalidInput("leave_out: must be True with plan=, which may leave torques out, got False")
            leave_out = False
        if method is None and bool(certify) == bool(plan.certify):
            planned = plan._planned
        if method is None:   # pieces have a method each, and a proof has none
            method = plan.wishes.get("method") if plan.pieces or plan.certify == "proof" else plan.method
        certify = plan.certify if certify else False
        given |= {"accuracy": accuracy, "method": method}
    most_steps = check_max_steps(DEFAULT_STEPS[certify == "proof"] if max_steps is None else max_steps)
    with shown(progress, f"solving {scene.name}".strip()) as callback:
        answer = _core.solve(scene, {
            **given, "certify": certify, "max_steps": most_steps, "dense": require_bool(dense, "dense"),
            "formulation": str(formulation), "leave_out": leave_out,
            "events": [_with_states(event, scene) for event in found] if scene.states else found,
            "progress": callback, "cost_factors": factors(), "body": body}, planned)
    asked: dict[str, Any] | None
    plain = method is None and formulation == "euler" and leave_out
    asked = None if plain else {"method": method, "formulation": formulation}
    if not leave_out and asked is not None:
        asked["leave_out"] = False
    options = {name: value for name, value in given.items() if value is not None}
    options |= {"certify": certify} if certify is not True else {}
    options |= {"max_steps": max_steps} if max_steps is not None else {}
    options |= {"formulation": formulation} if formulation != "euler" else {}
    options |= {} if leave_out else {"leave_out": False}
    options |= {"body": body} if body else {}
    motion = Motion(scene, answer, asked, options)
    if sensitivity is not None:
        for name, value in (("events", found or None), ("rtol", rtol), ("atol", atol), ("step", step)):
            if value is not None:
                raise _core.InvalidInput(f"{name}: must be left out with sensitivity=, which has an accuracy and all "
                                         f"times, got {value!r}")
        motion.sensitivity = differentiate(scene, sensitivity, 1e-9 if accuracy is None else accuracy, side, most_steps,
                                           bool(certify), body)
    return motion


def methods() -> list[dict[str, Any]]:
    """Return the records of all methods, one dict for each.

    Keys: "name"; "order", and "driven_order" with a torque; "dense_order" between the steps; "adaptive" (with rtol and
    atol, otherwise with `step=`); "implicit"; "comparison" (a step of game engines, which charts run); "keeps"
    (invariants of a free body that it conserves); "needs" (of a scene); "doc"; "source".
    """
    return list(_core.method_records())


def generalised_forces(torque: npt.ArrayLike, angles: npt.ArrayLike) -> Floats:
    """Return the generalised forces Q_phi, Q_theta, Q_psi of a torque in the textbook's z-x-z angles.

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
