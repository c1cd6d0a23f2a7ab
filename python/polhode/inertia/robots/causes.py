"""Causes of what is wrong with a link, named only where the evidence separates them."""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np

from .. import evidence as ev
from ..corruptions import Cause, undo
from ..diagnosis import CONVINCED, GEOMETRY_UNITS
from .geometry import Array
from .record import LinkRecord

BEATEN = 3.0        # nats by which a cause must beat the next of another kind: 20 to one
SUPPORT = 2.0       # nats for each factor e of links that the same cause explains
# The largest difference from the uniform body that may be left after the repair, by the quality of the geometry.
LEFT = {"body": 0.4, "hull": 0.5, "collision": 0.15, "part": 0.15}
SIZE = 0.3          # of a cause that is one factor: the logarithm of the size that may be left
EQUAL = 1e-3        # of an entry that becomes that of another moment
FORMULA = 0.05      # of a slip in a formula, which leaves no difference
FORMULAS = ((12.0, "the factor 1/12 of a box or a rod was left out"),
            (4.0, "full lengths or diameters were taken for half lengths or radii"),
            (0.25, "half lengths or radii were taken for full lengths or diameters"))
BONUS = 5.0         # nats for that
LEFT_SLIP = 0.15    # where nothing else is broken
ALIKE = 0.25        # of an entry that a decimal point is moved in: from another moment


class Candidate(NamedTuple):
    """A cause that explains a link: its total in nats (less is better), and the link without it."""

    kind: str
    text: str
    total: float
    gain: float
    body: ev.Bodies
    geometry_factor: float = 1.0


@dataclasses.dataclass
class Known:
    """The geometry of a link, its quality, and what is known from the rest of the file."""

    geometry: ev.Geometry
    quality: str
    small: bool = False        # no matter is dense enough to hold the mass in it
    copies: int = 0
    identified: bool = False


def candidates(given: ev.Bodies, evidence: ev.Evidence, known: Known, link: LinkRecord,
               broken: set[str]) -> list[Candidate]:
    """Return the causes that leave a sound body, agree with what is known, and gain enough."""
    geometry = known.geometry if known.quality in LEFT else ev.Geometry()
    if geometry is not known.geometry:
        evidence = ev.weigh(given, geometry)
    causes = [*link.rotation_causes(), *undo(given, geometry), *_floors(given, geometry), *_rotated_centre(given),
              *_formulas(given)]
    found = []
    if causes:
        weighed = ev.weigh(ev.stack([given, *(cause.body for cause in causes)]), geometry)
        sound = weighed.sound()
        for i, cause in enumerate(causes, 1):
            total = float(weighed.score[i]) + cause.cost - _bonus(cause, given)
            gain = float(weighed.score[0]) - total
            if sound[i] and gain > CONVINCED and _explains(cause, given, known, geometry, broken):
                found.append(Candidate(cause.kind, cause.text, total, gain, cause.body))
    if known.quality in ("body", "hull") and broken and np.ptp(given.matrix[0].diagonal()) > 0:
        for factor, text in GEOMETRY_UNITS:   # the body is right, what it is compared with is not
            scaled = geometry.scaled(factor)
            other = ev.weigh(given, scaled)
            total = float(other.score[0]) + 2.0
            if geometry.references and other.sound()[0] and float(evidence.score[0]) - total > CONVINCED \
                    and ev.apart(given, scaled) < LEFT[known.quality]:
                found.append(Candidate("units", text, total, float(evidence.score[0]) - total, given, factor))
    return found


def _floors(given: ev.Bodies, geometry: ev.Geometry) -> list[Cause]:
    """A mass that was raised to a round floor, beside the tensor of a lighter body."""
    mass, volume = float(given.mass[0]), geometry.volume
    power = 10.0 ** round(float(np.log10(mass)))
    if volume is None or abs(mass / power - 1) > 1e-9 or mass > 0.1:
        return []
    found = []
    for r in geometry.references:
        lighter = float(np.trace(given.matrix[0]) / np.trace(r.matrix))
        if lighter < 0.7 * mass and 200 < lighter / volume < 9_000:
            text = f"the mass was raised to {mass:g} kg: the tensor is that of {lighter:.3g} kg"
            found.append(Cause("floor", text, 1.0, ev.single(lighter, given.com[0], given.matrix[0])))
    return found


def _formulas(given: ev.Bodies) -> list[Cause]:
    """Slips in the formula of a box or cylinder: they leave one factor, exactly."""
    return [Cause("formula", text, 1.0, given._replace(matrix=given.matrix / factor)) for factor, text in FORMULAS]


def _rotated_centre(given: ev.Bodies) -> list[Cause]:
    """One component of the centre of mass with the other sign."""
    found = []
    for i, name in enumerate("xyz"):
        com = given.com[0].copy()
        if abs(com[i]) > 1e-3 * np.abs(com).max():
            com[i] = -com[i]
            found.append(Cause("sign", f"the sign of the centre of mass, {name}: reverse it", 0.0,
                               given._replace(com=com[None])))
    return found


def _bonus(cause: Cause, given: ev.Bodies) -> float:
    """A decimal point that makes a moment equal to another one is no accident."""
    i = _find_changed_entry(given.matrix[0], cause.body.matrix[0]) if cause.kind == "decimal" else None
    if i is None:
        return 0.0
    after = cause.body.matrix[0].diagonal()
    return BONUS if any(abs(after[i] - after[j]) <= EQUAL * abs(after[j]) for j in range(3) if j != i) else 0.0


def _find_changed_entry(before: Array, after: Array) -> int | None:
    """The one moment in which two tensors differ."""
    changed = np.argwhere(np.triu(before != after))
    return int(changed[0][0]) if len(changed) == 1 and changed[0][0] == changed[0][1] else None


