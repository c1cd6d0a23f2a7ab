"""`ph.ensemble`: run a recipe; and its result, of which states are drawn and computed again when they are wanted."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable
from html import escape
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _files
from .._core import InertiaTensor, InvalidInput
from .._scene.scene import Scene
from . import export, layout, states, store, summary
from . import recipe as recipes
from . import task as tasks
from .distributions import Floats
from .draw import Bodies, draw
from .layout import HEAD
from .recipe import EnsembleRecipe
from .states import States
from .task import Task

if TYPE_CHECKING:
    from matplotlib.figure import Figure

KIND = "ensemble"   # of a saved file


class Drawn(NamedTuple):
    """Bodies of an ensemble as they were drawn, a row for each.

    `inertia` has moments about the body axes, shape (bodies, 3), or is a tuple of tensors. `values` has all drawn
    numbers by their places in the recipe. `redrawn` counts the draws of a body that no body could be.
    """

    numbers: npt.NDArray[np.int64]
    inertia: Floats | tuple[InertiaTensor | None, ...]
    omega: Floats
    attitude: Floats
    values: dict[str, Floats]
    redrawn: npt.NDArray[np.int64]


class Ensemble:
    """Many bodies of a recipe, with their summary.

    Attributes
    ----------
    out : str or None
        The folder of its store.
    total : int
        Bodies, over all points of the sweep.
    points : tuple of dict
        The swept values of each point; one empty dict without a sweep.
    failed : dict
        Chunks that were given up in this run, with the reason.
    """

    def __init__(self, task: Task, rows: dict[int, Floats] | None = None, failed: dict[int, str] | None = None) -> None:
        self._task, self._rows = task, rows
        self.out, self.failed = task.out, failed or {}
        self._recipe: EnsembleRecipe = recipes.from_message(task.recipe)
        self.points = tuple(point.settings for point in self._recipe.points)
        self._cached: tuple[int, Any] = (-1, None)

    # ---- what is done

    @property
    def name(self) -> str:
        """The recipe's name."""
        return self._recipe.name

    @property
    def times(self) -> Floats:
        """The sample times [s]."""
        return np.array(self._recipe.times)

    @property
    def chunks(self) -> tuple[int, ...]:
        """The numbers of the chunks that are done."""
        if self._rows is not None:
            return tuple(sorted(self._rows))
        assert self.out is not None
        return tuple(store.marked(self.out, self._task.layout))

    @property
    def total_chunks(self) -> int:
        """The number of all chunks."""
        return self._task.layout.chunks

    @property
    def total(self) -> int:
        """The number of all bodies."""
        return self._recipe.count * len(self.points)

    @property
    def done(self) -> int:
        """The number of bodies that are done."""
        return sum(self._task.layout.bodies(chunk) for chunk in self.chunks)

    def _merged(self) -> tuple[summary.Summaries, dict[str, float]]:
        chunks = self.chunks
        if self._cached[0] != len(chunks):
            rows = self._rows
            reader = store.Reader(self.out) if rows is None and self.out is not None else None
            found = merge(self._task, chunks, reader.record if reader else (rows or {}).__getitem__)
            self._cached = (len(chunks), found)
        return self._cached[1]   # type: ignore[no-any-return]

    @property
    def summary(self) -> summary.Summaries:
        """The summaries by their names, of the bodies that are done."""
        return self._merged()[0]

    @property
    def counts(self) -> dict[str, Any]:
        """What became of the bodies that are done.

        "bodies"; "failed" (a NaN among their states); "redrawn" (once or more, because no body can be so);
        "impossible" (of those, given up); and of bodies that were integrated "solved" (with success), "certified" (with
        a bounded error), "steps" and "worst_error".
        """
        head = self._merged()[1]
        return {name: head[name] if name == "worst_error" else int(head[name]) for name in HEAD}

    @property
    def certified(self) -> float:
        """The share of the bodies whose error is bounded and within the accuracy; NaN for closed forms."""
        counts = self.counts
        integrated = any(not states.is_free(self._recipe, point) for point in self._recipe.points)
        return float(counts["certified"] / counts["bodies"]) if integrated and counts["bodies"] else float("nan")

    # ---- bodies, again

    def _point(self, point: int) -> Any:
        if isinstance(point, bool) or not isinstance(point, (int, np.integer)) or not 0 <= point < len(self.points):
            raise InvalidInput(f"point: must be 0 to {len(self.points) - 1}, got {point!r}")
        return self._recipe.points[point]

    def _draws(self, numbers: Iterable[int], point: int) -> tuple[npt.NDArray[np.int64], list[Bodies]]:
        try:
            wanted = np.asarray(list(numbers), dtype=np.int64)
        except (TypeError, ValueError, OverflowError):
            raise InvalidInput(f"numbers: must be whole numbers of bodies, got {numbers!r}") from None
        if wanted.ndim != 1 or wanted.size == 0 or wanted.min() < 0 or wanted.max() >= self._recipe.count:
            raise InvalidInput(f"numbers: must be one or more of 0 to {self._recipe.count - 1}, got {numbers!r}")
        cuts = np.flatnonzero(np.diff(wanted) != 1) + 1
        spec = self._point(point)
        return wanted, [draw(self._recipe, spec, int(part[0]), len(part)) for part in np.split(wanted, cuts)]

    def bodies(self, numbers: Iterable[int], point: int = 0) -> Drawn:
        """Draw bodies again.

        Parameters
        ----------
        numbers : iterable of int
            Such as ``range(17, 40)``.
        point : int
            Of a sweep.

        Returns
        -------
        Drawn
        """
        wanted, parts = self._draws(numbers, point)
        spec = self._recipe.points[point]
        starts = [states.start_of(spec, part) for part in parts]
        tensors: list[InertiaTensor | None] = []
        rows: list[Floats] = []
        for part in parts:
            if isinstance(part.inertia, np.ndarray):
                rows.append(part.inertia)
            else:
                tensors += part.inertia if isinstance(part.inertia, list) else [part.inertia] * len(part)
        values = {".".join(map(str, path)): np.concatenate([part.values[path] for part in parts])
                  for path in parts[0].values}
        return Drawn(wanted, np.concatenate(rows) if rows else tuple(tensors),
                     np.concatenate([omega for omega, _ in starts]),
                     np.concatenate([attitude for _, attitude in starts]), values,
                     np.concatenate([part.attempts for part in parts]))

    def states(self, numbers: Iterable[int], point: int = 0) -> States:
        """Draw bodies and compute their states again: the bits of the run.

        Parameters
        ----------
        numbers, point
            As for `bodies`.

        Returns
        -------
        States
            omega (bodies, times, 3), attitude (bodies, times, 4), status, error, success and steps.
        """
        _, parts = self._draws(numbers, point)
        found = [states.compute(self._recipe, self._recipe.points[point], part) for part in parts]
        return States(*(np.concatenate(columns) for columns in zip(*found, strict=True)))

    def scene(self, number: int, point: int = 0) -> Scene:
        """Return one body as a scene, for `solve`, `plan` and pictures.

        Raises
        ------
        InvalidInput
            For a number that is none of a body, and for a body that cannot exist.
        """
        _, parts = self._draws([number], point)
        (scene,) = states.scenes(self._recipe.points[point], parts[0])
        if scene is None:
            raise InvalidInput(f"number: must be that of a body that can exist, got {number}")
        return scene.replace(name=f"{self.name} {number}")

    # ---- for others

    @property
    def dataset(self) -> Any:
        """An xarray.Dataset: the store, read lazily, or the summaries where there is none.

        It may be opened while the run goes on: chunks that are not done are NaN.
        """
        return self.to_xarray()

    def to_xarray(self) -> Any:
        """Return the store as an xarray.Dataset, or the summaries where there is none."""
        return export.to_xarray(self)

    def to_pandas(self) -> Any:
        """Return the summaries as a pandas.DataFrame, a row for each time (and point)."""
        return export.to_pandas(self)

    def records(self, chunks: Iterable[int]) -> list[Floats]:
        """Return the records of chunks, as the store has them."""
        if self._rows is not None:
            return [self._rows[chunk] for chunk in chunks]
        assert self.out is not None
        reader = store.Reader(self.out)
        return [reader.record(chunk) for chunk in chunks]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the recipe and the sums to a .npz file, for `polhode.load`."""
        target = _files.to_path(path, "path")
        if target.suffix != ".npz":
            raise InvalidInput(f"path: must end in .npz, got {str(path)!r}; out= writes Zarr")
        recipe, chunks = self._recipe, self.chunks
        about = {"kind": KIND, "stamp": store.stamp(self._task), "layout": self._task.layout._asdict(),
                 "recipe": recipe.raw, "folder": recipe.folder}
        with _files.whole(target) as draft:
            np.savez_compressed(draft, about=np.array(json.dumps(about)), chunks=np.array(chunks, dtype=np.int64),
                                records=np.array(self.records(chunks)))

    def plot(self, *names: str, point: int = 0) -> Figure:
        """Draw the spread of quantities against time: bands of quantiles, median and rms.

        Parameters
        ----------
        *names : str
            Names of the summary; all of them if none is given.
        point : int
            Of a sweep.

        Returns
        -------
        matplotlib.figure.Figure
            A notebook shows it; ``.savefig(path)`` writes it.

        Raises
        ------
        InvalidInput
            For an unknown name or point, and without matplotlib.
        """
        from .picture import draw

        self._point(point)
        return draw(self, names, int(point))

    def _repr_html_(self) -> str:
        rows = {"bodies that are done": f"{self.done:,} of {self.total:,}", "times": self.times.size,
                "points of the sweep": len(self.points), "store": self.out or "none",
                "summary": ", ".join(self.summary), **{name.replace("_", " "): value for name, value in
                                                       self.counts.items() if name != "bodies"}}
        cells = "".join(f"<tr><td>{escape(str(name))}</td><td>{escape(str(value))}</td></tr>"
                        for name, value in rows.items())
        return f"<div><b>Ensemble</b> {escape(self.name)}<table>{cells}</table></div>"

    def __repr__(self) -> str:
        where = f" in {self.out}" if self.out else ""
        return f"Ensemble({self.name}: {self.done} of {self.total} bodies, {self.times.size} times{where})"


def merge(task: Task, chunks: Iterable[int], read: Callable[[int], Floats]) -> tuple[summary.Summaries, Any]:
    """Return the summaries of chunks, and the sums of the heads of their records."""
    recipe, cut = recipes.from_message(task.recipe), task.layout
    every = [tasks.quantities(task.recipe, index) for index in range(cut.points)]
    times = recipe.times.size
    merged = [layout.new_summary(quantities, times) for quantities in every]
    places = tasks.fields(task)
    head = dict.fromkeys(HEAD, 0.0)
    for chunk in chunks:
        row = read(chunk)
        index, first, _ = cut.place(chunk)
        merged[index].merge(layout.old_summary(every[index], times, places.unpack(row, cut.block_of(first))))
        for name, value in places.head(row).items():
            head[name] = max(head[name], value) if name == "worst_error" else head[name] + value
    return summary.make(recipe, merged, every), head
