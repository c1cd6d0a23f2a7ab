"""The beginning of a store: its arrays are made aside, and the folder takes its name when it is whole.

So of two runs that begin one store at once, one begins it, and the other goes on with it.
"""

from __future__ import annotations

import contextlib
import errno
import os
import pathlib
import shutil
import uuid
import warnings
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from .. import _folders
from .._core import InvalidInput, __version__
from . import states, store
from .recipe import from_message
from .summary import create_arrays
from .task import Task, fields


class Spec(NamedTuple):
    """An array of a store."""

    name: str
    shape: tuple[int, ...]
    chunks: tuple[int, ...]
    dims: tuple[str, ...]
    dtype: str
    fill: float
    attributes: dict[str, Any]
    compress: bool = False
    values: Any = None

    def create(self, group: Any) -> None:
        """Make the array."""
        from zarr.codecs import Crc32cCodec, ZstdCodec

        codecs: Any = [ZstdCodec(level=3), Crc32cCodec()] if self.compress else [Crc32cCodec()]
        array = group.create_array(self.name, shape=self.shape, chunks=self.chunks, dtype=self.dtype,
                                   fill_value=self.fill, compressors=codecs, dimension_names=self.dims,
                                   attributes=self.attributes,
                                   chunk_key_encoding={"name": "default", "separator": "."})
        if self.values is not None:
            array[...] = self.values

    @property
    def claim(self) -> _folders.Claim:
        """What the metadata of the array say."""
        codecs = ("bytes", *(("zstd",) if self.compress else ()), "crc32c")
        return _folders.Claim(self.shape, np.dtype(self.dtype), self.chunks, codecs)


def specs(task: Task) -> list[Spec]:
    """Return the arrays of the store of a task."""
    recipe, layout = from_message(task.recipe), task.layout
    times = recipe.times
    swept = layout.points > 1
    lead: tuple[str, ...] = ("point",) if swept else ()
    places = fields(task)
    found: list[Spec] = []

    def make(name: str, shape: tuple[int, ...], chunks: tuple[int, ...], dims: tuple[str, ...], dtype: str = "<f8",
             fill: float = np.nan, **attributes: Any) -> None:
        first: tuple[int, ...] = (layout.points,) if swept else ()
        found.append(Spec(name, (*first, *shape), (*(1 for _ in first), *chunks), (*lead, *dims), dtype, fill,
                          attributes))

    def fixed(name: str, values: Any, **attributes: Any) -> None:
        found.append(Spec(name, values.shape, values.shape, (name,), values.dtype.str, 0, attributes, values=values))

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
    attributes = {"long_name": "sums and histograms of each chunk of bodies",
                  "fields": {name: [start, list(shape)] for name, (start, shape, _) in places.places.items()}}
    found.append(Spec(store.MARKS, (layout.chunks, places.size), (1, places.size), ("chunk", "field"), "<f8", np.nan,
                      attributes, True))
    return found


def check(out: str, task: Task) -> None:
    """Refuse a store whose arrays are not those of its recipe."""
    for spec in specs(task):
        if _folders.claim_of(pathlib.Path(out) / spec.name) != spec.claim:
            raise InvalidInput(f"{out}: {spec.name} must be the array of the recipe, {spec.claim.dtype} of shape "
                               f"{spec.shape}")


def begin(task: Task) -> bool:
    """Make a new store; return False if another run has begun it meanwhile."""
    from .files import sync_folder

    assert task.out is not None
    out = pathlib.Path(os.path.realpath(task.out))
    out.parent.mkdir(parents=True, exist_ok=True)
    # The folder of a mount cannot be replaced: there the files take their names one by one, the stamp last.
    inside = out.is_dir() and (os.path.ismount(out) or not os.access(out.parent, os.W_OK))
    draft = (out / uuid.uuid4().hex if inside else out.parent / f".{uuid.uuid4().hex}").with_suffix(".partial")
    with _leftover(out) as leftover:
        if store.read_stamp(task.out) is not None:
            return False
        try:
            _fill(draft, task)
            if inside:
                _move_files(draft, out)
                return True
            leftover()
            with contextlib.suppress(OSError):
                os.rmdir(out)   # not every system renames to an empty folder
            os.rename(draft, out)
            sync_folder(out.parent)
            return True
        except OSError as error:
            if error.errno not in (errno.ENOTEMPTY, errno.EEXIST, errno.ENOENT):
                raise
            return False
        finally:
            shutil.rmtree(draft, ignore_errors=True)


def _fill(folder: pathlib.Path, task: Task) -> None:
    """Write the metadata of a store; the stamp comes last."""
    import zarr

    recipe, layout = from_message(task.recipe), task.layout
    group = store.group_of(str(folder), "w")
    for spec in specs(task):
        spec.create(group)
    content: dict[str, Any] = {
        "stamp": store.stamp(task), "layout": layout._asdict(), "recipe": recipe.raw,
        "sweep": [point.settings for point in recipe.points] if layout.points > 1 else []}
    if "mesh" in recipe.raw["body"] or "parts" in recipe.raw["body"]:
        content["folder"] = recipe.folder
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")   # the format's standard has no such part yet; xarray reads it at once
        zarr.consolidate_metadata(group.store)
    group = zarr.open_group(group.store, mode="r+", use_consolidated=True)
    group.attrs.update({"Conventions": "CF-1.11", "title": recipe.title, "source": f"polhode {__version__}",
                        "polhode_ensemble": content})


def _move_files(draft: pathlib.Path, out: pathlib.Path) -> None:
    names = [name for name, is_folder in _folders.walk(draft) if not is_folder]
    for name in sorted(names, key="zarr.json".__eq__):
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        os.replace(draft / name, out / name)


@contextlib.contextmanager
def _leftover(out: pathlib.Path) -> Iterator[Callable[[], object]]:
    """Give a function that empties the folder which is there now, and no other that takes its name later."""
    if not out.is_dir():
        yield lambda: None
        return
    if os.unlink not in os.supports_dir_fd:
        yield lambda: shutil.rmtree(out, ignore_errors=True)
        return
    handle = os.open(out, os.O_RDONLY | os.O_DIRECTORY)

    def empty() -> None:
        for _, folders, names, place in os.fwalk(".", topdown=False, dir_fd=handle):
            for name in names:
                with contextlib.suppress(FileNotFoundError):
                    os.unlink(name, dir_fd=place)
            for name in folders:
                with contextlib.suppress(FileNotFoundError):
                    os.rmdir(name, dir_fd=place)

    try:
        yield empty
    finally:
        os.close(handle)
