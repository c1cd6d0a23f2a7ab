"""The summary of an ensemble: mean, rms, extremes, histogram and quantiles of each quantity at each time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Literal, NamedTuple, overload

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.rotation import Rotation
from .._core import InvalidInput
from .distributions import Floats
from .recipe import EnsembleRecipe, Wanted

UNITS = {"angle": "rad", "axis_angle": "rad", "omega": "rad s-1", "energy": "J", "function": "1", "attitude": "1"}
TEXTS = {
    "angle": "angle of the rotation from the nominal attitude", "axis_angle": "angle from a body axis to a direction",
    "omega": "size of the angular velocity", "energy": "kinetic energy", "function": "value of a function",
    "attitude": "attitude of the bodies",
}
QUANTILES = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 0.999)   # that a store holds


class Quantiles(NamedTuple):
    """Quantiles with their bounds, shape (times, quantiles); the exact ones lie between `lower` and `upper`."""

    value: Floats
    lower: Floats
    upper: Floats


class QuantitySummary:
    """A number of each state, summed up over the bodies at each time.

    Arrays have the shape (times,); with a sweep (points, times).

    Attributes
    ----------
    name, of, unit : str
    count : ndarray of int
        Bodies that have a state.
    mean, rms, min, max : ndarray
    histogram : ndarray of int, shape (times, bins)
    edges : ndarray, shape (bins + 1,)
        Of the bins, 64 for each factor of two.
    """

    def __init__(self, wanted: Wanted, parts: dict[str, Any], edges: Floats) -> None:
        self.name, self.of, self.unit = wanted.name, wanted.of, UNITS[wanted.of]
        self.count: npt.NDArray[np.int64] = parts["count"]
        with np.errstate(invalid="ignore", divide="ignore"):
            self.mean: Floats = parts["sum"] / self.count
            self.rms: Floats = np.sqrt(parts["sum2"] / self.count)
        empty = self.count == 0
        self.min: Floats = np.where(empty, np.nan, parts["min"])
        self.max: Floats = np.where(empty, np.nan, parts["max"])
        self.histogram: npt.NDArray[np.int64] = parts["histogram"]
        self.edges = edges

    def quantile(self, q: npt.ArrayLike) -> Quantiles:
        """Return quantiles at each time, with bounds that are at most 1.6 % apart.

        The quantile q of n bodies is the value of rank ceil(q n).

        Parameters
        ----------
        q : array_like, shape () or (k,)
            0 to 1.

        Returns
        -------
        Quantiles
            Shape (times,) or (times, k); NaN at times without a body.

        Raises
        ------
        InvalidInput
            For a number outside 0 to 1.
        """
        wanted = np.asarray(q, dtype=float)
        if wanted.ndim > 1 or not ((wanted >= 0) & (wanted <= 1)).all():
            raise InvalidInput(f"q: must be numbers from 0 to 1, got {q!r}")
        below = np.cumsum(self.histogram, axis=-1)
        rank = np.maximum(np.ceil(wanted.reshape(-1) * self.count[..., None]), 1)
        bins = np.stack([(below < rank[..., k, None]).sum(axis=-1) for k in range(rank.shape[-1])], axis=-1)
        bins = np.minimum(bins, self.histogram.shape[-1] - 1)
        low, high = self.min[..., None], self.max[..., None]
        lower, upper = np.clip(self.edges[bins], low, high), np.clip(self.edges[bins + 1], low, high)
        answer = Quantiles(lower / 2 + upper / 2, lower, upper)
        return answer if wanted.ndim else Quantiles(*(part[..., 0] for part in answer))

    def __repr__(self) -> str:
        return f"QuantitySummary({self.name} [{self.unit}]: {self.count.max(initial=0)} bodies, {self.mean.size} times)"


class AttitudeSummary:
    """The mean attitude of the bodies at each time, and their spread about it.

    Attributes
    ----------
    name, of, unit : str
    count : ndarray of int
    mean : ndarray, shape (times, 4)
        Quaternions (x, y, z, w), body to space: the principal eigenvectors of the second moments.
    spread : ndarray, shape (times,)
        2 asin(sqrt(1 - l)) with the mean square l of the quaternions' component along the mean [rad].
    """

    def __init__(self, wanted: Wanted, parts: dict[str, Any], nominal: Any) -> None:
        self.name, self.of, self.unit = wanted.name, wanted.of, "1"
        self.count: npt.NDArray[np.int64] = parts["count"]
        empty = self.count == 0
        moments = np.where(empty[..., None], np.eye(4)[np.triu_indices(4)], parts["moments"])
        mean, spread = _core._mean_attitude(np.ascontiguousarray(moments))
        if nominal is not None:
            mean = _core.attitude.product(nominal, mean)
        self.mean: Floats = np.where(empty[..., None], np.nan, mean)
        self.spread: Floats = np.where(empty, np.nan, spread)

    @property
    def rotation(self) -> Rotation:
        """The mean attitudes as a Rotation."""
        return Rotation.from_quat(self.mean)

    def __repr__(self) -> str:
        return f"AttitudeSummary({self.name}: {self.count.max(initial=0)} bodies, {self.spread.size} times)"


class Summaries(Mapping[str, "QuantitySummary"]):
    """The summaries of an ensemble by their names.

    Each is a `QuantitySummary`, or an `AttitudeSummary` of an attitude. For type checkers only the one named "attitude"
    is of the latter.
    """

    def __init__(self, parts: dict[str, QuantitySummary | AttitudeSummary]) -> None:
        self._parts = parts

    @overload
    def __getitem__(self, name: Literal["attitude"]) -> AttitudeSummary: ...   # type: ignore[overload-overlap]

    @overload
    def __getitem__(self, name: str) -> QuantitySummary: ...

    def __getitem__(self, name: str) -> Any:
        if name not in self._parts:
            raise KeyError(f"{name!r}: must be one of {', '.join(self._parts)}")
        return self._parts[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._parts)

    def __len__(self) -> int:
        return len(self._parts)

    def __repr__(self) -> str:
        return f"Summaries({', '.join(map(repr, self._parts.values()))})"


def make(recipe: EnsembleRecipe, merged: list[Any], quantities: list[list[dict[str, Any]]]) -> Summaries:
    """Return the summaries of merged core summaries, one for each point of the sweep."""
    records = [summary.record()["quantities"] for summary in merged]
    found: dict[str, QuantitySummary | AttitudeSummary] = {}
    for index, wanted in enumerate(recipe.wanted):
        names = [key for key, value in records[0][index].items() if isinstance(value, np.ndarray)]
        parts = {key: np.stack([record[index][key] for record in records]) for key in names}
        if len(records) == 1:
            parts = {key: array[0] for key, array in parts.items()}
        if wanted.of == "attitude":
            nominal: list[Any] = [point[index].get("nominal") for point in quantities]
            stacked = None if nominal[0] is None else np.stack(nominal) if len(nominal) > 1 else nominal[0]
            found[wanted.name] = AttitudeSummary(wanted, parts, stacked)
        else:
            found[wanted.name] = QuantitySummary(wanted, parts, merged[0].edges(index))
    return Summaries(found)


def arrays_of(summary: QuantitySummary | AttitudeSummary) -> dict[str, tuple[tuple[str, ...], Any, str, str]]:
    """Return the arrays of a summary by their names in a store: dimensions, values, unit, text."""
    name, text = summary.name, TEXTS[summary.of]
    if isinstance(summary, AttitudeSummary):
        return {f"{name}_mean": (("time", "component"), summary.mean, "1", f"mean {text}, quaternion (x, y, z, w)"),
                f"{name}_spread": (("time",), summary.spread, "rad", f"spread of the {text}")}
    found = {f"{name}_{key}": (("time",), getattr(summary, key), summary.unit, f"{key} of the {text}")
             for key in ("mean", "rms", "min", "max")}
    bounds = summary.quantile(QUANTILES)
    return {**found, **{f"{name}_quantile_{key}": (("time", "quantile"), getattr(bounds, key), summary.unit,
                                                   f"{key} bound of the quantiles of the {text}")
                        for key in ("lower", "upper")}}


def create_arrays(recipe: EnsembleRecipe, make_array: Callable[..., Any], fixed: Callable[..., None]) -> None:
    """Make the arrays of all summaries in a store, empty until every chunk is done."""
    fixed("quantile", np.array(QUANTILES), units="1", long_name="share of the bodies")
    for name, (dims, shape, unit, text) in shapes(recipe).items():
        make_array(name, shape, shape, dims, units=unit, long_name=text)


def shapes(recipe: EnsembleRecipe) -> dict[str, tuple[tuple[str, ...], tuple[int, ...], str, str]]:
    """Return the dimensions, shape, unit and text of each array of the summaries."""
    sizes = {"time": recipe.times.size, "component": 4, "quantile": len(QUANTILES)}
    found = {}
    for wanted in recipe.wanted:
        zero = np.zeros(1)
        parts = {"count": np.zeros(1, dtype=np.int64), "sum": zero, "sum2": zero, "min": zero, "max": zero,
                 "histogram": np.zeros((1, 1), dtype=np.int64), "moments": np.zeros((1, 10))}
        empty = (AttitudeSummary(wanted, parts, None) if wanted.of == "attitude"
                 else QuantitySummary(wanted, parts, np.zeros(2)))
        for name, (dims, _, unit, text) in arrays_of(empty).items():
            found[name] = (dims, tuple(sizes[dim] for dim in dims), unit, text)
    return found
