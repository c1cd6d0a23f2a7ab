"""Saved files from anyone: the description is read first, and each array is compared with it before it is read."""

from __future__ import annotations

import functools
import json
import math
import pathlib
import zipfile
from collections.abc import Callable
from typing import Any

import numpy as np

from . import _files, _folders
from ._core import InvalidInput
from ._export import need
from ._folders import Claim

INFLATED = 64_000_000        # bytes to which a description may inflate, or
FACTOR = 400                 # times its size in the file; honest ones reach 185
REAL, WHOLE, TRUTH = (np.dtype(kind) for kind in (np.float64, np.int64, np.bool_))
WIDTHS = {"omega": 3, "attitude": 4}
Sums = Callable[[pathlib.Path, dict[str, Any]], tuple[int, int]]


def read(path: pathlib.Path, sums: Sums) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return what a file holds: `about` and the arrays, whose shapes and types are those that it describes.

    `sums` returns the number of chunks of an ensemble, and the numbers in a record.

    Raises
    ------
    InvalidInput
        For a file that was not saved by polhode, or is damaged.
    """
    try:
        about, arrays = (_read_folder if path.is_dir() else _read_file)(path, sums)
    except (InvalidInput, MemoryError, KeyboardInterrupt):
        raise
    except Exception as error:   # of zip, zlib, NumPy, Zarr and JSON
        raise InvalidInput(f"{path}: must be a file that polhode saved ({type(error).__name__})") from None
    return about, arrays


# ---- what belongs together


def wanted(path: pathlib.Path, about: Any, claims: dict[str, Claim], sums: Sums) -> list[str]:
    """Return the arrays to read; refuse those that do not fit the description, or each other."""
    kinds: dict[str, Any] = {"motion": _motion, "motions": _motions, "ensemble": functools.partial(_ensemble, sums)}
    kind = about.get("kind") if isinstance(about, dict) else None
    if not isinstance(kind, str) or kind not in kinds:
        raise InvalidInput(f"{path}: must be a file that polhode saved")
    try:
        expected = kinds[kind](path, about, claims)
    except (LookupError, TypeError, AttributeError) as error:
        raise InvalidInput(f"{path}: must be a file that polhode saved ({type(error).__name__})") from None
    for name, (shape, dtype) in expected.items():
        found = claims.get(name)
        if found is None or found.shape != shape or found.dtype != dtype:
            got = "none" if found is None else f"{found.dtype} of shape {found.shape}"
            raise InvalidInput(f"{path}: is damaged: {name} must be {dtype} of shape {shape}, got {got}")
    return list(expected)


def _motion(path: pathlib.Path, about: dict[str, Any], claims: dict[str, Claim]) -> dict[str, Any]:
    scene = about["scene"]
    _require_parts(path, about)
    (reached,) = claims["t"].shape if len(claims["t"].shape) == 1 else (-1,)
    if not 0 <= reached <= len(scene["times"]):
        raise InvalidInput(f"{path}: is damaged: t has the shape {claims['t'].shape}, and the scene has "
                           f"{len(scene['times'])} times")
    expected: dict[str, Any] = {"t": ((reached,), REAL)}
    for name, width in WIDTHS.items():
        bounds = [f"{name}_{side}" for side in ("lower", "upper") if f"{name}_{side}" in claims]
        for each in [name, *bounds] if name in scene["want"] else []:
            expected[each] = ((reached, width), REAL)
    for torque in scene["torques"]:
        for name, start in torque["state"][4] if torque["kind"] == "Formula" else []:
            expected[f"states.{name}"] = ((reached,) if len(start) == 1 else (reached, len(start)), REAL)
    for i, rotor in enumerate(scene["rotors"]):
        if any(rotor[6:9]):   # torque, viscous, coulomb
            expected[f"states.rotor_momentum_{i}"] = ((reached,), REAL)
    if scene.get("damper") is not None:
        expected["states.damper_momentum"] = ((reached, 3), REAL)
    for i, controller in enumerate(scene.get("controllers", [])):
        by_rotors = str(controller["output"]).startswith("rotor")
        if not by_rotors:
            expected[f"states.command_{i}"] = ((reached, 3), REAL)
        for k in range(int(controller["rotors"]) if by_rotors else 0):
            expected[f"states.rotor_momentum_{k}"] = ((reached,), REAL)
            if controller["output"] == "rotor_torque":
                expected[f"states.command_{i}_{k}"] = ((reached,), REAL)
        ticks = {name: claim.shape for name, claim in claims.items() if name.startswith(f"ticks.{i}.")}
        rows = ticks[f"ticks.{i}.t"][:1]
        expected |= {name: ((*rows, *shape[1:]), REAL) for name, shape in ticks.items()}
    for name in [name for name in expected if name.startswith("states.")]:
        for bound in (name.replace("states.", f"states_{side}.", 1) for side in ("lower", "upper")):
            if bound in claims:
                expected[bound] = expected[name]
    return expected


def _is_event(event: Any, t: Any, omega: Any, attitude: Any, states: Any = {}) -> bool:   # noqa: B006  never changed
    number = (int, float)
    rows = [(omega, 3), (attitude, 4)]
    return (isinstance(event, int) and isinstance(t, number) and isinstance(states, dict)
            and all(len(row) == size and all(isinstance(value, number) for value in row) for row, size in rows)
            and all(isinstance(value, number) or (isinstance(value, list) and all(isinstance(x, number) for x in value))
                    for value in states.values()))


def _require_parts(path: pathlib.Path, about: dict[str, Any]) -> None:
    """Refuse parts of other types than those of a motion, which would fail where they are used."""
    number = (int, float)
    parts = {**about, **{f"plan.{name}": value for name, value in about["plan"].items()},
             **{f"stats.{name}": about["stats"][name] for name in ("steps", "seconds")}}
    kinds: dict[str, Any] = {
        **dict.fromkeys(("status", "message", "error_kind", "plan.model", "plan.method", "plan.state"), str),
        **dict.fromkeys(("error", "asked", "plan.accuracy", "plan.rtol", "stats.steps", "stats.seconds"), number),
        **dict.fromkeys(("options", "stats", "plan.wishes"), dict), "events": list}
    wrong = [name for name, kind in kinds.items() if not isinstance(parts.get(name), kind)]
    wrong += [f"events[{i}]" for i, event in enumerate(about["events"]) if not _is_event(*event)]
    if wrong:
        raise InvalidInput(f"{path}: is damaged: {wrong[0]} is not that of a motion")


def _motions(path: pathlib.Path, about: dict[str, Any], claims: dict[str, Claim]) -> dict[str, Any]:
    bodies, scenes = len(about["status"]), about["scenes"]
    listed = [scenes] if isinstance(scenes, dict) else list(scenes)
    lengths = {len(scene["times"]) for scene in listed}
    if len(lengths) > 1 or not {len(about["message"]), len(about["method"])} <= {bodies} or (
            listed is not scenes and isinstance(scenes, list) and len(listed) != bodies):
        raise InvalidInput(f"{path}: is damaged: it has {bodies} bodies with {len(listed)} scenes of "
                           f"{sorted(lengths)} times")
    expected: dict[str, Any] = {name: ((bodies,), REAL) for name in ("t_reached", "error")}
    expected |= {"steps": ((bodies,), WHOLE)} | {name: ((bodies,), TRUTH) for name in ("success", "lanes", "refused")}
    if "start_t0" in claims:
        expected["start_t0"] = ((bodies,), REAL)
    if "start_times" in claims and len(shape := claims["start_times"].shape) == 2:   # each body has its own
        lengths = {shape[1]}
        expected["start_times"] = ((bodies, shape[1]), REAL)
    for name, width in WIDTHS.items():
        if name in claims and (not listed or name in listed[0]["want"]):
            expected[name] = ((bodies, *(lengths or {0}), width), REAL)
    for name, width in {"inertia": 3, **WIDTHS}.items():
        if (start := f"start_{name}") in claims:
            expected[start] = ((width,) if len(claims[start].shape) == 1 else (bodies, width), REAL)
    return expected


def _ensemble(sums: Sums, path: pathlib.Path, about: dict[str, Any], claims: dict[str, Claim]) -> dict[str, Any]:
    most, numbers = sums(path, about)
    (chunks,) = claims["chunks"].shape if len(claims["chunks"].shape) == 1 else (-1,)
    if not 0 <= chunks <= most:
        raise InvalidInput(f"{path}: is damaged: chunks has the shape {claims['chunks'].shape}, and the recipe has "
                           f"{most} chunks")
    records = (chunks, numbers) if chunks else (0,)
    return {"chunks": ((chunks,), WHOLE), "records": (records, REAL)}


# ---- .npz


def _read_file(path: pathlib.Path, sums: Sums) -> tuple[Any, dict[str, Any]]:
    with _files.opened(path, _files.MESH) as (file, _), zipfile.ZipFile(file) as table:
        entries = {info.filename.removesuffix(".npy"): info for info in table.infolist()}
        claims = {name: _claim(table, info) for name, info in entries.items()}
        kind = claims["about"]
        size = entries["about"].file_size
        if kind.shape != () or kind.dtype.kind != "U" or kind.dtype.itemsize > 4 * _folders.ABOUT:
            raise ValueError("about")
        if size > max(INFLATED, FACTOR * entries["about"].compress_size):
            raise InvalidInput(f"{path}: is damaged: its description inflates to {size} bytes")
        about = _loads(path, str(_array(table, entries["about"])))
        return about, {name: _array(table, entries[name]) for name in wanted(path, about, claims, sums)}


def _claim(table: zipfile.ZipFile, info: zipfile.ZipInfo) -> Claim:
    """Read the header of an array, and compare what it claims with the size that the archive claims."""
    formats: Any = np.lib.format
    with table.open(info) as part:
        version = formats.read_magic(part)
        shape, _, dtype = {(1, 0): formats.read_array_header_1_0, (2, 0): formats.read_array_header_2_0}[version](part)
        if dtype.hasobject or info.file_size != part.tell() + math.prod(shape) * dtype.itemsize:
            raise ValueError(info.filename)
    return Claim(shape, dtype)


def _array(table: zipfile.ZipFile, info: zipfile.ZipInfo) -> Any:
    with table.open(info) as part:
        return np.lib.format.read_array(part, allow_pickle=False)


def _loads(path: pathlib.Path, text: str) -> Any:
    try:
        return json.loads(text)
    except RecursionError:
        raise InvalidInput(f"{path}: is damaged: lists are nested too deep") from None


# ---- Zarr


def _read_folder(path: pathlib.Path, sums: Sums) -> tuple[Any, dict[str, Any]]:
    about = _loads(path, _folders.attributes(path)["polhode"])
    files = _folders.require_saved(path)
    claims = {name: _folders.claim_of(path / name) for name in files}
    names = wanted(path, about, claims, sums)
    for name in names:
        for file in files[name]:
            _folders.require_chunk(path / file, claims[name])
    zarr = need("zarr")
    return about, {name: np.asarray(zarr.open_array(str(path / name), mode="r")[...]) for name in names}
