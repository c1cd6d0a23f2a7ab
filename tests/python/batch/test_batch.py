"""Batches: broadcast as in NumPy, equal to the objects, the same bits however the work is cut."""

import csv
import pathlib
import warnings

import levels
import numpy as np
import pytest

import polhode as ph

REFERENCE = pathlib.Path(__file__).parents[2] / "reference"
RNG = np.random.default_rng(11)


def bodies(n, rng=RNG):
    half = rng.uniform(0.1, 1, (n, 3)) ** 2
    moments = half.sum(axis=1, keepdims=True) - half
    attitude = rng.normal(size=(n, 4))
    return moments, rng.normal(size=(n, 3)), attitude / np.linalg.norm(attitude, axis=1, keepdims=True)


def apart(p, q):
    """Angle between attitudes (..., 4)."""
    p, q = p * np.sign((p * q).sum(axis=-1, keepdims=True)), q
    return 2 * np.linalg.norm(p - q, axis=-1)


def assert_same(got, motions, times, tolerance=2e-15):
    omega, attitude = got
    for k, motion in enumerate(motions):
        w, q = motion.at(times[k])
        assert np.abs(omega[k] - w).max() <= tolerance * np.abs(w).max()
        assert apart(attitude[k], q).max() <= tolerance


def test_many_bodies_at_one_time_each_are_the_objects():
    moments, omega, attitude = bodies(300)
    omega[5], omega[6, [0, 2]], omega[7] = 0, 0, (1e-9, 2, 1e-9)      # at rest, on an axis, next to the separatrix
    omega[8] *= 1e-150
    moments[9] = 1
    t = RNG.uniform(-1000, 1000, 300)
    motions = [ph.FreeMotion(*row) for row in zip(moments, omega, attitude, strict=True)]
    assert_same(ph.free_motion(moments, omega, attitude, t), motions, t)


def test_the_stored_truth_in_one_call():
    with (REFERENCE / "free_motion.csv").open() as file:
        rows = list(csv.DictReader(file))
    rows = [r for r in rows if 2 * max(m := [float(r[k]) for k in ("I1", "I2", "I3")]) <= sum(m) * (1 + 1e-13)]

    def columns(*names):
        return np.array([[float(row[name]) for name in names] for row in rows])

    moments, omega, attitude = columns("I1", "I2", "I3"), columns("w1", "w2", "w3"), columns("x0", "y0", "z0", "w0")
    attitude /= np.linalg.norm(attitude, axis=1, keepdims=True)
    t, cond = columns("t")[:, 0], columns("cond")[:, 0]
    assert len(t) > 400
    for shape in ((-1,), (-1, 1)):      # one time each, and set up for many times
        w, q = ph.free_motion(moments, omega, attitude, t) if shape == (-1,) else (
            a[:, 0] for a in ph.free_motion(moments[:, None], omega[:, None], attitude[:, None],
                                            np.stack([t, 0 * t], axis=1)))
        expected = columns("o1", "o2", "o3")
        scale = np.abs(expected).max(axis=1)
        scale[scale == 0] = 1
        assert (np.linalg.norm((w - expected) / scale[:, None], axis=1) < 20 * (cond + 8.8e-16)).all()
        assert np.linalg.norm((w - expected) / scale[:, None], axis=1).max() < 3e-15
        assert apart(q, columns("x", "y", "z", "w")).max() < 3e-15


def test_broadcasting_in_every_shape():
    moments, omega, attitude = bodies(6)
    times = np.linspace(0, 50, 7)
    grid = ph.free_motion(moments[:, None], omega[:, None], attitude[:, None], times)
    assert grid[0].shape == (6, 7, 3) and grid[1].shape == (6, 7, 4)
    assert_same(grid, [ph.FreeMotion(*row) for row in zip(moments, omega, attitude, strict=True)], [times] * 6)
    other = ph.free_motion(moments, omega, attitude, times[:, None])                 # times before bodies
    np.testing.assert_array_equal(other[0], grid[0].swapaxes(0, 1))
    np.testing.assert_array_equal(other[1], grid[1].swapaxes(0, 1))
    cube = ph.free_motion(moments.reshape(2, 3, 1, 3), omega.reshape(2, 3, 1, 3), attitude.reshape(2, 3, 1, 4), times)
    np.testing.assert_array_equal(cube[0], grid[0].reshape(2, 3, 7, 3))
    middle = ph.free_motion(moments.reshape(2, 1, 3, 3), omega.reshape(2, 1, 3, 3), attitude.reshape(2, 1, 3, 4),
                            times[:, None])
    np.testing.assert_array_equal(middle[1], grid[1].reshape(2, 3, 7, 4).swapaxes(1, 2))
    own = ph.free_motion(moments[:, None], omega[:, None], attitude[:, None], np.tile(times, (6, 1)))
    np.testing.assert_array_equal(own[0], grid[0])
    one = ph.free_motion(moments[0], omega[0], attitude[0], 3.0)
    assert one[0].shape == (3,) and one[1].shape == (4,)
    mixed = ph.free_motion(moments[0], omega, attitude[:1], times[0])                # one shape of body, six spins
    assert mixed[0].shape == (6, 3)
    strided = ph.free_motion(np.repeat(moments, 2, axis=0)[::2], omega[::-1][::-1], np.asfortranarray(attitude),
                             times[0])
    np.testing.assert_array_equal(strided[0], ph.free_motion(moments, omega, attitude, times[0])[0])
    for empty in (ph.free_motion(moments[:0], omega[:0], attitude[:0], 1.0),
                  ph.free_motion(moments[0], omega[0], attitude[0], [])):
        assert empty[0].shape == (0, 3) and empty[1].shape == (0, 4)


