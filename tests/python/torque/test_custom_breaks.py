"""Own torques that jump: breaks, looks between the stages, and what a motion says of them."""

import pickle
import re

import numpy as np
import pytest
from measures import error

import polhode as ph

INERTIA, OMEGA, SPAN, TIMES = (1, 2, 2.5), (1, 2, 3), 20.0, np.linspace(0, 20, 11)


def make(function, scale=1.0, **options):
    """A scene whose time runs `scale` times slower."""
    return ph.Scene(inertia=INERTIA, omega=np.array(OMEGA) / scale, times=TIMES * scale,
                    torques=[ph.torques.Custom(function, **options)])


def windowed(torque, windows, scale=1.0):
    """The truth of a pulse: the library's own torque in windows."""
    return make(lambda t, w, q: (0.0, 0.0, 0.0), scale).replace(
        torques=[ph.torques.During(ph.torques.Constant(torque), windows)])


def apart(motion, truth):
    return error(motion.omega, motion.attitude, {"omega": truth.omega, "attitude": truth.attitude}, truth.scene.omega)


@pytest.mark.parametrize("scale", [1.0, 1e-12, 1e12])
@pytest.mark.parametrize("share", [1e-3, 3e-3, 3e-2])
@pytest.mark.parametrize("given", [False, True])
def test_a_pulse_between_the_stages_is_in_the_motion(share, given, scale):
    width, height = share * SPAN * scale, 0.05 / share / scale**2
    misses = 0
    for begin in np.array((0.21, 3.1234, 7.77, 11.0, 19.3)) * scale:
        end = begin + width

        def pulse(t, omega, attitude, begin=begin, end=end):
            return (0.0, 0.0, height if begin <= t < end else 0.0)

        scene = make(pulse, scale, **({"breaks": (end, begin)} if given else {}))
        truth = ph.solve(windowed((0, 0, height), [(begin, end)], scale), 1e-12)
        for accuracy in (1e-3, 1e-9):
            motion = ph.solve(scene, accuracy)
            assert motion.success and motion.error_kind == "bounded", motion.message
            assert [piece.begin for piece in motion.plan.pieces] == pytest.approx([0, begin, end], rel=1e-14)
            assert ("your torque jumps or kinks at t = " in motion.message) != given
            misses += apart(motion, truth) > motion.error
    assert misses == 0


@pytest.mark.parametrize("less_or_equal", [False, True])
def test_a_break_belongs_to_the_side_of_its_piece(less_or_equal):
    """A last stage ends at the break, where the function has the value of one side or of the other."""
    def step(t, omega, attitude):
        before = t <= 3.3 if less_or_equal else t < 3.3
        return (0.0, 0.0, 5.0 if before else -5.0)

    motion = ph.solve(make(step, breaks=[3.3]), 1e-10)
    two = [ph.torques.During(ph.torques.Constant((0, 0, s)), [w]) for s, w in ((5, (0, 3.3)), (-5, (3.3, 40)))]
    truth = ph.solve(make(step).replace(torques=two), 1e-12)
    assert apart(motion, truth) <= motion.error <= 1e-10 and motion.stats["rejected"] < 10


