"""Mass properties of meshes: against exact fractions, closed forms, published values and trimesh; and what is refused."""

import os
import pathlib
import pickle
import subprocess
import sys
import warnings
from fractions import Fraction

import numpy as np
import pytest
from meshes import TETRAHEDRON_FACES, box, exact, globe, inward, join, soup

import polhode as ph

EPS = 2.0**-53
TURN = ph.Rotation.from_rotvec((0.3, -1.1, 0.7)).as_matrix()


def errors(body, truth, density=1):
    """Relative errors of mass, centre (of the size or its own distance) and inertia (of its largest entry)."""
    volume, centre, inertia = truth
    largest = density * max(abs(x) for row in inertia for x in row)
    size = (largest / (density * volume)) ** 0.5
    mass = abs(Fraction(body.mass) / (density * volume) - 1)
    com = max(abs(Fraction(float(x)) - c) / max(Fraction(size), abs(c)) for x, c in zip(body.com, centre))
    moment = max(abs(Fraction(float(body.inertia.matrix[i, j])) - density * inertia[i][j]) / largest
                 for i in range(3) for j in range(3))
    return float(mass), float(com), float(moment)


def check(mesh, density=1.0, limit=4 * EPS, **options):
    body = ph.MassProperties.from_mesh(*mesh, density=density, **options)
    found = errors(body, exact(*mesh), Fraction(density))
    assert max(found) <= limit, found
    return body


def sliver(thickness):
    """A plate, turned anyhow: what the doubles of its corners say it is."""
    vertices, faces = box((-1, -0.5, -thickness), (1, 0.5, thickness))
    return vertices @ TURN.T, faces


def lollipop():
    """A ball on a long thin stick, one surface: far from the middle of its box."""
    def radius(x, y, z):
        return 1 if z > -0.98 else 40
    return globe(40, 20, radius, TURN)


MESHES = {
    "tetrahedron": (np.array([(0, 0, 0), (3, 0.1, 0), (0.2, 2, 0), (0.3, 0.4, 1)]), TETRAHEDRON_FACES),
    "box": box((-1, -2, -3), (1, 2, 3)),
    "turned box": (box((-1, -2, -3), (1, 2, 3))[0] @ TURN.T, box()[1]),
    "hollow box": join(box(), inward(box((-0.9, -0.8, -0.7), (0.9, 0.8, 0.7)))),
    "thin shell": join(globe(16, 8, turn=TURN), inward(globe(16, 8, lambda *v: 1 - 1e-7, TURN))),
    "two parts": join(box(), box((5, 0, 0), (6, 7, 0.1))),
    "sliver": sliver(1e-7),
    "needle": (box((-1e-6, -1e-6, -1), (1e-6, 1e-6, 1))[0] @ TURN.T, box()[1]),
    "lollipop": lollipop(),
    "potato": globe(32, 24, lambda x, y, z: 1 + 0.3 * x * y + 0.2 * z**3, TURN),
    "tiny": (box((-1, -2, -3), (1, 2, 3))[0] @ TURN.T * 1e-12, box()[1]),
    "huge": (box((-1, -2, -3), (1, 2, 3))[0] @ TURN.T * 1e12, box()[1]),
}


@pytest.mark.filterwarnings("ignore:vertices. the mesh is")
@pytest.mark.parametrize("name", MESHES)
def test_against_exact_fractions(name):
    check(MESHES[name])
    check(MESHES[name], density=2700.0)


@pytest.mark.filterwarnings("ignore:vertices. the mesh is")
@pytest.mark.parametrize("offset", [1.0, 1e3, 1e6])
@pytest.mark.parametrize("name", [name for name in MESHES if name != "huge"])
def test_far_from_the_origin(name, offset):
    """The vertices are moved, and rounded there: what they are then is the input."""
    vertices, faces = MESHES[name]
    extent = np.ptp(vertices, axis=0).max()
    moved = vertices + offset * extent * np.array([1, -0.7, 0.3])
    if name in ("sliver", "needle", "thin shell") and offset > 1:
        pytest.skip("rounded away")
    check((moved, faces))


@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_many_faces_in_plain_numbers_are_as_exact(offset):
    vertices, faces = globe(80, 40, lambda x, y, z: 1 + 0.3 * x * y + 0.2 * z**3, TURN)
    mesh = vertices + offset, faces
    assert ph._core.mesh_is_refined(*mesh) is False
    check(mesh)


def test_many_faces_that_need_more():
    flat, faces = globe(60, 30, lambda *v: 1.0)
    flat = flat * (1, 1, 1e-8) @ TURN.T
    assert ph._core.mesh_is_refined(flat, faces) is True
    check((flat, faces))


def test_closed_forms():
    for body, mesh in ((ph.shapes.box(48, (1, 2, 3)), MESHES["box"]),
                       (ph.shapes.tetrahedron(1, MESHES["tetrahedron"][0]), MESHES["tetrahedron"])):
        found = ph.MassProperties.from_mesh(*mesh, mass=body.mass)
        assert found.mass == body.mass
        np.testing.assert_allclose(found.com, body.com, rtol=0, atol=1e-16)
        np.testing.assert_allclose(found.inertia.matrix, body.inertia.matrix, rtol=0, atol=4e-16 * body.inertia.moments[2])


def test_tonons_tetrahedron():
    """F. Tonon, J. Math. Stat. 1 (2004) 8, density 1: printed with the rounding of its own computation, about 1e-8."""
    corners = [(8.33220, -11.86875, 0.93355), (0.75523, 5.0, 16.37072), (52.61236, 5.0, -5.38580), (2.0, 5.0, 3.0)]
    body = ph.MassProperties.from_mesh(corners, TETRAHEDRON_FACES[:, ::-1], density=1)
    np.testing.assert_allclose(body.com, (15.92492, 0.78281, 3.72962), atol=3e-5)
    a, b, c = 43520.33257, 194711.28938, 191168.76173  # moments
    yz, xz, xy = 4417.66150, -46343.16662, 11996.20119  # products, without the tensor's minus sign
    np.testing.assert_allclose(body.inertia.matrix, [(a, -xy, -xz), (-xy, b, -yz), (-xz, -yz, c)], rtol=3e-8)
