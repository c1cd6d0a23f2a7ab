"""The store of an ensemble: Zarr arrays with names and units, marks of finished chunks, and the stamp of the recipe.

A chunk's states come first, in whole Zarr chunks. Its record follows as one Zarr chunk of `record`. That file is the
mark of the chunk and its result at once. Nothing is locked, because a chunk has the same bytes whoever computes it.
"""

from __future__ import annotations

import contextlib
import errno
import json
import math
import os
import pathlib
import shutil
import warnings
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

import numpy as np

from .._build import build_info
from .._core import InvalidInput, __version__
from . import layout as layouts
from . import states
from .distributions import Floats
from .layout import Layout
from .recipe import EnsembleRecipe, from_content, from_message
from .summary import create_arrays, shapes
from .task import Task, fields

FORMAT = 1
MARKS = "record"
STAMPS = {   # what a store must share with the run that goes on, and how a difference is told
    "format": "the store has format {0}, and this polhode writes {1}",
    "version": "the store was made by polhode {0}, and this is {1}",
    "simd": "the store was made with {0} arithmetic, and this machine uses {1}; POLHODE_SIMD chooses",
    "count": "the store has {0} bodies, and {1} were requested",
    "recipe": "the store was made from another recipe ({0:.12}, now {1:.12})",
    "functions": "the store was made with the functions {0}, and these are {1}",
}
CRC = 4   # bytes of a checksum
COORDINATES = ("time", "state_time", "quantile")   # arrays that a store has from its beginning


class DiskFull(OSError):
    """The disk has no room, with the number of bytes that are missing."""

    def __init__(self, missing: int, out: str = "", done: int = 0, total: int = 0) -> None:
        text = f"the disk is full: {done} of {total} chunks are done, and the rest needs {missing} bytes more"
        super().__init__(errno.ENOSPC, text, out)
        self.missing = missing


def need_zarr() -> None:
    """Raise InvalidInput with the command that installs what stores need."""
    try:
        import zarr  # noqa: F401
    except ImportError as error:
        raise InvalidInput(f"out: needs {error.name}: pip install 'polhode[ensemble]'") from None


def arithmetic() -> str:
    """Return "fused" or "baseline": with fused products, the last bits of answers differ."""
    return "baseline" if build_info()["simd"] == "baseline" else "fused"


def stamp(task: Task) -> dict[str, Any]:
    """Return what decides the bytes of a store."""
    recipe = from_message(task.recipe)
    names = {name: f"{function.__module__}:{getattr(function, '__qualname__', name)}"
             for name, function in sorted(task.functions.items())}
    return {"format": FORMAT, "version": __version__, "simd": arithmetic(), "count": recipe.count,
            "recipe": recipe.hash, "functions": names}


def _group(out: str, mode: str) -> Any:
    import zarr

    from .files import LastingStore

    return zarr.open_group(LastingStore(out, read_only=mode == "r"), mode=mode,   # type: ignore[arg-type]
                           use_consolidated=False)


def file_of(out: str, name: str, *index: int) -> pathlib.Path:
    """Return the file of a Zarr chunk."""
    return pathlib.Path(out) / name / ".".join(["c", *map(str, index)])


# ---- the arrays

def _create(group: Any, name: str, shape: tuple[int, ...], chunks: tuple[int, ...], dims: tuple[str, ...], dtype: str,
            fill: float, compress: bool = False, **attributes: Any) -> Any:
    from zarr.codecs import Crc32cCodec, ZstdCodec

    codecs: Any = [ZstdCodec(level=3), Crc32cCodec()] if compress else [Crc32cCodec()]
    return group.create_array(name, shape=shape, chunks=chunks, dtype=dtype, fill_value=fill, compressors=codecs,
                              dimension_names=dims, attributes=attributes,
                              chunk_key_encoding={"name": "default", "separator": "."})


