"""Jacobi's elliptic functions on the complementary pair (m, m1), m = k^2 and m1 = 1 - m.

Near m = 1 the difference 1 - m loses its digits in floating point, so functions take both numbers. The smaller of the
two is taken as exact. Leave m1 out if you know m itself.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._attitude.arrays import to_numbers

__all__ = ["K", "jacobi", "nome"]


def _flat(names: tuple[str, ...], values: tuple[npt.ArrayLike, ...]) -> tuple[tuple[int, ...], list[Any]]:
    arrays = [to_numbers(value, name) for name, value in zip(names, values, strict=True)]
    try:
        arrays = list(np.broadcast_arrays(*arrays))
    except ValueError:
        shapes = ", ".join(str(a.shape) for a in arrays)
        raise _core.InvalidInput(f"{names[-1]}: must broadcast with the others, got shapes {shapes}") from None
    return arrays[0].shape, [a.ravel() for a in arrays]


def _pair(m: npt.ArrayLike, m1: npt.ArrayLike | None) -> tuple[npt.ArrayLike, npt.ArrayLike]:
    return (m, 1.0 - to_numbers(m, "m")) if m1 is None else (m, m1)


def _of_parameter(function: Any, m: npt.ArrayLike, m1: npt.ArrayLike | None) -> Any:
    shape, flat = _flat(("m", "m1"), _pair(m, m1))
    return function(*flat).reshape(shape)[()]


def jacobi(u: npt.ArrayLike, m: npt.ArrayLike, m1: npt.ArrayLike | None = None) -> tuple[Any, Any, Any]:
    """Return Jacobi's elliptic functions sn, cn and dn.

    Parameters
    ----------
    u : array_like
        Argument, at most 1e15 K.
    m, m1 : array_like
        Parameter k^2 and its complement, in [0, 1], m + m1 = 1 to rounding; they broadcast with u. By default
        m1 = 1 - m.

    Returns
    -------
    sn, cn, dn : ndarray
        Of the broadcast shape; each within 4 units in the last place (measured: 1), as far as 1e-30 abs(u) in the
        argument allows at the zeros.

    Raises
    ------
    InvalidInput
        Outside these ranges, or shapes that do not broadcast.

    Notes
    -----
    Theta quotients (NIST Handbook, dlmf.nist.gov 22.2) in double-double, with the nome of the smaller of m and m1.
    """
    shape, flat = _flat(("u", "m", "m1"), (u, *_pair(m, m1)))
    sn, cn, dn = _core._jacobi(*flat)
    return sn.reshape(shape)[()], cn.reshape(shape)[()], dn.reshape(shape)[()]


def K(m: npt.ArrayLike, m1: npt.ArrayLike | None = None) -> Any:
    """Return the complete elliptic integral of the first kind; infinite for m1 = 0.

    Parameters
    ----------
    m, m1 : array_like
        As for `jacobi`.

    Returns
    -------
    ndarray
        K(m), rounded once.
    """
    return _of_parameter(_core._complete_K, m, m1)


def nome(m: npt.ArrayLike, m1: npt.ArrayLike | None = None) -> Any:
    """Return the nome q = exp(-pi K(m1) / K(m)).

    Parameters
    ----------
    m, m1
        As for `jacobi`.

    Returns
    -------
    ndarray
        q in [0, 1]; it keeps its relative accuracy down to m of 1e-300.
    """
    return _of_parameter(_core._nome, m, m1)
