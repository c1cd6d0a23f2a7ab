"""Controllers in scene files: tables `[[controllers]]`."""

from __future__ import annotations

import dataclasses
from functools import cache
from typing import Any, Union

from .._clock.controller import Controller, Measure
from .._core import InvalidInput
from .._orbit.orbit import Orbit
from .orbits import Names, field_model, make_field, to_field_entry
from .validation import kinds, model

KEYS = ("period", "output", "command", "update", "let", "states", "parameters", "delay", "width", "start", "limit",
        "initial", "rotors", "measure")


@cache
def controller_model() -> Any:
    """Return the pydantic model of one controller."""
    kind = kinds()
    values: Any = Union[kind.number, kind.numbers]   # noqa: UP007
    field: Any = field_model()
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
                given["field"] = make_field(given["field"], orbits)
            if "measure" in given:
                given["measure"] = Measure(**given["measure"])
            made.append(Controller(**given))
        except InvalidInput as error:
            raise InvalidInput(f"controllers[{i}]: {error}") from None
    return made


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
    if controller.field is not None:
        entry["field"] = to_field_entry(controller.field, orbits)
    return entry


class Whole:
    """A whole number of a file."""

    def __init__(self, value: int) -> None:
        self.value = value

    def __str__(self) -> str:
        return str(self.value)
