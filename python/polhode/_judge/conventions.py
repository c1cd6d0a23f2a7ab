"""Conventions, found by kinematics alone: the rates are the attitude's derivative in one reading only."""

from __future__ import annotations

import dataclasses
import itertools
import math

import numpy as np

from .._attitude.rotation import Rotation
from .findings import Finding
from .read import SEQUENCES, Samples
from .states import Array, angle_vector, conjugate, multiply, to_body

UNITS = {1.0: "", math.pi / 180: "deg/s", 2 * math.pi / 60: "rpm", 2 * math.pi: "turns/s"}
FACTORS = {
    1.0: "units of rates",
    **{f: "units of rates" for u in (math.pi / 180, 2 * math.pi / 60, 2 * math.pi) for f in (u, 1 / u)},
    **{10.0**k: "units of time" for k in (-9, -6, -3, 3, 6, 9)},
}
INTERVALS = 2000
FAR = 1.0  # rad between samples, from which means by cubics say little
LONG = 1.5  # rad between samples, beyond which no longer intervals are tried: turns by more than pi look like others
SURE = 0.05  # rho of a reading that is believed even so
RESOLUTION = 1e-4  # of rho: the error of means by cubics
SIGNED = np.array([
    np.eye(3)[list(order)] * np.array(signs)[:, None]
    for order in itertools.permutations(range(3))
    for signs in itertools.product((1.0, -1.0), repeat=3)
])


@dataclasses.dataclass(frozen=True, eq=False)
class Reading:
    """One way to read the samples, with what it leaves of the mean rates, relative to them."""

    shifted: int  # places by which the four numbers are moved on
    reversed: bool
    space: bool
    axes: Array
    factor: float
    rho: float
    departures: int
    scale: float = 1.0


def rates_between(first: Array, second: Array, dt: Array, space: bool) -> Array:
    """Return the mean rates that take attitudes to others, in body axes or space axes."""
    step = multiply(second, conjugate(first)) if space else multiply(conjugate(first), second)
    rates: Array = angle_vector(step) / dt[:, None]
    return rates


def mean_rates(t: Array, omega: Array) -> Array:
    """Return means of the rates over the second of three intervals, by a cubic through four samples (4, n) each."""
    h = t[2] - t[1]
    nodes = (t - t[1]) / h
    powers = np.stack([nodes.T**k for k in range(4)], axis=1)
    weights = np.linalg.solve(powers, np.broadcast_to((1 / np.arange(1.0, 5.0))[:, None], (len(h), 4, 1)))[..., 0]
    mean: Array = np.einsum("nk,kni->ni", weights, omega)
    return mean


def _departures(axes: Array) -> int:
    order = np.argmax(np.abs(axes), axis=1)
    signs = axes.sum(axis=1)
    flips = int(np.sum(signs < 0))
    return int(not np.array_equal(order, np.arange(3))) + (0 if flips == 0 else 1 if flips in (1, 3) else 2)


CHANGES = tuple(map(_departures, SIGNED))
KNOWN = np.array(list(FACTORS))


def readings(samples: Samples, attitude: Array, stride: int) -> list[Reading]:
    """Return all readings with their best factor, at every `stride`-th sample."""
    assert samples.omega is not None
    last = len(samples.t) - 3 * stride
    first = np.unique(np.linspace(0, last - 1, min(last, INTERVALS)).astype(int))
    four = first + stride * np.arange(4)[:, None]
    t = samples.t[four]
    mean, begin, end = mean_rates(t, samples.omega[four]), attitude[four[1]], attitude[four[2]]
    out = []
    for shifted, reverse in itertools.product((0, -1, 1), (False, True)):
        # What was read as (x, y, z, w) is (w, x, y, z) if the scalar stands first, (y, z, w, x) if it was moved twice.
        own = [np.roll(q, shifted, axis=1) for q in (begin, end)]
        own = [conjugate(q) if reverse else q for q in own]
        for space in (False, True):
            rate = rates_between(own[0], own[1], t[2] - t[1], space)
            total, power = rate.T @ mean, float(np.sum(mean * mean))
            square = float(np.sum(rate * rate))
            if not square or not power:
                continue
            factors = np.sum(total * SIGNED, axis=(1, 2)) / power
            for k in np.flatnonzero(factors > 0):
                factor = float(factors[k])
                off = np.abs(np.log(factor / KNOWN))
                nearest = int(np.argmin(off))
                if off[nearest] > math.log(1.2):
                    continue
                known = float(KNOWN[nearest])
                rho = math.sqrt(max(0.0, 1 - factor * factor * power / square))
                departures = abs(shifted) + reverse + (space != samples.space) + CHANGES[k] + (known != 1.0)
                out.append(Reading(shifted, reverse, space, SIGNED[k], known, rho, departures, factor))
    return out


