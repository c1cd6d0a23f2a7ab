"""The solid of a film: a box or an ellipsoid of the body's inertia, or a mesh, as coloured triangles in body axes."""

from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ... import mesh, torques
from ..._core import InvalidInput, MassProperties
from ..._scene.scene import Scene
from ..._solve.motion import Floats

MOST = 60_000          # triangles: a page of 6 MB
THINNEST = 0.02        # of the largest side: so much of a flat or thin body is drawn
LEVER = 0.8            # of the largest share of the inertia that the distance from the pivot can explain
# The two colours along each principal axis, for the sides that look along it and against it.
SIDES = (("#e69f00", "#b87a00"), ("#56b4e9", "#2b7fb3"), ("#4fbf8b", "#258a5c"))


class Solid(NamedTuple):
    """Triangles in body axes about the fixed point, the largest distance from it being 1."""

    corners: Floats     # (n, 3, 3)
    normals: Floats     # (n, 3, 3)
    colours: Floats     # (n, 3), red, green and blue from 0 to 1
    name: str           # what it is, in words
    arm: Floats | None  # unit vector from the pivot towards the centre of mass; None for a body without a pivot


def _rgb(colour: str) -> list[float]:
    return [int(colour[k:k + 2], 16) / 255 for k in (1, 3, 5)]


def find_arm(scene: Scene) -> Floats | None:
    """Return the unit vector from the pivot to the centre of mass, or None without gravity on a pivot."""
    total = sum((t.weight * np.asarray(t.arm) for t in scene.torques if isinstance(t, torques.Gravity)), np.zeros(3))
    size = float(np.linalg.norm(total))
    return total / size if size > 0 else None


def _about_centre(scene: Scene) -> tuple[Floats, Floats, Floats]:
    """Return spreads (second moments along principal axes), those axes as columns, and the centre of mass.

    About a pivot, inertia fixes the body's size and its lever up to one number, k = m r^2: I = I_com + k (1 - u u^T).
    """
    matrix, arm, k = np.asarray(scene.inertia.matrix), find_arm(scene), 0.0
    if arm is not None:
        across = np.eye(3) - np.outer(arm, arm)
        low, high = 0.0, float(np.trace(matrix))
        for _ in range(60):   # the largest k that leaves a body
            k = (low + high) / 2
            low, high = (k, high) if _spreads(matrix - k * across)[0].min() >= 0 else (low, k)
        k = LEVER * low
        matrix = matrix - k * across
    spreads, axes = _spreads(matrix)
    return spreads, axes, np.zeros(3) if arm is None else np.sqrt(k) * arm   # for mass 1


def _spreads(matrix: Floats) -> tuple[Floats, Floats]:
    """Return the principal values of the integral of x x^T dm, which is trace(I)/2 - I, and a right-handed frame."""
    values, axes = np.linalg.eigh(np.trace(matrix) / 2 * np.eye(3) - matrix)
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    return values, axes


def _half_sides(spreads: Floats, factor: float) -> Floats:
    sides = np.sqrt(factor * np.maximum(spreads, 0.0))
    return np.maximum(sides, THINNEST * max(float(sides.max()), 1e-300))