def test_want_and_out():
    moments, omega, attitude = bodies(5)
    times = np.linspace(0, 9, 4)
    arguments = (moments[:, None], omega[:, None], attitude[:, None], times)
    w, q = ph.free_motion(*arguments)
    np.testing.assert_array_equal(ph.free_motion(*arguments, want="omega"), w)
    (only,) = ph.free_motion(*arguments, want=("attitude",))
    np.testing.assert_array_equal(only, q)
    swapped = ph.free_motion(*arguments, want=("attitude", "omega"))
    np.testing.assert_array_equal(swapped[0], q)
    out = (np.full_like(w, np.nan), np.full_like(q, np.nan))
    got = ph.free_motion(*arguments, out=out)
    assert got[0] is out[0] and got[1] is out[1]
    np.testing.assert_array_equal(out[0], w)
    strided = (np.zeros((5, 4, 6))[..., ::2], np.zeros((4, 5, 4)).swapaxes(0, 1))
    ph.free_motion(*arguments, out=strided)
    np.testing.assert_array_equal(strided[0], w)
    np.testing.assert_array_equal(strided[1], q)
    tensor = ph.InertiaTensor.from_moments(moments[0])
    np.testing.assert_array_equal(ph.free_motion(tensor, omega[0], attitude[0], times)[0], w[0])


def test_one_body_has_a_quick_way_with_the_same_bits():
    """Plain arguments of one body skip the broadcasting; `threads` asks for the usual way."""
    moments, omega, attitude = (array[0] for array in bodies(1))
    wheel = ((2.0, 2.0, 1.0), (0, 0, 3), (0, 0, 0, 1))
    for t in (np.linspace(-3, 50, 1001), RNG.uniform(0, 1e6, (7, 3)), np.zeros(1)):
        for one in ((moments, omega, attitude), (tuple(moments), list(omega), attitude), wheel):
            for got, usual in zip(ph.free_motion(*one, t), ph.free_motion(*one, t, threads=1), strict=True):
                assert got.shape == usual.shape and got.tobytes() == usual.tobytes()
            out = np.empty((*t.shape, 3)), np.empty((*t.shape, 4))
            written = ph.free_motion(*one, t, out=out)
            assert all(got is given for got, given in zip(written, out, strict=True))
            for got, usual in zip(out, ph.free_motion(*one, t, threads=1), strict=True):
                assert got.tobytes() == usual.tobytes()


@pytest.mark.parametrize("change", [
    {"inertia": ("1", 2.0, 2.5)}, {"inertia": (10**400, 2, 2)}, {"inertia": (1.0, 2.0, 4.0)}, {"omega": (1.0, 2.0)},
    {"omega": (np.nan, 0.0, 1.0)}, {"omega": (1e-320, 0.0, 1.0)}, {"attitude": (0, 0, 0, 1.1)}, {"t": [np.inf, 1.0]},
    {"attitude": (1, 0, 0, 0)}, {"t": [1e300]}, {"t": []}, {"inertia": (1e-160, 1.0, 1.0)}])
def test_what_the_quick_way_does_not_take_is_told_as_usual(change):
    call = {"inertia": (1.0, 2.0, 2.5), "omega": (1.0, 2.0, 3.0), "attitude": (0.0, 0.0, 0.0, 1.0), "t": [0.5]} | change
    call["t"] = np.array(call["t"])

    def outcome(**more):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                answer = [a.tobytes() for a in ph.free_motion(*call.values(), **more)]
            except ValueError as refused:
                answer = str(refused)
        return answer, [(w.category, str(w.message), w.filename) for w in caught]

    assert outcome() == outcome(threads=1)


