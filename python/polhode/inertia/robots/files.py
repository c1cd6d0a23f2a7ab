"""The files of a call: given ones, and those in given folders."""

from __future__ import annotations

import os
import pathlib
import re
from collections.abc import Iterator, Sequence

from ..._core import InvalidInput
from .formats import FORMATS, SHARED, SUFFIXES

STDIN = "-"
MOST = 1_000_000     # files of one call
_SKIPPED = {".git", ".hg", ".svn", "__pycache__", "node_modules", ".venv"}
_ROOT = re.compile(rb"<(?![?!])\s*([A-Za-z_:][\w:.-]*)")


def gather(paths: Sequence[str | os.PathLike[str]]) -> Iterator[tuple[pathlib.Path, bool]]:
    """Give each file once, with whether it was named itself. In folders, files of other kinds are passed over."""
    seen: set[str] = set()
    for given in paths:
        path = pathlib.Path(given)
        found = [(path, True)] if not path.is_dir() else [(file, False) for file in _walk(path)]
        for file, named in found:
            if str(file) not in seen:
                seen.add(str(file))
                yield file, named
        if len(seen) > MOST:
            raise InvalidInput(f"{given}: must hold at most {MOST} robot descriptions")


def _walk(folder: pathlib.Path) -> Iterator[pathlib.Path]:
    for place, folders, names in os.walk(folder):   # links to folders are not followed
        folders[:] = sorted(name for name in folders if name not in _SKIPPED)
        for name in sorted(names):
            file = pathlib.Path(place, name)
            if file.suffix.lower() in SUFFIXES and file.is_file() and _is_robot(file):
                yield file


def _is_robot(file: pathlib.Path) -> bool:
    """Decide by the first element; a suffix of its own is enough."""
    if file.suffix.lower() not in SHARED:
        return True
    try:
        with open(file, "rb") as opened:
            head = opened.read(20_000)
    except OSError:
        return False
    found = _ROOT.search(re.sub(rb"<!--.*?(-->|\Z)", b"", head, flags=re.S))
    return found is not None and any(found[1].decode() in format.roots for format in FORMATS.values())
