"""`ph.load`: motions and ensembles from files."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from . import _files, _folders, _saved_files, _wings
from ._batch.solve_many import Motions
from ._core import InvalidInput
from ._scene.plain import from_plain
from ._solve.event_hit import EventHit
from ._solve.motion import Motion
from ._solve.plan import Plan
from ._solve.ticks import Ticks

if TYPE_CHECKING:
    from ._wings import AttitudeEphemeris, Ensemble


def load(path: str | os.PathLike[str]) -> Any:
    """Read what `save` wrote, or the store of an ensemble.

    Parameters
    ----------
    path : path
        A .npz file, or a folder of Zarr. The store of an ensemble may be opened while its run goes on. Files of
        attitudes for other programs are read by their suffixes: .aem, .a, and the .bc files that polhode wrote.

    Returns
    -------
    Motion, Motions, Ensemble or AttitudeEphemeris
        A motion, and many motions, are equal to those that were saved. Dense output and derivatives are not saved. For
        type checkers it is Any, since the file decides.

    Raises
    ------
    InvalidInput
        For a file that is missing or damaged, or that polhode did not write; and for the store of an ensemble of
        another version.
    """
    found = _files.to_path(path, "path")
    if not found.exists():
        raise InvalidInput(f"{found}: cannot be read: no such file")
    if module := _wings.find_suffix(found.suffix):
        ephemeris: AttitudeEphemeris = _wings.load(module).load(found)
        return ephemeris
    if found.is_dir() and "polhode" not in _folders.attributes(found):
        store: Ensemble = _ensembles().open_run(str(found))
        return store
    about, arrays = _saved_files.read(found, lambda path, about: _ensembles().sizes(path, about))
    readers: dict[Any, Any] = {"motion": _motion, "motions": _motions,
                               "ensemble": lambda about, arrays: _ensembles().from_arrays(found, about, arrays)}
    kind = about.get("kind") if isinstance(about, dict) else None
    try:
        result: Motion | Motions | Ensemble = readers[kind](about, arrays)
        return result
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        if isinstance(error, InvalidInput):
            raise
        raise InvalidInput(f"{found}: must be a file that polhode saved ({type(error).__name__})") from None


def _ensembles() -> Any:
    return _wings.load("_ensemble.load")


def _motion(about: dict[str, Any], arrays: dict[str, Any]) -> Motion:
    scene = from_plain(about["scene"])
    motion = Motion.__new__(Motion)
    plan: dict[str, Any] = dict(about["plan"])
    wishes: dict[str, Any] = plan.pop("wishes")
    names = ("omega", "attitude", "omega_lower", "omega_upper", "attitude_lower", "attitude_upper")
    span = about["proved_span"]
    motion.__dict__.update(
        {name: arrays.get(name) for name in names},
        states=_named("states", arrays), scene=scene, **{
            part: None if span is None else _named(part, arrays) for part in ("states_lower", "states_upper")},
        ticks=tuple(_ticks(f"ticks.{i}.", arrays) for i in range(len(scene.controllers))),
        _answer=None, _options=wishes, t=arrays["t"],
        options=about["options"], status=str(about["status"]), _message=str(about["message"]), stats=about["stats"],
        error=float(about["error"]), error_kind=str(about["error_kind"]), asked=float(about["asked"]),
        proved_span=None if span is None else (float(span[0]), float(span[1])),
        plan=Plan(scene, plan, wishes),
        events=tuple(EventHit(int(event), float(t), _array(omega), _array(attitude), *map(_states, states))
                     for event, t, omega, attitude, *states in about["events"]))
    if "drift" in about:
        motion.__dict__["_drift"] = {str(name): float(value) for name, value in about["drift"].items()}
    return motion


def _named(part: str, arrays: dict[str, Any]) -> dict[str, Any]:
    return {name[len(part) + 1:]: array for name, array in arrays.items() if name.startswith(f"{part}.")}


def _ticks(head: str, arrays: dict[str, Any]) -> Ticks:
    own = {name.removeprefix(head): array for name, array in arrays.items() if name.startswith(head)}
    parts = {part: {name.removeprefix(f"{part}."): array for name, array in own.items() if name.startswith(f"{part}.")}
             for part in ("measurement", "states")}
    return Ticks(own["t"], parts["measurement"], own["command"], parts["states"])


def _states(states: dict[str, Any]) -> dict[str, Any]:
    return {str(name): float(value) if isinstance(value, (int, float)) else _array(value)
            for name, value in states.items()}


def _array(values: Any) -> Any:
    import numpy as np

    return np.asarray(values, dtype=float)


STARTS = ("inertia", "omega", "attitude", "t0", "times")


def _motions(about: dict[str, Any], arrays: dict[str, Any]) -> Motions:
    shared = about["scenes"]
    scenes = from_plain(shared) if isinstance(shared, dict) else [from_plain(scene) for scene in shared]
    starts = {name: arrays[f"start_{name}"] for name in STARTS if f"start_{name}" in arrays}
    omega: Any = arrays.get("omega")
    attitude: Any = arrays.get("attitude")
    return Motions(omega, attitude, tuple(about["status"]), tuple(about["message"]),
                   tuple(about["method"]), arrays["t_reached"], arrays["error"], arrays["steps"], arrays["success"],
                   arrays["lanes"], arrays["refused"], scenes, {**starts, **about["options"]})