def begin(task: Task) -> None:
    """Make the arrays of a new store. The stamp comes last: without it, a store has not begun."""
    recipe, layout = from_message(task.recipe), task.layout
    assert task.out is not None
    group = _group(task.out, "w")
    times = recipe.times
    swept = layout.points > 1
    lead: tuple[str, ...] = ("point",) if swept else ()
    places = fields(task)

    def make(name: str, shape: tuple[int, ...], chunks: tuple[int, ...], dims: tuple[str, ...], dtype: str = "<f8",
             fill: float = np.nan, **attributes: Any) -> Any:
        first: tuple[int, ...] = (layout.points,) if swept else ()
        return _create(group, name, (*first, *shape), (*(1 for _ in first), *chunks), (*lead, *dims), dtype, fill,
                       **attributes)

    def fixed(name: str, values: Any, **attributes: Any) -> None:
        array = _create(group, name, values.shape, values.shape, (name,), values.dtype.str, 0, **attributes)
        array[...] = values

    fixed("time", times, units="s", long_name="time since the epoch of the scene", axis="T")
    if not all(states.is_free(recipe, point) for point in recipe.points):
        make("status", (recipe.count,), (layout.chunk,), ("body",), "|i1", -1, long_name="how the body's run ended",
             flag_values=list(range(-1, len(states.STATUS))), flag_meanings=" ".join(["not_done", *states.STATUS]))
        make("error", (recipe.count,), (layout.chunk,), ("body",), units="1",
             long_name="bound of the body's error, NaN if not estimated")
    if recipe.states != "none":
        kept = times[::recipe.every]
        fixed("state_time", kept, units="s", long_name="time of the stored states")
        kind = "<f4" if recipe.states == "float32" else "<f8"
        for name, width, axis, units, text in (
                ("omega", 3, "axis", "rad s-1", "angular velocity in body axes"),
                ("attitude", 4, "component", "1", "unit quaternion (x, y, z, w), body to space")):
            make(name, (recipe.count, kept.size, width), (layout.slab, kept.size, width),
                 ("body", "state_time", axis), kind, units=units, long_name=text)
    create_arrays(recipe, make, fixed)
    _create(group, MARKS, (layout.chunks, places.size), (1, places.size), ("chunk", "field"), "<f8", np.nan,
            compress=True, long_name="sums and histograms of each chunk of bodies",
            fields={name: [start, list(shape)] for name, (start, shape, _) in places.places.items()})
    content: dict[str, Any] = {"stamp": stamp(task), "layout": layout._asdict(), "recipe": recipe.raw,
               "sweep": [point.settings for point in recipe.points] if swept else []}
    if "mesh" in recipe.raw["body"] or "parts" in recipe.raw["body"]:
        content["folder"] = recipe.folder
    import zarr

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")   # the format's standard has no such part yet; xarray reads it at once
        zarr.consolidate_metadata(group.store)
    group = zarr.open_group(group.store, mode="r+", use_consolidated=True)
    group.attrs.update({"Conventions": "CF-1.11", "title": recipe.title, "source": f"polhode {__version__}",
                        "polhode_ensemble": content})


def read_stamp(out: str) -> dict[str, Any] | None:
    """Return the attributes of a store, or None if it has not begun.

    Raises
    ------
    InvalidInput
        For a folder that is no store of an ensemble.
    """
    need_zarr()
    path = pathlib.Path(out)
    if not path.exists():
        return None
    if not path.is_dir():
        raise InvalidInput(f"{out}: must be a store of an ensemble, got a file")
    if not any(path.iterdir()):
        return None
    try:
        metadata = json.loads((path / "zarr.json").read_bytes())
        content = metadata["attributes"]["polhode_ensemble"]
        Layout(**content["layout"])
        return {"stamp": dict(content["stamp"]), **content}
    except FileNotFoundError:
        pass
    except ValueError:
        raise InvalidInput(f"{out}: zarr.json is damaged, or is not that of an ensemble") from None
    except (LookupError, TypeError, AttributeError):
        pass   # a group without a stamp has not begun
    for file in filter(pathlib.Path.is_file, path.rglob("*")):
        if not (file.name == "zarr.json" or file.name.endswith(".partial") or file.parent.name in COORDINATES):
            raise InvalidInput(f"{out}: must be a store of an ensemble, got a folder with other files")
    return None


