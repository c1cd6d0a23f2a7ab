"""Scene files: reading, the check against their schema, and conversion to scenes."""

from __future__ import annotations

import math
import os
import pathlib
import tomllib
from functools import cache
from typing import Annotated, Any, Literal, Union

import numpy as np

from .. import _files, torques
from .._core import Damper, InvalidInput, Rotor
from .._orbit.orbit import Orbit
from . import orbit_torques
from .bodies import attitude_of, body_inertia, body_model, changing_of, place_meshes
from .controllers import controller_model, make_controllers
from .orbits import make_orbits, orbit_model
from .scene import Scene, scene_folder
from .validation import euler_model, kinds, model, one_of, validate
from .write import save_scene as save_scene

MOST_SAMPLES = 10_000_000   # of a span, so that a file of a few bytes does not claim the machine's memory


def _check_start(start: Any) -> None:
    one_of(start, "omega", "omega_deg")
    if start.attitude is not None and start.euler is not None:
        raise ValueError("give attitude or euler, not both")


def _check_times(times: Any) -> None:
    given = {name for name in ("span", "samples", "values") if getattr(times, name) is not None}
    if given not in ({"span", "samples"}, {"values"}):
        raise ValueError(f"give span and samples, or values; got {', '.join(sorted(given)) or 'none of them'}")


@cache
def scene_model() -> Any:
    """Return the pydantic model of a scene file; its JSON Schema is `scene_model().model_json_schema()`."""
    from pydantic import Field

    kind = kinds()
    start = model("Start", _check_start, omega=(kind.vector | None, None), omega_deg=(kind.vector | None, None),
                   attitude=(kind.quaternion | None, None), euler=(euler_model() | None, None), t0=(kind.number, 0.0))
    times = model("Times", _check_times, span=(kind.number | None, None), values=(kind.numbers | None, None),
                   samples=(Annotated[int, Field(ge=1, le=MOST_SAMPLES)] | None, None))
    any_torque: Any = Union[tuple(_torque_models())]  # noqa: UP007  as many as the list has
    torque: Any = Annotated[any_torque, Field(discriminator="kind")]
    orbits: Any = dict[str, orbit_model()]   # type: ignore[misc]
    values: Any = Union[kind.number, kind.numbers]   # noqa: UP007
    rotor: Any = model("Rotor", axis=(kind.vector, ...), momentum=(kind.number | None, None),
                       inertia=(kind.number | None, None), speed=(kind.number | None, None), free=(bool, False),
                       during=(kind.windows | None, None), torque=(kind.number | str, 0.0), viscous=(kind.number, 0.0),
                       coulomb=(kind.number, 0.0), max_torque=(kind.number | None, None),
                       max_speed=(kind.number | None, None), let=(dict[str, str] | None, None),
                       parameters=(dict[str, values] | None, None))
    damper: Any = model("Damper", inertia=(kind.number, ...), viscous=(kind.number, ...),
                        rates=(kind.vector, (0.0, 0.0, 0.0)))
    controllers: Any = list[controller_model()]   # type: ignore[misc]
    return model("SceneFile", name=(str, ""), title=(str, ""), about=(str, ""),
                  want=(list[Literal["omega", "attitude"]], ["omega", "attitude"]),
                  body=(body_model(), ...), start=(start, ...), torques=(list[torque], []), rotors=(list[rotor], []),
                 orbits=(orbits, {}), damper=(damper | None, None), controllers=(controllers, []), times=(times, ...))


