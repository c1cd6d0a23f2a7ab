"""Files, read with limits and written whole."""

from __future__ import annotations

import contextlib
import json
import os
import pathlib
import stat
import uuid
from collections.abc import Iterator
from typing import Any, BinaryIO, TextIO

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
        return _checked(os.stat(path), path, most)
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be read: {error.strerror}") from None


def _checked(found: os.stat_result, path: pathlib.Path, most: int) -> int:
    if not stat.S_ISREG(found.st_mode):
        what = "a folder" if stat.S_ISDIR(found.st_mode) else "a device or a pipe"
        raise InvalidInput(f"{path}: cannot be read: it is {what}, not a file")
    if found.st_size > most:
        raise InvalidInput(f"{path}: must be at most {most // 1_000_000} MB, got {found.st_size} bytes")
    return found.st_size


@contextlib.contextmanager
def opened(path: pathlib.Path, most: int) -> Iterator[tuple[BinaryIO, int]]:
    """Give a regular file of at most `most` bytes, open for reading, and its size; raise InvalidInput for any other."""
    size_of(path, most)   # a device is not opened
    try:
        # What took the file's place since then is looked at again. A pipe without a writer would wait for ever.
        handle = os.open(path, os.O_RDONLY | _flag("O_NONBLOCK", "O_CLOEXEC", "O_NOCTTY", "O_BINARY"))
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be read: {error.strerror}") from None
    with open(handle, "rb") as file:
        yield file, _checked(os.fstat(handle), path, most)


def _flag(*names: str) -> int:
    """Return the flags of `os.open` that this system knows."""
    return sum(getattr(os, name, 0) for name in names)


def read(path: pathlib.Path, most: int) -> bytes:
    """Return the bytes of a regular file of at most `most` bytes; raise InvalidInput for any other."""
    try:
        with opened(path, most) as (file, size):
            return file.read(size)   # Python reserves this size
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be read: {error.strerror}") from None


def read_json(path: pathlib.Path, most: int) -> Any:
    """Return the content of a file of JSON; raise InvalidInput for any other."""
    try:
        return json.loads(read(path, most))
    except RecursionError:
        raise InvalidInput(f"{path}: is damaged: lists are nested too deep") from None
    except ValueError as error:   # of JSON, of UTF-8, of integers with thousands of digits
        if isinstance(error, InvalidInput):
            raise
        raise InvalidInput(f"{path}: is damaged: it is no JSON") from None


def draft_of(name: str) -> str:
    """Return a name that no other thread or process uses, with the file's suffix."""
    return f".{uuid.uuid4().hex}.draft{pathlib.PurePath(name).suffix}"


@contextlib.contextmanager
def whole(path: pathlib.Path, follow: bool = True) -> Iterator[pathlib.Path]:
    """Give a draft to write, which takes the file's place when it is whole; on an error the old file stays.

    The draft has the file's suffix. With `follow`, for names that the caller gave, links are followed, and what is
    there and is no regular file is written itself. Without, for names that polhode chose, both are refused.
    """
    target = pathlib.Path(os.path.realpath(path)) if follow else path
    if not follow:
        require_replaceable(target)
    elif target.exists() and not target.is_file():
        yield target
        return
    draft = target.with_name(draft_of(target.name))
    try:
        yield draft
        with open(draft, "rb+") as written:
            os.fsync(written.fileno())   # some systems report only now that the disk is full
        if target.exists():
            draft.chmod(target.stat().st_mode & 0o777)
        os.replace(draft, target)
    except BaseException:
        with contextlib.suppress(OSError):
            draft.unlink()
        raise


def write(path: pathlib.Path, content: str | bytes, follow: bool = True) -> None:
    """Write a file whole or not at all; `follow` as in `whole`."""
    with whole(path, follow) as draft:
        draft.write_bytes(content.encode() if isinstance(content, str) else content)


def require_free(path: pathlib.Path) -> None:
    """Refuse a name that something has, a link without an end too."""
    if os.path.lexists(path):
        raise InvalidInput(f"{path}: is not written: something stands there, and nothing is overwritten")


