"""xacro's macros, expanded by the xacro package where it is installed."""

from __future__ import annotations

import builtins
import contextlib
import io
import pathlib
from collections.abc import Iterator
from typing import Any

from ... import _files
from ..._core import InvalidInput
from .paths import Search


def expand(file: pathlib.Path, search: Search) -> bytes:
    """Return the URDF that a xacro file stands for. Packages and files are found in the folders of `search` alone.

    xacro evaluates the expressions in the file, by an evaluator of its own that knows no functions of Python's.

    Raises
    ------
    InvalidInput
        Without the xacro package, and for anything that xacro refuses.
    """
    _files.size_of(file, _files.TEXT)
    try:
        import xacro  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ImportError:
        raise InvalidInput(f"{file}: holds xacro's macros: expand them first (xacro robot.xacro > robot.urdf), or "
                           "install xacro") from None
    said = io.StringIO()
    try:
        with _within(xacro, search, file), contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
            document = xacro.process_file(str(file))
            return bytes(document.toxml(encoding="utf-8"))
    except (MemoryError, KeyboardInterrupt):
        raise
    except BaseException as error:   # xacro ends the program for some errors
        text = " ".join(str(error).split()) or type(error).__name__
        raise InvalidInput(f"{file}: xacro: {text[:200]}") from None


@contextlib.contextmanager
def _within(xacro: Any, search: Search, file: pathlib.Path) -> Iterator[None]:
    """Let xacro find packages where `search` does, and open no other files."""
    from xacro import substitution_args  # type: ignore[import-untyped, import-not-found, unused-ignore]

    def find(package: str) -> str:
        found = search.folder(package, file)
        if found is None:
            raise InvalidInput(f"package {package!r} not found: --package {package}=FOLDER gives the place")
        return str(found.absolute())

    def opened(name: Any, mode: str = "r", *more: Any, **options: Any) -> Any:
        if set(mode) & set("wax+"):
            raise InvalidInput(f"{str(name)[:60]!r} is not written")
        path = search.check(pathlib.Path(name), file)
        content = _files.read(path, _files.TEXT)
        if b"<!DOCTYPE" in content or b"<!ENTITY" in content:
            raise InvalidInput(f"{path} declares a document type or entities, which can blow up: refused")
        return builtins.open(path, mode, *more, **options)

    before = {name: getattr(substitution_args, name) for name in ("_eval_find",)}
    eval_dict = getattr(substitution_args, "_eval_dict", {})
    old = eval_dict.get("find")
    substitution_args._eval_find = find
    if "find" in eval_dict:
        eval_dict["find"] = find
    xacro.open = opened
    try:
        yield
    finally:
        for name, value in before.items():
            setattr(substitution_args, name, value)
        if old is not None:
            eval_dict["find"] = old
        del xacro.open
