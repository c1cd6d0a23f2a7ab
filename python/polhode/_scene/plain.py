"""Scenes as plain data, for files: every number keeps its bits."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from .. import torques
from .._clock.controller import Controller, Measure, _keywords
from .._core import Changing, Damper, InertiaTensor, InvalidInput, Rotor
from .._orbit.field import MagneticField
from .._orbit.named import Named, restore
from .._orbit.orbit import Orbit
from .._orbit.plates import Plate
from .._orbit.sunlight import Sunlit, make_sunlit
from .orbit_torques import KINDS
from .orbits import make_orbits
from .scene import Scene, _restore


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, dict):
        return {name: _plain(item) for name, item in value.items()}
    return [_plain(item) for item in value] if isinstance(value, (tuple, list)) else value


def _state(thing: Any) -> Any:
    return _plain(thing.__getstate__())


def _made(kind: Any, state: list[Any]) -> Any:
    """Return the object that had this state, without rounding it again."""
    made = kind.__new__(kind)
    holds_tuples = kind in (Rotor, Damper)
    made.__setstate__(tuple(tuple(part) if holds_tuples and isinstance(part, list) else part for part in state))
    return made


class LostFunction:
    """Stands for the function of a torque in a scene from a file. Anything that calls it is refused."""

    def __init__(self, name: str) -> None:
        self.__qualname__ = name

    def __call__(self, t: float, omega: Any, attitude: Any) -> Any:
        raise InvalidInput(f"scene: must have its torque {self.__qualname__!r}, a function, which no file holds; "
                           "give it again: scene.replace(torques=[...])")

    def __repr__(self) -> str:
        return f"<{self.__qualname__}, not in the file>"


def _own_torque(torque: Any) -> dict[str, Any]:
    """Return the name of a torque that is a function, and what was declared of it."""
    function, traits = torque.function, torque.traits
    name = str(getattr(function, "__qualname__", None) or getattr(function, "__name__", type(function).__name__))
    claims = {name: bool(traits[name]) for name in ("uses_time", "uses_attitude", "uses_rates")}
    return {"kind": "Custom", "name": name, "claims": claims, "breaks": list(torque.breaks)}


def _lost_torque(data: dict[str, Any]) -> Any:
    claims = {name: bool(data["claims"][name]) for name in ("uses_time", "uses_attitude", "uses_rates")}
    return torques.Custom(LostFunction(str(data["name"])), breaks=data["breaks"], **claims)


def _torque(torque: Any) -> dict[str, Any]:
    if isinstance(torque, torques.During):
        if not isinstance(torque, Sunlit):
            return {**_torque(torque.torque), "during": _plain(torque.windows)}
        orbit, sun, shadow = torque.sunlight
        light = {"orbit": _plain(orbit._given), "sun": list(sun), "shadow": shadow}
        return {**_torque(torque.torque), "sunlight": light}
    if isinstance(torque, Named):
        return _named_torque(torque)
    name = type(torque).__name__
    if name == "Custom":
        return _own_torque(torque)
    if name not in torques.__all__:
        raise InvalidInput(f"scene: must have torques that a file can hold, got {name}")
    return {"kind": name, "state": _state(torque)}


def _named_torque(torque: Named) -> dict[str, Any]:
    """Return the kind of a torque on an orbit, and its arguments."""
    given = dict(torque._given)
    if "plates" in given:
        given["plates"] = [dataclasses.asdict(plate) for plate in given["plates"]]
    if "orbit" in given:
        given["orbit"] = given["orbit"]._given
    if "field" in given:
        given["field"] = _field(given["field"])
    return {"kind": torque._kind, "given": _plain(given)}


def _from_named(data: dict[str, Any]) -> Any:
    given = dict(data["given"])
    if "plates" in given:
        given["plates"] = [Plate(**plate) for plate in given["plates"]]
    if "orbit" in given:
        given["orbit"] = _from_orbit(given["orbit"])
    if "field" in given:
        given["field"] = _from_field(given["field"])
    return restore(data["kind"], given)


def _from_torque(data: dict[str, Any]) -> Any:
    if data["kind"] in KINDS:
        torque = _from_named(data)
    elif data["kind"] not in torques.__all__ or data["kind"] in ("During", "records"):
        raise ValueError(data["kind"])
    elif data["kind"] == "Custom":
        torque = _lost_torque(data)
    else:
        torque = _made(getattr(torques, data["kind"]), data["state"])
    if "sunlight" in data:
        light = data["sunlight"]
        return make_sunlit(torque, _from_orbit(light["orbit"]), light["sun"], light["shadow"])
    return torques.During(torque, data["during"]) if "during" in data else torque


def _field(field: MagneticField) -> dict[str, Any]:
    return {**field._given, "kind": field._kind, "orbit": dict(field.orbit._given)}


def _from_field(data: dict[str, Any]) -> MagneticField:
    given = {name: value for name, value in data.items() if name not in ("kind", "orbit")}
    make = MagneticField.gauss if data["kind"] == "gauss" else MagneticField.dipole
    return make(_from_orbit(data["orbit"]), **given)


def _from_orbit(given: dict[str, Any]) -> Orbit:
    return make_orbits({"main": _Entry(given)})["main"]


def _controller(controller: Any, i: int) -> dict[str, Any]:
    if controller.function is not None:
        raise InvalidInput(f"scene.controllers[{i}]: must be one that a file can hold, got trace=False")
    parts = _keywords(controller._given) | {"measure": dataclasses.asdict(controller.measure)}
    if (field := controller.field) is not None:
        parts["field"] = _field(field)
    return {name: _plain(value) for name, value in parts.items()}


def _from_controller(data: dict[str, Any]) -> Controller:
    parts: dict[str, Any] = {**data, "measure": Measure(**data["measure"])}
    if "field" in parts:
        parts["field"] = _from_field(parts["field"])
    return Controller(**parts)


class _Entry:
    """Keys as a validated table gives them."""

    def __init__(self, given: dict[str, Any]) -> None:
        self.given = given

    def model_dump(self) -> dict[str, Any]:
        return self.given


def to_plain(scene: Scene) -> dict[str, Any]:
    """Return a scene as lists, numbers and text. Of a torque that is a function, its name stands there."""
    matrix, physical = _state(scene.inertia)
    given = {"changing": scene.changing, "momentum": scene.momentum}
    changes: dict[str, Any] = {name: _state(value) for name, value in given.items() if value is not None}
    if scene.leaving:
        changes["leaving"] = True
    return {"inertia": matrix, "physical": physical, **changes,
            "omega": scene.omega.tolist(), "attitude": scene.attitude.tolist(),
            "torques": [_torque(torque) for torque in scene.torques],
            "rotors": [_state(rotor) for rotor in scene.rotors],
            **({} if scene.damper is None else {"damper": _state(scene.damper)}),
            **({"controllers": [_controller(one, i) for i, one in enumerate(scene.controllers)]}
               if scene.controllers else {}),
            "times": scene.times.tolist(), "want": list(scene.want), "t0": scene.t0, "name": scene.name}


def from_plain(data: dict[str, Any]) -> Scene:
    """Return the scene of plain data.

    Raises
    ------
    InvalidInput, LookupError, TypeError, ValueError
        For data that is none of a scene.
    """
    changes = {name: _made(Changing, data[name]) for name in ("changing", "momentum") if name in data}
    inertia = changes.get("changing") or InertiaTensor(data["inertia"], physical=bool(data["physical"]))
    return _restore(Scene, {
        "inertia": inertia, "momentum": changes.get("momentum"), "leaving": bool(data.get("leaving", False)),
        "omega": data["omega"],
        "attitude": np.asarray(data["attitude"], dtype=float),
        "torques": [_from_torque(torque) for torque in data["torques"]],
        "rotors": [_made(Rotor, rotor) for rotor in data["rotors"]],
        "damper": _made(Damper, data["damper"]) if "damper" in data else None,
        "controllers": [_from_controller(one) for one in data.get("controllers", [])],
        "times": np.asarray(data["times"], dtype=float), "want": tuple(data["want"]), "t0": float(data["t0"]),
        "name": str(data["name"])})
