"""Ticks, delays, noise, limits, and what is refused."""

import pickle

import numpy as np
import pytest

import polhode as ph

START = {"inertia": (1.0, 2.0, 2.5), "omega": (0.2, -0.3, 0.1), "attitude": (0.5, 0.1, -0.1, np.sqrt(0.73))}


def rate(t, m, s, p):
    return -p.k * m.omega


def count(t, m, s, p):
    return 0.0 * m.omega, {"n": s.n + 1}


def scene(*controllers, times=(0.0, 1.0), **more):
    return ph.Scene(**{**START, "times": np.array(times), "controllers": controllers, **more})


def damper(period=0.25, **more):
    return ph.Controller(period, rate, parameters={"k": 0.5}, **more)


# ---- ticks


def test_ticks_are_products_of_the_period():
    ticks = ph.solve(scene(damper(0.1), times=(0.0, 3.0))).ticks[0]
    np.testing.assert_array_equal(ticks.t, 0.1 * np.arange(30))   # the tick at the last time is not called


def test_ticks_begin_at_the_start_of_a_scene():
    ticks = ph.solve(scene(damper(0.25, start=-1.0), times=(0.1, 1.1), t0=0.1)).ticks[0]
    np.testing.assert_array_equal(ticks.t, [0.25, 0.5, 0.75, 1.0])


def test_a_tick_measures_the_state_before_it():
    times = 0.25 * np.arange(5)
    motion = ph.solve(scene(damper(), times=times))
    ticks = motion.ticks[0]
    np.testing.assert_allclose(ticks.measurement["omega"], motion.omega[:4], rtol=0, atol=1e-14)
    np.testing.assert_allclose(ticks.command, -0.5 * motion.omega[:4], rtol=0, atol=1e-14)
    assert (ticks.measurement["attitude"][:, 3] >= 0).all()


def test_a_command_acts_from_its_delay_on():
    motion = ph.solve(scene(damper(0.25, delay=0.6), times=np.arange(0, 1.3, 0.05)))
    held, command = motion.states["command_0"], motion.ticks[0].command
    assert (held[:12] == 0).all()                                     # to 0.55
    np.testing.assert_array_equal(held[13:17], np.tile(command[0], (4, 1)))   # from 0.6 to 0.85
    np.testing.assert_array_equal(held[18:22], np.tile(command[1], (4, 1)))


def test_a_pulse_ends_after_its_width():
    motion = ph.solve(scene(damper(0.25, width=0.1), times=np.arange(0, 1.0, 0.05)))
    held = motion.states["command_0"]
    assert (held[:2] != 0).all() and (held[3:5] == 0).all() and (held[6] != 0).all() and (held[9] == 0).all()


def test_a_sample_on_a_tick_has_the_state_after_it():
    rotors = [ph.Rotor(axis, inertia=0.02, speed=0.0) for axis in np.eye(3)]
    controller = ph.Controller(0.5, lambda t, m, s, p: p.h * np.stack([1.0, 0.0, 0.0]), output="rotor_momentum",
                               parameters={"h": 0.1})
    motion = ph.solve(scene(controller, times=(0.0, 0.25), rotors=rotors))
    assert motion.omega[0, 0] == pytest.approx(0.2 - 0.1 / 1.0, abs=1e-15)
    L = np.array(motion.angular_momentum)
    np.testing.assert_allclose(L[1], L[0], atol=1e-14)
    assert motion.drift["angular_momentum"] < 1e-13


def test_two_controllers_at_one_instant_measure_the_same_state():
    motion = ph.solve(scene(damper(0.2), damper(0.1), times=(0.0, 1.0)))
    np.testing.assert_array_equal(motion.ticks[0].measurement["omega"], motion.ticks[1].measurement["omega"][::2])


def test_memory_is_kept_from_tick_to_tick():
    ticks = ph.solve(scene(ph.Controller(0.25, count, states={"n": 5.0}))).ticks[0]
    np.testing.assert_array_equal(ticks.states["n"], [6, 7, 8, 9])


def test_limits_cut_each_component():
    ticks = ph.solve(scene(damper(0.25, limit=(0.01, 0.02, 1.0)))).ticks[0]
    assert ticks.command[0, 0] == -0.01 and ticks.command[0, 1] == 0.02 and ticks.command[0, 2] == -0.05


def point(t, m, s, p):
    return p.kp * m.attitude[:3] * m.attitude[3] + p.kd * m.omega