def _left(body: ev.Bodies, geometry: ev.Geometry) -> float:
    """The largest difference from the nearest reference, as a part of the larger of both."""
    unit = body.matrix[0] / body.mass[0]
    nearest = np.inf
    for r in geometry.references:
        top = float(max(np.abs(r.matrix).max(), np.abs(unit).max()))
        shift = float(np.abs(body.com[0] - r.com).max()) / np.sqrt(top)
        nearest = min(nearest, max(float(np.abs(unit - r.matrix).max()) / top, shift))
    return nearest


def _explains(cause: Cause, given: ev.Bodies, known: Known, geometry: ev.Geometry, broken: set[str]) -> bool:
    """Return whether a cause explains more than its own factor."""
    body = cause.body
    before, after = given.matrix[0], body.matrix[0]
    if not geometry.references:
        return bool(broken & {"triangle", "positive"}) and _is_likely_alone(cause, before, after)
    if broken & {"triangle", "positive"} and cause.kind == "decimal" and _is_likely_alone(cause, before, after):
        return True
    left, was = _left(body, geometry), _left(given, geometry)
    limit = LEFT[known.quality] if broken else LEFT_SLIP
    if left > min(limit, 0.5 * was) or (cause.kind == "formula" and left > FORMULA):
        return False
    if geometry.volume is not None and not 20 < float(body.mass[0]) / geometry.volume < 25_000:
        return False
    com, other_com = given.com[0], body.com[0]
    same_tensor = np.allclose(after * body.mass[0] ** -1, before * given.mass[0] ** -1, rtol=1e-9, atol=0)
    if same_tensor and not np.array_equal(com, other_com):
        return _places(other_com, geometry)
    if _is_factor(before / given.mass[0], after / body.mass[0]):   # one factor explains itself: the form must tell
        sizes = [abs(np.log(np.trace(after) / body.mass[0] / np.trace(r.matrix))) for r in geometry.references]
        return min(sizes) < SIZE and _form(after, geometry) and not _isotropic(after)
    return True


def _is_likely_alone(cause: Cause, before: Array, after: Array) -> bool:
    """Without geometry: signs and orders have tensors of their own; a decimal point needs a number like it."""
    if cause.kind in ("sign", "order"):
        return True
    if cause.kind != "decimal":
        return False
    i = _find_changed_entry(before, after)
    if i is None:
        return False
    others = [after[j, j] for j in range(3) if j != i]
    return any(abs(after[i, i] - other) < ALIKE * abs(other) for other in others)


def _is_factor(before: Array, after: Array) -> bool:
    largest = np.abs(before).max()
    ratio = np.abs(after).max() / largest if largest > 0 else 0.0
    return bool(np.abs(after - ratio * before).max() <= 1e-9 * np.abs(after).max())


def _isotropic(matrix: Array) -> bool:
    diagonal = matrix.diagonal()
    return bool(np.ptp(diagonal) <= 0.05 * np.abs(diagonal).max())


def _form(matrix: Array, geometry: ev.Geometry) -> bool:
    """Return whether the tensor has the form of a reference, which is not that of a sphere."""
    unit = matrix / np.trace(matrix)
    for r in geometry.references:
        form = r.matrix / np.trace(r.matrix)
        if np.ptp(np.linalg.eigvalsh(form)) > 0.05 and np.abs(unit - form).max() < 0.25 * np.abs(form).max():
            return True
    return False


def _places(com: Array, geometry: ev.Geometry) -> bool:
    """Return whether a centre agrees with that of a reference, in more than being near the origin."""
    for r in geometry.references:
        size = float(np.linalg.norm(r.com))
        radius = float(np.sqrt(np.trace(r.matrix) / 2))
        if size > 0.1 * radius and np.linalg.norm(com - r.com) < 0.15 * size + 0.02 * radius:
            return True
    return False


def choose(possible: list[Candidate], known: Known, support: dict[str, int]) -> Candidate | None:
    """Return the best cause if it beats the next one of another kind by enough, with the support of other links."""
    if not possible:
        return None

    def total(candidate: Candidate) -> float:
        return candidate.total - SUPPORT * float(np.log(max(support.get(_key(candidate), 1), 1)))

    ranked = sorted(possible, key=total)
    best = ranked[0]
    rival = next((other for other in ranked[1:] if not _same(best, other)), None)
    if rival is not None and total(rival) - total(best) < BEATEN:
        return None
    return best


def _key(candidate: Candidate) -> str:
    """The same slip in other links."""
    if candidate.kind == "units":
        return candidate.text
    if candidate.kind == "point":
        return candidate.text.partition(",")[0].partition(":")[0]
    if candidate.kind in ("decimal", "floor"):
        return f"{candidate.kind} {candidate.text.partition(':')[0].partition(',')[0]}"
    return candidate.text


def _same(a: Candidate, b: Candidate) -> bool:
    """Return whether two causes have the same name, or the same outcome."""
    size, reach = float(np.abs(a.body.matrix).max()), float(np.abs(a.body.com).max())
    return a.kind == b.kind or (
        np.allclose(a.body.matrix, b.body.matrix, rtol=0, atol=0.01 * size)
        and np.allclose(a.body.com, b.body.com, rtol=0, atol=0.01 * reach)
        and np.allclose(a.body.mass, b.body.mass, rtol=1e-6) and a.geometry_factor == b.geometry_factor)


def tally(all_possible: list[list[Candidate]]) -> dict[str, int]:
    """Count for each slip how many links of a file it explains."""
    counts: dict[str, int] = {}
    for possible in all_possible:
        for key in {_key(candidate) for candidate in possible}:
            counts[key] = counts.get(key, 0) + 1
    return counts
