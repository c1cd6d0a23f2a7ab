"""Samples that are missing or come twice, found by steps of the exact flow."""

from __future__ import annotations

from typing import Any

import numpy as np

from .findings import Finding
from .law import Law
from .shooting import Data
from .states import Array, State, difference, displace

MOST = 20
BAD = 0.3  # of the turn of a step
SAMPLE = 500
DENSE = 0.2  # rad; the turn up to which a rough step will do


def _size(data: Data, gap: Array) -> Array:
    scales = np.concatenate(
        [np.full(3, data.scale if data.has_omega else np.inf), np.full(3, 1.0 if data.has_attitude else np.inf)]
    )
    size: Array = np.linalg.norm(gap / scales, axis=1)
    return size


def mend(data: Data, law: Law, findings: list[Finding]) -> Data:
    """Return data with the times of dropped samples set right, and without duplicated ones; say which."""
    count = len(data.t)
    if count < 8:
        return data
    dt = np.diff(data.t)
    reach = np.linalg.norm(data.omega[:-1], axis=1) * dt
    defect, median = _defects(data, law, dt, reach)
    bad = np.flatnonzero((defect > 8 * median) & (defect > BAD * np.minimum(reach, 1.0)))
    if not len(bad) or len(bad) > max(2, 0.02 * count):
        return data
    same = np.zeros(count, bool)
    same[1:] = np.all(data.omega[1:] == data.omega[:-1], axis=1) & np.all(
        data.attitude[1:] == data.attitude[:-1], axis=1
    )
    shift, dropped, twice = np.zeros(count), [], []
    for k in map(int, bad):
        if same[k + 1]:
            twice.append(int(k) + 1)
            if k + 2 < count:  # the row was put in, if what follows is one step late
                late = _fits(data, law, k, data.t[k + 2] - data.t[k], k + 2)
                if _fits(data, law, k, dt[k], k + 2) < 0.3 * late:
                    shift[k + 2 :] -= dt[k + 1]
            continue
        if same[k]:
            continue
        trials = [_fits(data, law, k, dt[k] * (m + 1), k + 1) for m in range(1, MOST + 1)]
        best = int(np.argmin(trials))
        if 3 * trials[best] < defect[k]:
            dropped.append((int(k) + 1, best + 1))
            shift[k + 1 :] += dt[k] * (best + 1)
    if dropped:
        total = sum(m for _, m in dropped)
        findings.append(
            Finding(
                "dropped",
                f"{total} samples are missing before sample"
                + ("s " if len(dropped) > 1 else " ")
                + ", ".join(str(k) for k, _ in dropped[:10]),
                size=total,
                where=tuple(k for k, _ in dropped),
                effect=float(np.max(defect[[k - 1 for k, _ in dropped]])),
                margin=float("inf"),
                cure="keep all samples, or give each its own time",
            )
        )
    if twice:
        findings.append(
            Finding(
                "duplicated",
                f"{len(twice)} samples repeat the one before: " + ", ".join(map(str, twice[:10])),
                size=len(twice),
                where=tuple(twice),
                effect=float(np.max(defect[[k - 1 for k in twice]])),
                cure="leave the repeated samples out",
            )
        )
    kept = np.ones(count, bool)
    kept[twice] = False
    t = (data.t + shift)[kept]
    mended = data.take(kept)
    return Data(t, mended.omega, mended.attitude, data.has_omega, data.has_attitude) if np.all(np.diff(t) > 0) else data


def _defects(data: Data, law: Law, dt: Array, reach: Array) -> tuple[Array, float]:
    """Return by how far each step misses the next sample, and the median; 0 where a rough step shows no gap.

    The rough step, with constant slopes of the rates, is off by less than half of what makes a gap.
    """
    slope = law.field(data.t[:-1], data.omega[:-1], data.attitude[:-1])[0] * dt[:, None]
    move = np.concatenate([slope, (data.omega[:-1] + 0.5 * slope) * dt[:, None]], axis=1)
    rough = _size(data, difference(displace((data.omega[:-1], data.attitude[:-1]), move),
                                   (data.omega[1:], data.attitude[1:])))
    some = np.zeros(len(dt), bool)
    some[:: max(1, len(dt) // SAMPLE)] = True
    which = np.flatnonzero(some | (reach > DENSE) | (rough > 0.5 * BAD * np.minimum(reach, 1.0)))
    start: State = (data.omega[:-1][which], data.attitude[:-1][which])
    end: State = (data.omega[1:][which], data.attitude[1:][which])
    exact = _size(data, difference(law.flow(data.t[:-1][which], dt[which], start), end))
    defect = np.zeros(len(dt))
    defect[which] = exact
    return defect, float(np.median(exact[some[which]]))


def _fits(data: Data, law: Law, k: int, dt: Any, to: int) -> float:
    """Return how far sample `to` is from what `dt` makes of sample k."""
    end = law.flow(data.t[k : k + 1], np.array([dt]), (data.omega[k : k + 1], data.attitude[k : k + 1]))
    return float(_size(data, difference(end, (data.omega[to : to + 1], data.attitude[to : to + 1])))[0])
