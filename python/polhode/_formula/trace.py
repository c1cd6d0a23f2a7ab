"""A Python function becomes a formula."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np

from .._core import InvalidInput
from .._core import symbols as _core
from .symbols import Symbol, joined, numbers_of

_STATES, _ACCURACY = 8, 1e-12


class Values:
    """The named parameters, as attributes."""

    def __init__(self, values: dict[str, Any]) -> None:
        self.__dict__.update(values)

    def __getattr__(self, name: str) -> Any:
        known = ", ".join(sorted(self.__dict__)) or "none"
        raise InvalidInput(f"Formula.function: must use parameters that are given, got p.{name}; known: {known}")


def _require_vector(result: Any) -> Any:
    try:
        shape = np.shape(result) if not isinstance(result, Symbol) else result.shape
    except ValueError:
        shape = ()
    if isinstance(result, (dict, str)) or shape != (3,):
        raise InvalidInput(f"Formula.function: must return a torque of shape (3,), got {type(result).__name__} of "
                           f"shape {shape}; states of a formula are not supported yet")
    return result


def _call(function: Callable[..., Any], parameters: dict[str, Any]) -> Any:
    tracer = _core.Tracer(parameters)
    named = {name: joined(v) if isinstance(v, list) else Symbol(v) for name, v in tracer.parameters().items()}
    result = function(Symbol(tracer.time()), joined(tracer.omega()), joined(tracer.attitude()), Values(named))
    return tracer.finish(list(numbers_of(_require_vector(result))))


def _require_signature(function: Callable[..., Any]) -> None:
    try:
        inspect.signature(function).bind(0, 0, 0, 0)
    except (TypeError, ValueError):
        raise InvalidInput("Formula.function: must be callable as function(t, omega, attitude, p), got "
                           f"{getattr(function, '__name__', type(function).__name__)}") from None


def trace(function: Callable[..., Any], parameters: dict[str, Any]) -> Any:
    """Return the formula of a function, as the core holds texts.

    Raises
    ------
    InvalidInput
        For a function that cannot be traced, and for one whose two traces differ.
    """
    _require_signature(function)
    first, second = _call(function, parameters), _call(function, parameters)
    if first != second:
        raise InvalidInput("Formula.function: must give the same formula each time, got two that differ; random "
                           "numbers and hidden states cannot be traced: draw before, or use polhode.torques.Custom")
    return first


def compare(function: Callable[..., Any], parameters: dict[str, Any], formula: Any) -> None:
    """Compare a function with its formula at eight random states.

    Raises
    ------
    InvalidInput
        For numbers that are not those of the formula.
    """
    arrays = {name: np.array(value) if isinstance(value, tuple) else value for name, value in parameters.items()}
    values = Values(arrays)
    rng = np.random.default_rng(2026)
    for _ in range(_STATES):
        t, omega, attitude = float(rng.uniform(0, 10)), rng.normal(size=3), rng.normal(size=4)
        attitude /= np.linalg.norm(attitude)
        with np.errstate(all="ignore"):
            own = np.array(_require_vector(function(t, omega.copy(), attitude.copy(), values)), float)
        traced = formula.value(t, omega, attitude)
        size = max(float(np.abs(own).max()), float(np.abs(traced).max()))
        wrong = ~((np.abs(own - traced) <= _ACCURACY * size) | (np.isnan(own) & np.isnan(traced)) | (own == traced))
        if wrong.any():
            i = int(np.argmax(wrong))
            raise InvalidInput(
                f"Formula.function: must have the numbers of its formula, got {own[i]:.17g} and {traced[i]:.17g} "
                f"N m in component {i} at t = {t:.17g}, omega = {omega.tolist()}, attitude = {attitude.tolist()}; the "
                "function depends on more than its arguments, or loses digits")
