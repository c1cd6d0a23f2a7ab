"""ph.heavy_top: many tops at many times, against one HeavyTop each."""

import numpy as np
import pytest

import polhode as ph

RNG = np.random.default_rng(5)
N = 40
LONE = RNG.uniform(0.3, 1.5, N)
MOMENTS = np.stack([np.ones(N), np.ones(N), LONE], axis=1)
ARMS = RNG.uniform(-3, 3, N)
OMEGA = RNG.normal(size=(N, 3)) * (1, 1, 4)
ATTITUDE = RNG.normal(size=(N, 4))
ATTITUDE /= np.linalg.norm(ATTITUDE, axis=1, keepdims=True)
TIMES = np.sort(RNG.uniform(-50, 100, 13))


def one_by_one(times):
    pairs = [ph.HeavyTop(m, a, w, q).at(t) for m, a, w, q, t in zip(MOMENTS, ARMS, OMEGA, ATTITUDE, times, strict=True)]
    return np.array([w for w, _ in pairs]), np.array([q for _, q in pairs])


def test_the_outer_grid_is_one_top_after_the_other_to_the_bit():
    omega, attitude = ph.heavy_top(MOMENTS[:, None], ARMS[:, None], OMEGA[:, None], ATTITUDE[:, None], TIMES)
    assert omega.shape == (N, 13, 3) and attitude.shape == (N, 13, 4)
    w, q = one_by_one([TIMES] * N)
    np.testing.assert_array_equal(omega, w)
    np.testing.assert_array_equal(attitude, q)
    flipped = ph.heavy_top(MOMENTS, ARMS, OMEGA, ATTITUDE, TIMES[:, None], want="attitude")
    np.testing.assert_array_equal(flipped, attitude.transpose(1, 0, 2))


def test_one_time_each_any_threads_and_out():
    times = RNG.uniform(0, 100, N)
    expected = one_by_one(times)
    for threads in (1, 2, 5):
        found = ph.heavy_top(MOMENTS, ARMS, OMEGA, ATTITUDE, times, threads=threads)
        for a, b in zip(found, expected, strict=True):
            np.testing.assert_allclose(a, b, rtol=0, atol=1e-13)
    bits = [ph.heavy_top(MOMENTS, ARMS, OMEGA, ATTITUDE, times, threads=k)[1].tobytes() for k in (1, 2, 7)]
    assert bits[0] == bits[1] == bits[2]
    out = np.empty((N, 3)), np.empty((N, 4))
    same = ph.heavy_top(MOMENTS, ARMS, OMEGA, ATTITUDE, times, out=out)
    assert same[0] is out[0] and out[1].tobytes() == bits[0]


def test_weightless_tops_are_free_bodies():
    free = ph.free_motion(MOMENTS, OMEGA, ATTITUDE, 12.5)
    top = ph.heavy_top(MOMENTS, 0.0, OMEGA, ATTITUDE, 12.5)
    scale = np.abs(OMEGA).max()
    np.testing.assert_allclose(top[0], free[0], atol=1e-13 * scale)
    angle = np.minimum(np.linalg.norm(top[1] - free[1], axis=1), np.linalg.norm(top[1] + free[1], axis=1))
    assert angle.max() < 1e-13


@pytest.mark.parametrize("moments", [(1, 1, 0.5), (1, 1, 1.7)])
def test_a_full_tensor_has_the_bits_of_the_object(moments):
    turn = ph.Rotation.from_rotvec((0.3, -0.5, 0.9))
    tensor = ph.InertiaTensor.from_moments(moments).rotated(turn)
    many = ph.heavy_top(tensor, 2.0, OMEGA, ATTITUDE, 3.5)
    for k in range(5):
        w, q = ph.HeavyTop(tensor, 2.0, OMEGA[k], ATTITUDE[k]).at(3.5)
        np.testing.assert_array_equal(many[0][k], w)
        np.testing.assert_array_equal(many[1][k], q)


def test_what_is_not_finite_poisons_its_own_rows():
    spins, times = OMEGA.copy(), np.array([1.0, np.nan, 2.0])
    spins[3, 1] = np.inf
    with pytest.warns(RuntimeWarning, match=f"{N - 1 + 3} rows"):
        omega, _ = ph.heavy_top(MOMENTS[:, None], ARMS[:, None], spins[:, None], ATTITUDE[:, None], times)
    poisoned = np.isnan(omega).any(axis=-1)
    assert poisoned[3].all() and poisoned[:, 1].all() and poisoned.sum() == N - 1 + 3


@pytest.mark.parametrize("arguments", [
    ((1, 2, 3), 1.0, (0, 0, 1), (0, 0, 0, 1), 1.0), ((1, 1, 0.5), 1.0, (0, 0), (0, 0, 0, 1), 1.0),
    ((1, 1, 0.5), 1.0, (0, 0, 1), (0, 0, 0, 2), 1.0), ((1, 1, 0.5), "heavy", (0, 0, 1), (0, 0, 0, 1), 1.0),
    ((1, 1, 0.5), (1.0, 2.0), (0, 0, 1), (0, 0, 0, 1), (1.0, 2.0, 3.0)),
    ((1, 1, -1), 1.0, (0, 0, 1), (0, 0, 0, 1), 1.0),
], ids=str)
def test_bad_input_is_named(arguments):
    with pytest.raises(ph.InvalidInput):
        ph.heavy_top(*arguments)
    with pytest.raises(ph.InvalidInput, match="threads"):
        ph.heavy_top((1, 1, 0.5), 1.0, (0, 0, 1), (0, 0, 0, 1), 1.0, threads=0)
