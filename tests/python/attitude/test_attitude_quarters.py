"""Matrices of quarter turns have exact zeros; exponents that are arrays; warnings as SciPy gives them."""

import itertools

import numpy as np
import pytest
import scipy.spatial.transform as scipy_transform
from numpy.testing import assert_array_equal

import polhode as ph

EPS = 2.0**-53


def exact(quat):
    """The matrices of the rotations that the quaternions mean, in extended precision."""
    x, y, z, w = (quat.astype(np.longdouble) / np.sqrt((quat.astype(np.longdouble) ** 2).sum(-1))[..., None]).T
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]).transpose(2, 0, 1)


def test_every_turn_of_a_cube_has_exact_zeros():
    quats = np.array([q for q in itertools.product((-1.0, 0, 1), repeat=4) if any(q)])
    turns = ph.Rotation.from_quat(quats / np.linalg.norm(quats, axis=1)[:, None])
    matrices, truth = turns.as_matrix(), exact(turns.as_quat())
    zero = np.abs(truth) < 1e-15
    assert zero.sum() == 288 and (matrices[zero] == 0).all()
    assert np.abs(matrices - truth).max() <= 2.01 * EPS
    tensor = ph.InertiaTensor(np.diag([1.0, 2, 3])).rotated([0, 0, np.sqrt(0.5), np.sqrt(0.5)]).matrix
    assert np.count_nonzero(tensor - np.diag(tensor.diagonal())) == 0


@pytest.mark.parametrize("kind, most, mean", [("any", 6.5, 0.8), ("small", 3.0, 0.2), ("half", 6.5, 0.82)])
def test_matrices_are_as_close_as_their_quaternions(kind, most, mean):
    """Units of rounding; 1 - 2 (y^2 + z^2) alone has 11.4 and 1.1 for any rotation, 12 and 1.3 near half turns."""
    rng = np.random.default_rng(7)
    quat = rng.normal(size=(200_000, 4))
    if kind == "small":
        quat[:, :3] *= 10.0 ** rng.uniform(-9, -1, (len(quat), 1))
        quat[:, 3] = 1
    elif kind == "half":
        quat[:, 3] *= 10.0 ** rng.uniform(-9, -1, len(quat))
    quat /= np.linalg.norm(quat, axis=1)[:, None]
    matrices = ph.Rotation.from_quat(quat).as_matrix()
    errors = np.abs(matrices - exact(quat)) / EPS
    assert errors.max() < most and np.sqrt((errors**2).mean()) < mean
    wide = matrices.astype(np.longdouble)
    assert np.abs(np.einsum("nij,nik->njk", wide, wide) - np.eye(3)).max() < 2.2 * most * EPS


def test_exponents_are_scipys_where_it_takes_them():
    many = ph.Rotation.random(3, rng=1)
    theirs = scipy_transform.Rotation.from_quat(many.as_quat())
    for n in (2, [2], np.array(2.0), [0.3], [1], np.array([-1.0])):
        assert (many**n).shape == (3,) and (many[0] ** n).single
        np.testing.assert_allclose((many**n).as_rotvec(), (theirs**n).as_rotvec(), rtol=1e-14, atol=1e-15)
    assert many ** [1] is many


def test_each_rotation_has_its_exponent():
    many = ph.Rotation.random(3, rng=1)
    each = many ** [0.5, 2, -1]
    for i, n in enumerate((0.5, 2, -1)):
        np.testing.assert_allclose(each[i].as_rotvec(), (many[i] ** n).as_rotvec(), rtol=1e-14)
    assert (many ** [[1.0], [2.0]]).shape == (2, 3) and (many[0] ** [1.0, 2.0]).shape == (2,)
    for wrong in ([1, 2], "x", [np.nan], np.inf, [[1], [np.inf]]):
        with pytest.raises(ph.InvalidInput, match="^exponent: must be"):
            many**wrong


def test_degrees_without_a_limit_are_warned_of():
    one = ph.Rotation.identity()
    with pytest.warns(UserWarning, match="^degrees: must be used with atol"):
        assert one.approx_equal(one, degrees=True)
    assert_array_equal(one.approx_equal(one, 1.0, degrees=True), True)
