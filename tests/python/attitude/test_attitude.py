"""Rotation against SciPy's, the laws of the group, and Rotation as a container."""

import copy
import doctest
import math
import pathlib
import pickle
import re

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation as SciPy

import polhode as ph
from polhode._attitude import rotation

SEQUENCES = [a + b + c for axes in ("XYZ", "xyz") for a in axes for b in axes for c in axes if a != b != c]
law = settings(derandomize=True, deadline=None, max_examples=100)
components = st.floats(-1, 1, allow_nan=False)


@st.composite
def rotations(draw):
    quat = np.array([draw(components) for _ in range(4)])
    size = np.linalg.norm(quat)
    return ph.Rotation.from_quat(quat / size if size > 1e-3 else [0, 0, 0, 1])


def same(mine, scipy, atol=2e-15):
    assert mine.shape == scipy.shape
    assert_allclose(mine.as_matrix(), scipy.as_matrix(), rtol=0, atol=atol)


@pytest.fixture
def rng():
    return np.random.default_rng(20)


# ---- SciPy's results


@pytest.mark.parametrize("seq", SEQUENCES)
@pytest.mark.parametrize("degrees", [False, True])
def test_euler_angles_as_scipy(seq, degrees, rng):
    angles = rng.uniform(-7, 7, (500, 3)) * (50 if degrees else 1)
    mine, scipy = ph.Rotation.from_euler(seq, angles, degrees), SciPy.from_euler(seq, angles, degrees)
    same(mine, scipy, 4e-14 if degrees else 4e-15)
    expected = scipy.as_euler(seq, degrees)
    assert_allclose(ph.Rotation(scipy).as_euler(seq, degrees), expected, rtol=0, atol=1e-10 if degrees else 1e-12)


@pytest.mark.parametrize("seq", ["x", "Y", "z", "xy", "zx", "ZX", "YZ", "xz"])
def test_one_and_two_axes_as_scipy(seq, rng):
    angles = rng.uniform(-4, 4, (50, len(seq)))
    same(ph.Rotation.from_euler(seq, angles), SciPy.from_euler(seq, angles))
    same(ph.Rotation.from_euler(seq, angles[0]), SciPy.from_euler(seq, angles[0]))


def test_one_axis_takes_a_number():
    same(ph.Rotation.from_euler("z", 90, degrees=True), SciPy.from_euler("z", 90, degrees=True))
    assert ph.Rotation.from_euler("z", 1).single