def wheels(limit=None, **motor):
    rotors = [ph.Rotor(axis, inertia=0.02, speed=3.0, free=True, **motor) for axis in np.eye(3)]
    law = ph.Controller(0.2, point, output="rotor_torque", parameters={"kp": 0.5, "kd": 1.5}, limit=limit)
    return ph.solve(scene(law, rotors=rotors, times=np.linspace(0, 6, 61)), 1e-9)


def test_a_motor_gives_no_more_than_its_largest_torque():
    by_motor, by_limit = wheels(torque="0", max_torque=0.05), wheels(limit=0.05)
    assert by_motor.success and np.abs(by_limit.ticks[0].command).max() == 0.05
    assert np.abs(by_motor.ticks[0].command).max() > 0.1
    np.testing.assert_allclose(by_motor.omega, by_limit.omega, rtol=0, atol=1e-11)


def test_wheels_stay_at_their_top_speed():
    motion = wheels(torque="0", max_torque=0.3, max_speed=12.0, coulomb=0.02, viscous=1e-3)
    speed = np.abs(motion.rotor_speed)
    assert motion.success and speed.max() == pytest.approx(12, abs=1e-12)
    assert (np.isclose(speed, 12, rtol=0, atol=1e-12).sum(axis=0) > 10).any()
    assert motion.drift["angular_momentum"] < 1e-13


# ---- what is measured


def test_noise_depends_on_seed_tick_and_number_alone():
    noisy = ph.Measure(omega_noise=1e-3, attitude_noise=1e-3, seed=7)
    first = ph.solve(scene(damper(measure=noisy))).ticks[0]
    later = ph.solve(scene(damper(measure=noisy), times=(0.5, 1.0), t0=0.5)).ticks[0]
    other = ph.solve(scene(damper(measure=ph.Measure(omega_noise=1e-3, seed=8)))).ticks[0]
    start = np.array(START["omega"])
    same = first.measurement["omega"][2] - later.measurement["omega"][0]
    clean = ph.solve(scene(damper(measure=noisy), times=(0.0, 0.5))).omega[1]
    np.testing.assert_allclose(same, clean - start, atol=1e-12)   # the same draw at tick 2
    assert (first.measurement["omega"][0] != other.measurement["omega"][0]).all()
    np.testing.assert_allclose(np.linalg.norm(first.measurement["attitude"], axis=1), 1, atol=1e-14)


def test_noise_has_the_size_that_is_asked():
    measure = ph.Measure(omega_noise=0.1, attitude_noise=0.01, seed=1)
    still = scene(damper(0.01, measure=measure, limit=1e-12), omega=(0, 0, 0), attitude=(0, 0, 0, 1), times=(0.0, 20.0))
    ticks = ph.solve(still, 1e-6).ticks[0]
    assert np.std(ticks.measurement["omega"]) == pytest.approx(0.1, rel=0.05)
    assert np.std(2 * ticks.measurement["attitude"][:, :3]) == pytest.approx(0.01, rel=0.05)


def test_quanta_round_halves_to_even():
    halves = scene(damper(measure=ph.Measure(omega_quantum=0.125)), omega=(0.3125, -0.4375, 0.1875), inertia=(2, 2, 2))
    ticks = ph.solve(halves, rtol=1e-9).ticks[0]
    np.testing.assert_array_equal(ticks.measurement["omega"][0], np.array([2, -4, 2]) * 0.125)


# ---- one bound over the loop


def test_a_loop_that_amplifies_ends_at_its_limit():
    wild = ph.Controller(0.25, rate, parameters={"k": 22.0}, limit=0.5)
    motion = ph.solve(scene(wild, times=np.linspace(0.0, 200.0, 201)), 1e-9)
    assert motion.error_kind == "limit" and not motion.success
    assert "tick" in motion.message


def test_an_unsure_branch_is_no_small_bound():
    def bang(t, m, s, p):
        return -p.u * np.sign(m.omega - p.edge)

    # the guard is 0 to rounding at tick 1 of a body that turns freely about a principal axis
    edge = ph.Controller(0.25, bang, parameters={"u": 1e-3, "edge": (0.0, 0.0, 0.3)})
    motion = ph.solve(scene(edge, omega=(0.0, 0.0, 0.3), times=(0.0, 1.0)), 1e-9)
    assert motion.error_kind == "limit" or motion.error > 1e-5


