"""The verdict on a link: the quality of its geometry, what is broken, and at which level."""

from __future__ import annotations

import dataclasses

import numpy as np

from ..._core import InvalidInput
from .. import evidence as ev
from ..breaches import Breach, breaches
from ..checks import Flaw, check
from ..codes import CODES
from ..diagnosis import LARGEST, nearest
from ..findings import Diagnosis, Finding
from .causes import Candidate, Known, candidates, choose
from .geometry import Array
from .placeholders import is_negligible, is_placeholder
from .record import LinkRecord

OSMIUM = 22_590.0        # [kg/m^3]: of a link that is denser than this, the geometry shows a part only
MARKER = 0.03            # [m]: shapes up to this size mark frames
SLACK = 0.01             # of the box round all that is seen; of what collides or is read in part, the box is doubled
EXACT = 0.1              # of a difference that a slip takes away all but this part of
EXTENT = 1.1             # moments beyond this many times the limit, where no cause is found
EXTENT_COLLISION = 3.0   # the same for collision shapes alone, whose box is taken twice as large besides
OUTSIDE = 0.15           # of the largest side of the geometry, where no cause is found
LIGHT = 2.0              # [kg/m^3]


@dataclasses.dataclass
class Case:
    """A link between the two passes over its file: what is broken, and the causes that would explain it."""

    link: LinkRecord
    broken: list[Breach]
    known: Known
    margin: float
    misfit: float | None
    possible: list[Candidate]
    settled: Finding | None = None   # where no cause has to be looked for


def study(link: LinkRecord) -> Case | None:
    """Find what is broken in a link, and each cause that may explain it."""
    if link.trouble is not None:
        # The file's name stands beside the message, which is about the rest.
        text = str(link.trouble).removeprefix(link.file).strip()
        return _settled(link, "unreadable", "text", text, "other programs refuse the whole file for it")
    if link.matrix is None or link.mass is None:
        return None
    matrix, mass = link.matrix, link.mass
    usable = np.abs(matrix) < LARGEST   # NaN is not
    if not usable.all():
        i, j = np.argwhere(~usable)[0]
        advice = "a wrong exponent?" if np.isfinite(matrix[i, j]) else "a number that was not computed"
        return _settled(link, "finite", "unknown", f"{matrix[i, j]} at [{i}, {j}]", advice)
    com = link.pose.rotation.T @ link.pose.place
    with np.errstate(all="ignore"):
        return _simple(link, mass, matrix) or _study(link, mass, com, matrix)


def _settled(link: LinkRecord, what: str, cause: str, text: str, advice: str, code: str = "") -> Case:
    level = CODES[code].level if code else ""
    finding = Finding(what, 100.0, text, cause, advice, level=level, code=code)
    return Case(link, [], Known(ev.Geometry(), "none"), np.nan, None, [], finding)


def _simple(link: LinkRecord, mass: float, matrix: Array) -> Case | None:
    """Zeros, before anything else is tried."""
    nothing = is_negligible(matrix, mass)
    if mass == 0 and nothing:
        return _settled(link, "massless", "massless", "massless: a frame", "mass and tensor are zero; simulators that "
                        "move the link by itself refuse it")
    if mass < 0:
        return _settled(link, "mass", "unknown", f"the mass is {mass:.6g} kg", "a sign too many?")
    if mass == 0:
        return _settled(link, "mass", "massless", "the mass is 0 kg, beside a tensor that is not zero",
                        "the mass was left at zero: give it, or make the tensor zero for a frame")
    if nothing:
        return _settled(link, "positive", "placeholder", "all moments are zero, beside a mass",
                        "a placeholder that was never filled in, or a point mass", "PI202")
    return None


def _study(link: LinkRecord, mass: float, com: Array, matrix: Array) -> Case:
    known = _known(link, mass, matrix)
    given = ev.single(mass, com, matrix)
    evidence = ev.weigh(given, known.geometry)
    margin, flaws = check(matrix)
    broken = breaches(given, evidence, Flaw(int(flaws)), float(margin), known.geometry)
    references = known.geometry.references
    misfit = ev.apart(given, known.geometry) if references else None
    case = Case(link, broken, known, float(margin), misfit, [])
    if broken or (misfit is not None and misfit > 0.02):
        case.possible = candidates(given, evidence, known, link, {breach.what for breach in broken})
    return case