def test_known_turns():
    quarter = ph.Rotation.from_euler("z", math.pi / 2)
    assert_allclose(quarter.apply([1, 0, 0]), [0, 1, 0], atol=1e-15)
    assert_allclose(quarter.as_quat(), [0, 0, math.sqrt(0.5), math.sqrt(0.5)], atol=1e-15)
    assert_allclose(quarter.as_matrix(), [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-15)
    phi, theta, psi = 0.3, 0.5, 0.7  # the textbook's A maps space to body; R_WB is its transpose
    third_axis = [math.sin(theta) * math.sin(phi), -math.sin(theta) * math.cos(phi), math.cos(theta)]
    assert_allclose(ph.Rotation.from_euler("ZXZ", [phi, theta, psi]).apply([0, 0, 1]), third_axis, atol=1e-15)


def test_conversions_as_scipy(rng):
    scipy = SciPy.random(1000, rng=rng)
    mine = ph.Rotation(scipy)
    same(mine, scipy)
    same(ph.Rotation.from_matrix(scipy.as_matrix()), scipy)
    same(ph.Rotation.from_rotvec(scipy.as_rotvec()), scipy)
    same(ph.Rotation.from_rotvec(scipy.as_rotvec(degrees=True), degrees=True), scipy, 4e-15)
    assert_allclose(mine.as_rotvec(), scipy.as_rotvec(), rtol=0, atol=4e-15)
    assert_allclose(mine.as_rotvec(degrees=True), scipy.as_rotvec(degrees=True), rtol=0, atol=4e-13)
    assert_allclose(mine.magnitude(), scipy.magnitude(), rtol=0, atol=2e-15)
    for options in ({}, {"canonical": True}, {"scalar_first": True}, {"canonical": True, "scalar_first": True}):
        assert_allclose(mine.as_quat(**options), scipy.as_quat(**options), rtol=0, atol=1e-15)
    same(ph.Rotation.from_quat(scipy.as_quat(scalar_first=True), scalar_first=True), scipy)


def test_use_as_scipy(rng):
    a, b = SciPy.random(300, rng=rng), SciPy.random(300, rng=rng)
    p, q = ph.Rotation(a), ph.Rotation(b)
    vectors = rng.normal(size=(300, 3))
    same(p * q, a * b)
    same(p.inv(), a.inv())
    assert_allclose(p.apply(vectors), a.apply(vectors), rtol=0, atol=4e-15)
    assert_allclose(p.apply(vectors, inverse=True), a.apply(vectors, inverse=True), rtol=0, atol=4e-15)
    for n in (-2.5, -1, 0, 0.3, 1, 2, 7):
        same(p**n, a**n, 1e-14)
    nudge = SciPy.from_rotvec([1e-5, 0, 0])
    for atol, degrees in ((None, False), (0.9e-5, False), (1.1e-5, False), (1e-3, True), (1.1e-5, True)):
        assert_array_equal(p.approx_equal(ph.Rotation(nudge) * p, atol, degrees),
                           a.approx_equal(nudge * a, atol, degrees))
    assert p[0].approx_equal(a[0]) is True
    assert p[0].approx_equal(a[1]) is False


def test_the_same_generator_gives_the_same_random_rotations():
    same(ph.Rotation.random(20, rng=7), SciPy.random(20, rng=7))
    same(ph.Rotation.random(rng=np.random.default_rng(3)), SciPy.random(rng=np.random.default_rng(3)))
    same(ph.Rotation.random(shape=(2, 3), rng=1), SciPy.random(shape=(2, 3), rng=1))
    assert ph.Rotation.random(5) != ph.Rotation.random(5)


def test_random_is_uniform():
    # The angle of a uniform rotation has density (1 - cos a)/pi: mean pi/2 + 2/pi; the image of an axis has mean 0.
    turns = ph.Rotation.random(200_000, rng=11)
    assert turns.magnitude().mean() == pytest.approx(math.pi / 2 + 2 / math.pi, abs=5e-3)
    assert_allclose(turns.apply([0, 0, 1]).mean(axis=0), 0, atol=6e-3)


@pytest.mark.parametrize("size", [1e-15, 1e-12, 1e-9, 1e-7])
def test_a_matrix_with_rounding_gives_the_nearest_rotation(size, rng):
    valid = SciPy.random(30, rng=rng).as_matrix()
    noisy = valid + size * rng.uniform(-1, 1, valid.shape)
    with mpmath.workdps(30):
        for matrix, mine in zip(noisy, ph.Rotation.from_matrix(noisy)):
            u, _, v = mpmath.svd_r(mpmath.matrix(matrix.tolist()))
            nearest = np.array((u * v).tolist(), dtype=float)
            assert_allclose(mine.as_matrix(), nearest, rtol=0, atol=1.5e-15 + (size if size < 1e-14 else 0))


def test_half_turns_and_their_neighbours():
    # Every branch of the matrix's formula, also where two of them are equally good.
    axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [0, 1, -1], [1, 0, 1], [1, 1, 1], [-1, 2, 3], [1, 1e-9, 0]]
    for axis in np.array(axes) / np.linalg.norm(axes, axis=1, keepdims=True):
        for angle in (0.0, 1e-300, 1e-9, 1.0, 2 * math.pi / 3, math.pi - 1e-9, math.pi, math.pi + 1e-9):
            scipy = SciPy.from_rotvec(angle * axis)
            same(ph.Rotation.from_matrix(scipy.as_matrix()), scipy)
            same(ph.Rotation.from_rotvec(angle * axis), scipy)
            same(ph.Rotation.from_rotvec(ph.Rotation(scipy).as_rotvec()), scipy)