def test_a_rate_that_is_0_has_a_sure_sign():
    def bang(t, m, s, p):
        return np.where(m.omega > 0, -p.u, np.where(m.omega < 0, p.u, 0.0))

    motion = ph.solve(scene(ph.Controller(0.25, bang, parameters={"u": 1e-3}), omega=(0.0, 0.0, 0.3)), 1e-9)
    assert motion.success


# ---- functions that are not traced


def test_an_untraced_function_has_an_estimated_error():
    def branch(t, m, s, p):
        return [-1e-3 if x > 0 else 1e-3 for x in m.omega], {"n": s.n + 1}

    with pytest.raises(ph.InvalidInput, match=r"np\.where.*trace=False"):
        ph.Controller(0.25, branch, states={"n": 0.0})
    motion = ph.solve(scene(ph.Controller(0.25, branch, states={"n": 0.0}, trace=False)))
    assert motion.error_kind == "estimated"
    np.testing.assert_array_equal(motion.ticks[0].states["n"], [1, 2, 3, 4])
    traced = ph.Controller(0.25, lambda t, m, s, p: np.where(m.omega > 0, -1e-3, 1e-3))
    np.testing.assert_allclose(motion.omega, ph.solve(scene(traced)).omega, rtol=0, atol=1e-12)


def test_the_plan_says_that_python_is_called():
    plan = ph.plan(scene(ph.Controller(0.25, lambda t, m, s, p: -m.omega, trace=False)), 1e-9)
    assert any("Python" in reason for reason in plan.reasons)


# ---- equal, pickled, saved


def field():
    return ph.MagneticField.dipole(ph.Orbit(mu=4e14, r0=(7e6, 0, 0), v0=(0, 7500.0, 900.0)), -7.9e15, tilt=0.2)


def every():
    return [damper(delay=0.1, width=0.2, limit=0.3, start=0.05),
            ph.Controller(0.5, lambda t, m, s, p: (p.k * np.cross(m.omega, m.field), {"b": m.field}), output="dipole",
                          field=field(),
                          states={"b": (0, 0, 0)}, parameters={"k": 3.0},
                          measure=ph.Measure(omega_noise=1e-5, field_noise=1e-9, omega_quantum=1e-4, seed=2**63 + 1))]


def test_controllers_compare_by_value_and_pickle():
    assert every() == every() and pickle.loads(pickle.dumps(every())) == every()
    assert damper() != damper(0.5) and damper() != damper(delay=0.1)


def test_a_scene_is_saved_to_the_same_bits(tmp_path):
    whole = scene(*every(), times=(0.0, 2.0))
    whole.save(tmp_path / "loop.toml")
    again = ph.Scene.load(tmp_path / "loop.toml")
    assert again.controllers == whole.controllers and again == whole.replace(name=again.name)
    np.testing.assert_array_equal(ph.solve(again).omega, ph.solve(whole).omega)


def test_a_motion_is_saved_with_its_ticks(tmp_path):
    motion = ph.solve(scene(*every(), times=(0.0, 2.0)))
    motion.save(tmp_path / "loop.npz")
    again = ph.load(tmp_path / "loop.npz")
    for a, b in zip(motion.ticks, again.ticks, strict=True):
        np.testing.assert_array_equal(a.t, b.t)
        np.testing.assert_array_equal(a.command, b.command)
        assert a.measurement.keys() == b.measurement.keys() and a.states.keys() == b.states.keys()
    assert again.scene == motion.scene
    pandas = pytest.importorskip("pandas")
    table = motion.ticks[1].to_pandas()
    assert isinstance(table, pandas.DataFrame) and {"t", "omega_x", "field_0", "command_2", "b_1"} <= set(table.columns)
    pytest.importorskip("xarray")
    assert {"ticks_0_command", "ticks_1_field", "ticks_1_b"} <= set(motion.to_xarray().variables)


def test_a_law_is_text_as_well():
    text = ph.Controller(0.25, command="-k * omega + z", states={"z": (0, 0, 0)}, update={"z": "z + 0.1 * omega"},
                         parameters={"k": 0.5})

    def same(t, m, s, p):
        return -p.k * m.omega + s.z, {"z": s.z + 0.1 * m.omega}

    traced = ph.Controller(0.25, same, states={"z": (0, 0, 0)}, parameters={"k": 0.5})
    np.testing.assert_allclose(ph.solve(scene(text)).omega, ph.solve(scene(traced)).omega, rtol=0, atol=1e-15)


# ---- refusals


