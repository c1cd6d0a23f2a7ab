"""Bodies of uniform density: `polhode.shapes.box(mass, half_sides)` and so on, each a `MassProperties`.

Heights are full heights. The symmetry axis is z. The centre of mass is at the origin unless the shape says otherwise.

The functions, their signatures and docstrings are made from the list of shapes of the core.
"""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable
from typing import Any

import numpy.typing as npt  # noqa: F401  the annotations name it

from . import _core
from ._core import MassProperties

_Parameters = tuple[tuple[str, tuple[int, ...], str], ...]


def _docstring(doc: str, parameters: _Parameters) -> str:
    lines = [*textwrap.wrap(doc, 110), "", "Parameters", "----------"]
    for name, size, meaning in parameters:
        lines += [f"{name} : " + (f"array_like, shape {size}" if size else "float"), f"    {meaning}"]
    lines += ["", "Returns", "-------", "MassProperties", "", "Raises", "------", "InvalidInput"]
    return "\n".join([*lines, "    A mass or a length that is not positive and finite, or a wrong shape."])


def _signature(parameters: _Parameters) -> inspect.Signature:
    kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
    return inspect.Signature(
        [inspect.Parameter(p, kind, annotation="npt.ArrayLike" if size else float) for p, size, _ in parameters],
        return_annotation=MassProperties,
    )


def _bind(name: str, parameters: _Parameters, args: tuple[Any, ...], named: dict[str, Any]) -> dict[str, Any]:
    try:
        return dict(_signature(parameters).bind(*args, **named).arguments)
    except TypeError as error:
        raise TypeError(f"{name}({', '.join(p for p, _, _ in parameters)}): {error}") from None


def _make(name: str, doc: str, parameters: _Parameters) -> Callable[..., MassProperties]:
    signature = _signature(parameters)

    def shape(*args: Any, **kwargs: Any) -> MassProperties:
        values = _bind(name, parameters, args, kwargs)
        return _core.make_shape(name, [values[p] for p, _, _ in parameters])

    shape.__name__ = shape.__qualname__ = name
    shape.__doc__ = _docstring(doc, parameters)
    shape.__annotations__ = {p: parameter.annotation for p, parameter in signature.parameters.items()}
    shape.__annotations__["return"] = MassProperties
    shape.__signature__ = signature  # type: ignore[attr-defined]
    return shape


def volume(shape: str, /, *sizes: Any, **named: Any) -> float:
    """Return the volume of a shape [m^3], for its mass by a density: `box(2700 * volume("box", sides), sides)`.

    Parameters
    ----------
    shape : str
        The name of the shape.
    *sizes, **named
        The parameters of the shape after its mass.

    Raises
    ------
    InvalidInput
        For a thin or unknown shape, and for parameters that the shape refuses.
    """
    for name, _, parameters in _core.shape_records():
        if name == shape:
            values = _bind(name, parameters, (1.0, *sizes), named)
            return _core.shape_volume(name, [values[p] for p, _, _ in parameters])
    raise _core.InvalidInput(f"shape: must be one of {', '.join(_functions)}; got {shape!r}")


def table() -> str:
    """Return the shapes as a Markdown table with name, parameters and description."""
    rows = ["| shape | parameters | body |", "|---|---|---|"]
    for name, doc, parameters in _core.shape_records():
        meanings = "; ".join(f"`{p}`: {meaning}" for p, _, meaning in parameters[1:])
        rows.append(f"| `{name}` | {meanings} | {doc} |")
    return "\n".join(rows)


_functions = {name: _make(name, doc, parameters) for name, doc, parameters in _core.shape_records()}
globals().update(_functions)
__all__ = [*_functions, "table", "volume"]


def __getattr__(name: str) -> Callable[..., MassProperties]:  # for type checkers; only wrong names come here
    raise AttributeError(f"no shape '{name}'; there are {', '.join(_functions)}")
