"""Folders of Zarr that may come from anyone: what they claim is looked at before Zarr reads it."""

from __future__ import annotations

import contextlib
import errno
import math
import os
import pathlib
import re
import uuid
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from . import _files
from ._core import InvalidInput

ABOUT = 4 * _files.TEXT   # characters of a description; ten million times take 170 million
METADATA = 1_000_000      # bytes of the metadata of an array, which take a thousand
CODECS = {"bytes", "zstd", "crc32c"}
# A file of an array of a saved motion, or a folder of them.
CHUNK = re.compile(r"(?P<name>[A-Za-z]\w*(\.\w+)?)/c(/\d+)*")
TRIES = 1000


def require_about(text: str) -> str:
    """Refuse to save a description that could not be loaded."""
    if len(text) > ABOUT:
        raise InvalidInput(f"motion: must be described by at most {ABOUT} characters, got {len(text)}")
    return text


class Claim(NamedTuple):
    """What an array says that it is."""

    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    chunks: tuple[int, ...] = ()
    codecs: tuple[str, ...] = ()


def walk(folder: pathlib.Path) -> Iterator[tuple[str, bool]]:
    """Yield the names in a folder and below, with True for folders, which come first; refuse links, pipes, devices."""
    left = [""]
    while left:
        inner = left.pop()
        try:
            entries = sorted(os.scandir(folder / inner), key=lambda entry: entry.name)
        except FileNotFoundError:
            continue   # a draft that has taken its place
        for entry in entries:
            name = f"{inner}/{entry.name}".lstrip("/")
            if entry.is_dir(follow_symlinks=False):
                left.append(name)
                yield name, True
            elif entry.is_file(follow_symlinks=False):
                yield name, False
            elif os.path.lexists(folder / name):
                what = "a link" if entry.is_symlink() else "a device or a pipe"
                raise InvalidInput(f"{folder / name}: cannot be read: it is {what}, not a file")


def claim_of(array: pathlib.Path) -> Claim:
    """Return what the metadata of an array claim; refuse what polhode does not write."""
    content = _files.read_json(array / "zarr.json", METADATA)
    try:
        grid = content["chunk_grid"]
        found = Claim(tuple(content["shape"]), np.dtype(content["data_type"]),
                      tuple(grid["configuration"]["chunk_shape"]), tuple(codec["name"] for codec in content["codecs"]))
        sizes = (*found.shape, *found.chunks)
        fits = (grid["name"] == "regular" and len(found.chunks) == len(found.shape) and set(found.codecs) <= CODECS
                and all(type(size) is int and size >= 0 for size in sizes) and not found.dtype.hasobject)
    except (LookupError, TypeError, ValueError, SyntaxError):
        fits = False
    if not fits:
        raise InvalidInput(f"{array / 'zarr.json'}: is damaged, or polhode did not write it")
    return found


def frame_size(head: bytes) -> int | None:
    """Return the bytes that a frame of Zstandard inflates to; None if it does not say (RFC 8878, section 3.1.1.1)."""
    if len(head) < 6 or head[:4] != b"\x28\xb5\x2f\xfd":
        return None
    single, code = head[4] >> 5 & 1, head[4] >> 6
    width = (single, 2, 4, 8)[code]
    start = 6 - single + (0, 1, 2, 4)[head[4] & 3]
    if width == 0 or len(head) < start + width:
        return None
    return int.from_bytes(head[start:start + width], "little") + 256 * (width == 2)


def require_chunk(file: pathlib.Path, claim: Claim) -> None:
    """Refuse a file of an array that has, or inflates to, other than the bytes of one chunk."""
    size = math.prod(claim.chunks) * claim.dtype.itemsize
    with _files.opened(file, _files.MESH) as (data, there):
        holds = frame_size(data.read(18)) if "zstd" in claim.codecs else there - 4 * ("crc32c" in claim.codecs)
    if holds != size:
        raise InvalidInput(f"{file}: must hold {size} bytes, got {'an unknown number' if holds is None else holds}")


# ---- saved motions


def require_saved(folder: pathlib.Path) -> dict[str, list[str]]:
    """Return the files of each array of a saved motion; refuse a folder with anything that `save` did not write."""
    if not folder.is_dir() or "polhode" not in attributes(folder):
        raise InvalidInput(f"path: {folder} is there and is not a saved motion")
    arrays: dict[str, list[str]] = {}
    others = []
    for name, is_folder in walk(folder):
        chunk = CHUNK.fullmatch(name)
        if is_folder and "/" not in name and (folder / name / "zarr.json").is_file():
            arrays[name] = []
        elif chunk and not is_folder:
            arrays.setdefault(chunk["name"], []).append(name)
        elif not (chunk or name == "zarr.json" or name.count("/") == 1 and name.endswith("/zarr.json")):
            others.append(name)
    if others:
        raise InvalidInput(f"path: {folder} holds {others[0]}, which polhode did not write")
    return arrays


def require_replaceable(target: pathlib.Path) -> None:
    """Refuse what is there and is no saved motion. Others may replace it meanwhile: then the new one is checked."""
    for _ in range(TRIES):
        before = _identity(target)
        if before is None:
            return
        try:
            require_saved(target)
            return
        except (InvalidInput, OSError):
            if _identity(target) == before:
                raise
    raise InvalidInput(f"path: {target} is being written by too many")


def _identity(path: pathlib.Path) -> tuple[int, int] | None:
    try:
        found = os.lstat(path)
    except FileNotFoundError:
        return None
    return found.st_dev, found.st_ino


def attributes(folder: pathlib.Path) -> dict[str, Any]:
    """Return the attributes of a group; empty without metadata."""
    if not os.path.lexists(folder / "zarr.json"):
        return {}
    if (folder / "zarr.json").is_symlink():
        raise InvalidInput(f"{folder / 'zarr.json'}: cannot be read: it is a link")
    content = _files.read_json(folder / "zarr.json", 2 * ABOUT)
    found = content.get("attributes") if isinstance(content, dict) else None
    return found if isinstance(found, dict) else {}


def put(draft: pathlib.Path, target: pathlib.Path) -> None:
    """Give a folder its name. A saved motion of this name is moved aside, and removed once the new one is in place.

    A process that ends in between leaves the older folder whole, under a name that ends in .old.
    """
    for _ in range(TRIES):   # threads that save to one name take turns
        old = None
        require_replaceable(target)
        if os.path.lexists(target):
            old = target.with_name(f"{target.name}.{uuid.uuid4().hex}.old")
            try:
                os.rename(target, old)
            except FileNotFoundError:
                continue
        try:
            os.rename(draft, target)
        except OSError as error:
            if error.errno in (errno.ENOTEMPTY, errno.EEXIST):
                _remove(old)
                continue
            if old is not None:
                os.rename(old, target)
            raise
        _remove(old)
        return
    raise InvalidInput(f"path: {target} is being written by too many")


def _remove(folder: pathlib.Path | None) -> None:
    """Remove the files of a saved motion and the folders that are then empty."""
    if folder is None:
        return
    with contextlib.suppress(InvalidInput, OSError):   # what came in meanwhile stays
        require_saved(folder)
        names = list(walk(folder))
        for name, is_folder in reversed(names):
            (os.rmdir if is_folder else os.unlink)(folder / name)
        os.rmdir(folder)

