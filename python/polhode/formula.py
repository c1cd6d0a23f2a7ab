"""Functions for torques that are traced into formulas. They take numbers, too."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._core import InvalidInput
from ._core import symbols as _core
from ._formula import symbols as _symbols

__all__ = ["clip", "friction", "norm", "to_body", "to_space", "where"]


def _is_traced(*values: Any) -> bool:
    for value in values:
        if isinstance(value, _symbols.Symbol):
            return True
        try:
            items = np.asarray(value)
        except Exception:   # refused where it is used
            continue
        if items.dtype == object and any(isinstance(item, _symbols.Symbol) for item in items.ravel()):
            return True
    return False


def _numbers(value: Any, name: str, *shape: int) -> Any:
    try:
        array = np.asarray(value, float)
    except Exception:
        raise InvalidInput(f"{name}: must be real numbers, got {type(value).__name__}") from None
    if shape and array.shape != shape:
        raise InvalidInput(f"{name}: must have shape {shape}, got {array.shape}")
    return array


def _require(value: Any, name: str, count: int) -> None:
    if _symbols.numbers_of(value).shape != (count,):
        raise InvalidInput(f"{name}: must have shape ({count},), got {_symbols.numbers_of(value).shape}")


def _rotation(q: Any) -> list[list[Any]]:
    x, y, z, w = (q[i] for i in range(4))
    return [[w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z]]


def to_body(attitude: Any, v: Any) -> Any:
    """Return a vector of space axes in body axes, R_WB^T v.

    Parameters
    ----------
    attitude : array_like, shape (4,)
        Unit quaternion (x, y, z, w), or its symbols.
    v : array_like, shape (3,)
        In space axes.

    Returns
    -------
    ndarray or symbols, shape (3,)
        In body axes.
    """
    if _is_traced(attitude, v):
        _require(attitude, "attitude", 4)
        _require(v, "v", 3)
        q, items = _symbols.numbers_of(attitude), _symbols.numbers_of(v)
        return _symbols.joined(_core.to_body(list(q), list(items)))
    R, vector = _rotation(_numbers(attitude, "attitude", 4)), _numbers(v, "v", 3)
    return np.array([sum(R[i][j] * vector[i] for i in range(3)) for j in range(3)])


def to_space(attitude: Any, v: Any) -> Any:
    """Return a vector of body axes in space axes, R_WB v.

    Parameters
    ----------
    attitude, v
        As for `to_body`; v is in body axes.

    Returns
    -------
    ndarray or symbols, shape (3,)
        In space axes.
    """
    if not _is_traced(attitude, v):
        attitude, v = _numbers(attitude, "attitude", 4), _numbers(v, "v", 3)
    _require(attitude, "attitude", 4)
    _require(v, "v", 3)
    R = _rotation(attitude)
    rows = [sum(R[i][j] * v[j] for j in range(3)) for i in range(3)]
    return np.array(rows) if not _is_traced(*rows) else _symbols.joined([_symbols.numbers_of(row)[()] for row in rows])


def norm(v: Any, smooth: float = 0.0) -> Any:
    """Return sqrt(v . v + smooth^2). With `smooth` above 0 it has derivatives where v is 0.

    Parameters
    ----------
    v : array_like, shape (n,)
        A vector, or its symbols.
    smooth : float
        In the unit of v.

    Returns
    -------
    float or symbol
        The length.
    """
    if _is_traced(v):
        return _symbols.norm(v, smooth)
    vector, smooth = _numbers(v, "v").ravel(), float(_numbers([smooth], "smooth", 1)[0])
    return float(np.sqrt(vector @ vector + smooth * smooth))


def where(condition: Any, a: Any, b: Any) -> Any:
    """Return a where the condition holds, else b, as `numpy.where` does.

    Parameters
    ----------
    condition : bool, array_like of bool, or a comparison of symbols
        What chooses.
    a, b : array_like
        Both are computed.

    Returns
    -------
    ndarray or symbols
        The choice.
    """
    if isinstance(condition, _symbols.Condition) or _is_traced(a, b):
        return _symbols._where(condition, a, b)
    try:
        return np.where(condition, a, b)
    except Exception as error:
        raise InvalidInput(f"where: must have arrays that fit, got what numpy.where refuses: {error}") from None


def friction(load: Any, rate: Any) -> Any:
    """Return dry friction: minus the load times the sign of the rate.

    Where the rate comes to 0, friction in a formula holds it there as long as the load is enough, and lets go then.
    The rate must be one that the friction slows down.

    Parameters
    ----------
    load : array_like
        The largest friction [N m], 0 or positive.
    rate : array_like
        What it slows down, as a component of omega [rad/s].

    Returns
    -------
    ndarray or symbols
        A torque along the axis of the rate [N m]. Of numbers it is `load` where the rate is 0.
    """
    if _is_traced(load, rate):
        return _symbols.friction(load, rate)
    return where(_numbers(rate, "rate") > 0, -_numbers(load, "load"), load)


def clip(a: Any, low: Any, high: Any) -> Any:
    """Return a within limits, as `numpy.clip` does.

    Parameters
    ----------
    a, low, high : array_like
        A value and its limits, or symbols.

    Returns
    -------
    ndarray or symbols
        min(max(a, low), high).
    """
    if _is_traced(a, low, high):
        return _symbols._clip(a, low, high)
    try:
        return np.clip(a, low, high)
    except Exception as error:
        raise InvalidInput(f"clip: must have arrays that fit, got what numpy.clip refuses: {error}") from None