@pytest.mark.parametrize("less_or_equal", [False, True])
@pytest.mark.parametrize("units", [1, 2, 3, 5])
@pytest.mark.parametrize("begin", [1.0, -1.0, 3.3])
def test_pieces_of_some_units_in_the_last_place(begin, units, less_or_equal):
    """A start or a second break some units from a break: the function has one side's value within the piece."""
    width, height = 2.0**-23, 1e9
    near = [begin, begin + width]
    for edge in (0, 1):
        for side in (-1, 1):
            near.append(near[edge])
            for _ in range(units):
                near[-1] = np.nextafter(near[-1], side * 9)

    def pulse(t, omega, attitude):
        inside = begin < t <= begin + width if less_or_equal else begin <= t < begin + width
        return (0.0, 0.0, height if inside else 0.0)

    times = [begin - width, *near, begin + 2 * width]
    torque = ph.torques.During(ph.torques.Constant((0, 0, height)), [(begin, begin + width)])
    for t0 in near:
        scene = ph.Scene(inertia=(2, 1.5, 1), omega=(0, 0, 0.5), t0=t0, times=times,
                         torques=[ph.torques.Custom(pulse, breaks=near)])
        exact = ph.solve(scene.replace(torques=[torque]), 1e-9, method="taylor").omega[:, 2]
        motion = ph.solve(scene.replace(torques=[ph.torques.Custom(pulse, breaks=near[:2])]), 1e-9)
        assert motion.status == "finished", motion.message
        # a piece of one unit may be of either side
        assert np.abs(motion.omega[:, 2] - exact).max() < 1.01 * np.spacing(abs(begin)) * height
        assert ph.solve(scene, 1e-9).status == "finished"


def test_the_knots_of_a_table_are_found():
    knots, values = np.linspace(0, 20, 14), np.random.default_rng(3).normal(size=14)

    def table(t, omega, attitude):
        return (0.0, 0.1, np.interp(t, knots, values))

    found = ph.solve(make(table), 1e-7)
    given = ph.solve(make(table, breaks=knots), 1e-11)
    assert [piece.begin for piece in found.plan.pieces] == pytest.approx(knots[:-1], abs=1e-8)
    assert found.error_kind == "bounded" and apart(found, given) <= found.error + given.error


def test_a_smooth_torque_is_not_divided():
    for function in (lambda t, w, q: -0.1 * w, lambda t, w, q: np.array((0, 0.2, 0.1)) * np.sin(40 * t),
                     lambda t, w, q: np.cross((0.1, 0.2, 0.3), w)):
        motion = ph.solve(make(function), 1e-8)
        assert motion.error_kind == "bounded" and not motion.plan.pieces and "jumps" not in motion.message


def test_a_switch_by_the_state_is_estimated():
    motion = ph.solve(make(lambda t, w, q: (0.0, 0.0, 0.3 if w[0] > 0.5 else -0.3)), 1e-6)
    assert motion.error_kind == "estimated" and motion.success and "jumps with the state" in motion.message
    assert "np.where in a Formula, or with During" in motion.message


def test_a_run_that_a_jump_ends_names_it_and_keeps_its_samples():
    by_time = r"your torque jumps near t = 13\.(7|6999).* np.where in a Formula, During.* breaks="
    for function, reason in ((lambda t, w, q: (0.0, 0.0, 1e5 if t > 13.7 else 0.0), by_time),
                             (lambda t, w, q: (0.0, 0.0, 1e5 if w[0] > 1.5 else 0.0),
                              "your torque jumps with .* np.where in a")):
        motion = ph.solve(make(function), method="dop853", rtol=1e-13, max_steps=20_000)
        assert motion.status == "failed"
        assert re.search(reason, motion.message), motion.message
        assert 1 < len(motion.t) < len(TIMES) and np.array_equal(motion.t, TIMES[:len(motion.t)])


def test_a_jump_that_ends_a_run_is_passed_where_an_accuracy_is_asked():
    motion = ph.solve(make(lambda t, w, q: (0.0, 0.0, 1e4 if 13.7 < t < 13.71 else 0.0)), 1e-9)
    assert motion.success and motion.error_kind == "bounded" and len(motion.plan.pieces) == 3


def test_breaks_are_checked_and_compared():
    def none(t, omega, attitude):
        return (0.0, 0.0, 0.0)

    for bad in ([np.nan], [np.inf], [[1.0]], 3.0):
        with pytest.raises(ph.InvalidInput, match=r"Custom\.breaks"):
            ph.torques.Custom(none, breaks=bad)
    torque = ph.torques.Custom(none, breaks=[2, 1, 2])
    assert torque.breaks == (1.0, 2.0) and torque != ph.torques.Custom(none)
    own = ph.torques.Custom(print, breaks=[2, 1])
    assert pickle.loads(pickle.dumps(own)).breaks == (1.0, 2.0)


