"""`AttitudeEphemeris`: attitudes at knots, and how they are interpolated."""

from __future__ import annotations

import dataclasses
import datetime

import numpy as np
import numpy.typing as npt

from .._core import InvalidInput
from . import interpolate
from .interpolate import Floats


@dataclasses.dataclass(frozen=True)
class AttitudeEphemeris:
    """Attitudes at knots, with the interpolation that a file states for its readers.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Times after the epoch [s]. Where two segments meet, both may have the time.
    attitude : ndarray, shape (n, 4)
        Unit quaternions (x, y, z, w), body to space.
    error : float
        The largest angle between the interpolated attitude and the true motion [rad], as the file states it; NaN if it
        states none.
    epoch : datetime.datetime
        The instant of t = 0, without a time zone: `time_system` says which clock it is of.
    time_system : str
        Such as "UTC" or "TDB".
    frame : str
        The name of the space axes, such as "EME2000".
    name : str
        The name of the body.
    method : {"lagrange", "linear"}
    degree : int
        The degree of the polynomials.
    cut : bool
        Next to the ends of a segment the polynomials have a lower degree, as in SPICE.
    segments : tuple of (int, int)
        The first row of each segment, and the row after its last. No interpolation crosses the end of a segment.
    """

    t: Floats
    attitude: Floats
    error: float
    epoch: datetime.datetime
    time_system: str = "UTC"
    frame: str = "EME2000"
    name: str = "BODY"
    method: str = "lagrange"
    degree: int = 7
    cut: bool = False
    segments: tuple[tuple[int, int], ...] = ()

    def __post_init__(self) -> None:
        if not self.segments:
            object.__setattr__(self, "segments", ((0, len(self.t)),))

    def __call__(self, t: npt.ArrayLike) -> Floats:
        """Return the attitudes at times as a reader of the file interpolates them.

        Parameters
        ----------
        t : array_like, shape (m,)
            Times after the epoch [s]. Where two segments meet, the later one counts.

        Returns
        -------
        ndarray, shape (m, 4)
            Unit quaternions (x, y, z, w), body to space.

        Raises
        ------
        InvalidInput
            For a time that no segment covers.
        """
        at = np.atleast_1d(np.asarray(t, dtype=float))
        result = np.full((at.size, 4), np.nan)
        for first, last in self.segments:
            knots = self.t[first:last]
            inside = (at >= knots[0]) & (at <= knots[-1])
            if inside.any():
                result[inside] = interpolate.lagrange(knots, self.attitude[first:last], at[inside], self.degree,
                                                       self.cut)
        if missing := at[np.isnan(result[:, 0])].tolist():
            raise InvalidInput(f"t: must be within a segment, got {missing[0]!r} s")
        return result

    def __repr__(self) -> str:
        stated = "no stated error" if np.isnan(self.error) else f"error at most {self.error:.3e} rad"
        many = f" in {len(self.segments)} segments" if len(self.segments) > 1 else ""
        return (f"AttitudeEphemeris({self.name}: {len(self.t)} knots{many} from {self.epoch.isoformat()} "
                f"{self.time_system}, {self.method} of degree {self.degree}, {stated})")
