"""Controllers in scene files: tables `[[controllers]]`."""

from __future__ import annotations

import dataclasses
from functools import cache
from typing import Any, Literal, Union

from .._clock.controller import Controller, Measure
from .._core import InvalidInput
from .._orbit.field import MagneticField
from .._orbit.orbit import Orbit
from .orbits import Names
from .validation import kinds, model

KEYS = ("period", "output", "command", "update", "let", "states", "parameters", "delay", "width", "start", "limit",
        "initial", "rotors", "measure")


@cache
def controller_model() -> Any:
    """Return the pydantic model of one controller."""
    kind = kinds()
    values: Any = Union[kind.number, kind.numbers]   # noqa: UP007
    rows: Any = list[kind.numbers] | None   # type: ignore[name-defined]
    numbers: Any = {name: (kind.number | None, None) for name in ("strength", "tilt", "spin", "phase", "radius")}
    field: Any = model("Field", kind=(Literal["dipole", "gauss"], ...), orbit=(str, ...), g=(rows, None),
                       h=(rows, None), **numbers)
    measure: Any = model("Measure", omega_noise=(kind.number, 0.0), attitude_noise=(kind.number, 0.0),
                         field_noise=(kind.number, 0.0), omega_quantum=(kind.number, 0.0), seed=(int, 0))
    return model("Controller", period=(kind.number, ...), output=(str, "torque"), command=(str, ...),
                 update=(dict[str, str], {}), let=(dict[str, str], {}), states=(dict[str, values], {}),
                 parameters=(dict[str, values], {}), delay=(kind.number, 0.0), width=(kind.number | None, None),
                 start=(kind.number, 0.0), limit=(values | None, None), initial=(values | None, None),
                 rotors=(int | None, None), field=(field | None, None), measure=(measure | None, None))


def make_controllers(entries: list[Any], orbits: dict[str, Orbit]) -> list[Controller]:
    """Return the controllers of a scene file.

    Raises
    ------
    InvalidInput
        With the number of the controller.
    """
    made = []
    for i, entry in enumerate(entries):
        given = {name: value for name, value in entry.model_dump().items() if value is not None}
        try:
            if "field" in given:
                given["field"] = _make_field(given["field"], orbits)
            if "measure" in given:
                given["measure"] = Measure(**given["measure"])
            made.append(Controller(**given))
        except InvalidInput as error:
            raise InvalidInput(f"controllers[{i}]: {error}") from None
    return made


def _make_field(entry: dict[str, Any], orbits: dict[str, Orbit]) -> MagneticField:
    given = {name: value for name, value in entry.items() if value is not None and name != "kind"}
    if given["orbit"] not in orbits:
        raise InvalidInput(f"field.orbit: must be an orbit of the file ({', '.join(orbits) or 'none'}), got "
                           f"{given['orbit']!r}")
    given["orbit"] = orbits[given["orbit"]]
    make = MagneticField.dipole if entry["kind"] == "dipole" else MagneticField.gauss
    try:
        return make(**given)
    except TypeError:
        raise InvalidInput(f"field: must have the keys of MagneticField.{entry['kind']}, got "
                           f"{', '.join(given)}") from None


def to_entry(controller: Controller, i: int, orbits: Names) -> dict[str, Any]:
    """Return the keys of a controller's table.

    Raises
    ------
    InvalidInput
        For a controller whose law is a Python function that was not traced.
    """
    if controller.function is not None:
        raise InvalidInput(f"controllers[{i}]: must be one that a file can hold, got trace=False; a traced law can "
                           "stand in a file")
    entry: dict[str, Any] = {}
    for name in KEYS:
        value = getattr(controller, name)
        if value is None or (isinstance(value, dict) and not value):
            continue
        if name == "measure":
            value = {key: number for key, number in dataclasses.asdict(value).items()
                     if key != "seed"} | {"seed": Whole(value.seed)}
        entry[name] = Whole(value) if name == "rotors" else value
    field = controller.field
    if field is not None:
        entry["field"] = {"kind": field._kind, **field._given, "orbit": orbits.find(field.orbit)}
    return entry


class Whole:
    """A whole number of a file."""

    def __init__(self, value: int) -> None:
        self.value = value

    def __str__(self) -> str:
        return str(self.value)
