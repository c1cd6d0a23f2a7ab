"""Numbers of the torques and the rotors of a scene, by their names."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _core, torques
from .._clock.controller import Controller
from .._core import Damper, InvalidInput, Rotor
from .._orbit.sunlight import rewrap
from .._scene.scene import Scene
from .._scene.write import list_keywords
from .rotations import Array


def _inner(torque: Any) -> Any:
    return torque.torque if isinstance(torque, torques.During) else torque


def _key(torque: Any) -> str:
    """The name in scene files: 'gravity_gradient' of GravityGradient."""
    inner = _inner(torque)
    name = "Formula" if isinstance(inner, torques.Formula) else type(inner).__name__
    return "".join("_" + c.lower() if c.isupper() and k else c.lower() for k, c in enumerate(name))


ROTOR_FIELDS = ("momentum", "inertia", "speed", "torque", "viscous", "coulomb", "max_torque", "max_speed")


def _read(holder: Any, field: str) -> Any:
    """The number of a torque, a rotor, a damper or a controller, or None."""
    if isinstance(holder, Controller):
        return {**holder.parameters, **holder.states}.get(field)
    if isinstance(holder, torques.Formula):
        return holder.parameters.get(field)
    if isinstance(holder, Rotor) and field not in ROTOR_FIELDS:
        return dict(holder.parameters or {}).get(field)
    return getattr(holder, field, None)


def _is_fitted(what: str, holder: Any, field: str) -> bool:
    """Whether a field is a number that is fitted."""
    if what == "damper":
        return field == "viscous"
    if what == "rotors":
        return field in ROTOR_FIELDS or field in dict(holder.parameters or {})
    return isinstance(holder, (torques.Formula, Controller)) or field not in ("traits", "value", "windows")


def _holders(scene: Scene) -> dict[str, tuple[Any, ...]]:
    """What has numbers that are fitted."""
    return {"torques": scene.torques, "rotors": scene.rotors, "controllers": scene.controllers,
            "damper": () if scene.damper is None else (scene.damper,)}


def find(scene: Scene, group: str) -> tuple[str, int, str]:
    """Return what a name such as 'torques.0.weight' means: ('torques', 0, 'weight').

    The first is 'torques', 'rotors', 'controllers', 'damper' or 'states'.
    """
    parts = group.split(".")
    if len(parts) == 2 and parts[0] == "states":
        owners = [k for k, torque in enumerate(scene.torques) if parts[1] in getattr(torque, "states", ())]
        if not owners:
            raise InvalidInput(f"fit: must be a state of the scene's formulas, {', '.join(scene.states) or 'none'}, "
                               f"got {group!r}")
        return "states", owners[0], parts[1]
    if len(parts) == 2 and parts[0] == "damper" and scene.damper is not None:
        parts = ["damper", "0", parts[1]]
    kinds = _holders(scene)
    if len(parts) == 3 and parts[0] in kinds and parts[1].isdigit() and int(parts[1]) < len(kinds[parts[0]]):
        what, index, field = parts[0], int(parts[1]), parts[2]
    else:
        among = [k for k, torque in enumerate(scene.torques) if _key(torque) == parts[0]]
        if parts[0] == "rotor" and len(scene.rotors) == 1:
            among, what = [0], "rotors"
        else:
            what = "torques"
        if len(parts) != 2 or len(among) != 1:
            raise InvalidInput(f"fit: must be 'omega', 'attitude', 'inertia', or numbers of torques and rotors of the "
                               f"scene, as 'torques.0.weight' or 'gravity.weight', got {group!r}")
        index, field = among[0], parts[1]
    holder = _inner(kinds[what][index])
    value = _read(holder, field)
    if what == "controllers":
        if value is None:
            raise InvalidInput(f"fit: must be a parameter or the start of a state of the controller, which has "
                               f"{', '.join((*holder.parameters, *holder.states)) or 'none'}, got {group!r}")
        return what, index, field
    if isinstance(holder, torques.Formula) and value is None:
        raise InvalidInput(f"fit: must be numbers of Formula, which has {', '.join(holder.parameters) or 'none'}, "
                           f"got {group!r}")
    if not _is_fitted(what, holder, field) or value is None or isinstance(value, str):
        raise InvalidInput(f"fit: {group!r} is no number of {holder!r}; ends of windows are not fitted")
    return what, index, field


def get(scene: Scene, group: str) -> Array:
    """Return the numbers of a group, shape (1,), (3,) or (9,)."""
    what, index, field = find(scene, group)
    if what == "states":
        return np.array(scene.states[field], dtype=float).reshape(-1)
    holder = _inner(_holders(scene)[what][index])
    return np.array(_read(holder, field), dtype=float).reshape(-1)


def names_of(scene: Scene, group: str) -> list[str]:
    """Return the names of a group's numbers."""
    what, index, field = find(scene, group)
    stem = f"{what}.{field}" if what in ("states", "damper") else f"{what}.{index}.{field}"
    return [group + name.removeprefix(stem) for name in _core._parameter_names(scene, group)]


def put(scene: Scene, group: str, value: Array) -> Scene:
    """Return the scene with other numbers of a group."""
    what, index, field = find(scene, group)
    if what == "states":
        start = value.reshape(np.shape(scene.states[field]))
        return scene.replace(torques=[torque.with_starts(**{field: start}) if field in getattr(torque, "states", ())
                                      else torque for torque in scene.torques])
    items = list(_holders(scene)[what])
    holder = _inner(items[index])
    shape = np.shape(_read(holder, field))
    new: Any = value.reshape(shape) if shape else float(value[0])
    if what == "damper":
        return scene.replace(damper=Damper(inertia=holder.inertia, viscous=new, rates=holder.rates))
    if what == "controllers":
        table = "parameters" if field in holder.parameters else "states"
        return scene.replace(controllers=[
            one.replace(**{table: {**getattr(one, table), field: new}}) if k == index else one
            for k, one in enumerate(items)])
    if what == "rotors":
        own = field in ROTOR_FIELDS
        change = {field: new} if own else {"parameters": {**holder.parameters, field: new}}
        made: Any = Rotor(**{**list_keywords(holder), **change})
    else:
        if isinstance(holder, torques.Formula):
            made = holder.with_parameters(**{field: new})
        else:
            public = [name for name in dir(holder) if not name.startswith("_") and name != "traits"]
            fields = [name for name in public if not callable(getattr(holder, name))]
            made = type(holder)(**{**{name: getattr(holder, name) for name in fields}, field: new})
        if isinstance(items[index], torques.During):
            made = rewrap(items[index], made)
    items[index] = made
    return scene.replace(**{what: items})
