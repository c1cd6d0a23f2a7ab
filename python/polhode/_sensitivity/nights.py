"""Scales and offsets that belong to groups of samples, found by least squares inside the residuals.

The residuals are those of scale * model + offset with the best scale and offset of each group, and their derivatives
include the derivatives of these (variable projection: Golub and Pereyra 1973). A scale is never negative.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


class Nights:
    """Samples y with weights 1 / sigma in groups 0, 1, ..., and which numbers each group has of its own."""

    def __init__(self, y: Array, weight: Array, night: npt.NDArray[np.intp], scale: bool, offset: bool) -> None:
        self.y, self.weight, self.night, self.scale, self.offset = y, weight, night, scale, offset
        self.members = np.zeros((len(y), int(night.max(initial=-1)) + 1))
        self.members[np.arange(len(y)), night] = 1

    @property
    def independent(self) -> int:
        """The samples less the scales and offsets, never below 0 in a group."""
        return int(np.maximum(self.members.sum(axis=0) - int(self.scale) - int(self.offset), 0).sum())

    def _sums(self, values: Array) -> Array:
        """Return the sums over the samples of each group, (..., groups)."""
        return np.asarray(values @ self.members)

    def _centred(self, values: Array) -> Array:
        """Return weighted values (..., n) less what an offset takes."""
        if not self.offset:
            return values
        means = self._sums(values * self.weight) / self._sums(self.weight**2)
        return np.asarray(values - self.weight * means[..., self.night])

    def matched(self, model: Array) -> tuple[Array, Array, Array]:
        """Return the scale of each group, (..., groups), and centred model and residuals over sigma, (..., n)."""
        f, y = self._centred(model * self.weight), self._centred(self.y * self.weight)
        size = self._sums(f * f)
        if self.scale:
            known = size > 1e-24 * self._sums((model * self.weight) ** 2)
            factor = np.where(known, np.maximum(self._sums(f * y), 0) / np.maximum(size, 1e-300), 0.0)
        else:
            factor = np.ones_like(size)
        return factor, f, factor[..., self.night] * f - y

    def rows(self, model: Array, d_model: Array) -> Array:
        """Return the derivatives (n, k) of the residuals over sigma from those of the model."""
        factor, f, r = self.matched(model)
        d_f = self._centred((self.weight[:, None] * d_model).T)
        out = factor[self.night] * d_f
        if self.scale:   # d scale = -(r . df + scale f . df) / f . f
            pulled = (self._sums(r * d_f) + factor * self._sums(f * d_f)) / np.maximum(self._sums(f * f), 1e-300)
            out = out - f * np.where(factor > 0, pulled, 0.0)[..., self.night]
        return np.asarray(out.T)