def _torque_models() -> list[Any]:
    """Return the models of all torques of scene files, distinguished by `kind`."""
    kind = kinds()
    models: list[Any] = []
    for key, records in _records_by_key().items():
        record = records[0]
        if key == "custom":
            continue   # a function cannot stand in a file
        if key == "formula":
            models.append(_formula_model())
            continue
        fields: dict[str, Any] = {"kind": (Literal[key], ...), "during": (kind.windows | None, None)}
        several = len(records) > 1   # of which the keys decide
        types = {"real": kind.number, "vector": kind.vector, "orbit": str}
        for parameter in (p for one in records for p in one["parameters"]):
            default = ... if parameter["default"] is None else parameter["default"]
            if several:
                fields[parameter["name"]] = (types[parameter["kind"]] | None, None)
                continue
            if parameter["kind"] == "matrix":
                fields[parameter["name"]], fields["diagonal"] = (kind.matrix | None, None), (kind.vector | None, None)
            elif parameter["kind"] == "choice":
                fields[parameter["name"]] = (Literal[tuple(parameter["choices"])], default)
            else:
                fields[parameter["name"]] = (types[parameter["kind"]], default)
        models.append(model(record["name"], **fields))
    return models + orbit_torques.models()


def _records_by_key() -> dict[str, list[dict[str, Any]]]:
    """Return the records of torques by `kind`. A kind with several has one a way of giving it."""
    found: dict[str, list[dict[str, Any]]] = {}
    for record in torques.records():
        found.setdefault(record["key"], []).append(record)
    return found


def _formula_model() -> Any:
    """Return the model of a torque that is a formula."""
    kind = kinds()
    values: Any = Union[kind.number, kind.numbers]   # noqa: UP007
    state: Any = model("State", start=(values, ...), rate=(str, ...))
    return model("Formula", kind=(Literal["formula"], ...), torque=(str | None, None), potential=(str | None, None),
                 let=(dict[str, str], {}), parameters=(dict[str, values], {}), states=(dict[str, state], {}),
                 orbits=(dict[str, str], {}), recognise=(bool, True), during=(kind.windows | None, None))


def find_scene(source: str | os.PathLike[str]) -> pathlib.Path:
    """Return the path of a scene file, given as a path or as the name of a scene of polhode."""
    path = _files.to_path(source, "scene")
    if _files.is_file(path):
        return path
    installed = scene_folder() / f"{path.name}.toml"
    if path.parent == pathlib.Path() and not path.suffix and _files.is_file(installed):
        return installed
    names = ", ".join(sorted(p.stem for p in scene_folder().glob("*.toml")))
    raise InvalidInput(f"scene: must be a file, or one of {names}; got {str(source)!r}")


def read_toml(path: pathlib.Path) -> dict[str, Any]:
    """Return the content of a TOML file; raise InvalidInput with one line if it has an error."""
    data = _files.read(path, _files.TEXT)
    try:
        return tomllib.loads(data.decode("utf-8").replace("\r\n", "\n"))
    except RecursionError:
        raise InvalidInput(f"{path}: not TOML: tables or lists are nested too deep") from None
    except ValueError as error:   # of TOML, of UTF-8, and of integers with thousands of digits
        raise InvalidInput(f"{path}: not TOML: {error}") from None


def _torque(entry: Any, orbits: dict[str, Orbit]) -> Any:
    if entry.kind in orbit_torques.KINDS:
        given = entry.model_dump(exclude={"kind", "during"})
        made = orbit_torques.make(entry.kind, given, orbits, lambda name: _find_orbit(orbits, name))
        return made if entry.during is None else torques.During(made, entry.during)
    records = _records_by_key()[entry.kind]
    values = entry.model_dump(exclude={"kind", "diagonal", "during"})
    if len(records) > 1:
        values = {name: value for name, value in values.items() if value is not None}
    record = _choose(records, values)
    for parameter in record["parameters"]:
        if parameter["kind"] == "orbit":
            values[parameter["name"]] = _find_orbit(orbits, values[parameter["name"]])
    if hasattr(entry, "diagonal"):
        if (entry.diagonal is None) == (entry.matrix is None):
            raise InvalidInput(f"torques: {entry.kind}: give matrix or diagonal, one of them")
        values["matrix"] = entry.matrix if entry.diagonal is None else entry.diagonal
    if entry.kind == "formula":
        arguments = {"function", "text", "let", "potential", "states", "recognise", "scale", "orbits"}
        reserved = arguments & set(values["parameters"])
        if reserved:
            raise InvalidInput(f"torques: formula: must not name a parameter {', '.join(sorted(reserved))}")
        values = {"text": values.pop("torque"), **values.pop("parameters"), **values}
        values["states"] = values["states"] or None
        names = values["orbits"]
        own_names = {own: _find_orbit(orbits, name) for own, name in names.items()}
        values["orbits"] = {**orbits, **own_names} or None
    torque = getattr(torques, record["name"])(**values)
    return torque if entry.during is None else torques.During(torque, entry.during)