def simplest(every: list[Reading], count: int) -> Reading:
    """Return the reading with the fewest departures of those that the data do not tell from the best.

    A better one leaves 20 % less, and gains 15 nats over all of the `count` intervals. Where the declared one leaves
    little, a better one leaves a third, because means by cubics over long intervals leave as much.
    """
    least = min(r.rho for r in every) + RESOLUTION
    near = max(1.25, math.exp(15 / (3 * count)))
    given = min((r for r in every if r.departures == 0), key=lambda r: r.rho, default=None)
    if given and given.rho < SURE and given.rho + RESOLUTION <= max(3.0, near) * least:
        return given
    return min((r for r in every if r.rho + RESOLUTION <= near * least), key=lambda r: (r.departures, r.rho))


def best_reading(samples: Samples, attitude: Array) -> tuple[Reading | None, Reading | None, int]:
    """Return the best reading and the one that was declared, at the stride that shows it best."""
    found: tuple[Reading | None, Reading | None, int] = None, None, 1
    angles = angle_vector(multiply(conjugate(attitude[:-1]), attitude[1:]))
    step, stride = float(np.median(np.linalg.norm(angles, axis=1))), 1
    while (len(samples.t) - 1) // stride >= 6 and (stride == 1 or stride * step < LONG):
        every = readings(samples, attitude, stride)
        if every:
            best = simplest(every, min(INTERVALS, (len(samples.t) - 1) // stride))
            if found[0] is None or best.rho + RESOLUTION < 0.7 * (found[0].rho + RESOLUTION):
                given = [r for r in every if r.departures == 0]
                found = best, given[0] if given else None, stride
        stride *= 2
    return found


def reach(samples: Samples) -> float:
    """Return the median turn between samples, by the rates as declared [rad]."""
    assert samples.omega is not None
    return float(np.median(np.linalg.norm(samples.omega[1:], axis=1) * np.diff(samples.t)))


def undo(samples: Samples, findings: list[Finding], untold: list[str]) -> float:
    """Find the conventions of samples with both channels, undo them, and return what remains of the rates.

    `untold` gets a sentence where the samples are too far apart."""
    assert samples.omega is not None and samples.attitude is not None
    if not np.any(samples.omega):
        return 0.0
    if samples.angles is not None:
        _sequence(samples, findings)
    best, declared, _ = best_reading(samples, samples.attitude)
    if reach(samples) > FAR and (best is None or best.rho > SURE):
        untold.append("samples are further apart than a radian: they do not show the conventions")
        return best.rho if best else 0.0
    if best is None or best.rho > 0.5:
        if len(samples.t) >= 8:
            rho = 1.0 if best is None else best.rho
            findings.append(
                Finding(
                    "inconsistent",
                    "rates and attitudes disagree in every reading: the best leaves "
                    f"{100 * rho:.0f} % of the attitude's mean rates",
                    size=rho,
                    effect=rho,
                    cure="check that both belong to one body, and to the same times",
                )
            )
        return 1.0
    evidence = {"rho": best.rho, "rho as declared": declared.rho if declared else None, "factor": best.scale}
    gap = 100 * math.log(((declared.rho if declared else 1.0) + RESOLUTION) / (best.rho + RESOLUTION))
    effect = math.sqrt(max(0.0, (declared.rho if declared else 1.0) ** 2 - best.rho**2))

    def tell(cause: str, text: str, cure: str, size: float | None = None) -> None:
        findings.append(Finding(cause, text, size=size, effect=effect, margin=gap, evidence=evidence, cure=cure))

    if best.shifted:
        tell(
            "scalar order",
            "the quaternion's scalar stands at the other end of the four numbers than declared",
            "declare order='wxyz' or 'xyzw', or move the scalar",
        )
        samples.attitude = np.roll(samples.attitude, best.shifted, axis=1)
    if best.reversed:
        tell(
            "conjugate",
            "attitudes take space to body: the reverse rotation",
            "conjugate the quaternion, or transpose the matrix",
        )
        samples.attitude = conjugate(samples.attitude)
    if best.factor != 1.0:
        _factor(samples, best.factor, tell)
    _axes(samples, best.axes, tell)
    if best.space != samples.space:
        words = ("space", "body") if best.space else ("body", "space")
        tell(
            "frame of rates",
            f"the rates are in {words[0]} axes, not in {words[1]} axes",
            f"declare frame='{words[0]}', or turn the rates",
        )
    samples.space = best.space
    return best.rho


def _factor(samples: Samples, factor: float, tell: object) -> None:
    assert callable(tell) and samples.omega is not None
    if FACTORS[factor] == "units of time":
        tell("units of time", f"times must be multiplied by {factor:g}", "give times in seconds", factor)
        samples.t = samples.t * factor
    else:
        unit = UNITS.get(factor) or "rad/s, taken for degrees"
        tell(
            "units of rates",
            f"rates are in {unit}: multiply by {factor:.7g}",
            "give rates in rad/s, or degrees=True",
            factor,
        )
        samples.omega = samples.omega * factor


def _axes(samples: Samples, axes: Array, tell: object) -> None:
    assert callable(tell) and samples.omega is not None
    order, signs = np.argmax(np.abs(axes), axis=1), axes.sum(axis=1)
    names = "xyz"
    if not np.array_equal(order, np.arange(3)):
        shown = ", ".join(("-" if signs[k] < 0 else "") + names[order[k]] for k in range(3))
        tell("axes exchanged", f"the body's x, y, z rates are the given {shown}", "exchange the columns of the rates")
    elif np.any(signs < 0):
        flipped = [names[k] for k in range(3) if signs[k] < 0]
        tell("axis flipped", "the rates about " + " and ".join(flipped) + " have the other sign", "reverse their sign")
    samples.omega = samples.omega @ axes.T


def _sequence(samples: Samples, findings: list[Finding]) -> None:
    """Find the sequence and unit of Euler angles by the rates."""
    assert samples.angles is not None and samples.attitude is not None
    given = best_reading(samples, samples.attitude)
    own, stride = given[1], given[2]
    best, chosen = own.rho if own else 1.0, None
    for unit in (1.0, math.pi / 180, 180 / math.pi):
        for sequence in (*SEQUENCES, *map(str.lower, SEQUENCES)):
            attitude = Rotation.from_euler(sequence, samples.angles * unit).as_quat()
            found = [r for r in readings(samples, attitude, stride) if r.departures == 0]
            if found and 1.5 * (found[0].rho + RESOLUTION) < best + RESOLUTION:
                best, chosen = found[0].rho, (sequence, unit, attitude)
    # A reading of the rates in another way, with fewer changes, stays possible.
    if (
        chosen is None
        or best > 0.5
        or (given[0] is not None and given[0].departures == 1 and given[0].rho < 1.5 * best + RESOLUTION)
    ):
        return
    sequence, unit, attitude = chosen
    words = {1.0: "", math.pi / 180: ", in degrees", 180 / math.pi: ", in radians"}[unit]
    findings.append(
        Finding(
            "Euler sequence",
            f"angles are of the sequence {sequence}{words}, not {samples.euler}",
            effect=own.rho if own else 1.0,
            evidence={"rho": best, "sequence": sequence},
            margin=100 * math.log(((own.rho if own else 1.0) + RESOLUTION) / (best + RESOLUTION)),
            cure=f"declare euler='{sequence}'" + (" and degrees" if words else ""),
        )
    )
    samples.attitude, samples.euler = attitude, sequence


def to_body_rates(samples: Samples) -> None:
    """Turn rates in space axes to body axes."""
    if samples.space and samples.omega is not None and samples.attitude is not None:
        samples.omega, samples.space = to_body(samples.attitude, samples.omega), False
