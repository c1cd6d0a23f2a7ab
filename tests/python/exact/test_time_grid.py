"""Uniform grids of times: the same motion as at any times, the same bits however they are cut."""

from fractions import Fraction

import levels
import numpy as np
import pytest

import polhode as ph

E = 2.0**-52
BLOCK, TOP = (0.2, 0.4, 0.52), (1.0, 1.0, 0.5)
TILTED = (0.1, 0.7, -0.3, 0.64)
FREE = {
    "triaxial": (BLOCK, (1, 2, 3)),
    "about the least": (BLOCK, (3, 0.2, 0.1)),
    "near the change of form": (BLOCK, (0.9, 5, 0.9)),
    "symmetric": ((1, 1, 0.5), (0.3, -2, 1)),
    "steady": (BLOCK, (0, 0, 2)),
    "near the separatrix": (BLOCK, (1e-4, 5, 1e-4)),
}
TOPS = {
    "looping": (TOP, 1.3, (0.1, 0.2, 5), TILTED),
    "hung by x": ((0.5, 1, 1), -0.7, (2, 0.3, -1), TILTED),
    "pendulum": (TOP, 1.0, (0.6, 0, 0), (0, 0, 0, 1)),
}


def motions():
    unit = np.array(TILTED) / np.linalg.norm(TILTED)
    for name, (moments, omega) in FREE.items():
        yield name, ph.FreeMotion(moments, omega, unit)
    for name, (moments, arm, omega, _) in TOPS.items():
        yield name, ph.HeavyTop(moments, arm, omega, unit)


def grids():
    rng = np.random.default_rng(3)
    unordered = rng.uniform(-50, 50, 400)
    return {
        "linspace": np.linspace(0, 200, 1001),
        "arange": np.arange(-30, 70, 0.1),
        "backward": np.linspace(40, -90, 777),
        "tiny steps": 3.0 + 1e-12 * np.arange(500),
        "far below a unit": 1e-300 * np.arange(200),
        "coarse steps": 1234.567 * np.arange(300),
        "one time again and again": np.full(300, 1.5),
        "summed": np.cumsum(np.full(900, 0.1)),
        "far away, steps of 1/8": 2.0**34 + 0.125 * np.arange(600),
        "far away, steps that round": 6.1e9 + 0.1 * np.arange(600),
        "nearly uniform": 0.1 * np.arange(500) + 1e-9 * rng.normal(size=500),
        "one of them off": np.where(np.arange(500) == 333, 7.0, 0.1 * np.arange(500)),
        "two rates": np.concatenate([0.1 * np.arange(300), 30 + 0.3 * np.arange(300)]),
        "any": unordered,
        "short": np.linspace(0, 6, 64),
        "a block and one": np.linspace(0, 6, 129),
    }


def one_by_one(motion, times):
    states = [motion.at(float(t)) for t in times]
    return np.array([w for w, _ in states]), np.array([q for _, q in states])


def distances(motion, times):
    """Of array evaluation from single times: in omega, relative to the largest, and in the angle."""
    w, q = motion.at(times)
    w1, q1 = one_by_one(motion, times)
    turn = np.linalg.norm(q - q1 * np.sign((q * q1).sum(axis=1))[:, None], axis=1)
    return np.abs(w - w1).max() / np.abs(w1).max(), 2 * turn.max()


@pytest.mark.parametrize("grid", grids())
def test_a_grid_is_the_motion_at_each_of_its_times(grid):
    times = grids()[grid]
    for name, motion in motions():
        in_omega, in_angle = distances(motion, times)
        assert in_omega < 12 * E and in_angle < 12 * E, name


def test_a_grid_against_a_motion_known_otherwise():
    """A symmetric body in rational arithmetic: both rates exact, sine and cosine from mpmath."""
    mp = pytest.importorskip("mpmath").mp
    moments, omega = (1.0, 1.0, 0.5), (0.75, 0.0, 2.0)
    times = np.linspace(-1000, 3000, 2003)
    with mp.workdps(40):
        # w1 + i w2 turns at (I3 - I1) / I1 w3 about the axis.
        rate = Fraction(-1, 2) * 2
        angles = [mp.mpf(float(t)) * mp.mpf(rate.numerator) / rate.denominator for t in times]
        expected = np.array([[float(0.75 * mp.cos(a)), float(0.75 * mp.sin(a)), 2.0] for a in angles])
    w, _ = ph.FreeMotion(moments, omega).at(times)
    assert np.abs(w - expected).max() < 8 * E * 2