def test_a_full_tensor_has_the_bits_of_the_object():
    moments, omega, attitude = bodies(4)
    q = np.array([0.1, 0.7, -0.3, 0.6]) / np.linalg.norm([0.1, 0.7, -0.3, 0.6])
    R = ph.Rotation.from_quat(q).as_matrix()
    tensor = ph.InertiaTensor(R @ np.diag(moments[0]) @ R.T)
    times = np.linspace(0, 20, 5)
    motions = [ph.FreeMotion(tensor, w, a) for w, a in zip(omega, attitude, strict=True)]
    assert_same(ph.free_motion(tensor, omega[:, None], attitude[:, None], times), motions, [times] * 4, 0)
    assert_same(ph.free_motion(tensor, omega, attitude, times[:4]), motions, times, 0)
    out = np.empty((4, 3))
    assert ph.free_motion(tensor, omega, attitude, times[:4], out=out, want="omega") is out
    np.testing.assert_array_equal(out[1], motions[1].at(times[1])[0])


def test_not_a_number_poisons_its_rows_alone():
    moments, omega, attitude = bodies(100)
    t = np.linspace(0, 9, 100)
    clean = ph.free_motion(moments, omega, attitude, t)
    moments[3, 1], omega[40, 0], attitude[41, 3], t[99] = np.nan, np.inf, np.nan, -np.inf
    with pytest.warns(RuntimeWarning, match="^4 rows"):
        got = ph.free_motion(moments, omega, attitude, t)
    bad = np.isin(np.arange(100), [3, 40, 41, 99])
    for a, b in zip(got, clean, strict=True):
        assert np.isnan(a[bad]).all()
        np.testing.assert_array_equal(a[~bad], b[~bad])
    times = np.array([0.0, np.nan, 2.0, 3.0])
    with pytest.warns(RuntimeWarning, match="^15 rows"):
        w, q = ph.free_motion(moments[:12, None], omega[:12, None], attitude[:12, None], times)
    assert np.isnan(w[:, 1]).all() and np.isnan(w[3]).all() and np.isfinite(w[4, [0, 2, 3]]).all()


@pytest.mark.parametrize("change", ["moments", "omega", "attitude", "times", "text", "shapes", "want", "out", "threads",
                                    "flat"])
def test_refusals(change):
    moments, omega, attitude = bodies(3)
    t, options = np.zeros(3), {}
    if change == "moments":
        moments[1, 0] = -1
    elif change == "flat":
        moments[2] = (1, 1, 2.1)
    elif change == "omega":
        omega = omega[:, :2]
    elif change == "attitude":
        attitude[2] *= 2
    elif change == "times":
        t[1] = 1e28
    elif change == "text":
        t = ["now"] * 3
    elif change == "shapes":
        t = np.zeros(4)
    else:
        options = {"want": {"want": "speed"}, "out": {"out": (np.zeros(3), np.zeros(4))},
                   "threads": {"threads": 0}}[change]
    with pytest.raises(ph.InvalidInput):
        ph.free_motion(moments, omega, attitude, t, **options)


def test_a_result_too_large_is_refused_before_it_starts():
    body = [a[0] for a in bodies(1)]
    with pytest.raises(MemoryError, match="bytes"):
        ph.free_motion(*body, np.broadcast_to(0.0, (10**6, 10**6, 10**3)))


def digest(threads):
    rng = np.random.default_rng(3)
    found = []
    for n, t in ((1, rng.uniform(0, 1e3, 30000)), (997, rng.uniform(0, 1e3, 997)), (331, rng.uniform(0, 1e3, 37))):
        moments, omega, attitude = bodies(n, rng)
        omega[0] = omega[0] * (1, 1, 1) if n == 1 else (1e-9, 3, 1e-9)
        if n == 331:
            moments, omega, attitude = moments[:, None], omega[:, None], attitude[:, None]
        found += [a.tobytes() for a in ph.free_motion(moments, omega, attitude, t, threads=threads)]
    return found


def test_the_same_bits_for_any_number_of_threads_and_any_split():
    expected = digest(1)
    for threads in (2, 3, 5):
        assert digest(threads) == expected
    moments, omega, attitude = bodies(50)
    t = np.linspace(0, 99, 13)
    whole = ph.free_motion(moments[:, None], omega[:, None], attitude[:, None], t)
    for k in (0, 3, 17):
        part = ph.free_motion(moments[k : k + 5, None], omega[k : k + 5, None], attitude[k : k + 5, None], t)
        np.testing.assert_array_equal(part[0], whole[0][k : k + 5])
        np.testing.assert_array_equal(part[1], whole[1][k : k + 5])


def test_the_same_bits_on_avx2_and_avx512():
    found = levels.outputs("import hashlib, test_batch;"
                           "print(hashlib.sha256(b''.join(test_batch.digest(1))).hexdigest())", levels.LEVELS)
    assert found["avx2"] == found["avx512"] != found["baseline"]


def test_no_warning_without_cause():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ph.free_motion(*bodies(3), 1.0)