def recipe_of(out: str) -> tuple[EnsembleRecipe, Layout, dict[str, Any]]:
    """Return the recipe of a store, its layout and its stamp."""
    content = read_stamp(out)
    if content is None:
        raise InvalidInput(f"{out}: must be a store of an ensemble, got none that has begun")
    recipe = from_content(content["recipe"], content.get("folder", "."), out)
    layout = Layout(**content["layout"])
    layouts.check(recipe, layout, out)
    return recipe, layout, content["stamp"]


def check_stamp(out: str, found: dict[str, Any], wanted: dict[str, Any]) -> None:
    """Refuse a store that another recipe, version or arithmetic made."""
    for key, text in STAMPS.items():
        if found.get(key) != wanted[key]:
            raise InvalidInput(f"{out}: {text.format(found.get(key), wanted[key])}")


def discard(out: str) -> None:
    """Remove a store that has not begun."""
    shutil.rmtree(out, ignore_errors=True)


# ---- marks and records

def marked(out: str, layout: Layout) -> list[int]:
    """Return the chunks that are done, in order."""
    folder = pathlib.Path(out) / MARKS
    names = {entry.name for entry in os.scandir(folder)} if folder.is_dir() else set()
    return [chunk for chunk in range(layout.chunks) if f"c.{chunk}.0" in names]


class Reader:
    """Reads the records of a store."""

    def __init__(self, out: str) -> None:
        self.out = out
        self.group = _group(out, "r")
        self._records = self.group[MARKS]

    def record(self, chunk: int) -> Floats:
        """Return a chunk's record; refuse a damaged one by its name."""
        try:
            return np.asarray(self._records[chunk])
        except Exception as error:   # codecs raise what they like
            path = file_of(self.out, MARKS, chunk, 0)
            raise InvalidInput(f"{path}: the record of chunk {chunk} is damaged ({type(error).__name__}); remove the "
                               f"file to compute the chunk again") from None


def check_files(out: str, recipe: EnsembleRecipe, layout: Layout, chunks: list[int]) -> None:
    """Refuse a store where a file of a finished chunk is missing or cut short."""
    for chunk in chunks:
        for path, size in files_of(out, recipe, layout, chunk):
            there = path.stat().st_size if path.exists() else 0
            if there != size:
                raise InvalidInput(f"{path}: must have {size} bytes, got {there}; remove "
                                   f"{file_of(out, MARKS, chunk, 0)} to compute chunk {chunk} again")


