"""`errors="nan"` and `progress=` of batches: impossible bodies fail alone, and long calls tell how far they are."""

import numpy as np
import pytest

import polhode as ph

TIMES = np.linspace(0.0, 5.0, 7)
N = 200


def starts():
    rng = np.random.Generator(np.random.Philox(4))
    moments = 0.02 + 0.01 * rng.random((N, 3))
    omega = 2 * rng.random((N, 3)) - 1
    attitude = ph.Rotation.from_rotvec(rng.random((N, 3))).as_quat()
    return moments, omega, attitude


def spoil(moments, omega, attitude):
    """Spoil five bodies in five ways; return which are still good."""
    moments[3] = [1.0, 1.0, 3.0]
    moments[64, 1] = -1.0
    attitude[65] *= 1.1
    omega[150] *= 1e26
    omega[199, 2] = np.nan
    good = np.ones(N, bool)
    good[[3, 64, 65, 150, 199]] = False
    return good


@pytest.mark.parametrize("threads", [1, 2])
def test_free_bodies_that_are_impossible_fail_alone(threads):
    moments, omega, attitude = starts()
    whole = ph.free_motion(moments[:, None], omega[:, None], attitude[:, None], TIMES)
    good = spoil(moments, omega, attitude)
    with pytest.raises(ph.InvalidInput, match=r"inertia\[3\]"):
        ph.free_motion(moments[:, None], omega[:, None], attitude[:, None], TIMES, threads=threads)
    with pytest.warns(RuntimeWarning, match=rf"^{5 * TIMES.size} rows are NaN .* no possible body"):
        found = ph.free_motion(moments[:, None], omega[:, None], attitude[:, None], TIMES, errors="nan",
                               threads=threads)
    for a, b in zip(found, whole, strict=True):
        assert np.array_equal(a[good], b[good]) and np.isnan(a[~good]).all()


def test_each_at_its_own_time_and_one_alone():
    moments, omega, attitude = starts()
    t = np.linspace(0, 3, N)
    whole = ph.free_motion(moments, omega, attitude, t)
    good = spoil(moments, omega, attitude)
    with pytest.warns(RuntimeWarning, match="^5 rows"):
        found = ph.free_motion(moments, omega, attitude, t, errors="nan")
    for a, b in zip(found, whole, strict=True):
        assert np.array_equal(a[good], b[good]) and np.isnan(a[~good]).all()
    with pytest.warns(RuntimeWarning, match="^7 rows"):
        assert np.isnan(ph.free_motion([1, 1, 3], [1, 0, 0], (0, 0, 0, 1), TIMES, errors="nan")[0]).all()


def test_bodies_that_the_lanes_leave():
    # At rest, on the unstable axis, next to it, and beyond the range of times there.
    moments = np.tile([1.0, 2.0, 2.5], (4, 1))
    omega = np.array([[0.0, 0, 0], [0, 1.0, 0], [0, 1.0, 1e-12], [0, 1e25, 0]])
    with pytest.warns(RuntimeWarning, match="^3 rows"):
        found, _ = ph.free_motion(moments[:, None], omega[:, None], (0, 0, 0, 1), [0.0, 0.5, 1.2], errors="nan")
    assert np.isfinite(found[:3]).all() and np.isnan(found[3]).all()


def test_tops_and_gyrostats_that_are_impossible_fail_alone():
    moments = np.tile([0.02, 0.02, 0.01], (10, 1))
    omega = np.tile([0.1, 0.0, 9.0], (10, 1))
    attitude = ph.Rotation.from_euler("x", 0.5).as_quat()
    for bad in ([0.02, 0.021, 0.01], [-1.0, 1.0, 1.0], [np.nan, 1.0, 1.0]):
        spoiled = moments.copy()
        spoiled[4] = bad
        for motion, extra in ((ph.heavy_top, (0.3,)), (ph.gyrostat, ((0.0, 0.1, 0.0),))):
            if motion is ph.gyrostat and bad[0] == 0.02:
                continue   # a gyrostat may have any moments
            arms = extra[0]
            whole = motion(moments[:, None], arms, omega[:, None], attitude, TIMES)
            with pytest.warns(RuntimeWarning, match=f"^{TIMES.size} rows are NaN"):
                found = motion(spoiled[:, None], arms, omega[:, None], attitude, TIMES, errors="nan")
            good = np.arange(10) != 4
            for a, b in zip(found, whole, strict=True):
                assert np.array_equal(a[good], b[good]) and np.isnan(a[4]).all()
            if not np.isnan(bad[0]):
                with pytest.raises(ph.InvalidInput, match=r"body\[4\]"):
                    motion(spoiled[:, None], arms, omega[:, None], attitude, TIMES)


@pytest.mark.parametrize("options", [{"method": "taylor", "rtol": 1e-9}, {"method": "rk45", "rtol": 1e-6},
                                     {"accuracy": 1e-8}, {"method": "dop853", "rtol": 1e-8}])