def create(path: pathlib.Path, content: str | bytes) -> None:
    """Write a new file whole or not at all. What has the name already stays, and is never followed."""
    require_free(path)
    draft = path.with_name(draft_of(path.name))
    try:
        draft.write_bytes(content.encode() if isinstance(content, str) else content)
        with open(draft, "rb+") as written:
            os.fsync(written.fileno())
        try:
            os.link(draft, path)   # fails where a file came since the look, which a rename would replace
        except FileExistsError:
            require_free(path)
        except OSError:   # a file system without links
            require_free(path)
            os.rename(draft, path)
    finally:
        with contextlib.suppress(OSError):
            draft.unlink()


def require_replaceable(path: pathlib.Path, handle: int | None = None) -> None:
    """Refuse to write where a link or what is no regular file stands; `handle` is the folder of a bare name."""
    name = path if handle is None else path.name
    with contextlib.suppress(FileNotFoundError):
        mode = os.stat(name, dir_fd=handle, follow_symlinks=False).st_mode
        if not stat.S_ISREG(mode):
            what = "a link" if stat.S_ISLNK(mode) else "a folder" if stat.S_ISDIR(mode) else "a device or a pipe"
            raise InvalidInput(f"{path}: is not written: {what} stands there")


def open_log(path: pathlib.Path) -> TextIO:
    """Open a file to append lines. A link, or what is no regular file, is refused."""
    require_replaceable(path)
    flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | _flag("O_NOFOLLOW", "O_NONBLOCK", "O_CLOEXEC")
    handle = os.open(path, flags, 0o666)
    try:
        _checked(os.fstat(handle), path, 2**62)
        return open(handle, "a", encoding="utf-8")
    except BaseException:
        os.close(handle)
        raise


# ---- below a folder that may come from anyone


@contextlib.contextmanager
def _folder(root: pathlib.Path, folders: tuple[str, ...]) -> Iterator[int | None]:
    """Give the open folder root/folders, reached without a link below the root; None where the system has no such."""
    place, flags = root, os.O_RDONLY | _flag("O_DIRECTORY", "O_CLOEXEC")
    handle = os.open(root, flags) if os.open in os.supports_dir_fd else None
    try:
        for name in folders:
            place /= name
            if handle is None:
                if place.is_symlink() or place.resolve().name != name:
                    raise InvalidInput(f"{place}: is not entered: it is a link")
                continue
            try:
                inner = os.open(name, flags | os.O_NOFOLLOW, dir_fd=handle)
            except OSError:
                raise InvalidInput(f"{place}: is not entered: it is a link, or no folder") from None
            os.close(handle)
            handle = inner
        yield handle
    finally:
        if handle is not None:
            os.close(handle)


def read_below(root: pathlib.Path, inner: pathlib.PurePath, most: int) -> bytes:
    """Return the bytes of the regular file root/inner. Links below the root are refused, the file itself among them."""
    path = root / inner
    with _folder(root, inner.parts[:-1]) as handle:
        if path.is_symlink():
            raise InvalidInput(f"{path}: is not read: it is a link")
        try:
            file = os.open(path if handle is None else inner.name, os.O_RDONLY | _flag("O_NOFOLLOW", "O_NONBLOCK",
                           "O_CLOEXEC", "O_BINARY"), dir_fd=handle)
        except OSError as error:
            raise InvalidInput(f"{path}: is not read: {error.strerror}") from None
    with open(file, "rb") as opened_file:
        return opened_file.read(_checked(os.fstat(file), path, most))


def write_below(root: pathlib.Path, inner: pathlib.PurePath, data: bytes) -> None:
    """Write the file root/inner whole or not at all, through no link below the root.

    The new file takes the name's place. So another name of the old file (a hard link) keeps the old content, and what
    comes to stand there between the look and the writing is replaced and never followed.
    """
    with _folder(root, inner.parts[:-1]) as handle:
        path = root / inner
        require_replaceable(path, handle)
        draft: str | pathlib.Path = draft_of(inner.name)
        name: str | pathlib.Path = inner.name
        if handle is None:
            draft, name = path.with_name(str(draft)), path
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | _flag("O_NOFOLLOW", "O_CLOEXEC", "O_BINARY")
        file = os.open(draft, flags, 0o666, dir_fd=handle)
        try:
            with open(file, "wb") as opened_file:
                opened_file.write(data)
                opened_file.flush()
                os.fsync(file)
            os.replace(draft, name, src_dir_fd=handle, dst_dir_fd=handle)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(draft, dir_fd=handle)
            raise
