"""Controllers: programs that sample a motion at their ticks, compute a command and hold it."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.arrays import is_whole, require_bool, to_any, to_number
from .._core import InvalidInput
from .._keywords import checked
from .._orbit.field import MagneticField
from .law import Law

ROTORS = ("rotor_torque", "rotor_momentum")


@dataclasses.dataclass(frozen=True)
class Measure:
    """Errors of what a controller measures.

    A draw depends on the seed, the quantity, the number of the controller and the tick alone. Noise comes first, then
    the quantum.

    Parameters
    ----------
    omega_noise : float
        Standard deviation of each component of omega [rad/s].
    attitude_noise : float
        Of each component of a small rotation on the side of the body [rad].
    field_noise : float
        Of each component of the field [T].
    omega_quantum : float
        Each component of omega is rounded to a multiple of it, halves to even [rad/s].
    seed : int
        From 0 to 2^64 - 1.
    """

    omega_noise: float = 0.0
    attitude_noise: float = 0.0
    field_noise: float = 0.0
    omega_quantum: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        for name in ("omega_noise", "attitude_noise", "field_noise", "omega_quantum"):
            value = to_number(getattr(self, name), f"Measure.{name}")
            if not (value >= 0 and np.isfinite(value)):
                raise InvalidInput(f"Measure.{name}: must be 0 or positive, and finite, got {value!r}")
            object.__setattr__(self, name, value)
        if not is_whole(self.seed) or not 0 <= self.seed < 2**64:
            raise InvalidInput(f"Measure.seed: must be a whole number from 0 to 2^64 - 1, got {self.seed!r}")
        object.__setattr__(self, "seed", int(self.seed))


def _named(values: Any, where: str) -> dict[str, Any]:
    if values is None:
        return {}
    if not isinstance(values, Mapping):
        raise InvalidInput(f"{where}: must be a dict of names and numbers, got {type(values).__name__}")
    found: dict[str, Any] = {}
    for name, value in values.items():
        array = to_any(value, f"{where}.{name}").astype(float)
        if array.ndim > 1 or (array.ndim == 1 and array.size < 2):
            raise InvalidInput(f"{where}.{name}: must be a number, or a list of two numbers or more, got shape "
                               f"{array.shape}")
        found[str(name)] = float(array) if array.ndim == 0 else tuple(array.tolist())
    return dict(sorted(found.items()))


def _texts(values: Any, where: str) -> dict[str, str]:
    if values is None:
        return {}
    if not isinstance(values, Mapping) or not all(isinstance(text, str) for pair in values.items() for text in pair):
        raise InvalidInput(f"{where}: must be a dict of names and texts, got {type(values).__name__}")
    return dict(values)


def _numbers(value: Any, where: str) -> tuple[float, ...]:
    array = to_any(value, where).astype(float)
    if array.ndim > 1:
        raise InvalidInput(f"{where}: must be a number, or a list of numbers, got shape {array.shape}")
    return tuple(array.ravel().tolist())


def _make_law(function: Callable[..., Any], given: dict[str, Any]) -> Law:
    measured = {} if given["field"] is None else {"field": 3}
    measured |= {"speed": given["rotors"]} if given["rotors"] else {}
    return Law(function, len(given["initial"]), given["states"], given["parameters"], measured)


class Controller(_core.Controller):
    """A program that samples the motion at times start + k period, computes a command and holds it.

    Tick k measures the state just before its time. Its command acts from ``delay`` after the tick until the next
    command acts. Between ticks nothing changes it.

    Parameters
    ----------
    period : float
        Time between ticks [s].
    function : callable, optional
        ``function(t, m, s, p)`` returns the command, or the command and a dict of the states that change. ``m.omega``
        and ``m.attitude`` are what is measured, in body axes and as a unit quaternion with w >= 0; ``m.field`` is the
        field in body axes [T] where ``field`` is given, ``m.speed`` the speeds of the rotors [rad/s] where ``rotors``
        is. ``s.name`` is a state and ``p.name`` a parameter. It is called once, on symbols, as that of a
        `polhode.torques.Formula`: branches are written with np.where.
    output : {"torque", "dipole", "rotor_torque", "rotor_momentum"}
        What is commanded. "torque": on the body, shape (3,), body axes [N m]. "dipole": a magnetic moment in ``field``,
        shape (3,), body axes [A m^2]. "rotor_torque": of the motors of all rotors of the scene, which are free, one
        number each [N m]; it is added to their own torque, and their max_torque cuts the sum. "rotor_momentum": of all
        rotors, which are held, one number each [kg m^2/s]; omega jumps, and the momentum of all stays.
    states : dict, optional
        The memory of the controller: starts by name, numbers or shape (n,).
    parameters : dict, optional
        Named numbers of the law.
    delay : float
        From a tick to the beginning of its command [s]. It may exceed the period.
    width : float, optional
        For how long a command acts, at most the period; without it, until the next command acts [s].
    start : float
        Time of tick 0 [s]. There are no ticks before the scene's t0.
    limit : float or array_like, optional
        Each component of the command is cut to plus and minus this.
    field : MagneticField, optional
        The field that a dipole acts in, and that is measured.
    measure : Measure, optional
        Noise and quanta of the measurement.
    trace : bool
        False: the function is no formula, and Python is called at each tick. The error is then estimated, not bounded.
    command : str, optional
        The law as text, in place of a function, as that of a `polhode.torques.Formula`. Its names are t, omega,
        attitude, field, speed, the states and the parameters.
    update : dict of str, optional
        New numbers of the states, beside ``command``.
    let : dict of str, optional
        Names for shared parts of these texts, in order.
    initial : array_like, optional
        The command before the first tick; 0 if left out.
    rotors : int, optional
        The number of the scene's rotors, whose speeds are measured. By default 3 for the outputs of rotors, else 0.

    Raises
    ------
    InvalidInput
        For numbers out of range, a function that cannot be traced, and a command of another shape.
    """

    __slots__ = ("_given",)
    _given: dict[str, Any]

    @checked
    def __init__(
        self,
        period: float,
        function: Callable[..., Any] | None = None,
        *,
        output: str = "torque",
        states: Mapping[str, Any] | None = None,
        parameters: Mapping[str, Any] | None = None,
        delay: float = 0.0,
        width: float | None = None,
        start: float = 0.0,
        limit: npt.ArrayLike | None = None,
        field: MagneticField | None = None,
        measure: Measure | None = None,
        trace: bool = True,
        command: str | None = None,
        update: Mapping[str, str] | None = None,
        let: Mapping[str, str] | None = None,
        initial: npt.ArrayLike | None = None,
        rotors: int | None = None,
    ) -> None:
        if (function is None) == (command is None):
            raise InvalidInput("Controller: must be given a function or command=, one of them, got "
                               + ("none" if function is None else "both"))
        if field is not None and not isinstance(field, MagneticField):
            raise InvalidInput(f"Controller.field: must be a MagneticField, got {type(field).__name__}")
        if not isinstance(output, str):
            raise InvalidInput(f"Controller.output: must be a text, got {type(output).__name__}")
        measure = Measure() if measure is None else measure
        if not isinstance(measure, Measure):
            raise InvalidInput(f"Controller.measure: must be a Measure, got {type(measure).__name__}")
        trace = require_bool(trace, "Controller.trace")
        if rotors is None:
            rotors = 3 if output in ROTORS else 0
        if not is_whole(rotors) or not 0 <= rotors <= 1000:
            raise InvalidInput(f"Controller.rotors: must be a whole number from 0 to 1000, got {rotors!r}")
        if initial is None:
            initial = np.zeros(int(rotors) if output in ROTORS else 3)
        given: dict[str, Any] = {
            "period": to_number(period, "Controller.period"), "output": output,
            "delay": to_number(delay, "Controller.delay"),
            "width": None if width is None else to_number(width, "Controller.width"),
            "start": to_number(start, "Controller.start"),
            "limit": None if limit is None else _numbers(limit, "Controller.limit"), "field": field,
            "rotors": int(rotors),
            "measure": measure, "initial": _numbers(initial, "Controller.initial"),
            "states": _named(states, "Controller.states"), "parameters": _named(parameters, "Controller.parameters"),
            "function": None, "command": command,
            "update": _texts(update, "Controller.update"), "let": _texts(let, "Controller.let") or None,
        }
        parts = dict(given)
        if function is not None:
            for name, value in (("update", update), ("let", let)):
                if value is not None:
                    raise InvalidInput(f"Controller.{name}: must be left out for a function, got {value!r}")
            law = _make_law(function, given)
            if trace:
                given["command"], given["update"], let_text = law.trace()
                given["let"] = let_text or None
                parts = dict(given)
            else:
                given["function"] = function
                parts["function"] = _Called(law, given["period"], given["start"])
        elif not trace:
            raise InvalidInput("Controller.trace: must be left out for a text, got False")
        super().__init__(parts)
        self._given = given
        if function is not None:
            self._compare(law, traced=trace)

    def _compare(self, law: Law, traced: bool) -> None:
        """Compare a function with its law, or with another call, at a few states."""
        for t, row in law.probes():
            with np.errstate(all="ignore"):
                own = np.array(law.numbers(t, row))
                if traced:
                    every = self._call(t, row)
                    n = law.commands
                    other = np.concatenate([every[:n], every[n + sum(law.measured.values()):]])
                else:
                    other = np.array(law.numbers(t, row))
                size = float(np.abs(own).max(initial=0.0))
                same = np.abs(own - other) <= (1e-9 * size if traced else 0.0)
                same |= (own == other) | (np.isnan(own) & np.isnan(other))
            if not same.all():
                i = int(np.argmin(same))
                raise InvalidInput(f"Controller.function: must give the same numbers each time, got {own[i]:.17g} and "
                                   f"{other[i]:.17g} for one tick; what it keeps between ticks belongs into states=")

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self._given:
            raise AttributeError(f"'Controller' object has no attribute {name!r}")
        return self._given[name]

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._given})

    def replace(self, **changes: Any) -> Controller:
        """Return a controller with some parts changed, by the names of the constructor."""
        parts = _keywords(self._given)
        if "function" in changes or "command" in changes:
            law = ("function", "command", "update", "let", "trace")
            parts = {name: value for name, value in parts.items() if name not in law}
        return Controller(**{**parts, **changes})

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (_keywords(self._given),)

    def __eq__(self, other: object) -> bool:
        return self._given == other._given if isinstance(other, Controller) else NotImplemented

    def __hash__(self) -> int:
        return hash((self._given["period"], self._given["output"], self._given["command"]))

    def __repr__(self) -> str:
        given = self._given
        law = given["command"] or getattr(given["function"], "__name__", "a function")
        return f"polhode.Controller({given['period']!r}, output={given['output']!r}, command={law!r})"


class _Called:
    """A function as the core calls it: with the tick in what it refuses."""

    def __init__(self, law: Law, period: float, start: float) -> None:
        self.law, self.period, self.start = law, period, start

    def __call__(self, t: float, row: Any) -> Any:
        try:
            return np.array(self.law.numbers(t, row))
        except InvalidInput as refusal:
            tick = round((t - self.start) / self.period)
            raise InvalidInput(f"{refusal} at tick {tick}, t = {t!r} s") from None


def _keywords(given: dict[str, Any]) -> dict[str, Any]:
    """Return the keywords that make an equal controller."""
    parts = {name: value for name, value in given.items() if value is not None}
    if "function" in parts:
        parts |= {"trace": False}
        for name in ("command", "update", "let"):
            parts.pop(name, None)
    return parts


def _restore(parts: dict[str, Any]) -> Controller:
    return Controller(**parts)
