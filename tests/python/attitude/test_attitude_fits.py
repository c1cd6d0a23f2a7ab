"""Means, alignments and modified Rodrigues parameters of rotations: SciPy's, their laws, and what is refused."""

import math
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation as SciPy

import polhode as ph

R = ph.Rotation
EPS = np.finfo(float).eps


@pytest.fixture
def rng():
    return np.random.default_rng(7)


def angle(mine, other):
    """The angle between two rotations, polhode's or SciPy's [rad]."""
    return (R(mine).inv() * R(other)).magnitude()


# ---- mean


@pytest.mark.parametrize("spread", [1.0, 1e-3, 1e-8])
def test_means_are_scipys(rng, spread):
    for count in (1, 2, 3, 50):
        turns = SciPy.random(rng=rng) * SciPy.from_rotvec(spread * rng.normal(size=(count, 3)))
        weights = rng.uniform(0.1, 3, count)
        assert angle(R(turns).mean(), turns.mean()) < 20 * EPS
        assert angle(R(turns).mean(weights), turns.mean(weights)) < 20 * EPS
        assert angle(R(turns).mean(1e300 * weights), turns.mean(weights)) < 20 * EPS


def test_the_mean_lies_between_and_does_not_see_signs(rng):
    a = R.random(rng=1)
    b = a * R.from_rotvec([0.0, 0.6, 0.0])
    assert angle(R.concatenate([a, b]).mean(), a * R.from_rotvec([0.0, 0.3, 0.0])) < 4 * EPS
    quats = R.random(20, rng=2).as_quat()
    signs = rng.choice([-1.0, 1.0], size=(20, 1))
    assert angle(R(quats).mean(), R(signs * quats).mean()) < 20 * EPS
    assert angle(R.concatenate([a, b]).mean([0.0, 2.0]), b) < 4 * EPS   # what has no weight is not seen
    for alone in R.random(300, rng=3):
        assert angle(R.concatenate([a, alone]).mean([0.0, 2.0]), alone) < 4 * EPS
    assert angle(a.mean(), a) < 4 * EPS and a.mean().single


def test_a_mean_is_of_all_dimensions(rng):
    turns = R.from_rotvec(0.3 * rng.normal(size=(4, 5, 3)))
    weights = rng.uniform(0.5, 1, (4, 5))
    assert angle(turns.mean(), R(turns.as_quat().reshape(-1, 4)).mean()) < 4 * EPS
    assert angle(turns.mean(weights), R(turns.as_quat().reshape(-1, 4)).mean(weights.ravel())) < 4 * EPS
    assert turns.mean(weights[:1]) == turns.mean(np.tile(weights[:1], (4, 1)))


# ---- align_vectors


@pytest.mark.parametrize("count", [2, 3, 40])
def test_alignments_are_scipys(rng, count):
    for _ in range(20):
        b = rng.normal(size=(count, 3))
        a = SciPy.random(rng=rng).apply(b) + 0.2 * rng.normal(size=(count, 3))
        for weights in (None, rng.uniform(0.1, 2, count)):
            (mine, left), (theirs, theirs_left) = R.align_vectors(a, b, weights), SciPy.align_vectors(a, b, weights)
            assert angle(mine, theirs) < 1e-13 and left == pytest.approx(theirs_left, rel=1e-10)
        sharp = np.append(np.inf, rng.uniform(0.1, 2, count - 1))
        (mine, left), (theirs, theirs_left) = R.align_vectors(a, b, sharp), SciPy.align_vectors(a, b, sharp)
        assert angle(mine, theirs) < 1e-13 and left == pytest.approx(theirs_left, rel=1e-10)


def test_what_is_only_rotated_is_found_and_nothing_is_left(rng):
    turn = R.random(rng=4)
    close = np.array([[1, 0, 0], [1, 1e-6, 0]])
    for b in (rng.normal(size=(5, 3)), np.eye(3), np.eye(3)[:2], close, 1e200 * np.eye(3), 1e-200 * np.eye(3)):
        found, left = R.align_vectors(turn.apply(b), b)
        assert angle(found, turn) < (1e-9 if b is close else 10 * EPS)
        assert left <= 10 * EPS * np.abs(b).max()   # SciPy's cancels: 1e-8


def test_a_mirror_is_not_taken_for_a_rotation(rng):
    b = rng.normal(size=(10, 3))
    a = b * [1, 1, -1]
    (mine, left), (theirs, theirs_left) = R.align_vectors(a, b), SciPy.align_vectors(a, b)
    assert angle(mine, theirs) < 1e-12 and left == pytest.approx(theirs_left, rel=1e-12)
    assert np.linalg.det(mine.as_matrix()) == pytest.approx(1, abs=1e-15) and left > 1