def _known(link: LinkRecord, mass: float, matrix: Array) -> Known:
    """The quality of the geometry as evidence.

    "body": what is seen, all of it. "hull": the same, with convex hulls of open meshes. "collision": the shapes that
    collide alone. "part": some of it was not read. "marker": too small to hold the mass. "none": there is nothing.
    """
    try:
        geometry = link.geometry()
    except InvalidInput:   # a body that is all but flat
        return Known(ev.Geometry(), "none")
    if (link_box := geometry.box) is None:
        return Known(geometry, "none")
    seen = bool(link.visual.parts) and link.visual.whole
    quality = "body" if seen and not link.visual.bound else "hull" if seen else "collision"
    if not (link.visual.whole and link.collision.whole):
        quality = "part" if not seen else quality
    geometry = dataclasses.replace(geometry, slack=1.0 if quality in ("collision", "part") else SLACK)
    side = float(np.ptp(link_box, axis=0).max())
    volume = geometry.volume
    small = volume is not None and mass > OSMIUM * volume and not _agrees(link, geometry, mass, matrix)
    if side <= MARKER and not _agrees(link, geometry, mass, matrix) and (
            volume is None or not 50 < mass / volume < 12_000):
        return Known(geometry, "marker")
    return Known(geometry, quality, small=small)


def _agrees(link: LinkRecord, geometry: ev.Geometry, mass: float, matrix: Array) -> bool:
    """Return whether tensor over mass is that of the geometry, so that only the density is in question."""
    if not geometry.references:
        return False
    com = link.pose.rotation.T @ link.pose.place
    return ev.apart(ev.single(mass, com, matrix), geometry) < 0.3


def conclude(case: Case, support: dict[str, int]) -> Diagnosis:
    """Name the cause, given how many other links of the file each cause explains, and set the level."""
    if case.settled is not None:
        return Diagnosis((case.settled,), case.margin, case.misfit)
    link = case.link
    assert link.matrix is not None and link.mass is not None
    cause = choose(case.possible, case.known, support)
    found = [_finding(breach, cause, case) for breach in case.broken]
    findings = [finding for finding in found if finding is not None]
    if not case.broken and cause is not None and case.misfit is not None:
        left = ev.apart(cause.body, case.known.geometry)
        if cause.geometry_factor == 1 and (case.misfit > 0.2 or left < EXACT * case.misfit):
            breach = Breach("geometry", 100 * case.misfit, "differs from a uniform body of its geometry by "
                            f"{100 * case.misfit:.3g} % of the largest moment, by {100 * left:.2g} % once repaired")
            findings.append(_with_cause(breach, cause, case))
    if not case.broken and case.known.quality == "none":
        # Without a geometry nothing else would tell.
        reason = is_placeholder(link.matrix, link.mass, case.known.copies)
        if reason:
            moments = " ".join(f"{x:.6g}" for x in link.matrix.diagonal())
            text = f"the moments are {moments} kg m^2 beside {link.mass:.6g} kg, with no geometry"
            breach = Breach("size", 0.0, text)
            findings.append(_plain(breach, case, "placeholder", reason, "PI203"))
    if link.fixed:   # nothing uses these numbers
        findings = [dataclasses.replace(f, level="remark") if f.level == "warning" else f for f in findings]
    return Diagnosis(tuple(findings), case.margin, case.misfit)


def _with_cause(breach: Breach, cause: Candidate, case: Case, code: str = "") -> Finding:
    body = cause.body
    return Finding(*breach, cause.kind, cause.text, body.matrix[0], float(body.mass[0]), body.com[0],
                   level=CODES[code].level if code else "", code=code)


def _plain(breach: Breach, case: Case, cause: str, advice: str, code: str = "", matrix: Array | None = None) -> Finding:
    mass = case.link.mass
    com = case.link.pose.rotation.T @ case.link.pose.place
    return Finding(*breach, cause, advice, matrix, mass, com, level=CODES[code].level if code else "", code=code)