# ---- laws


@law
@given(rotations(), rotations(), rotations())
def test_group(a, b, c):
    assert ((a * b) * c).approx_equal(a * (b * c), 4e-15)
    assert (a * a.inv()).magnitude() < 4e-15
    assert (a * b).inv().approx_equal(b.inv() * a.inv(), 4e-15)
    assert_allclose((a * b).as_matrix(), a.as_matrix() @ b.as_matrix(), rtol=0, atol=4e-15)
    assert a * ph.Rotation.identity() == a


@law
@given(rotations(), st.tuples(components, components, components))
def test_apply_is_the_matrix_and_keeps_length(a, v):
    v = np.array(v)
    assert_allclose(a.apply(v), a.as_matrix() @ v, rtol=0, atol=4e-15)
    assert_allclose(a.apply(a.apply(v), inverse=True), v, rtol=0, atol=4e-15)
    assert np.linalg.norm(a.apply(v)) == pytest.approx(np.linalg.norm(v), rel=4e-15, abs=1e-300)


@law
@given(rotations())
def test_every_form_gives_the_rotation_back(a):
    assert ph.Rotation.from_quat(a.as_quat()) == a
    assert ph.Rotation.from_matrix(a.as_matrix()).approx_equal(a, 4e-15)
    assert ph.Rotation.from_rotvec(a.as_rotvec()).approx_equal(a, 4e-15)
    for seq in SEQUENCES:
        assert ph.Rotation.from_euler(seq, a.as_euler(seq)).approx_equal(a, 4e-15)


@law
@given(rotations(), st.floats(-3, 3), st.floats(-3, 3))
def test_powers_add(a, m, n):
    # The angle is at most pi, so that (a^m)^n is a^(mn) only while m keeps within a half turn.
    assert (a**m * a**n).approx_equal(a ** (m + n), 4e-14)


@law
@given(rotations(), st.sampled_from([1e-12, 1e12]))
def test_vectors_of_any_size(a, scale):
    v = np.array([0.3, -0.7, 1.1])
    assert_allclose(a.apply(scale * v), scale * a.apply(v), rtol=1e-15, atol=4e-16 * scale)


def test_a_long_product_stays_a_rotation():
    step = ph.Rotation.from_euler("ZXZ", [0.1, 0.2, 0.3])
    turn = ph.Rotation.identity()
    for _ in range(10_000):
        turn = turn * step
    assert abs(np.linalg.norm(turn.as_quat()) - 1) < 4e-16
    assert turn.approx_equal(ph.Rotation.from_rotvec(10_000 * step.as_rotvec()), 1e-11)


def test_normalising_twice_moves_no_bit():
    quat = np.random.default_rng(5).normal(size=(100_000, 4))
    turns = ph.Rotation(quat / np.linalg.norm(quat, axis=1, keepdims=True) * (1 + 5e-7))
    assert_array_equal(ph.Rotation(turns.as_quat()).as_quat(), turns.as_quat())


# ---- small angles and half turns of the rotation vector


@pytest.mark.parametrize("size", [10.0**-k for k in (0, 1, 2, 3, 5, 8, 12, 20, 100, 150, 160, 200, 290, 300)])
def test_rotation_vectors_lose_nothing(size):
    v = size * np.array([0.6, -0.48, 0.64])
    turn = ph.Rotation.from_rotvec(v)
    assert_allclose(turn.as_rotvec(), v, rtol=1e-15, atol=0)
    assert turn.magnitude() == pytest.approx(size, rel=1e-15)
    assert_allclose(turn.as_quat()[:3], v / 2 * (math.sin(size / 2) / (size / 2)), rtol=1e-15)