def files_of(out: str, recipe: EnsembleRecipe, layout: Layout, chunk: int) -> list[tuple[pathlib.Path, int]]:
    """Return the files of a chunk beside its record, with their sizes [bytes]."""
    index, first, end = layout.place(chunk)
    lead = (index,) if layout.points > 1 else ()
    found = []
    if not all(states.is_free(recipe, point) for point in recipe.points):
        number = first // layout.chunk
        found += [(file_of(out, "status", *lead, number), layout.chunk + CRC),
                  (file_of(out, "error", *lead, number), 8 * layout.chunk + CRC)]
    if recipe.states != "none":
        times = recipe.times[::recipe.every].size
        size = (4 if recipe.states == "float32" else 8) * layout.slab * times
        for start, _ in layout.slabs(first, end):
            found += [(file_of(out, name, *lead, start // layout.slab, 0, 0), width * size + CRC)
                      for name, width in (("omega", 3), ("attitude", 4))]
    return found


def bytes_of(recipe: EnsembleRecipe, layout: Layout, chunk: int) -> int:
    """Return the bytes of a chunk's files, without its record, which is compressed."""
    return sum(size for _, size in files_of("", recipe, layout, chunk))


@lru_cache(maxsize=16)
def _array(out: str, name: str, made: str) -> Any:
    """Return an array for writing; `made` is the same for the same metadata. Chunks of NaN are written, too."""
    # Of this array alone: Zarr's own setting is the process's, and a thread that restores it takes it from the others.
    return _group(out, "r+")[name].with_config({"write_empty_chunks": True})


class Writer:
    """Writes the files of one chunk."""

    def __init__(self, task: Task, chunk: int) -> None:
        assert task.out is not None
        self.task, self.chunk, self.out = task, chunk, task.out
        self._recipe = from_message(task.recipe)
        self._lead: tuple[int, ...] = (task.layout.place(chunk)[0],) if task.layout.points > 1 else ()

    def _array(self, name: str) -> Any:
        return _array(self.out, name, f"{self._recipe.hash} {self.task.layout}")

    def is_marked(self) -> bool:
        """Return True if the chunk is done."""
        return file_of(self.out, MARKS, self.chunk, 0).is_file()

    def require_room(self) -> None:
        """Raise DiskFull if the chunk's states do not fit: nothing is computed in vain."""
        missing = bytes_of(self._recipe, self.task.layout, self.chunk) - shutil.disk_usage(self.out).free
        if missing > 0:
            raise DiskFull(missing)

    def write_states(self, point: int, start: int, omega: Floats, attitude: Floats) -> None:
        """Write the states of a slab: one Zarr chunk of each array."""
        stop = start + len(omega)
        self._array("omega")[(*self._lead, slice(start, stop))] = omega
        self._array("attitude")[(*self._lead, slice(start, stop))] = attitude

    def write_outcomes(self, point: int, first: int, status: Any, error: Floats) -> None:
        """Write how the bodies of the chunk ended."""
        where = (*self._lead, slice(first, first + len(status)))
        self._array("status")[where], self._array("error")[where] = status, error

    def mark(self, record: Floats) -> None:
        """Write the record: the chunk is done."""
        self._array(MARKS)[self.chunk] = record


def need(task: Task) -> int:
    """Return the bytes that the chunks still to do take, the records by those that are there."""
    assert task.out is not None
    recipe, done = from_message(task.recipe), set(marked(task.out, task.layout))
    sizes = [file_of(task.out, MARKS, chunk, 0).stat().st_size for chunk in done] or [8 * fields(task).size]
    left = [chunk for chunk in range(task.layout.chunks) if chunk not in done]
    summaries = sum(8 * math.prod(shape) + CRC for _, shape, _, _ in shapes(recipe).values()) * task.layout.points
    return sum(bytes_of(recipe, task.layout, chunk) for chunk in left) + len(left) * max(sizes) + summaries


def raise_full(task: Task) -> None:
    """Raise DiskFull with the number of bytes that the rest of the ensemble needs beside what is free."""
    assert task.out is not None
    with_margin = max(need(task) - shutil.disk_usage(task.out).free, 1)
    raise DiskFull(with_margin, task.out, len(marked(task.out, task.layout)), task.layout.chunks)


@contextlib.contextmanager
def disk(task: Task) -> Iterator[None]:
    """Turn a full disk into DiskFull with the missing bytes."""
    try:
        yield
    except OSError as error:
        if error.errno not in (errno.ENOSPC, errno.EDQUOT) or isinstance(error, DiskFull):
            raise
        raise_full(task)


def write_summary(out: str, arrays: dict[str, Any]) -> None:
    """Write the arrays of a summary."""
    group = _group(out, "r+")
    for name, (_, values, _, _) in arrays.items():
        group[name][...] = values


def verify(out: str, recipe: EnsembleRecipe, layout: Layout, chunks: list[int]) -> None:
    """Read every file of finished chunks; refuse the first damaged one by its name."""
    check_files(out, recipe, layout, chunks)
    reader = Reader(out)
    for chunk in chunks:
        reader.record(chunk)
        for path, _ in files_of(out, recipe, layout, chunk):
            if not _is_whole(path):
                raise InvalidInput(f"{path}: the checksum is wrong; remove {file_of(out, MARKS, chunk, 0)} to compute "
                                   f"chunk {chunk} again")


def _is_whole(path: pathlib.Path) -> bool:
    """Return True if the last four bytes of a file are the CRC-32C of the others."""
    from google_crc32c import value

    data = path.read_bytes()
    return int(value(data[:-CRC])) == int.from_bytes(data[-CRC:], "little")


def clean(out: str) -> int:
    """Remove the drafts that ended processes left; return their number."""
    found = 0
    for path in pathlib.Path(out).rglob("*.partial"):
        with contextlib.suppress(FileNotFoundError):
            path.unlink()
            found += 1
    return found