def test_a_million_samples():
    times = np.linspace(0, 1e5, 1_000_001)
    motion = ph.FreeMotion(BLOCK, (1, 2, 3))
    w, q = motion.at(times)
    pick = np.random.default_rng(5).integers(0, times.size, 500)
    w1, q1 = one_by_one(motion, times[pick])
    assert np.abs(w[pick] - w1).max() < 12 * E * np.abs(w1).max()
    assert np.linalg.norm(q[pick] - q1, axis=1).max() < 6 * E
    momentum = ph.Rotation.from_quat(q[::1000]).apply(w[::1000] * BLOCK)
    assert np.abs(momentum - motion.angular_momentum).max() < 20 * E * np.linalg.norm(motion.angular_momentum)
    energy = 0.5 * (w**2 * BLOCK).sum(axis=1)
    assert np.abs(energy / motion.energy - 1).max() < 20 * E
    assert np.abs((q**2).sum(axis=1) - 1).max() < 10 * E


def test_a_grid_of_a_billion_periods():
    motion = ph.FreeMotion(BLOCK, (1, 2, 3))
    start = np.floor(1e9 * motion.period)
    for step in (0.25, 0.1):
        in_omega, in_angle = distances(motion, start + step * np.arange(300))
        assert in_omega < 12 * E and in_angle < 12 * E


def test_everything_scales():
    unit = np.array(TILTED) / np.linalg.norm(TILTED)
    times = np.linspace(-3, 80, 500)
    w, q = ph.FreeMotion(BLOCK, (1, 2, 3), unit).at(times)
    for factor in (2.0**-900, 2.0**40, 2.0**900):
        w1, q1 = ph.FreeMotion(BLOCK, np.array([1, 2, 3]) * factor, unit).at(times / factor)
        np.testing.assert_array_equal(w1, w * factor)
        np.testing.assert_array_equal(q1, q)


SCRIPT = """
import sys, numpy as np, polhode as ph
grid = np.linspace(-100, 900, 40_001)
q = np.array([0.1, 0.7, -0.3, 0.64]); q /= np.linalg.norm(q)
broken = np.where(np.arange(40_001) == 30_000, np.nan, grid)
spins = np.outer(np.arange(1, 9), [1, 2, 3.])
for threads in (1, 3):
    for out in (*ph.free_motion((0.2, 0.4, 0.52), (1, 2, 3), q, grid, threads=threads),
                *ph.heavy_top((1, 1, 0.5), 1.3, (0.1, 0.2, 5), q, grid, threads=threads),
                *ph.free_motion((0.2, 0.4, 0.52), spins[:, None], q, grid[:5003], threads=threads),
                *ph.free_motion((0.2, 0.4, 0.52), (1, 2, 3), q, broken, threads=threads)):
        sys.stdout.buffer.write(np.ascontiguousarray(out).tobytes())
"""


def test_the_same_bits_for_any_threads_and_on_avx2_and_avx512():
    found = {level: np.frombuffer(text).view(np.uint64).reshape(2, -1)
             for level, text in levels.outputs(SCRIPT, levels.LEVELS).items()}
    for level in found.values():
        np.testing.assert_array_equal(level[0], level[1])
    np.testing.assert_array_equal(found["avx2"], found["avx512"])
    baseline = found["baseline"].view(np.float64)
    there = np.isfinite(baseline)
    assert np.abs((baseline - found["avx2"].view(np.float64))[there]).max() < 100 * E * 30


def test_a_batch_gives_the_bits_of_the_object():
    unit = np.array(TILTED) / np.linalg.norm(TILTED)
    times = np.linspace(0, 50, 1001)
    spins = np.array([[1, 2, 3.0], [3, 0.2, 0.1], [1e-4, 5, 1e-4]])
    tops = ph.heavy_top(TOP, 1.3, spins[:, None], unit, times)
    own = ph.heavy_top(TOP, 1.3, spins[:, None], unit, np.stack([times] * 3))
    for k, spin in enumerate(spins):
        for got in (tops, own):
            for a, b in zip(got, ph.HeavyTop(TOP, 1.3, spin, unit).at(times), strict=True):
                np.testing.assert_array_equal(a[k], b)
    bodies = ph.free_motion(BLOCK, spins[:, None], unit, times)
    again = ph.free_motion(BLOCK, spins[:, None], unit, np.stack([times] * 3))
    for a, b in zip(bodies, again, strict=True):
        np.testing.assert_array_equal(a, b)


def test_times_beyond_reach_are_refused_on_a_grid_too():
    motion = ph.FreeMotion(BLOCK, (1, 2, 3))
    with pytest.raises(ph.InvalidInput, match="1e25"):
        motion.at(np.linspace(0, 1e26, 1000))
    with pytest.raises(ph.InvalidInput, match="finite"):
        motion.at(np.where(np.arange(200) == 100, np.nan, np.arange(200.0)))
    with pytest.raises(ph.InvalidInput, match=r"^t"):
        ph.HeavyTop(TOP, 1.3, (0.1, 0.2, 5)).at(np.linspace(0, 1e26, 1000))
