"""A Python function becomes a formula."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np

from .._core import InvalidInput
from .._core import symbols as _core
from .symbols import Symbol, joined, numbers_of

_PROBES, _ACCURACY = 8, 1e-12
_NEAR = 8   # calls some units of rounding beside a look


class Values:
    """Named parameters or states, as attributes."""

    def __init__(self, letter: str, values: dict[str, Any]) -> None:
        self.__dict__.update(values)
        self.__dict__["__letter"] = letter

    def __getattr__(self, name: str) -> Any:
        letter = self.__dict__["__letter"]
        known = ", ".join(sorted(name for name in self.__dict__ if name != "__letter")) or "none"
        kind = "parameters" if letter == "p" else "states"
        raise InvalidInput(f"Formula.function: must use {kind} that are given, got {letter}.{name}; known: {known}")


class Signature:
    """How a user's function is called: a torque with or without states, or a potential."""

    def __init__(self, function: Callable[..., Any], states: dict[str, Any], is_potential: bool) -> None:
        self.function, self.states, self.is_potential = function, states, is_potential
        self.where = "Formula.potential" if is_potential else "Formula.function"
        names = "t, attitude, p" if is_potential else "t, omega, attitude, p, s" if states else "t, omega, attitude, p"
        try:
            inspect.signature(function).bind(*names.split(", "))
        except (TypeError, ValueError):
            own = "potential" if is_potential else "function"
            raise InvalidInput(f"{self.where}: must be callable as {own}({names}), got "
                               f"{getattr(function, '__name__', type(function).__name__)}") from None

    def call(self, t: Any, omega: Any, attitude: Any, p: Values, s: Values) -> list[Any]:
        """Return the numbers of the torque, then of the rates in the order of the states; or the potential."""
        if self.is_potential:
            return self._numbers(self.function(t, attitude, p), (), "a potential")
        result = self.function(t, omega, attitude, p, s) if self.states else self.function(t, omega, attitude, p)
        rates: dict[str, Any] = {}
        if self.states:
            if not (isinstance(result, tuple) and len(result) == 2 and isinstance(result[1], dict)):
                raise InvalidInput(f"{self.where}: must return (torque, rates of the states), got "
                                   f"{type(result).__name__}")
            result, rates = result
            if rates.keys() != self.states.keys():
                raise InvalidInput(f"{self.where}: must return the rate of each state ({', '.join(self.states)}), got "
                                   f"{', '.join(map(str, rates)) or 'none'}")
        numbers = self._numbers(result, (3,), "a torque")
        for name in sorted(self.states):
            numbers += self._numbers(rates[name], np.shape(self.states[name]), f"the rate of {name}")
        return numbers

    def _numbers(self, result: Any, shape: tuple[int, ...], what: str) -> list[Any]:
        try:
            found = result.shape if isinstance(result, Symbol) else np.shape(result)
        except ValueError:
            found = None
        if isinstance(result, (dict, str)) or found != shape:
            raise InvalidInput(f"{self.where}: must return {what} of shape {shape}, got {type(result).__name__} of "
                               f"shape {found}")
        return list(np.ravel(numbers_of(result)))


def _named(values: dict[str, Any]) -> dict[str, Any]:
    return {name: joined(v) if isinstance(v, list) else Symbol(v) for name, v in values.items()}


def _call(signature: Signature, parameters: dict[str, Any]) -> Any:
    tracer = _core.Tracer(parameters, signature.states)
    p, s = Values("p", _named(tracer.parameters())), Values("s", _named(tracer.states()))
    return tracer.finish(signature.call(Symbol(tracer.time()), joined(tracer.omega()), joined(tracer.attitude()), p, s))


def trace(function: Callable[..., Any], parameters: dict[str, Any], states: dict[str, Any], is_potential: bool) -> Any:
    """Return the formula of a function, as the core holds texts.

    Raises
    ------
    InvalidInput
        For a function that cannot be traced, and for one whose two traces differ.
    """
    signature = Signature(function, states, is_potential)
    first, second = _call(signature, parameters), _call(signature, parameters)
    if first != second:
        raise InvalidInput(f"{signature.where}: must give the same formula each time, got two that differ; random "
                           "numbers and hidden states cannot be traced: draw before, or use polhode.torques.Custom")
    return first


