"""The store of an ensemble: Zarr arrays with names and units, marks of finished chunks, and the stamp of the recipe.

A chunk's states come first, in whole Zarr chunks. Its record follows as one Zarr chunk of `record`. That file is the
mark of the chunk and its result at once. Nothing is locked, because a chunk has the same bytes whoever computes it.
"""

from __future__ import annotations

import contextlib
import errno
import math
import os
import pathlib
import re
import shutil
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

import numpy as np

from .. import _files, _folders
from .._build import build_info
from .._core import InvalidInput, __version__
from . import layout as layouts
from . import states
from .distributions import Floats
from .layout import Layout
from .recipe import EnsembleRecipe, from_content, from_message
from .summary import shapes
from .task import Task, fields

FORMAT = 1
MARKS = "record"
STAMPS = {   # what a store must share with the run that goes on, and the words for a difference
    "format": "the store has format {0}, and this polhode writes {1}",
    "version": "the store was made by polhode {0}, and this is {1}",
    "simd": "the store was made with {0} arithmetic, and this machine uses {1}; POLHODE_SIMD chooses",
    "count": "the store has {0} bodies, and {1} were requested",
    "recipe": "the store was made from another recipe ({0:.12}, now {1:.12})",
    "functions": "the store was made with the functions {0}, and these are {1}",
}
CRC = 4   # bytes of a checksum
UNFINISHED = re.compile(   # the files of a store that has not begun
    r"([0-9a-f]+\.partial/)?(\w+/zarr\.json|zarr\.json|(time|state_time|quantile)/c(\.\d+)*)(\.[0-9a-f]+\.partial)?")
CHUNK = re.compile(r"c\.(\d{1,18})\.0")


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


def group_of(out: str, mode: str) -> Any:
    """Open a store as a group of Zarr."""
    import zarr

    from .files import LastingStore

    return zarr.open_group(LastingStore(out, read_only=mode == "r"), mode=mode,   # type: ignore[arg-type]
                           use_consolidated=False)


def file_of(out: str, name: str, *index: int) -> pathlib.Path:
    """Return the file of a Zarr chunk."""
    return pathlib.Path(out) / name / ".".join(["c", *map(str, index)])


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
        if not os.path.lexists(path / "zarr.json"):
            raise FileNotFoundError
        content = _folders.attributes(path)["polhode_ensemble"]
        Layout(**content["layout"])
        return {"stamp": dict(content["stamp"]), **content}
    except FileNotFoundError:
        pass
    except InvalidInput as error:
        raise InvalidInput(f"{out}: zarr.json is damaged, or is not that of an ensemble: {error}") from None
    except (LookupError, TypeError, AttributeError):
        pass   # a group without a stamp has not begun
    for name, is_folder in _folders.walk(path):
        if not is_folder and not UNFINISHED.fullmatch(name):
            raise InvalidInput(f"{out}: must be a store of an ensemble, got a folder with other files")
    return None


def require_own(out: str) -> None:
    """Refuse a store with links, pipes or devices: nothing is read or written through them."""
    for _ in _folders.walk(pathlib.Path(out)):
        pass


def recipe_of(out: str) -> tuple[EnsembleRecipe, Layout, dict[str, Any]]:
    """Return the recipe of a store, its layout and its stamp."""
    content = read_stamp(out)
    if content is None:
        raise InvalidInput(f"{out}: must be a store of an ensemble, got none that has begun")
    require_own(out)
    recipe = from_content(content["recipe"], content.get("folder", "."), out)
    layout = Layout(**content["layout"])
    layouts.check(recipe, layout, out)
    return recipe, layout, content["stamp"]


def check_stamp(out: str, found: dict[str, Any], wanted: dict[str, Any]) -> None:
    """Refuse a store that another recipe, version or arithmetic made."""
    for key, text in STAMPS.items():
        if found.get(key) != wanted[key]:
            raise InvalidInput(f"{out}: {text.format(found.get(key), wanted[key])}")


# ---- marks and records

def marked(out: str, layout: Layout) -> list[int]:
    """Return the chunks that are done, in order."""
    folder = pathlib.Path(out) / MARKS
    names = (CHUNK.fullmatch(entry.name) for entry in os.scandir(folder)) if folder.is_dir() else ()
    return sorted(chunk for name in names if name and (chunk := int(name[1])) < layout.chunks
                  and name[0] == f"c.{chunk}.0")


class Reader:
    """Reads the records of a store."""

    def __init__(self, out: str) -> None:
        self.out = out
        self.group = group_of(out, "r")
        self._records = self.group[MARKS]
        self._claim = _folders.claim_of(pathlib.Path(out) / MARKS)

    def record(self, chunk: int) -> Floats:
        """Return a chunk's record; refuse a damaged one by its name."""
        path = file_of(self.out, MARKS, chunk, 0)
        try:
            if path.exists():   # Zarr would inflate to any size that the file states
                _folders.require_chunk(path, self._claim)
            return np.asarray(self._records[chunk])
        except Exception as error:   # codecs raise what they like
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
    return group_of(out, "r+")[name].with_config({"write_empty_chunks": True})


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
    there = next(path for path in (pathlib.Path(task.out), *pathlib.Path(task.out).parents) if path.exists())
    with_margin = max(need(task) - shutil.disk_usage(there).free, 1)
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
    group = group_of(out, "r+")
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

    data = _files.read(path, _files.MESH)
    return int(value(data[:-CRC])) == int.from_bytes(data[-CRC:], "little")


def clean(out: str) -> int:
    """Remove the drafts that ended processes left; return their number."""
    found = 0
    for path in pathlib.Path(out).rglob("*.partial"):
        with contextlib.suppress(FileNotFoundError):
            if path.is_dir():
                shutil.rmtree(path, ignore_errors=True)
            else:
                path.unlink()
            found += 1
    return found
