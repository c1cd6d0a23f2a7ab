"""Diagnosis of inertia data: errors, their size, their likely causes, and corrected data."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._core import InertiaTensor, InvalidInput, MassProperties
from . import evidence as ev
from .breaches import Breach, breaches
from .checks import Flaw, check
from .corruptions import Cause, undo
from .findings import Diagnosis, Finding

Array = npt.NDArray[np.float64]

CONVINCED = 10.0   # nats that a cause must gain on the given data, less its own rarity: 20 000 to one
GEOMETRY_UNITS = (
    (1e-3, "the geometry is in millimetres: a mesh without scale 0.001?"),
    (1e-2, "the geometry is in centimetres: a mesh without scale 0.01?"),
    (0.0254, "the geometry is in inches: a mesh without scale 0.0254?"),
    (1e3, "the geometry was scaled from millimetres to metres once too often"),
)


LARGEST = 1e100    # of any number: above it squares overflow


def diagnose(*body: Any, geometry: MassProperties | None = None, extents: npt.ArrayLike | None = None,
             volume: float | None = None, about: npt.ArrayLike | None = None) -> Diagnosis:
    """Find errors in a tensor, or in mass, centre of mass and tensor together, and suggest corrections.

    Unphysical data are not refused, but reported. A cause is named only if its correction explains the data much better
    than an uneven distribution of mass could. `docs/diagnosis.md` lists the errors that can be found.

    Parameters
    ----------
    *body
        `matrix`, or `mass, com, matrix`: the tensor, shape (3, 3), about the centre of mass [kg m^2]; the mass [kg];
        the centre of mass (3,) in the same axes [m]. Or one InertiaTensor or MassProperties.
    geometry : MassProperties, optional
        A uniform body of the same form, in the same axes from the same origin. Its mass is ignored.
    extents : array_like, shape (2, 3), optional
        Lower and upper corner of a box, along the same axes, that holds all of the body [m].
    volume : float, optional
        Approximate volume of the material [m^3], to check the density. Hollow parts are allowed for.
    about : array_like, shape (3,), optional
        The point of reference of `matrix` [m], if it is not the centre of mass.

    Returns
    -------
    Diagnosis

    Raises
    ------
    InvalidInput
        For wrong shapes, and for a mass, centre or extents that are not finite.
    """
    mass, com, matrix = _given(body)
    known = _geometry(geometry, extents, volume)
    shift = np.zeros((3, 3))
    if about is not None:
        if mass is None or com is None:
            raise InvalidInput("about: must be given together with mass and com")
        shift = mass * ev.point_term(np.asarray(_core.to_numbers(about, "about", [3])) - com)
    with np.errstate(all="ignore"):   # overflow counts as an impossible body
        return judge(mass, com, matrix - shift, known)


def _given(body: tuple[Any, ...]) -> tuple[float | None, Array | None, Array]:
    if len(body) == 1 and isinstance(body[0], MassProperties):
        props = body[0]
        return props.mass, np.asarray(props.com), np.asarray(props.inertia.matrix)
    if len(body) == 1:
        matrix = body[0].matrix if isinstance(body[0], InertiaTensor) else body[0]
        return None, None, _core.to_numbers(matrix, "matrix", [3, 3], finite=False)
    if len(body) != 3:
        raise InvalidInput(f"body: must be matrix, or mass, com, matrix; got {len(body)} arguments")
    mass, com, matrix = body
    if isinstance(matrix, InertiaTensor):
        matrix = matrix.matrix
    kilograms, place = float(_core.to_numbers(mass, "mass", [])), _core.to_numbers(com, "com", [3])
    if not (abs(kilograms) < LARGEST and np.abs(place).max() < LARGEST):
        raise InvalidInput(f"mass, com: must be below {LARGEST:g}; got {kilograms:g}, {place.tolist()}")
    return kilograms, place, _core.to_numbers(matrix, "matrix", [3, 3], finite=False)


def _geometry(body: MassProperties | None, extents: npt.ArrayLike | None, volume: float | None) -> ev.Geometry:
    if body is not None and not isinstance(body, MassProperties):
        raise InvalidInput(f"geometry: must be a MassProperties, such as a shape or a mesh; got {type(body).__name__}")
    box = None
    if extents is not None:
        box = _core.to_numbers(extents, "extents", [2, 3])
        if not (box[0] < box[1]).any() or (box[0] > box[1]).any():
            raise InvalidInput(f"extents: must be a lower and an upper corner; got {box.tolist()}")
    if volume is not None and not (volume := float(_core.to_numbers(volume, "volume", []))) > 0:
        raise InvalidInput(f"volume: must be positive; got {volume}")
    return ev.Geometry(() if body is None else (ev.reference(body),), box, volume)


def judge(mass: float | None, com: Array | None, matrix: Array, geometry: ev.Geometry,
          more: Sequence[Cause] = ()) -> Diagnosis:
    """Diagnose checked numbers; `more` are causes known from the file alone."""
    usable = np.abs(matrix) < LARGEST   # NaN is not
    if not usable.all():
        i, j = np.argwhere(~usable)[0]
        advice = "a wrong exponent?" if np.isfinite(matrix[i, j]) else "a number that was not computed"
        return Diagnosis((Finding("finite", 100.0, f"{matrix[i, j]} at [{i}, {j}]", "unknown", advice),), np.nan)
    findings = []
    if Flaw.NOT_SYMMETRIC in _judged(matrix)[1]:
        finding, matrix = _symmetric(mass, com, matrix, geometry)
        findings.append(finding)
    margin, bits = _judged(matrix)
    given = ev.single(mass, com, matrix)
    evidence = ev.weigh(given, geometry)
    broken = breaches(given, evidence, bits, margin, geometry)
    misfit = ev.apart(given, geometry) if geometry.references else None
    cause = _explain(given, evidence, {breach.what for breach in broken}, geometry, more)
    if cause is not None and not broken:
        apart, left = (100 * ev.apart(body, geometry) for body in (given, cause.body))
        broken = [Breach("geometry", apart, f"differs from a uniform body of its geometry by {apart:.3g} % of the "
                         f"largest moment, by {left:.2g} % once repaired")]
    findings += [_finding(breach, cause, given, margin) for breach in broken]
    if cause is None and geometry.known and (Flaw.TRIANGLE in bits or Flaw.NOT_POSITIVE in bits):
        # Two faults at once, maybe: what the body can be first, what it is beside its geometry then.
        first = _explain(given, ev.weigh(given, ev.Geometry()), {"triangle"}, ev.Geometry(), ())
        findings[-1] = _finding(broken[-1], first, given, margin)
        repaired = findings[-1].matrix
        findings += [] if repaired is None else judge(mass, com, repaired, geometry, more).findings
    return Diagnosis(tuple(findings), margin, misfit)


def _judged(matrix: Array) -> tuple[float, Flaw]:
    margin, flaws = check(matrix)
    return float(margin), Flaw(int(flaws))


def _explain(given: ev.Bodies, evidence: ev.Evidence, broken: set[str], geometry: ev.Geometry,
             more: Sequence[Cause]) -> Cause | None:
    """Return the cause that explains the data best, if it does so much better than bad luck."""
    if not broken and not (geometry.references and evidence.misfit[0] > 0.01):
        return None
    causes = [*more, *undo(given, geometry, only_units=broken == {"density"})]
    weighed = ev.weigh(ev.stack([given, *(cause.body for cause in causes)]), geometry)
    totals = weighed.score[1:] + [cause.cost for cause in causes]
    totals[~weighed.sound()[1:]] = np.inf
    for factor, text in GEOMETRY_UNITS if geometry.known else ():   # the body is right, what it is compared with is not
        scaled = ev.weigh(given, geometry.scaled(factor))
        causes.append(Cause("units", text, 2.0, given))
        totals = np.append(totals, scaled.score + 2.0 if scaled.sound()[0] else np.inf)
    if not causes:
        return None
    best = int(np.argmin(totals))
    return causes[best] if weighed.score[0] - totals[best] > CONVINCED else None


def _finding(breach: Breach, cause: Cause | None, given: ev.Bodies, margin: float) -> Finding:
    mass = None if np.isnan(given.mass[0]) else float(given.mass[0])
    com = None if np.isnan(given.com[0]).any() else given.com[0]
    matrix = given.matrix[0]
    rounding = breach.what == "triangle" and margin > -ev.ROUNDED
    if cause is not None and not (rounding and cause.kind == "decimal"):
        body = cause.body
        return Finding(*breach, cause.kind, cause.text, body.matrix[0], None if mass is None else float(body.mass[0]),
                       None if com is None else body.com[0])
    diagonal = matrix.diagonal()
    if breach.what in ("triangle", "positive") and diagonal.any():
        kind, advice = ("rounding", "a flat body whose numbers were rounded?") if rounding else (
            "unknown", "no single slip explains it;")
        advice += " the nearest tensor that a body can have is given"
        return Finding(*breach, kind, advice, nearest(matrix), mass, com)
    if not matrix.any() or (np.ptp(diagonal) == 0 and np.count_nonzero(matrix) == 3):
        return Finding(*breach, "placeholder", "a placeholder that was never filled in?", None, mass, com)
    return Finding(*breach, "unknown", "no single slip explains it; look at mass, units and geometry", None, mass, com)


def nearest(matrix: Array) -> Array:
    """Return the nearest tensor that a body can have: second moments that are negative become zero."""
    values, axes = np.linalg.eigh(ev.spread(matrix))
    repaired = ev.from_spread(axes * np.maximum(values, 0.0) @ axes.T)
    return (repaired + repaired.T) / 2


def _symmetric(mass: float | None, com: Array | None, matrix: Array, geometry: ev.Geometry) -> tuple[Finding, Array]:
    """What broke the symmetry, and the best symmetric tensor: of each pair either entry, either sign."""
    largest = np.abs(matrix).max()
    apart = np.abs(matrix - matrix.T) / largest
    i, j = divmod(int(apart.argmax()), 3)
    i, j = min(i, j), max(i, j)
    a, b = matrix[i, j], matrix[j, i]
    text = f"{a:.6g} at [{i}, {j}] and {b:.6g} across, apart by {100 * apart.max():.3g} % of the largest entry"
    upper, lower = (np.triu(m) + np.triu(m, 1).T for m in (matrix, matrix.T))
    if apart.max() < ev.ROUNDED:
        return Finding("symmetric", 100 * apart.max(), text, "rounding", "rounded numbers: the mean of both is taken",
                       (matrix + matrix.T) / 2, mass, com), (matrix + matrix.T) / 2
    choices = [upper, lower]
    weighed = ev.weigh(ev.stack([ev.single(mass, com, m) for m in choices]), geometry)
    best = choices[int(np.argmin(weighed.score))]
    cause, advice = "unknown", "a slip in one of them; the entry that fits better is taken"
    ratio = abs(a / b) if a and b else 0.0
    if not (np.triu(matrix, 1).any() and np.tril(matrix, -1).any()):
        cause, advice = "triangle of zeros", "one triangle only was filled in: it is copied across"
        best = upper + lower - np.diag(matrix.diagonal())
    elif a == -b:
        cause, advice = "sign", "the sign in one triangle; " + (
            "the better fit is taken" if geometry.references else "the data do not show which")
    elif ratio and abs(np.log10(ratio) - round(np.log10(ratio))) < 1e-9:
        cause, advice = "decimal", "a decimal point in one of them; the entry that fits better is taken"
    return Finding("symmetric", 100 * apart.max(), text, cause, advice, best, mass, com), best