def _finding(breach: Breach, cause: Candidate | None, case: Case) -> Finding | None:
    """One broken condition as a finding, at the level that its evidence carries; None where it carries none."""
    link, quality = case.link, case.known.quality
    matrix, mass = link.matrix, link.mass
    assert matrix is not None and mass is not None
    if breach.what in ("triangle", "positive"):
        if breach.what == "triangle" and case.margin > -ev.ROUNDED:
            return _plain(breach, case, "rounding", "a flat body whose numbers were rounded? the nearest tensor that a "
                          "body can have is given", matrix=nearest(matrix))
        reason = is_placeholder(matrix, mass, case.known.copies)
        if cause is not None and not (reason and cause.kind == "decimal"):
            return _with_cause(breach, cause, case)
        if reason:
            return _plain(breach, case, "placeholder", reason + " No body has them")
        return _plain(breach, case, "unknown", "no single slip explains it; the nearest tensor that a body can have is "
                      "given", matrix=nearest(matrix))
    outside = breach.what == "extent" and "outside" in breach.text
    code = "PI103" if outside else ""
    placeholder = is_placeholder(matrix, mass, case.known.copies)
    if placeholder:
        return _plain(breach, case, "placeholder", placeholder, "PI203")
    if mass < 1e-5:
        return _plain(breach, case, "placeholder", "a mass of almost nothing: a placeholder?", "PI203")
    if quality == "marker" or (case.known.small and cause is None):
        return _plain(breach, case, "marker", "the geometry is too small to hold the mass: it marks the link, or shows "
                      "a part of it", "PI205")
    if breach.what == "density":
        return _density(breach, cause, case)
    if cause is not None:
        return _with_cause(breach, cause, case, code)
    amount = breach.per_cent / 100
    if outside and (quality not in ("body", "hull") or _distance(case) < OUTSIDE):
        return None
    if breach.what == "extent" and not outside:
        limit = EXTENT if quality in ("body", "hull") else EXTENT_COLLISION
        if amount + 1 < limit:
            return None
    if breach.what == "size" and quality not in ("body", "hull"):
        return None
    if case.known.identified:
        return _plain(breach, case, "identified", "many links of this file are unlike their geometry, each in a way of "
                      "its own: identified parameters, of which only sums are known?", "PI204")
    return _plain(breach, case, "unknown", "no single slip explains it; look at mass, units and geometry", code)


def _distance(case: Case) -> float:
    """How far the centre of mass lies outside the box, as a part of its largest side: a thin part may hide a motor."""
    box = case.known.geometry.box
    assert box is not None
    com = case.link.pose.rotation.T @ case.link.pose.place
    return float(np.maximum(np.maximum(box[0] - com, com - box[1]), 0.0).max() / np.ptp(box, axis=0).max())


def _density(breach: Breach, cause: Candidate | None, case: Case) -> Finding | None:
    """Mass over volume, or mass over moments, beyond what matter has."""
    link, geometry, mass = case.link, case.known.geometry, case.link.mass
    assert mass is not None and link.matrix is not None
    if geometry.volume is None or not _agrees(link, geometry, mass, link.matrix):
        if cause is not None:
            return _with_cause(breach, cause, case)
        if "below" in breach.text:
            return None   # a hollow part, whose moments say something else
        if mass <= 0.01 and np.log10(mass) == round(np.log10(mass)):
            return _plain(breach, case, "floor", f"a mass raised to {mass:g} kg, beside the tensor of a lighter part?")
        return _plain(breach, case, "unknown", "the mass or the tensor in another unit?")
    density = mass / geometry.volume
    if density < LIGHT:
        return _plain(breach, case, "density", f"mass over volume is {density:.3g} kg/m^3: a toy, or a density in "
                      "g/cm^3", "PI206")
    steps = [k for k in (1e3, 1e6) if 300 < density / k < 20_000]
    if not steps:
        steps = [k for k in (10.0, 100.0) if 600 < density / k < 9_000]
    advice = f"mass over volume is {density:.3g} kg/m^3, and the tensor goes with it: the unit of the density?"
    # The shape agrees, so mass and tensor are one factor too large together.
    error = case.known.quality == "body" and density > ev.DENSEST
    level = "PI006" if error else "PI105"
    if steps:
        body = ev.single(mass / steps[0], link.pose.rotation.T @ link.pose.place, link.matrix / steps[0])
        return Finding(*breach, "density", advice + f" Both are {steps[0]:g} times too large", body.matrix[0],
                       float(body.mass[0]), body.com[0], level=CODES[level].level, code=level)
    return _plain(breach, case, "density", advice, level)
