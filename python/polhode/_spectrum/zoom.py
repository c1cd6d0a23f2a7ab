"""A shape of the table made finer, with both frequencies held: so that no body loses its phase over many turns.

The samples meet a curve of a body in two sums, of the part along the momentum and of the part across it. Fourier series
of the curve give both for all phases at once.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from .curve import PHASES
from .scan import STEP, Array, refine
from .shapes import Shapes, around, cell_of

Complex = npt.NDArray[np.complex128]

TOP = 8            # harmonics of a curve
HARMONICS = np.arange(-TOP, TOP + 1)
FINER = 5          # shapes along each side of a cell
ZOOMS = 5          # of cells, each half as wide as the last
NEAR = 0.7         # of what the samples could meet: a cell with less is left as it is, no body there fits


def series_of(curves: npt.NDArray[np.generic]) -> Complex:
    """Return the Fourier coefficients of the harmonics from -TOP to TOP of curves (bodies, PHASES, ...)."""
    return np.asarray(np.fft.fft(curves, axis=1)[:, HARMONICS] / PHASES)


def over_phases(rows: Complex) -> Complex:
    """Return the values at all phases of series (..., 2 TOP + 1)."""
    whole = np.zeros((*rows.shape[:-1], PHASES), dtype=complex)
    whole[..., HARMONICS % PHASES] = rows
    return np.asarray(np.fft.ifft(whole, axis=-1) * PHASES)


@dataclasses.dataclass(frozen=True)
class Sums:
    """Samples across the momentum (n, m) and along it (n, m), and what joins both sums to one number."""

    t: Array
    across: npt.NDArray[np.generic]
    along: Array
    join: Callable[[Array, Array], Array]

    def met(self, across: Complex, along: Complex, nu: float, kappa2: float) -> Array:
        """Return what bodies with series (bodies, 2 TOP + 1, m) meet at all phases, (bodies, PHASES)."""
        seen = np.exp(1j * np.outer(kappa2 + nu * HARMONICS, self.t)) @ self.across
        return self.join(np.abs(over_phases(np.einsum("bhj,hj->bh", across, seen))), self.met_along(along, nu))

    def met_along(self, along: Complex, nu: float) -> Array:
        """Return the part along the momentum, which does not depend on the precession."""
        seen = np.exp(1j * np.outer(nu * HARMONICS, self.t)) @ self.along
        return np.asarray(over_phases(np.einsum("bhj,hj->bh", along, seen)).real)


def zoom(sums: Sums, rows: Callable[[Shapes], tuple[Complex, Complex]], nu: float, kappa2: float, which: int,
         size: tuple[int, int]) -> tuple[Shapes, int, int, float]:
    """Return (shapes, the best of them, its phase, 2 kappa) in a cell of a table; `rows` gives series of shapes."""
    centre, half, sign = cell_of(*size, which)
    across, along = rows(around(centre, 0 * half, sign, 1)[0])
    for _ in range(ZOOMS):
        def best_of(trials: Array, across: Complex = across, along: Complex = along) -> Array:
            return np.array([sums.met(across, along, nu, float(f)).max() for f in trials])

        kappa2 = refine(best_of, kappa2, STEP / float(np.ptp(sums.t)), 4)
        shapes, places = around(centre, half, sign, FINER)
        every = rows(shapes)
        power = sums.met(*every, nu, kappa2)
        best = int(power.max(axis=1).argmax())
        centre, half = places[best], half / 2
        across, along = (part[best : best + 1] for part in every)
    return shapes, best, int(power[best].argmax()), kappa2