@pytest.mark.parametrize("gap", [1.0, 1e-3, 1e-9, 1e-15, 1e-17, 0.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_one_pair_is_aligned_by_the_shortest_rotation(gap, sign):
    b = np.array([2.0, 0.0, 0.0])
    a = 3 * sign * np.array([math.cos(gap), math.sin(gap), 0.0])
    found, left = R.align_vectors(a, b)
    assert_allclose(found.apply(b) / 2, a / 3, atol=4 * EPS)
    assert found.magnitude() == pytest.approx(gap if sign > 0 else math.pi - gap, rel=1e-14, abs=0)
    assert left == pytest.approx(1.0, rel=1e-14)   # the lengths differ
    assert R.align_vectors([a], [b], [4.0])[1] == pytest.approx(2.0, rel=1e-14)
    assert R.align_vectors([a], [b], [np.inf])[1] == 0.0


def test_an_exact_pair_may_be_opposite_and_the_others_turn_about_it(rng):
    b = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.2], [0.3, 0.9, 0.1]])
    for a_first in ([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]):
        a = np.array([a_first, [0.5, 0.7, 0.0], [-0.8, 0.4, 0.3]])
        found, left = R.align_vectors(a, b, [np.inf, 1.0, 2.0])
        assert_allclose(found.apply(b[0]), a_first, atol=4 * EPS)
        for more in (-1e-4, 1e-4):   # no other turn about the exact direction leaves less
            other = R.from_rotvec(more * np.array(a_first)) * found
            assert np.sqrt([0.0, 1.0, 2.0] @ ((a - other.apply(b)) ** 2).sum(axis=1)) > left


@pytest.mark.parametrize("weights", [[np.inf, 1.0], [1.0, np.inf]])
@pytest.mark.parametrize("seed", range(20))
def test_an_exact_pair_beside_a_parallel_one_gives_the_shortest_rotation(weights, seed):
    rng = np.random.default_rng(seed)
    a, b = rng.normal(size=(2, 3)), np.tile(rng.normal(size=3), (2, 1))
    with pytest.warns(UserWarning, match="leave the rotation open"):
        found = R.align_vectors(a, b, weights)[0]
    exact, given = a[np.argmax(weights)], b[0]
    angle = np.arctan2(np.linalg.norm(np.cross(given, exact)), given @ exact)
    assert abs(found.magnitude() - angle) < 1e-14


@pytest.mark.parametrize("b", [[[1, 2, 3], [2, 4, 6]], [[1, 2, 3], [0, 0, 0]], np.zeros((2, 3))])
def test_vectors_that_leave_the_rotation_open_are_told(b):
    turn = R.random(rng=5)
    with pytest.warns(UserWarning, match="leave the rotation open"):
        found, left = R.align_vectors(turn.apply(b), b)
    assert_allclose(found.apply(b), turn.apply(b), atol=1e-14)
    assert left < 1e-14


# ---- modified Rodrigues parameters


def test_parameters_are_scipys(rng):
    turns = SciPy.random(500, rng=rng)
    assert_allclose(R(turns).as_mrp(), turns.as_mrp(), rtol=0, atol=2 * EPS)
    for size in (1e-300, 1e-9, 0.1, 1.0, 3.0, 1e5):
        p = rng.normal(size=(50, 3)) * size
        assert_allclose(R.from_mrp(p).as_matrix(), SciPy.from_mrp(p).as_matrix(), rtol=0, atol=8 * EPS)


def test_parameters_come_back(rng):
    turns = R.random(shape=(7, 30), rng=rng)
    back = R.from_mrp(turns.as_mrp())
    assert back.shape == (7, 30) and back.approx_equal(turns, atol=8 * EPS).all()
    small = 1e-200 * rng.normal(size=3)
    assert_allclose(R.from_mrp(small).as_mrp(), small, rtol=4 * EPS)
    assert_allclose(R.from_mrp(small).as_rotvec(), 4 * small, rtol=4 * EPS)   # a quarter of the angle
    assert_array_equal(R.identity().as_mrp(), np.zeros(3))


