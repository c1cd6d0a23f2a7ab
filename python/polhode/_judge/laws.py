"""Which law the samples obey: as given, without gyroscopic term, with its sign reversed, or with another tensor."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator

import numpy as np

from .._core import InertiaTensor, InvalidInput
from .law import Law
from .shooting import Data, Track, fit
from .states import Array, difference

WINDOWS = 200


@dataclasses.dataclass(frozen=True, eq=False)
class Variant:
    """Another law, with the cause that it stands for."""

    cause: str
    text: str
    cure: str
    law: Law


def variants(law: Law) -> Iterator[Variant]:
    """Give the laws of common faults; each differs from the given one."""
    yield Variant(
        "no gyroscopic term",
        "the rates change as if Euler's equations had no gyroscopic term",
        "add -omega x (I omega) to the torque",
        dataclasses.replace(law, gyro=0.0),
    )
    yield Variant(
        "gyroscopic sign",
        "the gyroscopic term of Euler's equations has the other sign",
        "use I omega' = torque - omega x (I omega)",
        dataclasses.replace(law, gyro=-1.0),
    )
    seen = [law.matrix]
    size = np.max(np.abs(law.matrix))

    def fresh(matrix: Array) -> bool:
        if any(np.max(np.abs(matrix - old)) < 1e-12 * size for old in seen):
            return False
        seen.append(matrix)
        try:
            InertiaTensor(matrix, physical=False)
        except InvalidInput:
            return False
        return True

    diagonal = np.diag(np.diag(law.matrix))
    for signs in itertools.product((1.0, -1.0), repeat=3):
        matrix = diagonal.copy()
        for sign, (i, j) in zip(signs, ((0, 1), (0, 2), (1, 2)), strict=True):
            matrix[i, j] = matrix[j, i] = sign * law.matrix[i, j]
        if fresh(matrix):
            yield Variant(
                "products of inertia",
                "products of inertia have the other sign than given",
                "the tensor has minus the sums of m x y beside its diagonal",
                dataclasses.replace(law, matrix=matrix),
            )
    for order in itertools.permutations(range(3)):
        rotated = law.matrix[np.ix_(order, order)]
        for signs in itertools.product((1.0, -1.0), repeat=2):
            flip = np.array([1.0, *signs])
            matrix = rotated * np.outer(flip, flip)
            if fresh(matrix):
                shown = ", ".join("xyz"[k] for k in order)
                yield Variant(
                    "inertia axes",
                    f"the moments are in another order: those about x, y, z are the given {shown}",
                    "exchange the moments",
                    dataclasses.replace(law, matrix=matrix),
                )


def windowed(data: Data, law: Law) -> float:
    """Return the sum of squares of what the flow over about a radian leaves, from many samples."""
    dt = float(np.median(np.diff(data.t)))
    ahead = int(np.clip(round(1.0 / (data.scale * dt)), 1, max(1, len(data.t) // 3)))
    first = np.unique(np.linspace(0, len(data.t) - 1 - ahead, WINDOWS).astype(int))
    span = data.t[first + ahead] - data.t[first]
    end = law.flow(data.t[first], span, (data.omega[first], data.attitude[first]))
    gap = difference(end, (data.omega[first + ahead], data.attitude[first + ahead]))
    return float(sum(np.sum((gap[:, part] / scale) ** 2) for part, scale in data.channels))


def longest(data: Data, law: Law, near: Track | None = None) -> Track:
    """Fit segments that are as long as the motion stays near the data."""
    length = len(data.t)
    while True:
        track = fit(data, law, length)
        rest = track.deviation()
        good = (np.linalg.norm(rest[:, :3], axis=1) < 0.12) & (np.linalg.norm(rest[:, 3:], axis=1) < 0.12)
        if np.mean(good) >= 0.97 and np.all(np.isfinite(rest)) or length <= 4:
            return track
        length = max(4, length // 2)


def choose(data: Data, law: Law) -> tuple[Variant | None, Track]:
    """Return the law that the samples obey, None for that given, and its motion along the data."""
    own = windowed(data, law)
    best, least = None, 0.5 * own
    for variant in variants(law):
        value = windowed(data, variant.law)
        if value < least:
            best, least = variant, value
    track = longest(data, law)
    if best is None:
        return None, track
    other = longest(data, best.law)
    sizes = [float(np.sqrt(np.mean(t.deviation() ** 2))) for t in (track, other)]
    if other.length > track.length or other.length == track.length and sizes[1] < np.exp(-1.5) * sizes[0]:
        return best, other
    return None, track
