"""Windows and events beside controllers, and many loops at once."""

import numpy as np
import pytest

import polhode as ph

START = {"inertia": (1.0, 2.0, 2.5), "omega": (0.2, -0.3, 0.1), "attitude": (0.5, 0.1, -0.1, np.sqrt(0.73))}


def pd(t, m, s, p):
    return -p.kp * m.attitude[:3] * m.attitude[3] - p.kd * m.omega


def law(period=0.1, **more):
    return ph.Controller(period, pd, parameters={"kp": 2.0, "kd": 3.0}, **more)


def scene(*controllers, times=(0.0, 1.0), **more):
    return ph.Scene(**{**START, "times": np.array(times), "controllers": controllers, **more})


# ---- windows


def silent(period):
    return ph.Controller(period, lambda t, m, s, p: 0.0 * m.omega)


@pytest.mark.parametrize("edges", [(0.33, 0.71), (0.3, 0.7), (-1.0, 0.7), (0.3, 9.0), (0.0, 1.0),
                                   (np.nextafter(0.3, 1), np.nextafter(0.7, 0)), (0.75, 0.75 + 1e-13)])
def test_a_window_beside_a_silent_controller_is_that_without_one(edges):
    push = ph.torques.During(ph.torques.Constant((0.1, -0.2, 0.05)), [edges])
    times = np.linspace(0, 1, 21)
    with_clock = ph.solve(scene(silent(0.1), torques=[push], times=times), 1e-11)
    without = ph.solve(ph.Scene(**START, torques=[push], times=times), 1e-11)
    assert with_clock.success and with_clock.error_kind == "bounded"
    apart = np.linalg.norm(with_clock.omega - without.omega, axis=1).max() / without.omega_scale
    assert apart <= with_clock.error + without.error


def test_a_window_acts_while_it_is_open():
    push = ph.torques.During(ph.torques.Constant((0.1, 0, 0)), [(0.25, 0.5), (0.75, np.inf)])
    motion = ph.solve(scene(law(), torques=[push], times=0.125 * np.arange(9)))
    np.testing.assert_array_equal(motion.states["window_0"], [0, 0, 1, 1, 0, 0, 1, 1, 1])


def test_a_window_by_state_and_one_by_hand_agree():
    """A constant push in a window is what a second controller commands from a delay on, for a width."""
    push = ph.torques.During(ph.torques.Constant((0.1, -0.2, 0.05)), [(0.33, 0.83)])
    other = ph.Controller(10.0, lambda t, m, s, p: p.u + 0.0 * m.omega, parameters={"u": (0.1, -0.2, 0.05)}, delay=0.33,
                          width=0.5)
    times = np.linspace(0, 1, 11)
    a = ph.solve(scene(law(), torques=[push], times=times), 1e-10)
    b = ph.solve(scene(law(), other, times=times), 1e-10)
    assert np.linalg.norm(a.omega - b.omega, axis=1).max() / a.omega_scale <= a.error + b.error


def test_scenes_with_windows_are_given_back():
    push = ph.torques.During(ph.torques.Constant((0.1, 0, 0)), [(0.25, 0.5)])
    whole = scene(law(), torques=[push])
    assert whole.torques[0] == push and whole.replace(times=(0, 2.0)).torques[0] == push


@pytest.mark.parametrize(("make", "words"), [
    (lambda: scene(law(), rotors=[ph.Rotor((0, 0, 1), momentum=0.1, during=(0.2, 0.5))]), "rotor"),
    (lambda: scene(law(), torques=[ph.torques.During(ph.torques.Custom(lambda t, w, q: 0 * w), (0.2, 0.5))]), "Custom"),
])
def test_what_has_no_place_beside_a_controller_is_refused(make, words):
    with pytest.raises(ph.InvalidInput, match=words) as refusal:
        ph.solve(make())
    assert "\n" not in str(refusal.value)


# ---- events


def test_events_are_located_between_ticks():
    times = np.linspace(0, 4, 9)
    level = 0.05
    event = ph.Event(lambda t, w, q, s: w[0] - level)
    motion = ph.solve(scene(law(), times=times), 1e-10, events=[event])
    assert len(motion.events) >= 1
    for hit in motion.events:
        again = ph.solve(scene(law(), times=(hit.t, 4.0)), 1e-12)
        assert abs(again.omega[0, 0] - level) < 1e-9
    plain = ph.solve(scene(law(), times=times), 1e-10)
    np.testing.assert_array_equal(motion.omega, plain.omega)
    np.testing.assert_array_equal(motion.ticks[0].command, plain.ticks[0].command)


