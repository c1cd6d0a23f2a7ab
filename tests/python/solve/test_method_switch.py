"""A damped body that spins fast at first and slowly later: the state is handed from Taylor's steps to Radau's."""

import numpy as np
import pytest

import polhode as ph


def slowing(speed, damping, span, samples=101):
    return ph.Scene(inertia=(1, 2, 2.5), omega=np.array((1, 2, 3)) * speed, times=np.linspace(0, span, samples),
                    torques=[ph.torques.Damping(np.array((1, 1 / 2, 1 / 3)) * damping)])


@pytest.mark.parametrize("accuracy", [1e-6, 1e-9, 1e-11])
def test_a_fast_body_that_slows_down_is_handed_to_the_implicit_method(accuracy):
    common = slowing(30, 100, 100)
    plan = ph.plan(common, accuracy)
    first, second = plan.pieces
    assert (first.method, second.method) == ("taylor", "radau") and 0 < first.end == second.begin < 20
    assert "switch from taylor to radau at t =" in str(plan) and plan.predicted_error < 2 * accuracy
    motion = ph.solve(common, accuracy=accuracy)
    omega, attitude, _ = ph._core.reference(common, 26, 1e-21, 100_000)
    assert motion.success and motion.plan.pieces == plan.pieces, motion.message
    rates = np.linalg.norm(motion.omega - omega, axis=1).max() / np.linalg.norm(omega, axis=1).max()
    angle = 2 * np.minimum(*(np.linalg.norm(motion.attitude + s * attitude, axis=1) for s in (1, -1))).max()
    assert max(rates, angle) <= motion.error <= accuracy
    alone = {name: ph.solve(common, accuracy=accuracy, method=name) for name in ("taylor", "radau")}
    assert all(one.plan.pieces == () and one.plan.method == name
               for name, one in alone.items())   # a named method stays
    assert motion.stats["steps"] < 0.7 * min(one.stats["steps"] for one in alone.values())


def test_events_and_dense_output_go_across_a_hand_over():
    common = slowing(30, 100, 100)
    end = ph.plan(common, 1e-9).pieces[0].end
    half = ph.Event(lambda t, w, q: t - 1.5 * end)
    motion = ph.solve(common, accuracy=1e-9, dense=True, events=[half])
    assert len(motion.plan.pieces) == 2 and [hit.t for hit in motion.events] == [pytest.approx(1.5 * end)]
    times = np.array([0.3, 0.999, 1, 1.001, 2]) * end
    other = ph.solve(common.replace(times=times), method="dop853", rtol=1e-13)
    assert np.abs(motion(times)[1] - other.attitude).max() < 1e-7


@pytest.mark.parametrize("changes", [{"damping": 1}, {"times": np.linspace(-1, 100, 11)}, {"span": 1}])
def test_nothing_is_handed_over_where_it_cannot_pay(changes):
    parts = {"speed": 30, "damping": 100, "span": 100, **changes}
    times = parts.pop("times", None)
    made = slowing(**parts)
    assert ph.plan(made if times is None else made.replace(times=times), 1e-9).pieces == ()


@pytest.mark.parametrize("scale", [2.0**-40, 2.0**40])
def test_a_hand_over_scales_away(scale):
    common, scaled = slowing(30, 100, 100), slowing(30 / scale, 100 / scale, 100 * scale)
    a, b = ph.plan(common, 1e-9).pieces, ph.plan(scaled, 1e-9).pieces
    assert a[0].end * scale / 2 < b[0].end < a[0].end * scale * 2 and [p.method for p in a] == [p.method for p in b]
    assert ph.solve(scaled, accuracy=1e-9).success


def test_rates_that_die_away_do_not_stop_the_implicit_method():
    """They were followed to the smallest numbers there are, where no step is short enough."""
    motion = ph.solve(slowing(3, 100, 100), accuracy=1e-9, method="radau")
    assert motion.success and motion.stats["steps"] < 2000 and np.abs(motion.omega[-1]).max() < 1e-12


def test_a_body_that_soon_turns_about_one_axis_is_planned_by_what_a_look_tells():
    """By its turns it would be Taylor's; Radau's rates follow a steady turn in few steps, as the pilot run counted."""
    steady = ph.Scene(inertia=(1, 2, 2.5), omega=(27, 53, 80), torques=[ph.torques.Damping((1e3, 0.01, 0.01))],
                      times=np.linspace(0, 100, 101))
    plan = ph.plan(steady, 1e-6)
    assert plan.method == "radau" and ph.solve(steady, accuracy=1e-6).success
