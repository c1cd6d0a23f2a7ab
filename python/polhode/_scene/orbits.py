"""Orbits in scene files: tables `[orbits.NAME]`, which torques name."""

from __future__ import annotations

from functools import cache
from typing import Any, Literal

from .._core import InvalidInput
from .._orbit.field import MagneticField
from .._orbit.orbit import Orbit
from .validation import kinds, model

ELEMENTS = ("periapsis_distance", "a", "e", "inclination", "node", "periapsis", "anomaly", "t0", "j2", "radius")


@cache
def orbit_model() -> Any:
    """Return the pydantic model of one orbit: the keys of `Orbit`, of `Orbit.from_elements` or of `Orbit.table`."""
    kind = kinds()
    numbers: dict[str, Any] = {name: (kind.number | None, None) for name in ELEMENTS}
    rows = list[kind.vector] | None   # type: ignore[name-defined]
    return model("Orbit", mu=(kind.number | None, None), r0=(kind.vector | None, None), v0=(kind.vector | None, None),
                 t=(kind.numbers | None, None), r=(rows, None), v=(rows, None), **numbers)


def make_orbits(entries: dict[str, Any]) -> dict[str, Orbit]:
    """Return the orbits of a scene file by name.

    Raises
    ------
    InvalidInput
        With the name of the orbit.
    """
    orbits = {}
    for name, entry in entries.items():
        given = {key: value for key, value in entry.model_dump().items() if value is not None}
        make = Orbit.table if "t" in given else Orbit if "r0" in given else Orbit.from_elements
        try:
            orbits[name] = make(**given)
        except InvalidInput as error:
            raise InvalidInput(f"orbits.{name}: {error}") from None
    return orbits


@cache
def field_model() -> Any:
    """Return the pydantic model of a magnetic field: the keys of its maker, and the name of its orbit."""
    kind = kinds()
    rows: Any = list[kind.numbers] | None   # type: ignore[name-defined]
    numbers: Any = {name: (kind.number | None, None) for name in ("strength", "tilt", "spin", "phase", "radius")}
    return model("Field", kind=(Literal["dipole", "gauss"], ...), orbit=(str, ...), g=(rows, None), h=(rows, None),
                 **numbers)


def make_field(entry: dict[str, Any], orbits: dict[str, Orbit]) -> MagneticField:
    """Return the magnetic field of a checked table.

    Raises
    ------
    InvalidInput
        For a name that is no orbit of the file, and for the keys of another field.
    """
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


def to_field_entry(field: MagneticField, orbits: Names) -> dict[str, Any]:
    """Return the keys of a field's table."""
    return {"kind": field._kind, **field._given, "orbit": orbits.find(field.orbit)}


def to_entry(orbit: Orbit) -> dict[str, Any]:
    """Return the keys of an orbit's table."""
    return dict(orbit._given)


class Names:
    """The names of orbits in a file that is written, and their tables."""

    def __init__(self) -> None:
        self.orbits: dict[str, Orbit] = {}

    def find(self, orbit: Orbit, wish: str = "main") -> str:
        """Return the name of an orbit, and give it one if it has none."""
        for name, known in self.orbits.items():
            if known == orbit:
                return name
        name, number = wish, 1
        while name in self.orbits:
            name, number = f"{wish}{number + 1}", number + 1
        self.orbits[name] = orbit
        return name
