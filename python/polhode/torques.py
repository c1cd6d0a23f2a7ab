"""Torques on a body. Each class is made from a record of the list of torques of the core."""

from __future__ import annotations

from typing import Any

from . import _core
from ._core.torques import *  # noqa: F403  the list is the compiled one
from ._orbit.field import Dipole
from ._orbit.plates import Drag, SolarPressure

_names = [record["name"] for record in _core.torque_records()]
__all__ = [*_names, "During", "Dipole", "Drag", "SolarPressure", "records"]  # noqa: F405

for _name in __all__[:-1]:
    globals()[_name].__module__ = "polhode.torques"


def _make_gradient(cls: Any, *args: Any, **numbers: Any) -> Any:
    """GravityGradient of an orbit is a class of its own."""
    if "orbit" not in numbers:
        return _new_gradient(cls)
    if args or len(numbers) > 1:
        raise _core.InvalidInput("GravityGradient: must be given mean_motion and phase, or orbit alone, got both")
    return _core.torques.OrbitGradient(**numbers)


_new_gradient: Any = _core.torques.GravityGradient.__new__
setattr(_core.torques.GravityGradient, "__new__", staticmethod(_make_gradient))  # noqa: B010


def records() -> list[dict[str, Any]]:
    """Return the records of all torques: name, scene-file key, doc, source and parameters."""
    return list(_core.torque_records())