def _choose(records: list[dict[str, Any]], values: dict[str, Any]) -> dict[str, Any]:
    """Return the record whose parameters are given."""
    for record in records:
        own = {parameter["name"] for parameter in record["parameters"]}
        needed = {parameter["name"] for parameter in record["parameters"] if parameter["default"] is None}
        if len(records) == 1 or needed <= set(values) <= own:
            return record
    ways = ", or ".join(" and ".join(p["name"] for p in record["parameters"]) for record in records)
    raise InvalidInput(f"torques: {records[0]['key']}: must have {ways}; got {', '.join(values) or 'none of them'}")


def _find_orbit(orbits: dict[str, Orbit], name: str) -> Orbit:
    if name not in orbits:
        raise InvalidInput(f"orbit: must name a table of [orbits], got {name!r}; "
                           f"there are {', '.join(orbits) or 'none'}")
    return orbits[name]


def _rotors(entries: list[Any]) -> list[Rotor]:
    rotors = []
    for i, entry in enumerate(entries):
        try:
            rotors.append(Rotor(**entry.model_dump()))
        except InvalidInput as error:
            raise InvalidInput(f"rotors[{i}]: {error}") from None
    return rotors


def make_scene(data: dict[str, Any], where: str = "scene") -> Scene:
    """Build a scene from the content of a scene file."""
    entry = validate(scene_model(), data, where)
    start, times = entry.start, entry.times
    grid = times.values
    if grid is None:
        end = start.t0 + times.span
        if not math.isfinite(end):
            raise InvalidInput(f"{where}: times.span: must end at a finite time, got t0 {start.t0:g} and span "
                               f"{times.span:g}")
        grid = np.linspace(start.t0, end, times.samples)
    try:
        orbits = make_orbits(entry.orbits)
        return Scene(
            inertia=changing_of(entry.body, "inertia") or body_inertia(entry.body),
            omega=np.radians(start.omega_deg) if start.omega is None else start.omega,
            attitude=attitude_of(start),
            torques=[_torque(torque, orbits) for torque in entry.torques],
            times=grid,
            want=entry.want,
            t0=start.t0,
            name=entry.name,
            rotors=_rotors(entry.rotors),
            damper=None if entry.damper is None else Damper(**entry.damper.model_dump()),
            momentum=changing_of(entry.body, "momentum"),
            leaving=entry.body.leaving,
            controllers=make_controllers(entry.controllers, orbits),
        )
    except InvalidInput as error:
        raise InvalidInput(f"{where}: {error}") from None


def load_scene(source: str | os.PathLike[str]) -> Scene:
    """Read a scene file; see `Scene.load`."""
    path = find_scene(source)
    data = read_toml(path)
    data.setdefault("name", path.stem)
    place_meshes(data.get("body"), path.parent)
    return make_scene(data, path.name)


def load_body(source: str | os.PathLike[str]) -> Any:
    """Return the checked [body] table of a scene file, or of a file with that table alone."""
    path = find_scene(source)
    data = read_toml(path)
    if not isinstance(data.get("body"), dict):
        raise InvalidInput(f"{path.name}: body: missing, or not a table")
    place_meshes(data["body"], path.parent)
    return validate(body_model(), data["body"], f"{path.name}: body")