def test_a_terminal_event_ends_the_ticks():
    event = ph.Event(lambda t, w, q, s: t - 0.55, terminal=True)
    motion = ph.solve(scene(law(), times=(0.2, 0.5, 0.6, 1.0)), 1e-9, events=[event])
    assert motion.status == "event" and motion.events[-1].t == pytest.approx(0.55, abs=1e-12)
    np.testing.assert_array_equal(motion.t, [0.2, 0.5])
    np.testing.assert_allclose(motion.ticks[0].t, 0.1 * np.arange(6), rtol=0, atol=1e-15)


def test_a_jump_at_a_tick_is_an_event():
    """The held command changes its sign at a tick: found there, once."""
    def alternate(t, m, s, p):
        return p.u * np.where(s.n > 1.5, 1.0, -1.0) + 0.0 * m.omega, {"n": s.n + 1}

    flip = ph.Controller(0.25, alternate, states={"n": 0.0}, parameters={"u": 0.1})
    event = ph.Event(lambda t, w, q, s: s["command_0"][0])
    motion = ph.solve(scene(flip, times=(0.0, 1.0)), 1e-9, events=[event])
    assert [hit.t for hit in motion.events] == [0.5]


# ---- many loops


def noisy(**more):
    return law(0.1, measure=ph.Measure(omega_noise=1e-3, attitude_noise=1e-3, seed=11), **more)


def test_many_loops_have_the_same_bits_for_any_threads_and_company():
    whole = scene(noisy(), times=np.linspace(0, 2, 5))
    omega = np.array(START["omega"]) + 0.01 * np.arange(12)[:, None]
    one = ph.solve_many(whole, omega=omega, threads=1)
    two = ph.solve_many(whole, omega=omega, threads=2)
    np.testing.assert_array_equal(one.omega, two.omega)
    part = ph.solve_many(whole, omega=omega[[7, 3]], numbers=[7, 3], threads=2)
    np.testing.assert_array_equal(part.omega, one.omega[[7, 3]])
    alone = ph.solve(whole.replace(omega=omega[7]), body=7)
    np.testing.assert_array_equal(alone.omega, one.omega[7])
    assert one.success.all()


def test_bodies_draw_apart():
    whole = scene(noisy())
    many = ph.solve_many(whole, omega=np.tile(START["omega"], (3, 1)))
    assert (many.omega[0, -1] != many.omega[1, -1]).all() and (many.omega[1, -1] != many.omega[2, -1]).all()


def test_many_loops_have_columns():
    whole = scene(noisy(), times=(0.5, 1.0))
    omega = np.array(START["omega"]) + 0.01 * np.arange(3)[:, None]
    many = ph.solve_many(whole, omega=omega, sensitivity="controllers.0.kp")
    alone = ph.solve(whole.replace(omega=omega[2]), sensitivity="controllers.0.kp", body=2)
    np.testing.assert_array_equal(many.sensitivity.d_omega[2], alone.sensitivity.d_omega)


def test_python_at_each_tick_is_refused_among_many():
    whole = scene(ph.Controller(0.25, lambda t, m, s, p: -m.omega, trace=False))
    with pytest.raises(ph.InvalidInput, match="traced among many"):
        ph.solve_many(whole, omega=np.zeros((2, 3)))


RECIPE = """
name = "loops"
count = 24
seed = 4
draw = "by-body"

[body]
moments = [1.0, 2.0, 2.5]

[start]
omega = { normal = [0.0, 0.2] }

[[controllers]]
period = 0.1
command = "-kp * attitude.xyz * attitude.w - kd * omega"
parameters = { kp = { uniform = [1.5, 2.5] }, kd = { normal = [3.0, 0.1] } }
measure = { omega_noise = 1e-3, seed = 3 }

[times]
span = 2.0
samples = 5

[store]
states = "float64"
chunk = 8

[[summary]]
of = "omega"
"""


def test_recipes_draw_gains_and_bodies_draw_noise(tmp_path):
    pytest.importorskip("zarr")
    path = tmp_path / "loops.toml"
    path.write_text(RECIPE)
    here = ph.ensemble(path, executor=0, out=tmp_path / "here.zarr")
    there = ph.ensemble(path, executor=2, out=tmp_path / "there.zarr")
    np.testing.assert_array_equal(here.summary["omega"].mean, there.summary["omega"].mean)
    a, b = here.states(range(24)), there.states(range(5, 9))
    np.testing.assert_array_equal(a.omega[5:9], b.omega)
    body = here.scene(6)
    gains = {here.scene(i).controllers[0].parameters["kp"] for i in range(24)}
    assert len(gains) == 24 and all(1.5 <= kp <= 2.5 for kp in gains)
    alone = ph.solve(body, body=6)
    np.testing.assert_array_equal(alone.omega, a.omega[6])


@pytest.mark.parametrize("number", [-1, 1.5, 2**62, None])
def test_numbers_of_bodies_are_whole(number):
    with pytest.raises(ph.InvalidInput, match="body: must be a whole number"):
        ph.solve(scene(law()), body=number)
