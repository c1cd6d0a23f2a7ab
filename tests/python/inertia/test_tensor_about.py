"""Bodies from tensors about other points, bodies that no mass makes, and solids with the same mass properties."""

from fractions import Fraction

import numpy as np
import pytest

import polhode as ph


def test_a_report_about_the_origin():
    body = ph.shapes.box(3, (1, 2, 3)).moved((0.5, 0.5, 0.5, 0.5), (4, -5, 6))
    for point in ((0, 0, 0), (1, 2, 3), (4, -5, 6)):
        again = ph.MassProperties.from_tensor(3, body.com, body.about(point), about=point)
        np.testing.assert_allclose(again.inertia.matrix, body.inertia.matrix, rtol=0, atol=1e-13)
        assert again.mass == 3 and np.array_equal(again.com, body.com)
    assert ph.MassProperties.from_tensor(3, body.com, body.about((0, 0, 0)).matrix) == \
        ph.MassProperties.from_tensor(3, body.com, body.about((0, 0, 0)))
    assert ph.MassProperties.from_tensor(3, body.com, body.inertia, about=body.com) == body


def test_against_fractions():
    mass, com, about = 2.5, (0.5, -0.25, 3.0), (1.0, 0.125, -2.0)
    matrix = [[160.0, 1, 2], [1, 170.0, 3], [2, 3, 190.0]]
    d = [Fraction(c) - Fraction(a) for c, a in zip(com, about)]
    square = sum(x * x for x in d)
    exact = [[Fraction(matrix[i][j]) - Fraction(mass) * ((square if i == j else 0) - d[i] * d[j]) for j in range(3)]
             for i in range(3)]
    found = ph.MassProperties.from_tensor(mass, com, matrix, about=about)
    np.testing.assert_allclose(found.inertia.matrix, [[float(x) for x in row] for row in exact], rtol=0, atol=4e-14)


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
def test_what_no_body_has(scale):
    body = ph.shapes.box(3, (scale, 2 * scale, 3 * scale)).moved(translation=(9 * scale, 0, 0))
    with pytest.raises(ph.InvalidInput, match="inertia about the centre of mass: must be .*about the centre of mass "
                                              "already"):
        ph.MassProperties.from_tensor(3, body.com, body.inertia)
    thin = ph.shapes.rod(2, scale).moved(translation=(1e3 * scale, 0, 0))   # rounding leaves less than nothing
    again = ph.MassProperties.from_tensor(2, thin.com, thin.about((0, 0, 0)))
    assert abs(again.inertia.matrix[2, 2]) <= 1e-9 * scale**2


def test_bad_arguments():
    tensor = np.diag([2.0, 3, 4])
    for given, name in (((0, (0, 0, 0), tensor), "mass"), ((1, (0, 0, np.nan), tensor), "com"),
                        ((1, (0, 0, 0), np.eye(2)), "inertia")):
        with pytest.raises(ph.InvalidInput, match=f"^{name}"):
            ph.MassProperties.from_tensor(*given)
    with pytest.raises(ph.InvalidInput, match="^about"):
        ph.MassProperties.from_tensor(1, (0, 0, 0), tensor, about=(0, np.inf, 0))


@pytest.mark.parametrize("moments", [(3, 3, 9), (3, 5, 9), (1, 1, 3)])
def test_moments_that_no_mass_makes(moments):
    with pytest.raises(ph.InvalidInput, match="triangle"):
        ph.FreeMotion(moments, (1, 2, 3))
    free = ph.FreeMotion(moments, (1, 2, 3), physical=False)
    other = ph.FreeMotion(ph.InertiaTensor(np.diag(np.array(moments, float)), physical=False), (1, 2, 3))
    for mine, theirs in zip(free.at([0.0, 7.0]), other.at([0.0, 7.0])):
        assert np.array_equal(mine, theirs)
    with pytest.raises(ph.InvalidInput):
        ph.FreeMotion((-1, 5, 9), (1, 2, 3), physical=False)


SIZES = np.array((0.3, 1.0, 2.5))


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
@pytest.mark.parametrize("find, make", [(ph.inertia.equivalent_box, ph.shapes.box),
                                        (ph.inertia.equivalent_ellipsoid, ph.shapes.ellipsoid)])
def test_the_solid_of_a_tensor(find, make, scale):
    solid = make(3, SIZES * scale)
    sizes, axes = find(3, solid.inertia)
    np.testing.assert_allclose(sizes, SIZES[::-1] * scale, rtol=1e-14)   # by ascending moments
    turned = solid.moved((0.1, 0.2, 0.3, 0.9273618495495704))
    sizes, axes = find(3, turned.inertia)
    np.testing.assert_allclose(sizes, SIZES[::-1] * scale, rtol=1e-13)
    back = make(3, sizes).moved(ph.Rotation.from_matrix(axes))
    np.testing.assert_allclose(back.inertia.matrix, turned.inertia.matrix, rtol=0, atol=1e-14 * 20 * scale**2)


def test_flat_tensors_have_flat_solids_and_bad_ones_none():
    sizes, _ = ph.inertia.equivalent_box(2, ph.shapes.disk(2, 1.0).inertia)
    assert sizes[2] == 0 and sizes[0] == sizes[1] > 0
    assert list(ph.inertia.equivalent_ellipsoid(2, np.zeros((3, 3)))[0]) == [0, 0, 0]
    with pytest.raises(ph.InvalidInput, match="^mass"):
        ph.inertia.equivalent_box(0, np.eye(3))
    loose = ph.InertiaTensor(np.diag([1.0, 1, 3]), physical=False)
    with pytest.raises(ph.InvalidInput, match="triangle"):
        ph.inertia.equivalent_box(1, loose)