@pytest.mark.parametrize(("make", "words"), [
    (lambda: damper(0.0), "Controller.period: must be positive"),
    (lambda: damper(-1.0), "Controller.period: must be positive"),
    (lambda: damper(float("nan")), "Controller.period: must be"),
    (lambda: damper(delay=-0.1), "Controller.delay: must be 0 or positive"),
    (lambda: damper(width=0.3), "Controller.width: must be at most the period"),
    (lambda: damper(limit=-1.0), "Controller.limit: must be positive"),
    (lambda: damper(limit=(1.0, 2.0)), "Controller.limit: must be one number"),
    (lambda: damper(output="force"), "Controller.output: must be"),
    (lambda: damper(output="dipole"), "Controller.field: must be given"),
    (lambda: ph.Controller(1.0, lambda t, m, s, p: m.omega[:2]), r"a command of shape \(3,\)"),
    (lambda: ph.Controller(1.0, lambda t, m, s, p: (m.omega, {"z": 1.0})), "must return states that are given"),
    (lambda: ph.Controller(1.0, lambda t, m, s, p: (m.omega, {"z": m.omega}), states={"z": 0.0}),
     r"the state z of shape \(\)"),
    (lambda: ph.Controller(1.0, lambda t, m, s, p: m.field), "m.field; give field="),
    (lambda: ph.Controller(1.0, lambda t, m, s, p: m.speed), "m.speed; give rotors="),
    (lambda: ph.Controller(1.0, lambda t, m: m.omega), r"callable as function\(t, m, s, p\)"),
    (lambda: ph.Controller(1.0, lambda t, m, s, p: np.random.default_rng().normal(size=3) * m.omega),
     "the same law each time"),
    (lambda: ph.Controller(1.0, lambda t, m, s, p: m.omega, parameters={"command": 1.0}), "named otherwise"),
    (lambda: ph.Controller(1.0, command="-k * omega"), "Controller.command"),
    (lambda: ph.Controller(1.0), "a function or command="),
    (lambda: ph.Measure(omega_noise=-1), "Measure.omega_noise: must be 0 or positive"),
    (lambda: ph.Measure(seed=-1), "Measure.seed: must be a whole number"),
    (lambda: damper(measure=ph.Measure(field_noise=1.0)), "Measure.field_noise: must be 0 without"),
    (lambda: scene(damper(1e-17)), "period: must be above the spacing of the times"),
    (lambda: scene(ph.Controller(1.0, lambda t, m, s, p: m.omega, output="rotor_torque")), "rotors: must be as many"),
    (lambda: scene(ph.Controller(1.0, lambda t, m, s, p: m.omega, output="rotor_torque"),
                   rotors=[ph.Rotor(a, inertia=0.01, speed=0.0) for a in np.eye(3)]), "free: must be True"),
    (lambda: scene(3), "a polhode.Controller"),
    (lambda: ph.solve(scene(damper(), times=(-1.0, 1.0))), "at or after t0"),
    (lambda: ph.solve(scene(damper()), method="dop853"), "method: must be left out"),
    (lambda: ph.solve(scene(damper()), 1e-6, certify="proof"), "proofs do not go through ticks"),
])
def test_bad_input_is_refused_in_one_sentence(make, words):
    with pytest.raises(ph.InvalidInput, match=words) as refusal:
        make()
    assert "\n" not in str(refusal.value)


def test_a_function_that_keeps_state_is_found():
    calls = []

    def counts(t, m, s, p):
        calls.append(t)
        return m.omega * len(calls)

    with pytest.raises(ph.InvalidInput, match="belongs into states="):
        ph.Controller(1.0, counts, trace=False)


def test_numbers_that_are_not_finite_have_their_tick():
    def late(t, m, s, p):
        return m.omega / (1.0 if t < 0.6 else 0.0)

    with pytest.raises(ph.InvalidInput, match="finite.* at tick 3, t = 0.75 s"):
        ph.solve(scene(ph.Controller(0.25, lambda t, m, s, p: m.omega / (0.75 - t))))
    with pytest.raises(ph.InvalidInput, match="finite.* at tick 3, t = 0.75 s"), np.errstate(all="ignore"):
        ph.solve(scene(ph.Controller(0.25, late, trace=False)))


def test_a_wrong_shape_has_its_tick():
    def late(t, m, s, p):
        return m.omega[:2] if t == 0.5 else m.omega

    with pytest.raises(ph.InvalidInput, match="tick 2, t = 0.5 s"):
        ph.solve(scene(ph.Controller(0.25, late, trace=False)))
