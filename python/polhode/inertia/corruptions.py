"""Common errors in inertia data, each with its correction."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .evidence import Bodies, Geometry, point_term, single

Array = npt.NDArray[np.float64]

ENTRIES = {"ixx": (0, 0), "iyy": (1, 1), "izz": (2, 2), "ixy": (0, 1), "ixz": (0, 2), "iyz": (1, 2)}
ORDERS = {
    "xx, xy, xz, yy, yz, zz": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),   # URDF, SDF
    "xx, yy, zz, xy, xz, yz": ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"),   # MuJoCo
    "xx, yy, zz, yz, xz, xy": ("ixx", "iyy", "izz", "iyz", "ixz", "ixy"),   # Voigt
    "xx, xy, yy, xz, yz, zz": ("ixx", "ixy", "iyy", "ixz", "iyz", "izz"),   # the lower triangle, row by row
}
USUAL = set(list(ORDERS)[:2])


class Cause(NamedTuple):
    """A possible error, and the corrected body."""

    kind: str
    text: str
    cost: float    # in nats: how rare it is
    body: Bodies


def _key(body: Bodies) -> bytes:
    return b"".join((part + 0.0).tobytes() for part in body)   # 0.0: minus zero is zero


def undo(given: Bodies, geometry: Geometry, only_units: bool = False) -> list[Cause]:
    """Return all possible causes for a body, without those that change nothing."""
    mass = float(given.mass[0]) if np.isfinite(given.mass[0]) else None
    com = given.com[0] if np.isfinite(given.com[0]).all() else None
    matrix = given.matrix[0]
    causes: list[Cause] = []
    seen = {_key(given)}
    families = [_units(mass, com, matrix)]
    if not only_units:
        families += [_signs(mass, com, matrix), _points(mass, com, matrix, geometry), _orders(mass, com, matrix),
                     _axes(mass, com, matrix), _decimals(mass, com, matrix, geometry)]
    for family in families:
        new = []
        for cause in family:
            if (key := _key(cause.body)) not in seen:
                seen.add(key)
                new.append(cause)
        causes += [cause._replace(cost=cause.cost + float(np.log(len(new)))) for cause in new]
    return causes


def _signs(mass: float | None, com: Array | None, matrix: Array) -> Iterator[Cause]:
    for names, cost in ((("ixy", "ixz", "iyz"), 0.0), (("ixy",), 2.0), (("ixz",), 2.0), (("iyz",), 2.0)):
        flipped = matrix.copy()
        for name in names:
            i, j = ENTRIES[name]
            flipped[i, j] = flipped[j, i] = -matrix[i, j]
        if len(names) == 3:
            text = "the products of inertia have the opposite sign (written as +integral of x y dm): reverse all three"
        else:
            text = f"the sign of {names[0]}: reverse it"
        yield Cause("sign", text, cost, single(mass, com, flipped))


def _orders(mass: float | None, com: Array | None, matrix: Array) -> Iterator[Cause]:
    for (read, places), (written, names) in itertools.permutations(ORDERS.items(), 2):
        sorted_out = np.empty((3, 3))
        for place, name in zip(places, names):
            i, j = ENTRIES[name]
            sorted_out[i, j] = sorted_out[j, i] = matrix[ENTRIES[place]]
        text = f"the order of the six numbers: written as {written}, read as {read}"
        usual = {read, written} == USUAL
        yield Cause("order", text, 0.5 if usual else 2.5, single(mass, com, sorted_out))


def _points(mass: float | None, com: Array | None, matrix: Array, geometry: Geometry) -> Iterator[Cause]:
    if mass is None or com is None:
        return
    term = mass * point_term(com)
    where = "(" + ", ".join(f"{x:.4g}" for x in com) + ")"
    if com.any():
        yield Cause("point", "the tensor is about the frame's origin, not about the centre of mass: subtract the "
                    f"parallel-axis term m (d.d 1 - d d^T), d = {where} m", 0.0, single(mass, com, matrix - term))
        yield Cause("point", "the parallel-axis term was subtracted from a tensor about the centre of mass: "
                    f"add m (d.d 1 - d d^T) again, d = {where} m", 3.5, single(mass, com, matrix + term))
    else:
        for r in geometry.references:
            where = "(" + ", ".join(f"{x:.4g}" for x in r.com) + ")"
            yield Cause("point", f"the centre of mass was left at the origin: the geometry has it at {where} m", 1.0,
                        single(mass, r.com, matrix))
            yield Cause("point", "tensor about the frame's origin and no centre of mass: the geometry has it at "
                        f"{where} m; subtract the parallel-axis term", 1.0,
                        single(mass, r.com, matrix - mass * point_term(r.com)))


# (mass, tensor, com): what each was multiplied by, what to say, and how rare it is
UNITS = (
    (1e3, 1, 1, "the mass is in grams", 0.0),
    (1e3, 1e3, 1, "mass in grams and tensor in g m^2", 0.5),
    (1, 1e3, 1, "the tensor is in g m^2 (or the mass in tonnes)", 0.5),
    (1, 1e6, 1, "the tensor is in kg mm^2", 0.0),
    (1, 1e6, 1e3, "lengths in millimetres: the tensor is in kg mm^2, the centre of mass in mm", 0.0),
    (1, 1e9, 1, "the tensor is in g mm^2", 0.0),
    (1, 1e9, 1e3, "the tensor is in g mm^2, the centre of mass in mm", 0.0),
    (1e3, 1e9, 1, "mass in grams and tensor in g mm^2", 0.5),
    (1e3, 1e9, 1e3, "all in grams and millimetres", 0.0),
    (1, 1e4, 1, "the tensor is in kg cm^2", 0.5),
    (1, 1e4, 1e2, "lengths in centimetres: the tensor is in kg cm^2, the centre of mass in cm", 0.5),
    (1, 1e7, 1, "the tensor is in g cm^2", 0.5),
    (1, 1e7, 1e2, "the tensor is in g cm^2, the centre of mass in cm", 0.5),
    (1e3, 1e7, 1e2, "all in grams and centimetres", 0.5),
    (1, 1, 1e3, "the centre of mass is in millimetres", 0.0),
    (1, 1, 1e2, "the centre of mass is in centimetres", 0.5),
    (1, 1, 1e-3, "the centre of mass was divided by 1000 once too often (metres taken for millimetres)", 0.5),
    (1e-3, 1, 1, "the mass is in tonnes, or was divided by 1000 once too often", 0.5),
    (1, 1e-3, 1, "the tensor was divided by 1000 (grams to kilograms) once too often", 0.5),
    (1e-3, 1e-3, 1, "mass and tensor were divided by 1000 (grams to kilograms) once too often", 0.5),
    (1, 1e-6, 1, "the tensor was divided by 1e6 (mm^2 to m^2) once too often", 0.0),
    (1, 1e-6, 1e-3, "lengths were divided by 1000 once too often, in the tensor and the centre of mass", 0.5),
    (1, 1e-9, 1, "the tensor was divided by 1e9 (g mm^2 to kg m^2) once too often", 0.5),
    (1, 1e-9, 1e-3, "tensor and centre of mass were taken from grams and millimetres once too often", 0.5),
    (1, 1e-4, 1, "the tensor was divided by 1e4 (cm^2 to m^2) once too often", 0.5),
    (1, 1e-7, 1, "the tensor was divided by 1e7 (g cm^2 to kg m^2) once too often", 1.0),
    (1, 1 / 2.926397e-4, 1, "the tensor is in lb in^2", 1.5),
)


def _units(mass: float | None, com: Array | None, matrix: Array) -> Iterator[Cause]:
    if mass is None:
        return
    for k_mass, k_tensor, k_com, text, cost in UNITS:
        if k_com != 1 and (com is None or not com.any()):
            continue
        yield Cause("units", text, cost,
                    single(mass / k_mass, None if com is None else com / k_com, matrix / k_tensor))


def _axes(mass: float | None, com: Array | None, matrix: Array) -> Iterator[Cause]:
    for order in itertools.permutations(range(3)):
        for signs in ((1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1)):
            mirror = np.eye(3)[list(order)] * np.array(signs)[:, None]
            rotated = mirror @ matrix @ mirror.T
            if order == (0, 1, 2):
                axis = "xyz"[signs.index(-1)] if -1 in signs else ""
                if not axis:
                    continue
                text = f"mirrored or left-handed axes: {axis} points the other way"
                cost = 1.0
            else:
                text = "axes exchanged: x, y, z should be " + ", ".join(
                    ("-" if s < 0 else "") + "xyz"[i] for i, s in zip(order, signs))
                cost = 1.5 + (min(signs) < 0)
            yield Cause("axes", text + ", in the tensor", cost, single(mass, com, rotated))
            if com is not None and com.any():
                yield Cause("axes", text + ", in tensor and centre of mass", cost + 0.5,
                            single(mass, mirror @ com, rotated))
                if order == (0, 1, 2):   # a mirror turns one component of com, or the two others with the frame
                    yield Cause("axes", text + ", in tensor and centre of mass", cost + 0.5,
                                single(mass, -mirror @ com, rotated))
    values, q = np.linalg.eigh(matrix)
    back = q.T @ np.diag(values) @ q
    for order in itertools.permutations(range(3)):
        for signs in ((1, 1, 1), (-1, 1, 1), (1, -1, 1), (1, 1, -1)):
            mirror = np.eye(3)[list(order)] * np.array(signs)[:, None]
            yield Cause("axes", "the principal axes were applied transposed (R^T D R for R D R^T)", 2.0,
                        single(mass, com, mirror @ back @ mirror.T))


def _decimals(mass: float | None, com: Array | None, matrix: Array, geometry: Geometry) -> Iterator[Cause]:
    slips = ((10.0, 0.0), (0.1, 0.0), (100.0, 1.5), (0.01, 1.5), (1000.0, 2.5), (0.001, 2.5))
    for name, (i, j) in ENTRIES.items():
        if matrix[i, j] == 0:
            continue
        for factor, cost in slips:
            slipped = matrix.copy()
            slipped[i, j] = slipped[j, i] = matrix[i, j] * factor
            yield Cause("decimal", f"a decimal point in {name}: {slipped[i, j]:.6g} instead of {matrix[i, j]:.6g}",
                        1.0 + cost, single(mass, com, slipped))
    if mass is None or not geometry.references:
        return
    for factor, cost in slips[:4]:
        yield Cause("decimal", f"a decimal point in the mass, {mass * factor:.6g} instead of {mass:.6g} kg, or in the "
                    "whole tensor the other way", 1.0 + cost, single(mass * factor, com, matrix))
        for i in range(3 if com is not None else 0):
            assert com is not None
            if com[i]:
                moved = com.copy()
                moved[i] *= factor
                yield Cause("decimal", f"a decimal point in the centre of mass, {'xyz'[i]}: {moved[i]:.6g} instead of "
                            f"{com[i]:.6g} m", 1.0 + cost, single(mass, moved, matrix))