def test_half_turns_have_one_rotation_vector():
    for quat in ([0.6, 0, 0.8, 0.0], [-0.6, 0, -0.8, 0.0], [-0.6, 0, -0.8, -0.0]):
        assert_allclose(ph.Rotation(quat).as_rotvec(), math.pi * np.array([0.6, 0, 0.8]), rtol=1e-15)
    assert_allclose(ph.Rotation([0, -1.0, 0, 0]).as_rotvec(), [0, math.pi, 0], rtol=1e-15)
    assert_array_equal(ph.Rotation([0, 0, -1.0, 0]).as_quat(canonical=True), [0, 0, 1, 0])


def test_long_rotation_vectors():
    assert ph.Rotation.from_rotvec([0, 0, 2 * math.pi]).magnitude() < 1e-15
    same(ph.Rotation.from_rotvec([3e4, -4e4, 1e4]), SciPy.from_rotvec([3e4, -4e4, 1e4]), 1e-11)
    assert np.isfinite(ph.Rotation.from_rotvec([1e200, 1e300, 0]).as_quat()).all()


# ---- shapes, and the container


def test_shapes_broadcast_as_scipy(rng):
    mine = {s: ph.Rotation.random(rng=1, shape=s) for s in ((), (1,), (3,), (2, 3), (2, 1), (0,))}
    scipy = {s: SciPy.random(rng=1, shape=s) for s in mine if s != (0,)} | {(0,): SciPy.identity(0)}
    for s in mine:
        for t in mine:
            try:
                expected = (scipy[s] * scipy[t]).shape
            except ValueError:
                with pytest.raises(ph.InvalidInput):
                    mine[s] * mine[t]
                with pytest.raises(ph.InvalidInput):
                    mine[s].apply(np.ones((*t, 3)))
                continue
            assert (mine[s] * mine[t]).shape == expected
            assert mine[s].apply(np.ones((*t, 3))).shape == (*expected, 3)
            same(mine[s] * mine[t], scipy[s] * scipy[t])


def test_outputs_have_the_shape_of_the_rotations():
    for shape in ((), (0,), (4,), (2, 3)):
        turns = ph.Rotation.identity(shape=shape)
        assert turns.shape == shape and turns.single == (shape == ())
        assert turns.as_quat().shape == (*shape, 4)
        assert turns.as_matrix().shape == (*shape, 3, 3)
        assert turns.as_rotvec().shape == turns.as_euler("zxz").shape == (*shape, 3)
        assert np.shape(turns.magnitude()) == np.shape(turns.gimbal_lock("zxz")) == shape
        assert (turns**2.5).shape == turns.inv().shape == shape
    single = ph.Rotation.identity()
    assert isinstance(single.magnitude(), float) and single.gimbal_lock("ZXZ") is True


def test_indexing_as_arrays():
    turns = ph.Rotation.random(6, rng=2)
    quat = turns.as_quat()
    for index in (0, -1, slice(1, 4), slice(None, None, -2), [0, 3], np.arange(6) % 2 == 0, np.int64(2), ..., None):
        assert_array_equal(turns[index].as_quat(), quat[index])
        assert_array_equal((turns[index] * turns[index].inv()).magnitude() < 1e-15, True)
    grid = ph.Rotation.random(shape=(2, 3), rng=2)
    assert grid[1, 2].single and grid[:, 1].shape == (2,) and grid[..., 0].shape == (2,)
    assert len(turns) == 6 and len(list(turns)) == 6 and list(turns)[2] == turns[2] and bool(ph.Rotation.identity(0))
    for bad in (6, (0, 0), (slice(None), 1)):
        with pytest.raises(IndexError):
            turns[bad]
    for single_use in (len, iter, lambda r: r[0]):
        with pytest.raises(TypeError, match="single"):
            single_use(turns[0])


def test_concatenate():
    a, b = ph.Rotation.random(2, rng=1), ph.Rotation.random(rng=2)
    joined = ph.Rotation.concatenate([a, b, SciPy.identity(3)])
    assert len(joined) == 6 and joined[:2] == a and joined[2] == b and joined[5] == ph.Rotation.identity()
    assert ph.Rotation.concatenate(a) == a and ph.Rotation.concatenate([b]) == b
    for bad in ([], [ph.Rotation.random(shape=(2, 3)), b]):
        with pytest.raises(ph.InvalidInput, match="rotations"):
            ph.Rotation.concatenate(bad)


