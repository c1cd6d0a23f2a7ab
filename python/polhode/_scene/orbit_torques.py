"""Torques on orbits in scene files: the kinds `dipole`, `drag` and `solar_pressure`."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any, Literal

from .. import torques
from .._core import InvalidInput
from .._orbit.named import Named
from .._orbit.orbit import Orbit
from .._orbit.plates import Plate
from .orbits import Names, field_model, make_field, to_field_entry
from .validation import kinds, model

AIR = ("coefficient", "density", "height_radius", "scale_height")
KINDS = ("dipole", "drag", "solar_pressure")

FindOrbit = Callable[[str], Orbit]


def models() -> list[Any]:
    """Return the models of these torques."""
    kind = kinds()
    plate: Any = model("Plate", area=(kind.number, ...), normal=(kind.vector, ...), centre=(kind.vector, ...),
                       specular=(kind.number, 0.0), diffuse=(kind.number, 0.0))
    during: Any = (kind.windows | None, None)
    numbers: Any = {name: (kind.number, ...) for name in AIR}
    return [
        model("Dipole", kind=(Literal["dipole"], ...), moment=(kind.vector, ...), field=(field_model(), ...),
              during=during),
        model("Drag", kind=(Literal["drag"], ...), plates=(list[plate], ...), orbit=(str, ...), spin=(kind.number, 0.0),
              during=during, **numbers),
        model("SolarPressure", kind=(Literal["solar_pressure"], ...), plates=(list[plate], ...), sun=(kind.vector, ...),
              pressure=(kind.number, ...), orbit=(str | None, None), shadow=(kind.number | None, None), during=during),
    ]


def make(kind: str, values: dict[str, Any], orbits: dict[str, Orbit], find: FindOrbit) -> Any:
    """Return the torque of a table without its windows.

    Raises
    ------
    InvalidInput
        For numbers that the torque refuses, and names that are no orbit of the file.
    """
    given = {name: value for name, value in values.items() if value is not None}
    if kind == "dipole":
        return torques.Dipole(given["moment"], make_field(given["field"], orbits))
    given["plates"] = [_make_plate(entry, i, kind) for i, entry in enumerate(given["plates"])]
    if "orbit" in given:
        given["orbit"] = find(given["orbit"])
    return torques.Drag(**given) if kind == "drag" else torques.SolarPressure(**given)


def _make_plate(entry: dict[str, Any], i: int, kind: str) -> Plate:
    try:
        return Plate(**entry)
    except InvalidInput as error:
        raise InvalidInput(f"{kind}: plates[{i}]: {error}") from None


def to_entry(torque: Named, orbits: Names) -> dict[str, Any]:
    """Return the keys of a torque's table."""
    entry: dict[str, Any] = {"kind": torque._kind, **torque._given}
    if "plates" in entry:
        entry["plates"] = [dataclasses.asdict(plate) for plate in entry["plates"]]
    if "orbit" in entry:
        entry["orbit"] = orbits.find(entry["orbit"])
    if "field" in entry:
        entry["field"] = to_field_entry(entry["field"], orbits)
    return entry


def light_entry(sunlight: tuple[Orbit, Any, float], orbits: Names) -> dict[str, Any]:
    """Return the keys of a shadow."""
    orbit, _, shadow = sunlight
    return {"orbit": orbits.find(orbit), "shadow": shadow}
