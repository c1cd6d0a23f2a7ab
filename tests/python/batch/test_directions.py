"""Directions in place of attitudes, and float32: of the closed forms of many bodies, against attitudes in float64."""

import numpy as np
import pytest

import polhode as ph

RNG = np.random.default_rng(5)
FEW = 5 * 2.2e-16   # units of rounding, of the length of the axis
START = (0.5, -0.5, 0.5, 0.5)
TOP, WHEEL = ((1.0, 1.0, 0.5), 1.3, (0.1, 0.2, 5.0), START), ((0.2, 0.4, 0.52), (0.1, -0.3, 0.5), (1, 2, 3), START)

# moments and omega of each regime: series, hyperbolic, separatrix, unstable axis, steady, symmetric, sphere, rest
REGIMES = {
    "series": ((0.2, 0.4, 0.52), (1, 2, 3)),
    "other axis": ((0.52, 0.4, 0.2), (3, -1, 0.2)),
    "hyperbolic": ((0.2, 0.4, 0.52), (1e-4, 5, 1e-4)),
    "separatrix": ((2, 5, 6), (1, 0.75, -1)),
    "unstable axis": ((0.2, 0.4, 0.52), (0, 5, 0)),
    "steady": ((0.2, 0.4, 0.52), (0, 0, 2)),
    "oblate": ((0.3, 0.3, 0.5), (1, 2, 3)),
    "prolate": ((0.2, 0.5, 0.5), (1, 2, 3)),
    "sphere": ((0.5, 0.5, 0.5), (1, 2, 3)),
    "rest": ((0.2, 0.4, 0.52), (0, 0, 0)),
}


def turned(q, v, inverse=False):
    """Vectors turned by unit quaternions, in extended precision."""
    q, v = q.astype(np.longdouble), np.asarray(v, np.longdouble)
    q = q / np.sqrt((q * q).sum(axis=-1, keepdims=True))
    u, w = (-q[..., :3] if inverse else q[..., :3]), q[..., 3:]
    t = 2 * np.cross(u, v)
    return v + w * t + np.cross(u, t)


def bodies(n, rng=RNG):
    half = rng.uniform(0.1, 1, (n, 3)) ** 2
    attitude = rng.normal(size=(n, 4))
    return (half.sum(axis=1, keepdims=True) - half, rng.normal(size=(n, 3)),
            attitude / np.linalg.norm(attitude, axis=1, keepdims=True))


@pytest.mark.parametrize("frame", ["body", "space"])
@pytest.mark.parametrize("regime", REGIMES)
def test_a_direction_is_the_axis_turned_by_the_attitude(regime, frame):
    times, axis = RNG.uniform(-1000, 1000, 1111), (0.3, -2.0, 0.7)
    arguments = (*REGIMES[regime], START, times)
    omega, attitude = ph.free_motion(*arguments)
    found, same = ph.free_motion(*arguments, want=("direction", "omega"), axis=axis, frame=frame)
    assert np.abs(found - turned(attitude, axis, frame == "space")).max() <= FEW * np.linalg.norm(axis)
    assert np.array_equal(same, omega)
    grid = np.linspace(0, 1000, 1500)
    _, on_grid = ph.free_motion(*arguments[:3], grid)
    found = ph.free_motion(*arguments[:3], grid, want="direction", axis=axis, frame=frame)
    assert np.abs(found - turned(on_grid, axis, frame == "space")).max() <= FEW * np.linalg.norm(axis)


@pytest.mark.parametrize(("function", "arguments"), [(ph.heavy_top, TOP), (ph.gyrostat, WHEEL)])
def test_tops_and_gyrostats_follow_axes_too(function, arguments):
    times = RNG.uniform(0, 100, 777)
    attitude = function(*arguments, times, want="attitude")
    for axis, frame in (((0, 0, 1), "body"), ((1, 0, 0), "space")):
        found = function(*arguments, times, want="direction", axis=axis, frame=frame)
        assert np.abs(found - turned(attitude, axis, frame == "space")).max() <= FEW