def brake(t, omega, attitude):
    return -69 / 30 * 0.00257 * np.array(omega)


def test_a_damped_own_torque_costs_more_at_a_higher_accuracy():
    scene = ph.Scene(inertia=(0.00257, 0.00842, 0.00975), omega=np.radians((10, 20, 30)),
                     torques=[ph.torques.Custom(brake)], times=np.linspace(0, 30, 301))
    calls = [ph.solve(scene, 10.0**-k).stats["derivatives"] for k in range(3, 13)]
    for k, count in enumerate(calls):
        assert count <= 1.2 * min(calls[k:]), calls


@pytest.mark.parametrize("suffix", ["npz", "zarr"])
def test_a_motion_with_an_own_torque_is_saved(tmp_path, suffix):
    if suffix == "zarr":
        pytest.importorskip("zarr")
    path = tmp_path / f"a.{suffix}"
    for torque in (ph.torques.Custom(brake, uses_time=False), ph.torques.During(ph.torques.Custom(brake), [(1, 2)])):
        motion = ph.solve(make(brake).replace(torques=[torque]), 1e-8)
        motion.save(path)
        again = ph.load(path)
        assert np.array_equal(again.omega, motion.omega) and np.array_equal(again.attitude, motion.attitude)
        assert (again.error, again.error_kind, again.message) == (motion.error, motion.error_kind, motion.message)
        assert again.plan.pieces == motion.plan.pieces and again.stats == motion.stats and again.success
        assert again.drift == motion.drift and "brake" in repr(again.scene.torques)
        with pytest.raises(ph.InvalidInput, match="must have its torque 'brake', a function, which no file holds"):
            ph.solve(again.scene, 1e-8)
        repeated = ph.solve(again.scene.replace(torques=[torque]), **again.options)
        assert np.array_equal(repeated.omega, motion.omega)
        again.save(path)
        assert np.array_equal(ph.load(path).omega, motion.omega)


def test_datasets_of_own_torques_exist():
    pytest.importorskip("xarray")
    motion = ph.solve(make(brake), 1e-6)
    assert np.array_equal(motion.to_xarray().omega, motion.omega)


@pytest.mark.parametrize("method", ["dop853", "rk45", "radau"])
@pytest.mark.parametrize("times", [[-10.0], [-14.0, -10.0], [-10.0, 10.0]])
def test_a_jump_before_the_start(method, times):
    """The comparison has a sample at the start, whose piece has no length and was not planned."""
    def step(t, omega, attitude):
        return (0.0, 0.0, 0.5 if t < -3.3 else -0.5)

    scene = make(step).replace(times=times)
    motion = ph.solve(scene, 1e-6, method=method)
    truth = ph.solve(make(step, breaks=[-3.3]).replace(times=times), 1e-11)
    assert motion.success and apart(motion, truth) <= motion.error + truth.error


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("span", [3.0, 10.0])
def test_a_motion_along_a_jump_ends_soon(accuracy, span):
    """Dry friction by the sign of the rates: at rest each step crosses the jump, and most are rejected."""
    calls = 0

    def dry(t, omega, attitude):
        nonlocal calls
        calls += 1
        return -0.3 * np.sign(omega)

    motion = ph.solve(ph.Scene(inertia=INERTIA, omega=(1, 0.5, -1.2), torques=[ph.torques.Custom(dry)],
                               times=np.linspace(0, span, 11)), accuracy)
    assert calls < 2_000_000
    if not motion.success:
        assert motion.status == "max_steps" and len(motion.t) and "jumps with the state" in motion.message
    assert not motion.success or motion.error_kind == "estimated"
    assert motion.success == (accuracy == 1e-3 and span == 3.0)
