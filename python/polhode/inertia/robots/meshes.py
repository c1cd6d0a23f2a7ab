"""Meshes as bodies: each file is read and integrated once, and placed as often as it is named."""

from __future__ import annotations

import collections
import dataclasses
import functools
import pathlib
import warnings
from typing import Any

import numpy as np
import numpy.typing as npt

from ... import mesh as mesh_files
from ..._core import InvalidInput, MassProperties
from ..evidence import from_spread, spread

Array = npt.NDArray[np.float64]

MOST_CACHED = 300_000_000   # bytes of vertices that stay in memory


@dataclasses.dataclass(frozen=True)
class Moments:
    """Volume, centre and second moments about it, of unit density, in the file's unit."""

    volume: float
    centre: Array
    second: Array


@dataclasses.dataclass(frozen=True)
class Surface:
    """A mesh file.

    `solid` is the body inside where the surface is closed. `hull` is the convex hull where it is not: a bound, larger
    than the body.
    """

    corners: Array            # vertices that faces use, or of the hull
    solid: Moments | None
    hull: Moments | None
    why: str = ""             # of a surface that is not closed

    @functools.cached_property
    def low(self) -> Array:
        """The lower corner of the box round it."""
        return np.asarray(self.corners.min(0))

    @functools.cached_property
    def high(self) -> Array:
        """The upper corner of the box round it."""
        return np.asarray(self.corners.max(0))


_cache: collections.OrderedDict[tuple[str, int, int], Surface | InvalidInput] = collections.OrderedDict()


def surface(file: pathlib.Path) -> Surface:
    """Read a mesh file once.

    Raises
    ------
    InvalidInput
        As `polhode.mesh.read`.
    """
    try:
        state = file.stat()
    except OSError as error:
        raise InvalidInput(f"{file}: cannot be read: {error.strerror}") from None
    key = (str(file.resolve()), state.st_mtime_ns, state.st_size)
    if key in _cache:
        _cache.move_to_end(key)
    else:
        try:
            _cache[key] = _surface(*mesh_files.read(file))
        except InvalidInput as error:
            _cache[key] = error
        total = 0
        for held in reversed(list(_cache)):
            value = _cache[held]
            total += value.corners.nbytes if isinstance(value, Surface) else 1000
            if total > MOST_CACHED and held != key:
                del _cache[held]
    found = _cache[key]
    if isinstance(found, InvalidInput):
        raise found
    return found


def inline(vertices: Array, faces: npt.NDArray[np.int64] | None) -> Surface:
    """A mesh whose numbers stand in the description; without faces MuJoCo takes the convex hull."""
    if faces is None:
        hull = convex_hull(vertices)
        return Surface(vertices, None if hull is None else hull[0], None)
    if faces.size and (faces.min() < 0 or faces.max() >= len(vertices)):
        raise InvalidInput(f"a face names vertex {int(faces.max())} of {len(vertices)}")
    return _surface(vertices, faces)


def _surface(vertices: Array, faces: npt.NDArray[np.int64]) -> Surface:
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    corners = vertices if used.all() else vertices[used]
    if not np.isfinite(corners).all():
        raise InvalidInput("holds vertices that are not finite")
    try:
        with warnings.catch_warnings():   # of its size, which is compared here, and of the winding
            warnings.simplefilter("ignore")
            solid = MassProperties.from_mesh(vertices, faces, density=1.0, repair="flip")
        return Surface(corners, _moments(solid), None)
    except InvalidInput as error:   # open, as many visual meshes are
        why = str(error)
    hull = convex_hull(corners)
    return Surface(corners if hull is None else hull[1], None, None if hull is None else hull[0], why)


def _moments(body: MassProperties) -> Moments:
    return Moments(body.mass, np.asarray(body.com), spread(np.asarray(body.inertia.matrix)))


def convex_hull(points: Array) -> tuple[Moments, Array] | None:
    """The body within the convex hull, and the hull's vertices; None without SciPy, and where the points are flat."""
    try:
        from scipy.spatial import (  # type: ignore[import-untyped, import-not-found, unused-ignore]
            ConvexHull,
            QhullError,
        )
    except ImportError:
        return None
    if len(points) < 4:
        return None
    try:
        points = _outer(points, ConvexHull)
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return None
    middle = points[hull.vertices].mean(0)
    a, b, c = (points[hull.simplices[:, i]] - middle for i in range(3))
    volumes = np.abs(np.einsum("ni,ni->n", a, np.cross(b, c))) / 6   # of tetrahedra from a point inside
    volume = float(volumes.sum())
    if not volume > 0:
        return None
    total = a + b + c
    centre = (volumes[:, None] * total).sum(0) / (4 * volume)
    # The integral of x x^T over a tetrahedron with a corner at 0: V/20 (sum of v v^T + s s^T), s the sum of corners.
    second = sum((np.einsum("n,ni,nj->ij", volumes, x, x) for x in (a, b, c, total)), np.zeros((3, 3))) / 20
    second = second - volume * np.outer(centre, centre)
    return Moments(volume, centre + middle, second), points[hull.vertices]


# Thirteen directions, with their opposites: the axes of a cube, of its edges and of its corners.
_DIRECTIONS = np.array([(x, y, z) for x in (0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)
                        if (x, y, z) > (0, 0, 0)], dtype=float)


def _outer(points: Array, make: Any) -> Array:
    """Leave out repeated points, and those within the hull of some extreme ones: they are no corners of the whole."""
    if len(points) < 1000:
        return points
    along = points @ _DIRECTIONS.T
    extreme = points[np.unique([along.argmax(0), along.argmin(0)])]
    if len(extreme) < 5:
        return points
    reach = float(np.abs(points).max())
    beyond = np.zeros(len(points), dtype=bool)
    for plane in make(extreme).equations:
        beyond |= points @ plane[:3] + plane[3] > -1e-9 * reach
    left = np.ascontiguousarray(points[beyond])
    rows = np.unique(left.view([("", left.dtype)] * 3))
    return rows.view(left.dtype).reshape(-1, 3)


def placed(moments: Moments, scale: Array, rotation: Array, place: Array) -> MassProperties:
    """The body with scaled axes, rotated and moved: x = rotation @ (scale * x_file) + place."""
    volume = moments.volume * float(np.abs(scale.prod()))
    second = moments.second * np.outer(scale, scale) * float(np.abs(scale.prod()))
    tensor = from_spread(rotation @ second @ rotation.T)
    return MassProperties(volume, rotation @ (scale * moments.centre) + place, (tensor + tensor.T) / 2)