def test_many_bodies_each_with_its_axis_and_time():
    moments, omega, attitude = bodies(300)
    moments[7], omega[7], omega[8], omega[9] = (0.2, 0.4, 0.52), (1e-7, 5, 1e-7), 0, (0, 1, 0)
    axes, times = RNG.normal(size=(300, 3)), RNG.uniform(-100, 100, 300)
    q = ph.free_motion(moments, omega, attitude, times, want="attitude")
    found = ph.free_motion(moments, omega, attitude, times, want="direction", axis=axes)
    assert np.abs(found - turned(q, axes)).max() <= FEW * 4
    grid = np.linspace(0, 50, 200)
    q = ph.free_motion(moments[:, None], omega[:, None], attitude[:, None], grid, want="attitude")
    many = [ph.free_motion(moments[:, None], omega[:, None], attitude[:, None], grid, want="direction",
                           axis=axes[:, None], threads=threads) for threads in (1, 2)]
    assert np.array_equal(*many)
    assert np.abs(many[0] - turned(q, axes[:, None])).max() <= FEW * 4
    tilted = ph.InertiaTensor.from_moments((0.2, 0.4, 0.52)).rotated((0.1, 0.7, -0.1, 0.7))
    q = ph.free_motion(tilted, omega, attitude, times, want="attitude")
    found = ph.free_motion(tilted, omega, attitude, times, want="direction", axis=axes)
    assert np.abs(found - turned(q, axes)).max() <= FEW * 4


def test_a_direction_into_memory_of_the_caller_and_rows_that_are_not_finite():
    moments, omega, attitude = bodies(40)
    axes, times = RNG.normal(size=(40, 3)), RNG.uniform(-100, 100, 40)
    axes[3, 1], times[5], omega[6, 0] = np.nan, np.inf, np.nan
    out = np.empty((40, 3))
    with pytest.warns(RuntimeWarning, match="3 rows are NaN") as record:
        assert ph.free_motion(moments, omega, attitude, times, want="direction", axis=axes, out=out) is out
    assert record[0].filename == __file__
    assert np.isnan(out).any(axis=1).nonzero()[0].tolist() == [3, 5, 6]
    many = (moments[:, None], omega[:, None], attitude[:, None], np.array([1.0, np.nan, 2.0]))
    with pytest.warns(RuntimeWarning, match="44 rows are NaN"):
        grid = ph.free_motion(*many, want="direction", axis=axes[:, None])
    assert np.isnan(grid[0]).any(axis=1).tolist() == [False, True, False]
    assert np.isnan(grid[3]).all()


@pytest.mark.parametrize("options", [
    {"want": "direction"}, {"axis": (0, 0, 1)}, {"want": "direction", "axis": (0, 0, 1), "frame": "world"},
    {"want": "direction", "axis": (0, 1)}, {"want": "directions", "axis": (0, 0, 1)}, {"dtype": "float16"},
    {"dtype": "int"}, {"dtype": np.int32}, {"dtype": None},
    {"dtype": "float32", "out": (np.empty((2, 3)), np.empty((2, 4)))},
    {"out": (np.empty((2, 3), np.float32), np.empty((2, 4), np.float32))},
])
def test_what_makes_no_sense_is_refused(options):
    with pytest.raises(ph.InvalidInput, match=r"axis|frame|want|dtype|out"):
        ph.free_motion((0.2, 0.4, 0.52), (1, 2, 3), START, [1.0, 2.0], **options)


def error(found, omega, attitude):
    """The larger of the errors, of omega over its largest and of the attitude [rad]."""
    w, q = found
    assert w.dtype == q.dtype == np.float32
    w, q = w.astype(float), q.astype(float)
    scale = np.abs(omega).max() or 1.0
    sign = np.sign((q * attitude).sum(axis=-1, keepdims=True))
    return max(np.abs(w - omega).max() / scale, 2 * np.linalg.norm(q * sign - attitude, axis=-1).max())