def test_equal_by_value():
    quat = ph.Rotation.random(4, rng=3).as_quat()
    a, b = ph.Rotation(quat), ph.Rotation(-quat)
    assert a == b and hash(a) == hash(b) and len({a, b, a[:2]}) == 2
    assert a != a[:2] and a != a[::-1] and a[0] != a[:1] and a != "a"
    half = ph.Rotation([1.0, 0, 0, 0.0])
    assert half == ph.Rotation([-1.0, 0, 0, -0.0]) and hash(half) == hash(ph.Rotation([-1.0, -0.0, 0, -0.0]))


@pytest.mark.parametrize("shape", [(), (3,), (2, 2), (0,)])
def test_copies_are_equal(shape):
    turns = ph.Rotation.random(shape=shape, rng=4)
    for twin in (pickle.loads(pickle.dumps(turns)), copy.copy(turns), copy.deepcopy(turns)):
        assert twin == turns
        assert_array_equal(twin.as_quat(), turns.as_quat())
        with pytest.raises(AttributeError):
            twin._quat = None


def test_immutable():
    quat = np.array([0.0, 0.0, 0.0, 1.0])
    turn = ph.Rotation(quat)
    quat[:] = 5
    turn.as_quat()[:] = 5
    assert turn == ph.Rotation.identity()
    for change in (lambda: setattr(turn, "_quat", quat), lambda: setattr(turn, "x", 1), lambda: delattr(turn, "_quat")):
        with pytest.raises(AttributeError):
            change()
    with pytest.raises(ValueError):
        turn._quat[0] = 1.0


def test_repr_gives_the_rotation_back():
    turns = ph.Rotation.random(3, rng=5)
    assert eval(repr(turns), {"Rotation": ph.Rotation}) == turns
    assert eval(repr(turns[0]), {"Rotation": ph.Rotation}) == turns[0]
    assert len(repr(ph.Rotation.random(10_000))) < 1000


def test_scipys_rotations_are_accepted():
    mine, scipy = ph.Rotation.random(3, rng=6), SciPy.random(3, rng=7)
    same(mine * scipy, SciPy(mine.as_quat()) * scipy)
    same(scipy * mine, scipy * SciPy(mine.as_quat()))
    same(ph.Rotation.from_quat(scipy), scipy)
    assert mine.approx_equal(scipy).tolist() == [False] * 3


def test_array_likes():
    # lists, integers, float32, Fortran order, strides, read-only
    assert ph.Rotation.from_quat([0, 0, 0, 1]) == ph.Rotation.identity()
    angles = np.asfortranarray(np.random.default_rng(8).uniform(-3, 3, (8, 6)))[::2, ::2]
    angles.flags.writeable = False
    assert ph.Rotation.from_euler("zyx", angles) == ph.Rotation.from_euler("zyx", angles.tolist())
    singles = ph.Rotation.random(5, rng=9).as_quat().astype(np.float32)
    assert_allclose(ph.Rotation(singles).as_quat(), singles, atol=2e-7)


# ---- what is written about it


def test_the_examples_of_the_docstrings_and_the_page():
    assert doctest.testmod(rotation).failed == 0 and doctest.testmod(rotation).attempted > 0
    page = (pathlib.Path(__file__).parents[3] / "docs" / "attitude.md").read_text()
    names = {}
    exec(re.search(r"```python\n(.*?)```", page, flags=re.S)[1], names)
    assert_allclose(names["turn"].as_euler("ZXZ", degrees=True), [40, 25, 10], rtol=1e-14)
    assert_allclose(names["omega"], [0.1 * math.sin(0.4) * math.sin(0.2), 0.1 * math.sin(0.4) * math.cos(0.2),
                                     0.1 * math.cos(0.4) + 5.0], rtol=1e-15)
