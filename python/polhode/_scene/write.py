"""Scenes as scene files, which `Scene.load` reads back to the same bits."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core, _files, torques
from .._core import InvalidInput
from .._orbit.named import Named
from .._orbit.orbit import Orbit
from .._orbit.sunlight import Sunlit
from .controllers import Whole
from .controllers import to_entry as to_entry_of_controller
from .orbit_torques import light_entry
from .orbit_torques import to_entry as to_entry_of_named
from .orbits import Names, to_entry

if TYPE_CHECKING:
    from .scene import Scene


def _value(value: Any) -> str:
    """A value of TOML. The shortest text of a float64 gives the same bits."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value)   # a basic string of TOML is one of JSON
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(name)} = {_value(item)}" for name, item in value.items()) + " }"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    if isinstance(value, Whole):
        return str(value)
    text = repr(float(value))
    return text if any(c in text for c in ".en") else text + ".0"


def _key(name: str) -> str:
    return name if name.replace("_", "").replace("-", "").isalnum() and name.isascii() else json.dumps(name)


def _table(lines: list[str], head: str, entries: dict[str, Any]) -> None:
    lines += ["", head, *(f"{_key(name)} = {_value(value)}" for name, value in entries.items())]


def _torque(torque: Any, i: int, orbits: Names) -> dict[str, Any]:
    if isinstance(torque, torques.During):
        inner = _torque(torque.torque, i, orbits)
        if isinstance(torque, Sunlit):
            return inner | light_entry(torque.sunlight, orbits)
        return inner | {"during": torque.windows}
    if isinstance(torque, Named):
        return to_entry_of_named(torque, orbits)
    name = type(torque).__name__
    record = next((r for r in _core.torque_records() if r["name"] == name), None)
    if record is None or name == "Custom":
        raise InvalidInput(f"torques[{i}]: must be one that a file can hold, got {name}; a Formula can stand in a file")
    entry: dict[str, Any] = {"kind": record["key"]}
    if name == "Formula":
        what = ("torque", torque.text) if torque.potential is None else ("potential", torque.potential)
        parts = {what[0]: what[1], "let": torque.let, "parameters": torque.parameters, "states": torque.states}
        entry |= {key: part for key, part in parts.items() if part}
        if torque.orbits:
            entry["orbits"] = {own: orbits.find(orbit, own) for own, orbit in torque.orbits.items()}
        return entry if torque.recognise else {**entry, "recognise": False}
    values = {parameter["name"]: getattr(torque, parameter["name"]) for parameter in record["parameters"]}
    return entry | {name: orbits.find(value) if isinstance(value, Orbit) else value for name, value in values.items()}


def list_keywords(rotor: Any) -> dict[str, Any]:
    """Return the keywords that make an equal rotor."""
    names = ("axis", "momentum", "inertia", "speed", "free", "during", "torque", "let", "parameters", "viscous",
             "coulomb", "max_torque", "max_speed")
    drive = {"torque": 0.0, "viscous": 0.0, "coulomb": 0.0, "let": {}, "parameters": {}}
    return {name: value for name in names if (value := getattr(rotor, name, None)) is not None and value is not False
            and not (name in drive and value == drive[name])}


def _body(scene: Scene) -> dict[str, Any]:
    """Return the [body] table; pieces of the inertia come before those of the momentum."""
    matrix, physical = scene.inertia.__getstate__()
    body: dict[str, Any] = {} if scene.changing else {"matrix": matrix}
    if not physical:
        body["physical"] = False
    pieces = [{"from": begin, "to": end, name: terms}
              for name, changing in (("inertia", scene.changing), ("momentum", scene.momentum)) if changing
              for begin, end, terms in changing.pieces]
    return body | ({"pieces": pieces} if pieces else {}) | ({"leaving": True} if scene.leaving else {})


def to_toml(scene: Scene) -> str:
    """Return a scene as the text of a scene file.

    Raises
    ------
    InvalidInput
        For a torque that is a Python function.
    """
    lines = [f"name = {_value(scene.name)}", f"want = {_value(list(scene.want))}"]
    _table(lines, "[body]", _body(scene))
    _table(lines, "[start]", {"omega": scene.omega, "attitude": scene.attitude, "t0": scene.t0})
    _table(lines, "[times]", {"values": scene.times})
    orbits = Names()
    entries = [_torque(torque, i, orbits) for i, torque in enumerate(scene.torques)]
    for controller in scene.controllers:
        if controller.field is not None:
            orbits.find(controller.field.orbit)
    for name, orbit in orbits.orbits.items():
        _table(lines, f"[orbits.{_key(name)}]", to_entry(orbit))
    for entry in entries:
        _table(lines, "[[torques]]", entry)
    for rotor in scene.rotors:
        _table(lines, "[[rotors]]", list_keywords(rotor))
    if scene.damper is not None:
        _table(lines, "[damper]", {name: getattr(scene.damper, name) for name in ("inertia", "viscous", "rates")})
    for i, controller in enumerate(scene.controllers):
        _table(lines, "[[controllers]]", to_entry_of_controller(controller, i, orbits))
    return "\n".join(lines) + "\n"


def save_scene(scene: Scene, path: str | os.PathLike[str]) -> None:
    """Write a scene file; see `Scene.save`."""
    target = _files.to_path(path, "path")
    if target.suffix != ".toml":
        raise InvalidInput(f"path: must end in .toml, got {str(path)!r}")
    _files.write(target, to_toml(scene))