def _box(scene: Scene) -> tuple[Floats, Floats, Floats]:
    """The uniform box: spread = side^2 / 3 of a half side."""
    spreads, axes, centre = _about_centre(scene)
    half = _half_sides(spreads, 3.0)
    corners, normals, colours = [], [], []
    for k in range(3):
        u, v = np.eye(3)[(k + 1) % 3], np.eye(3)[(k + 2) % 3]
        for side, sign in enumerate((1.0, -1.0)):
            n = sign * np.eye(3)[k]
            ring = [n + a * u + sign * b * v for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            for triangle in ((0, 1, 2), (0, 2, 3)):
                corners.append([ring[j] * half for j in triangle])
                normals.append([n] * 3)
                colours.append(_rgb(SIDES[k][side]))
    return np.array(corners) @ axes.T + centre, np.array(normals) @ axes.T, np.array(colours)


def _ellipsoid(scene: Scene, rows: int = 16) -> tuple[Floats, Floats, Floats]:
    """The uniform ellipsoid: spread = semi-axis^2 / 5. Its octants have two colours, so that its rotation is seen."""
    spreads, axes, centre = _about_centre(scene)
    semi = _half_sides(spreads, 5.0)
    unit = sphere(rows)
    middle = unit.mean(axis=1)
    even = np.prod(np.sign(middle), axis=1) > 0
    colours = np.where(even[:, None], _rgb(SIDES[0][0]), _rgb(SIDES[1][1]))
    normals = unit / semi
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    return unit * semi @ axes.T + centre, normals @ axes.T, colours


def sphere(rows: int) -> Floats:
    """Return triangles of the unit sphere, outward, shape (n, 3, 3)."""
    theta, phi = np.linspace(0, np.pi, rows + 1), np.linspace(0, 2 * np.pi, 2 * rows + 1)
    points = np.stack([np.outer(np.sin(theta), np.cos(phi)), np.outer(np.sin(theta), np.sin(phi)),
                       np.outer(np.cos(theta), np.ones_like(phi))], axis=-1)
    points[:, -1] = points[:, 0]
    points[0], points[-1] = (0, 0, 1), (0, 0, -1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    upper, lower = np.stack([a, b, c], axis=2)[:-1], np.stack([a, c, d], axis=2)[1:]   # one triangle at the poles
    return np.concatenate([upper.reshape(-1, 3, 3), lower.reshape(-1, 3, 3)])


def _mesh(scene: Scene, given: Any) -> tuple[Floats, Floats, Floats]:
    """A mesh as it is: about its centre of mass, or about its origin, where there is a pivot."""
    if isinstance(given, (str, os.PathLike)):
        given = mesh.read(given)
    elif hasattr(given, "vertices") and hasattr(given, "faces"):
        given = given.vertices, given.faces
    try:
        vertices, faces = np.asarray(given[0], dtype=float), np.asarray(given[1], dtype=int)
        fits = vertices.ndim == faces.ndim == 2 and vertices.shape[1] == faces.shape[1] == 3 and faces.size > 0
        fits = fits and faces.min() >= 0 and faces.max() < len(vertices) and bool(np.isfinite(vertices).all())
    except (TypeError, ValueError, IndexError, KeyError):
        fits = False
    if not fits:
        raise InvalidInput("body: must be 'box', 'ellipsoid', a mesh file, or vertices (n, 3) and faces (m, 3)")
    if len(faces) > MOST:
        raise InvalidInput(f"body: must have at most {MOST:,} triangles to be shown, got {len(faces):,}")
    if find_arm(scene) is None:
        try:
            vertices = vertices - MassProperties.from_mesh(vertices, faces, density=1.0).com
        except InvalidInput:   # an open surface has no volume; it is drawn about its middle
            vertices = vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    corners = vertices[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = normal / np.where(size > 0, size, 1.0)
    along = np.abs(normal).argmax(axis=1)
    side = (normal[np.arange(len(faces)), along] < 0).astype(int)
    palette = np.array([[_rgb(colour) for colour in pair] for pair in SIDES])
    return corners, np.repeat(normal[:, None], 3, axis=1), palette[along, side]


def make_solid(scene: Scene, body: Any = "box") -> Solid:
    """Return what a film rotates.

    Parameters
    ----------
    scene : Scene
    body : {"box", "ellipsoid"}, path, (vertices, faces), or an object with these two
    """
    named: dict[str, Any] = {"box": _box, "ellipsoid": _ellipsoid}
    if isinstance(body, str) and body in named:
        corners, normals, colours = named[body](scene)
        about = "about the pivot" if find_arm(scene) is not None else "of the body"
        name = f"uniform {body} with the inertia {about}"
    else:
        corners, normals, colours = _mesh(scene, body)
        name = "mesh"
    reach = float(np.linalg.norm(corners, axis=2).max()) or 1.0
    return Solid(corners / reach, normals, colours, name, find_arm(scene))


def choose_axis(scene: Scene, axis: npt.ArrayLike | None) -> Floats:
    """Return the body axis whose path is drawn, unit: as given, or the arm, or the principal axis nearest to omega."""
    if axis is not None:
        given: Floats = np.asarray(axis, dtype=float)
        if given.shape != (3,) or not np.isfinite(given).all() or not given.any():
            raise InvalidInput(f"axis: must be a vector of shape (3,), finite and not 0; got {axis!r}")
        return np.asarray(given / np.linalg.norm(given))
    if (arm := find_arm(scene)) is not None:
        return arm
    axes = np.asarray(scene.inertia.axes)
    along = axes.T @ np.asarray(scene.omega)
    k = int(np.abs(along).argmax())
    return np.asarray(axes[:, k] * (1.0 if along[k] >= 0 else -1.0))