def test_solve_many_leaves_out_what_solve_refuses(options):
    moments, omega, attitude = (array[:12].copy() for array in starts())
    scene = ph.Scene(inertia=(0.02, 0.025, 0.03), omega=(0, 0, 1), times=TIMES,
                     torques=[ph.torques.Damping(np.eye(3) * 1e-4)])
    whole = ph.solve_many(scene, inertia=moments, omega=omega, attitude=attitude, **options)
    assert not whole.refused.any()
    moments[2] = [1.0, 1.0, 3.0]
    omega[5, 1] = np.nan
    attitude[7] *= 2
    with pytest.raises(ph.InvalidInput, match="body"):
        ph.solve_many(scene, inertia=moments, omega=omega, attitude=attitude, **options)
    found = ph.solve_many(scene, inertia=moments, omega=omega, attitude=attitude, errors="nan", **options)
    assert np.flatnonzero(found.refused).tolist() == [2, 5, 7]
    good = ~found.refused
    assert np.array_equal(found.omega[good], whole.omega[good]) and np.isnan(found.omega[~good]).all()
    assert np.array_equal(found.attitude[good], whole.attitude[good]) and np.isnan(found.attitude[~good]).all()
    assert [found.status[i] for i in (2, 5, 7)] == ["failed"] * 3 and "triangle" in found.message[2]
    assert np.isnan(found.t_reached[[2, 5, 7]]).all() and not found.success[[2, 5, 7]].any()
    assert [status for status, fine in zip(found.status, good, strict=True) if fine] == ["finished"] * 9


def test_wrong_options_are_refused_all_the_same():
    scene = ph.Scene(inertia=(0.02, 0.025, 0.03), omega=(0, 0, 1), times=TIMES)
    for options in ({"method": "rk45", "rtol": -1.0}, {"method": "nonsense", "rtol": 1e-6}, {"accuracy": -1.0}):
        with pytest.raises(ph.InvalidInput):
            ph.solve_many(scene, omega=np.ones((3, 3)), errors="nan", **options)
    for call in (lambda: ph.free_motion([1, 1, 1], [0, 0, 1], (0, 0, 0, 1), 1.0, errors="ignore"),
                 lambda: ph.solve_many(scene, omega=np.ones((3, 3)), accuracy=1e-6, errors=None)):
        with pytest.raises(ph.InvalidInput, match="errors: must be 'raise' or 'nan'"):
            call()


@pytest.mark.parametrize("threads", [1, 2])
def test_progress_of_a_batch(threads):
    moments, omega, attitude = starts()
    moments, omega, attitude = (np.repeat(array, 40, axis=0)[:, None] for array in (moments, omega, attitude))
    times, seen = np.linspace(0, 9, 1000), []
    found = ph.free_motion(moments, omega, attitude, times, want="omega", threads=threads,
                           progress=lambda done, total: seen.append((done, total)))
    assert np.array_equal(found, ph.free_motion(moments, omega, attitude, times, want="omega"))
    total = moments.shape[0] * times.size
    assert {last for _, last in seen} == {total} and seen[-1] == (total, total)
    done = [first for first, _ in seen]
    assert done == sorted(done) and 0 < done[0] <= total and (threads > 1 or len(done) > 1)


def test_progress_of_tops_and_of_one_body():
    seen = []
    ph.heavy_top((0.02, 0.02, 0.01), 0.3, np.tile([0.1, 0.0, 9.0], (2000, 1))[:, None], (0, 0, 0, 1),
                 np.linspace(0, 5, 2000), want="omega", progress=lambda *got: seen.append(got))
    assert seen[-1] == (4_000_000, 4_000_000) and 0 < seen[0][0] <= 4_000_000
    seen.clear()
    body, times = ph.FreeMotion([1.0, 2.0, 2.5], [0.1, 1.0, 0.2]), np.linspace(0, 1e3, 4_000_000)
    found = body.at(times, progress=lambda *got: seen.append(got))
    assert seen[-1] == (times.size, times.size) and 0 < seen[0][0] <= times.size
    assert all(np.array_equal(a, b) for a, b in zip(found, body.at(times), strict=True))


def test_progress_ends_a_call_by_what_it_raises():
    def stop(done, total):
        raise RuntimeError(f"at {done} of {total}")

    for call in (lambda: ph.FreeMotion([1, 2, 2.5], [0.1, 1, 0.2]).at(np.linspace(0, 1e3, 4_000_000), progress=stop),
                 lambda: ph.free_motion([1, 2, 2.5], np.ones((4000, 1, 3)), (0, 0, 0, 1), np.linspace(0, 9, 1000),
                                        progress=stop)):
        with pytest.raises(RuntimeError, match="^at [1-9]"):
            call()


def test_progress_true_writes_a_line(capsys):
    ph.free_motion([1, 2, 2.5], np.ones((10, 1, 3)), (0, 0, 0, 1), np.linspace(0, 9, 10), progress=True)
    assert "100.0% of 100 states" in capsys.readouterr().err
    assert ph.FreeMotion([1, 2, 2.5], [1, 1, 1]).at([1.0], progress=False)[0].shape == (1, 3)
    for call in (lambda: ph.FreeMotion([1, 2, 2.5], [1, 1, 1]).at([1.0], progress=3),
                 lambda: ph.heavy_top([2, 2, 1], 1, [1, 1, 1], (0, 0, 0, 1), 1.0, progress="yes")):
        with pytest.raises(ph.InvalidInput, match="progress: must be True or a callable"):
            call()
