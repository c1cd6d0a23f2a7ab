"""Formulas that scene files have a kind for: they keep what they were made of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from .._core import InvalidInput
from .._core.torques import Formula

_makers: dict[str, Callable[..., Any]] = {}
_classes: dict[str, type[Named]] = {}


class Named(Formula):
    """A formula made by `Dipole`, `Drag` or `SolarPressure`, with the arguments of that call."""

    _kind: str
    _given: dict[str, Any]

    def with_parameters(self, **parameters: Any) -> Formula:
        super().with_parameters(**parameters)   # which checks them
        return restore(self._kind, self._given | parameters)

    def __reduce__(self) -> tuple[Any, ...]:
        return restore, (self._kind, self._given)


def make_named(kind: str, formula: Formula, given: dict[str, Any]) -> Named:
    """Return the formula as one of a kind of scene files."""
    named = _classes[kind].__new__(_classes[kind])
    named.__setstate__(formula.__getstate__())
    named._kind, named._given = kind, given
    return named


def register(kind: str, make: Callable[..., Any]) -> None:
    """Name the function that makes the formulas of a kind, and give them a class of its name."""
    _makers[kind] = make
    _classes[kind] = type(make.__name__, (Named,), {"__module__": "polhode.torques"})


def restore(kind: str, given: dict[str, Any]) -> Formula:
    """Return the formula of a kind and its arguments."""
    if kind not in _makers or not isinstance(given, dict):
        raise InvalidInput("Formula: must be restored from its own state")
    made: Formula = _makers[kind](**given)
    return made
