"""Wrong keywords of plain functions: the error names what is likely meant, and what there is."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from . import _core

P = ParamSpec("P")
R = TypeVar("R")


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """Refuse keywords that the function does not have, as the compiled classes do. Adds one frame to the stack."""
    code = function.__code__
    names = code.co_varnames[:code.co_argcount + code.co_kwonlyargcount]

    @functools.wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        for key in kwargs:
            if key not in names:
                raise _core.InvalidInput(wrong(function.__qualname__.removesuffix(".__init__"), key, names))
        return function(*args, **kwargs)

    return call


def wrong(owner: str, key: str, names: tuple[str, ...]) -> str:
    """Return the message about a keyword that is not among the names."""
    import difflib  # for the error alone

    names = tuple(name for name in names if name not in ("self", "cls"))
    near = difflib.get_close_matches(key, names, 1, 0.5)
    hint = f", did you mean {near[0]!r}?" if near else f"; it has {', '.join(names)}"
    return f"{owner}: has no keyword {key!r}{hint}"