def test_half_turns_have_length_one_and_one_sign(rng):
    axes = rng.normal(size=(50, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    axes = np.concatenate([axes, np.eye(3), -np.eye(3)])
    for sign in (1.0, -1.0):
        turns = R(np.concatenate([sign * axes, np.zeros((56, 1))], axis=1))
        p = turns.as_mrp()
        assert_allclose(np.linalg.norm(p, axis=1), 1, atol=2 * EPS)
        first = np.take_along_axis(p, np.argmax(p != 0, axis=1)[:, None], axis=1)
        assert (first > 0).all()
        assert R.from_mrp(p).approx_equal(turns, atol=4 * EPS).all()
        assert R.from_mrp(-p).approx_equal(turns, atol=4 * EPS).all()


@pytest.mark.parametrize("size", [1e-12, 0.3, 0.999, 1.0, 1.001, 40.0, 1e150, 1e300])
def test_a_shadow_is_the_same_rotation(rng, size):
    n = rng.normal(size=3)
    n /= np.linalg.norm(n)
    with warnings.catch_warnings():
        warnings.simplefilter("error")   # no overflow
        assert angle(R.from_mrp(size * n), R.from_mrp(-n / size)) < 8 * EPS
    assert np.linalg.norm(R.from_mrp(size * n).as_mrp()) <= 1 + 2 * EPS
    assert_allclose(np.tan(R.from_mrp(size * n).magnitude() / 4), min(size, 1 / size), rtol=1e-14)


# ---- what is refused


@pytest.mark.parametrize(("call", "match"), [
    (lambda: R.from_mrp([1, 2]), r"mrp: must be an array of shape \(\.\.\., 3\), got shape \(2,\)"),
    (lambda: R.from_mrp(1.0), r"mrp: must be an array of shape \(\.\.\., 3\), got shape \(\)"),
    (lambda: R.from_mrp([[1, 2, 3], [1, math.nan, 3]]), "mrp: must be finite, got nan at flat index 4"),
    (lambda: R.from_mrp("text"), "mrp: must be an array of real numbers"),
    (lambda: R.from_mrp([[1, 2], [3]]), "mrp: must be an array of real numbers"),
    (lambda: R.from_mrp([1j, 0, 0]), "mrp: must be an array of real numbers, got dtype complex128"),
    (lambda: R.identity(0).mean(), "rotations: must be one or more for a mean, got none"),
    (lambda: R.identity(3).mean([1, 2]), r"weights: must be of shape \(3,\), got shape \(2,\)"),
    (lambda: R.identity(3).mean([1, -2, 1]), "weights: must be 0 or more, got -2.0"),
    (lambda: R.identity(3).mean([1, math.nan, 1]), "weights: must be 0 or more, got nan"),
    (lambda: R.identity(3).mean([0, 0, 0]), "weights: must hold one above 0, got none"),
    (lambda: R.identity(3).mean([1, math.inf, 0]), "weights: must be finite for a mean, got inf"),
    (lambda: R.align_vectors([1, 2], [1, 2]), r"a: must be an array of shape"),
    (lambda: R.align_vectors([1, 2, 3], [1, 2, math.inf]), "b: must be finite, got inf at flat index 2"),
    (lambda: R.align_vectors(np.ones((2, 3)), np.ones((3, 3))), r"equally many .* got shapes \(2, 3\) and \(3, 3\)"),
    (lambda: R.align_vectors(np.ones((2, 2, 3)), np.ones((2, 2, 3))), r"a, b: must be one vector each"),
    (lambda: R.align_vectors(np.ones((0, 3)), np.ones((0, 3))), r"a, b: must be one vector each"),
    (lambda: R.align_vectors(np.eye(3), np.eye(3), [1, 2]), r"weights: must be of shape \(3,\), got shape \(2,\)"),
    (lambda: R.align_vectors(np.eye(3), np.eye(3), [1, 2, -1]), "weights: must be 0 or more"),
    (lambda: R.align_vectors(np.eye(3), np.eye(3), [math.inf, 2, math.inf]), "must hold one inf at most, got 2"),
    (lambda: R.align_vectors([0, 0, 0], [1, 0, 0]), "a, b: must not be zero where the alignment is exact, got it at 0"),
])
def test_what_is_refused(call, match):
    with pytest.raises(ph.InvalidInput, match=match):
        call()


def test_empty_arrays_of_parameters_are_no_error():
    assert R.from_mrp(np.zeros((0, 3))).shape == (0,) and R.identity(0).as_mrp().shape == (0, 3)


@pytest.mark.parametrize("b", [[[0, 1, 0], [0, 1, 0]], [[1, 2, 3], [-2, -4, -6]], [[0.3, 0, 0.1], [0, 0, 0]]])
def test_an_exact_pair_alone_is_aligned_by_the_shortest_rotation(rng, b):
    """The other vector lies along it, and says nothing about the turn round it."""
    b = np.array(b, float)
    for scale in (1e-12, 1.0, 1e12):
        for _ in range(5):
            a = scale * rng.normal(size=(2, 3))
            with pytest.warns(UserWarning, match="leave the rotation open"):
                found, _ = R.align_vectors(a, b, [np.inf, 1.0])
            angle = np.arccos(a[0] @ b[0] / np.linalg.norm(a[0]) / np.linalg.norm(b[0]))
            assert found.magnitude() == pytest.approx(angle, rel=1e-7)
            assert_allclose(found.apply(b[0]) / np.linalg.norm(b[0]), a[0] / np.linalg.norm(a[0]), atol=4 * EPS)