def trace_motor(function: Callable[..., Any], parameters: dict[str, Any]) -> Any:
    """Return the formula of a motor's function as the torque (u, 0, 0) with the state speed.

    Raises
    ------
    InvalidInput
        For a function that cannot be traced, and for one that does not return a number.
    """
    try:
        inspect.signature(function).bind("t", "omega", "attitude", "p", "s")
    except (TypeError, ValueError):
        raise InvalidInput("Rotor.torque: must be callable as torque(t, omega, attitude, p, s), got "
                           f"{getattr(function, '__name__', type(function).__name__)}") from None

    def torque(t: Any, omega: Any, attitude: Any, p: Values, s: Values) -> tuple[Any, dict[str, Any]]:
        own = function(t, omega, attitude, p, s)
        shape = own.shape if isinstance(own, Symbol) else np.shape(own)
        if shape != ():
            raise InvalidInput(f"Rotor.torque: must return a number, got shape {shape}")
        return np.array([own, 0.0, 0.0], object), {"speed": 0.0}

    return trace(torque, parameters, {"speed": 0.0}, False)


def compare(function: Callable[..., Any], parameters: dict[str, Any], states: dict[str, Any], is_potential: bool,
            formula: Any) -> None:
    """Compare a function with its formula at eight random states.

    Raises
    ------
    InvalidInput
        For numbers that are not those of the formula.
    """
    signature = Signature(function, states, is_potential)
    arrays = {name: np.array(value) if isinstance(value, tuple) else value for name, value in parameters.items()}
    p = Values("p", arrays)
    rng = np.random.default_rng(2026)

    def both(t: Any, omega: Any, attitude: Any, at: dict[str, Any], s: Values) -> tuple[Any, Any]:
        """The numbers of the function, and those of its formula."""
        with np.errstate(all="ignore"):
            own = np.array(signature.call(t, omega.copy(), attitude.copy(), p, s), omega.dtype).astype(float)
        if is_potential:
            return own, np.array([formula.energy(t, attitude)])
        rates = formula.rates(t, omega, attitude, at)
        value = formula.value(t, omega, attitude, states=at if states else None)
        return own, np.concatenate([value, *(np.ravel(rates[name]) for name in sorted(states))])

    for _ in range(_PROBES):
        t, omega, attitude = float(rng.uniform(0, 10)), rng.normal(size=3), rng.normal(size=4)
        attitude /= np.linalg.norm(attitude)
        at = {name: np.asarray(start) + rng.normal(size=np.shape(start)) for name, start in states.items()}
        s = Values("s", {name: float(value) if value.ndim == 0 else value.copy() for name, value in at.items()})
        own, traced = both(t, omega, attitude, at, s)
        size = max(float(np.abs(own).max()), float(np.abs(traced).max()))
        wrong = ~((np.abs(own - traced) <= _ACCURACY * size) | (np.isnan(own) & np.isnan(traced)) | (own == traced))
        if wrong.any():   # or what remains is the rounding of terms that cancel
            near = [both(t * by[0], omega * by[1:4], attitude * by[4:], at, s)
                    for by in 1 + np.finfo(float).eps * rng.integers(-4, 5, (_NEAR, 8))]
            wide = np.longdouble
            near.append(both(t, omega.astype(wide), attitude.astype(wide), at, s))
            wrong &= ~(np.abs(own - traced) <= 64 * np.ptp([(own, traced), *near], axis=0).max())
        if wrong.any():
            i = int(np.argmax(wrong))
            raise InvalidInput(
                f"{signature.where}: must have the numbers of its formula, got {own[i]:.17g} and {traced[i]:.17g} "
                f"in component {i} at t = {t:.17g}, omega = {omega.tolist()}, attitude = {attitude.tolist()}; the "
                "function depends on more than its arguments, or loses digits")
