"""The derivatives of a motion, by column."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from .._attitude.arrays import is_one_of, require_text
from .._core import InvalidInput

Array = npt.NDArray[np.float64]
_NAMES = {"omega": "xyz", "attitude": "xyz", "axes": "xyz", "inertia": "123"}


def to_names(wrt: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names of groups as a tuple."""
    names = (wrt,) if isinstance(wrt, str) else tuple(wrt) if isinstance(wrt, Sequence) else ()
    if not names or not all(isinstance(name, str) for name in names):
        raise InvalidInput(f"wrt: must be names such as 'omega' or ('omega', 'inertia'), got {wrt!r}")
    for name in names:
        require_text(name, "wrt")
    return names


def name_columns(wrt: str | Sequence[str]) -> tuple[str, ...]:
    """Return a name for each column: 'omega_x' to 'omega_z', 'inertia_1' to 'inertia_3' and so on."""
    return tuple(f"{group}_{part}" if part else group for group in to_names(wrt) for part in _NAMES.get(group, [""]))


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Sensitivity:
    """A motion and its derivatives at some times.

    Attributes
    ----------
    omega : ndarray, shape (..., 3)
        Angular velocity in body axes [rad/s].
    attitude : ndarray, shape (..., 4)
        Body to space, unit, (x, y, z, w).
    d_omega : ndarray, shape (..., 3, n)
        Derivatives of omega in body axes, one column for each parameter.
    d_attitude : ndarray, shape (..., 3, n)
        The small rotations of the attitude R [rad]: exp(d theta) R for side 'space', R exp(d theta) for 'body'.
    columns : tuple of str
        The names of the columns.
    side : {'space', 'body'}
        The axes of the small rotations, those of the attitude at t = 0 included.
    error : ndarray, shape (n,), or None
        The estimated error of each column relative to its size, where the motion was integrated with a certificate.
    d_states : dict of ndarray, shape (..., n) or (..., k, n)
        Derivatives of the states of the scene's formulas, by name; empty without any.
    uncertain : str
        Which branch of a controller's law is not certain, and at which tick; empty if all are. The errors are then
        infinite.

    Notes
    -----
    The size of a column is the larger of abs(d omega) / abs(omega(0)) and the angle of the small rotation. Where the
    motion was integrated, the largest abs(omega) of start and samples stands in the place of abs(omega(0)). The error
    covers the derivatives of states, relative to the largest of each in the motion.
    """

    omega: Array
    attitude: Array
    d_omega: Array
    d_attitude: Array
    columns: tuple[str, ...]
    side: str = "space"
    error: Array | None = None
    d_states: dict[str, Array] = dataclasses.field(default_factory=dict)
    uncertain: str = ""

    def column(self, name: str) -> tuple[Array, Array]:
        """Return (d omega, d attitude) of one column, each of shape (..., 3)."""
        if not is_one_of(name, self.columns):
            raise InvalidInput(f"name: must be among the columns {', '.join(self.columns)}, got {name!r}")
        k = self.columns.index(name)
        return self.d_omega[..., k], self.d_attitude[..., k]

    @property
    def transition(self) -> Array:
        """(..., 6, 6): d (omega, attitude) at t by d (omega, attitude) at t = 0; needs both groups."""
        wanted = name_columns(("omega", "attitude"))
        if not set(wanted) <= set(self.columns):
            raise InvalidInput("transition: needs the columns of 'omega' and 'attitude', got "
                               f"{', '.join(self.columns)}; ask for wrt=('omega', 'attitude')")
        which = [self.columns.index(name) for name in wanted]
        return np.concatenate([self.d_omega[..., which], self.d_attitude[..., which]], axis=-2)

    def __repr__(self) -> str:
        shape = self.omega.shape[:-1]
        return f"Sensitivity(shape={shape}, columns={self.columns}, side={self.side!r})"


def of_groups(omega: Array, attitude: Array, d_omega: Array, d_attitude: Array, wrt: str | Sequence[str],
              side: str) -> Sensitivity:
    """Make the result from the names of groups."""
    return Sensitivity(omega, attitude, d_omega, d_attitude, name_columns(wrt), side)
