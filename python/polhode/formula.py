"""Functions for torques that are traced into formulas. They take numbers, too."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._core import symbols as _core
from ._formula import symbols as _symbols

__all__ = ["clip", "norm", "to_body", "to_space", "where"]


def _is_traced(*values: Any) -> bool:
    return any(isinstance(v, _symbols.Symbol) or np.asarray(v).dtype == object for v in values)


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
        q, items = _symbols.numbers_of(attitude), _symbols.numbers_of(v)
        return np.stack([_symbols.Symbol(item) for item in _core.to_body(list(q), list(items))])
    R, vector = _rotation(np.asarray(attitude, float)), np.asarray(v, float)
    return np.array([sum(R[i][j] * vector[i] for i in range(3)) for j in range(3)])


def to_space(attitude: Any, v: Any) -> Any:
    """Return a vector of body axes in space axes, R_WB v.

    Parameters
    ----------
    attitude : array_like, shape (4,)
        Unit quaternion (x, y, z, w), or its symbols.
    v : array_like, shape (3,)
        In body axes.

    Returns
    -------
    ndarray or symbols, shape (3,)
        In space axes.
    """
    traced = _is_traced(attitude, v)
    R = _rotation(attitude if traced else np.asarray(attitude, float))
    rows = [sum(R[i][j] * v[j] for j in range(3)) for i in range(3)]
    return np.stack(rows)


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
    vector = np.asarray(v, float)
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
    return np.where(condition, a, b)


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
    return _symbols._clip(a, low, high) if _is_traced(a, low, high) else np.clip(a, low, high)