@pytest.mark.parametrize("regime", REGIMES)
@pytest.mark.parametrize("reach", [10.0, 1e3, 1e9, 1e15, 1e24])
def test_float32_is_within_a_millionth_at_any_time(regime, reach):
    moments, spin = REGIMES[regime]
    times = RNG.uniform(-reach, reach, 4001)
    expected = ph.free_motion(moments, spin, START, times)
    assert error(ph.free_motion(moments, spin, START, times, dtype="float32"), *expected) < 1e-6
    one = ph.free_motion(moments, spin, START, times, dtype=np.float32, want="attitude")
    assert np.array_equal(one, ph.free_motion(moments, spin, START, times, dtype=np.dtype("f4"))[1])


def test_float32_of_many_bodies_tops_and_gyrostats():
    for k in range(300):
        moments, omega, attitude = bodies(1, np.random.default_rng(k))
        times = np.random.default_rng(k).uniform(-1e6, 1e6, 100)
        w, q = ph.free_motion(moments[0], omega[0], attitude[0], times)
        assert error(ph.free_motion(moments[0], omega[0], attitude[0], times, dtype="float32"), w, q) < 1e-6
    for function, arguments in ((ph.heavy_top, TOP), (ph.gyrostat, WHEEL)):
        times = RNG.uniform(-1e5, 1e5, 1000)
        assert error(function(*arguments, times, dtype="float32"), *function(*arguments, times)) < 1e-6
    moments, omega, attitude = bodies(500)
    times = RNG.uniform(-1e5, 1e5, 500)
    expected = ph.free_motion(moments, omega, attitude, times)
    assert error(ph.free_motion(moments, omega, attitude, times, dtype="float32"), *expected) < 1e-6
    tilted = ph.InertiaTensor.from_moments((0.2, 0.4, 0.52)).rotated((0.1, 0.7, -0.1, 0.7))
    expected = ph.free_motion(tilted, (1, 2, 3), START, times)
    assert error(ph.free_motion(tilted, (1, 2, 3), START, times, dtype="float32"), *expected) < 1e-6


def test_float32_bits_depend_neither_on_the_place_nor_on_the_threads():
    times = RNG.uniform(-1e5, 1e5, 70_001)
    arguments = (*REGIMES["series"], START)
    w, q = ph.free_motion(*arguments, times, dtype="float32", threads=1)
    for piece in (slice(0, 1), slice(3, 20), slice(5, 1000), slice(69_990, None)):
        w1, q1 = ph.free_motion(*arguments, times[piece], dtype="float32")
        assert np.array_equal(w1, w[piece])
        assert np.array_equal(q1, q[piece])
    w2, q2 = ph.free_motion(*arguments, times, dtype="float32", threads=2)
    assert np.array_equal(w, w2)
    assert np.array_equal(q, q2)
    out = (np.empty_like(w), np.empty_like(q))
    assert ph.free_motion(*arguments, times, dtype="float32", out=out)[0] is out[0]
    assert np.array_equal(out[1], q)
    direction = ph.free_motion(*arguments, times, dtype="float32", want="direction", axis=(1, 2, 2))
    exact = ph.free_motion(*arguments, times, want="direction", axis=(1, 2, 2))
    assert np.array_equal(direction, exact.astype(np.float32))


@pytest.mark.parametrize("unit", [1e-30, 1e-12, 1e12, 1e30])
def test_float32_at_other_scales(unit):
    moments, spin = REGIMES["series"]
    times = RNG.uniform(-1e3, 1e3, 500) / unit
    expected = ph.free_motion(moments, np.multiply(spin, unit), START, times)
    assert error(ph.free_motion(moments, np.multiply(spin, unit), START, times, dtype="float32"), *expected) < 1e-6
