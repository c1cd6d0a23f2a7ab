"""Files, read with limits and written whole."""

from __future__ import annotations

import contextlib
import os
import pathlib
import stat
from collections.abc import Iterator

from ._core import InvalidInput

TEXT = 64_000_000         # bytes of a scene, a robot, a glTF description; they take thousands
MESH = 4_000_000_000      # bytes of a mesh: eighty million triangles


def to_path(source: object, name: str) -> pathlib.Path:
    """Return the path; refuse what is none, with the name of the argument."""
    if not isinstance(source, (str, os.PathLike)):
        raise InvalidInput(f"{name}: must be a path, got {type(source).__name__}")
    text = os.fspath(source)
    if not isinstance(text, str):
        raise InvalidInput(f"{name}: must be a path of text, got {type(text).__name__}")
    if "\0" in text:
        raise InvalidInput(f"{name}: must be a path without null characters, got {text!r}")
    return pathlib.Path(text)


def is_file(path: pathlib.Path) -> bool:
    """Return True for a regular file; False too where the name is none for the system, such as one that is too long."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def size_of(path: pathlib.Path, most: int) -> int:
    """Return the size of a regular file [bytes]; refuse devices, pipes, and files above `most`."""
    to_path(path, str(path).replace("\0", "?"))
    try:
        found = os.stat(path)
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be read: {error.strerror}") from None
    if not stat.S_ISREG(found.st_mode):
        what = "a folder" if stat.S_ISDIR(found.st_mode) else "a device or a pipe"
        raise InvalidInput(f"{path}: cannot be read: it is {what}, not a file")
    if found.st_size > most:
        raise InvalidInput(f"{path}: must be at most {most // 1_000_000} MB, got {found.st_size} bytes")
    return found.st_size


def read(path: pathlib.Path, most: int) -> bytes:
    """Return the bytes of a regular file of at most `most` bytes; raise InvalidInput for any other."""
    size = size_of(path, most)
    try:
        with open(path, "rb") as file:
            return file.read(size)   # Python reserves what is asked for
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be read: {error.strerror}") from None


@contextlib.contextmanager
def whole(path: pathlib.Path) -> Iterator[pathlib.Path]:
    """Give a draft to write, which takes the file's place when it is whole; on an error the old file stays.

    The draft has the file's suffix. Links are followed. What is there and is no regular file, is written itself.
    """
    target = pathlib.Path(os.path.realpath(path))
    if target.exists() and not target.is_file():
        yield target
        return
    draft = target.with_name(f".{target.stem[:100]}.{os.getpid()}.draft{target.suffix}")
    try:
        yield draft
        with open(draft, "rb+") as written:
            os.fsync(written.fileno())   # some systems tell only now that the disk is full
        if target.exists():
            draft.chmod(stat.S_IMODE(target.stat().st_mode))
        os.replace(draft, target)
    except BaseException:
        with contextlib.suppress(OSError):
            draft.unlink()
        raise


def write(path: pathlib.Path, content: str | bytes) -> None:
    """Write a file whole or not at all."""
    with whole(path) as draft:
        draft.write_bytes(content.encode() if isinstance(content, str) else content)
