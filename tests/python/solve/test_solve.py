"""Solving a scene: against stored truth, in every direction of time, with everything that may end a run."""

import pickle
import signal
import threading
import time

import numpy as np
import pytest
from bodies import BLOCK, PARTS, TILTED, scene
from measures import attitude_error, error, rates_error, truth

import polhode as ph

# ---- accuracy

# The error that rk45 reaches at rtol 1e-6 and 1e-10 on each scene, with a factor 2 above and 5 below what was measured:
# a run that becomes unexpectedly better is as suspicious as one that becomes worse.
REACHED = {
    "S1": (4.1e-2, 6.2e-6), "S3": (7.9e-3, 1.2e-6), "S4": (2.1e-3, 1.9e-7), "S5": (4.1e-6, 2.4e-10),
    "S6": (7.4e-4, 1.1e-7), "S7": (6.6e-7, 1.5e-10), "S9": (9.5e-6, 2.5e-10),
}


@pytest.mark.parametrize("name", REACHED)
def test_error_against_stored_truth(name):
    for rtol, reached in zip((1e-6, 1e-10), REACHED[name], strict=True):
        motion = ph.solve(scene(name), rtol=rtol)
        found = error(motion.omega, motion.attitude, truth(name))
        assert reached / 5 < found < 2 * reached, (rtol, found)


@pytest.mark.parametrize("name", ["S5", "S9"])
def test_error_goes_as_the_tolerance_down_to_rounding(name):
    found = [error(m.omega, m.attitude, truth(name))
             for m in (ph.solve(scene(name), rtol=r) for r in 10.0 ** -np.arange(4, 13))]
    gains = np.array(found[:-1]) / found[1:]
    assert np.all(gains > 2) and 5 < np.exp(np.log(gains).mean()) < 20


def test_error_goes_as_the_fifth_power_of_the_steps():
    reference = truth("S5")
    runs = [ph.solve(scene("S5"), rtol=r) for r in (1e-7, 1e-9, 1e-11)]
    errors = [error(m.omega, m.attitude, reference) for m in runs]
    steps = [m.stats["steps"] for m in runs]
    slope = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert 4.7 < slope < 5.4


def test_accuracy_of_a_short_regular_scene_is_got():
    motion = ph.solve(scene("S5"), accuracy=1e-8)
    assert error(motion.omega, motion.attitude, truth("S5")) < 1e-8
    assert motion.success and motion.error_kind == "bounded" and motion.plan.model == "euler"
    by_hand = ph.solve(scene("S5"), rtol=1e-8)
    assert np.isnan(by_hand.error) and by_hand.error_kind == "not estimated" and "not estimated" in by_hand.message
    assert by_hand.success and by_hand.plan.method == "rk45"


def test_success_is_false_when_an_invariant_moved_by_more_than_was_asked():
    motion = ph.solve(scene("S1"), rtol=1e-6)
    assert motion.status == "finished" and not motion.success
    assert "drifted by" in motion.message and max(motion.drift.values()) > 1e-6
    assert ph.solve(scene("S1", times=[0, 1.0]), rtol=1e-7).success


def test_unit_quaternions_whatever_the_tolerance():
    motion = ph.solve(scene("S1"), rtol=1e-3)
    np.testing.assert_allclose(np.linalg.norm(motion.attitude, axis=1), 1, atol=4e-16)


# ---- the same motion by other roads


@pytest.mark.parametrize("name", ["S1", "S5", "S6", "S7", "S9"])
def test_a_full_tensor_turns_as_its_principal_axes_do(name):
    """The body axes turned by R: inertia, start, arm and damping turn with them; space sees the same motion."""
    rng = np.random.default_rng(7)
    q = rng.normal(size=4)
    q /= np.linalg.norm(q)                       # q_BA, A the new body axes
    x, y, z, w = q
    R = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                  [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                  [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    parts = PARTS[name]
    inertia = R.T @ np.diag(parts["inertia"]) @ R
    p = parts.get("attitude", (0, 0, 0, 1))
    turned = np.array([p[3] * x + p[0] * w + p[1] * z - p[2] * y, p[3] * y - p[0] * z + p[1] * w + p[2] * x,
                       p[3] * z + p[0] * y - p[1] * x + p[2] * w, p[3] * w - p[0] * x - p[1] * y - p[2] * z])
    torques = []
    for torque in parts.get("torques", ()):
        if isinstance(torque, ph.torques.Gravity):
            torque = ph.torques.Gravity(torque.weight, R.T @ torque.arm)
        elif isinstance(torque, ph.torques.Constant):
            torque = ph.torques.Constant(R.T @ torque.torque)
        elif isinstance(torque, ph.torques.Damping):
            torque = ph.torques.Damping(R.T @ torque.matrix @ R)
        torques.append(torque)
    times = parts["times"][:51]
    a = ph.solve(scene(name, times=times), rtol=1e-12)
    b = ph.solve(ph.Scene(inertia=(inertia + inertia.T) / 2, omega=R.T @ parts["omega"], attitude=turned,
                          torques=torques,
                          times=times), rtol=1e-12)
    assert rates_error(b.omega @ R.T, a.omega) < 1e-9
    L = a.angular_momentum
    np.testing.assert_allclose(b.angular_momentum, L, atol=1e-9 * np.abs(L).max())


@pytest.mark.parametrize("name", ["S1", "S5", "S9"])
def test_lagranges_equations_agree_with_eulers(name):
    """Two formulations, one motion: to 1e-12 while the angles stay away from theta = 0 and pi."""
    attitude = (np.sin(0.5), 0.0, 0.0, np.cos(0.5))
    one = scene(name, attitude=attitude, times=np.linspace(0, 0.6, 13))
    a = ph.solve(one, rtol=1e-14)
    b = ph.solve(one, rtol=1e-14, formulation="lagrangian")
    assert b.plan.model == "lagrangian"
    assert rates_error(b.omega, a.omega) < 1e-12
    assert attitude_error(b.attitude, a.attitude) < 1e-12


def test_lagranges_equations_fail_at_theta_zero_with_the_reason():
    with pytest.raises(ph.InvalidInput, match=r"theta.*divide by sin"):
        ph.solve(scene("S1"), formulation="lagrangian")
    # A free symmetric body whose axis passes through space z: theta reaches 0 at t = pi/8.
    through = ph.Scene(inertia=(1, 1, 1), omega=(-1.0, 0, 0), attitude=(np.sin(0.25), 0, 0, np.cos(0.25)),
                       times=np.linspace(0, 1, 101))
    motion = ph.solve(through, rtol=1e-9, formulation="lagrangian")
    assert motion.status == "failed" and not motion.success
    assert "sin(theta)" in motion.message
    assert motion.t.size and abs(motion.t[-1] - 0.5) <= 0.011
    assert ph.solve(through, rtol=1e-9).success


def test_q_psi_is_the_torque_along_body_z():
    rng = np.random.default_rng(3)
    for _ in range(20):
        torque, angles = rng.normal(size=3), rng.uniform(-3, 3, size=3)
        Q = ph.generalised_forces(torque, angles)
        phi, theta, psi = angles
        nodes = np.array([np.cos(psi), -np.sin(psi), 0])
        vertical = np.array([np.sin(theta) * np.sin(psi), np.sin(theta) * np.cos(psi), np.cos(theta)])
        np.testing.assert_allclose(Q, [torque @ vertical, torque @ nodes, torque[2]], atol=1e-15)


def test_rates_alone_are_the_same_rates():
    for name in ("S1", "S7", "S9"):
        both, rates = ph.solve(scene(name), rtol=1e-8), ph.solve(scene(name, want=["omega"]), rtol=1e-8)
        assert rates.attitude is None and rates.plan.state == "omega" and both.plan.state == "omega, attitude"
        assert rates_error(rates.omega, both.omega) < 1e-3
        assert rates.stats["steps"] <= both.stats["steps"]
    gravity = ph.solve(scene("S5", want=["omega"]), rtol=1e-8)
    assert gravity.plan.state == "omega, attitude" and gravity.attitude is None
    attitude = ph.solve(scene("S5", want="attitude"), rtol=1e-8)
    assert attitude.omega is None and attitude.attitude.shape == (201, 4)
    with pytest.raises(ph.InvalidInput, match="omega"):
        _ = attitude.energy


# ---- times


def test_times_in_any_order_forwards_and_backwards():
    times = np.array([3.0, -2.0, 0.0, 7.5, 7.5, -0.1, 0.2])
    motion = ph.solve(scene("S1", times=times), rtol=1e-11)
    np.testing.assert_array_equal(motion.t, times)
    omega, attitude = ph.FreeMotion(BLOCK, (1, 2, 3)).at(times)
    assert rates_error(motion.omega, omega) < 1e-9 and attitude_error(motion.attitude, attitude) < 1e-9
    np.testing.assert_array_equal(motion.omega[3], motion.omega[4])
    np.testing.assert_array_equal(motion.omega[2], (1, 2, 3))


def test_there_and_back():
    there = ph.solve(scene("S5", times=[20.0]), rtol=1e-12)
    back = ph.solve(scene("S5", omega=there.omega[0], attitude=there.attitude[0], t0=20.0, times=[0.0]), rtol=1e-12)
    assert rates_error(back.omega, np.array([[0.3, 0.2, 3]])) < 1e-10
    assert attitude_error(back.attitude, np.array([TILTED])) < 1e-10


@pytest.mark.parametrize("t0", [0.0, 5.0])
def test_zero_span(t0):
    motion = ph.solve(scene("S5", times=[t0], t0=t0), dense=True)
    np.testing.assert_array_equal(motion.omega, [[0.3, 0.2, 3]])
    assert motion.success and motion.stats["steps"] == 0
    np.testing.assert_array_equal(motion(t0)[0], (0.3, 0.2, 3))


def test_start_time_shifts_a_torque_that_sees_time():
    spin = ph.torques.Custom(lambda t, omega, attitude: (0, 0, np.cos(t)), uses_attitude=False, uses_rates=False)
    late = ph.solve(ph.Scene(inertia=(1, 1, 1), omega=(0, 0, 0), torques=[spin], t0=2.0, times=[2.0, 4.0]), rtol=1e-11)
    assert abs(late.omega[1, 2] - (np.sin(4) - np.sin(2))) < 1e-10


@pytest.mark.parametrize("method", ["rk45", "dop853", "radau"])
@pytest.mark.parametrize("rate", [1e-13, 1e-16])
def test_next_to_rest_far_from_zero_the_first_step_is_one_that_time_can_take(method, rate):
    """Steps as short as such rates ask for are below the spacing of the times around 1000 s."""
    push = ph.torques.Constant((0.1, 0.2, 0.3))
    one = ph.Scene(inertia=(1, 2, 2.5), omega=(rate, 0, 0), torques=[push], t0=1000.0,
                   times=np.linspace(1000, 1010, 11))
    motion, known = ph.solve(one, method=method, rtol=1e-9), ph.solve(one, method="taylor", rtol=1e-13)
    assert motion.status == "finished"
    assert np.abs(motion.omega - known.omega).max() < 1e-7


# ---- scales


@pytest.mark.parametrize("power", [-150, -12, 12, 150])
def test_everything_scales(power):
    """Inertia by s; rates by r and times by 1/r: the same numbers of steps and the same motion."""
    base = ph.solve(scene("S5"), rtol=1e-9)
    s = 2.0**power
    heavier = ph.solve(scene("S5", inertia=np.array((1, 2, 2.5)) * s,
                             torques=[ph.torques.Gravity(2 * s, (0.3, 0.2, 0.5))]), rtol=1e-9)
    np.testing.assert_array_equal(heavier.omega, base.omega)
    r = 2.0 ** (power // 3)
    faster = ph.solve(scene("S5", omega=np.array((0.3, 0.2, 3)) * r, times=PARTS["S5"]["times"] / r,
                            torques=[ph.torques.Gravity(2 * r * r, (0.3, 0.2, 0.5))]), rtol=1e-9)
    assert all(faster.stats[key] == base.stats[key] for key in base.stats if key != "seconds")
    np.testing.assert_array_equal(faster.attitude, base.attitude)


# ---- dense output


def test_dense_output_is_as_good_as_the_samples():
    motion = ph.solve(scene("S5", times=np.linspace(-1, 20, 5)), rtol=1e-10, dense=True)
    reference = truth("S5")
    omega, attitude = motion(reference["t"])
    assert error(omega, attitude, reference) < 2e-8
    assert motion(3.0)[0].shape == (3,) and motion(np.zeros((2, 5)))[1].shape == (2, 5, 4)
    same = ph.solve(scene("S5"), rtol=1e-10)
    np.testing.assert_allclose(omega, same.omega, atol=3e-8)
    for t in (20.1, -1.1, np.nan):
        with pytest.raises(ph.InvalidInput, match="time between"):
            motion(t)
    with pytest.raises(ph.InvalidInput, match="dense=True"):
        same(1.0)


def test_order_of_the_continuous_extension():
    """Between the steps the error falls as the fourth power of the step, or better."""
    times = np.linspace(0, 2, 777)
    omega, attitude = ph.FreeMotion(BLOCK, (1, 2, 3)).at(times)
    found = []
    for rtol in (1e-7, 1e-9):
        motion = ph.solve(scene("S1", times=times), rtol=rtol)
        found.append((error(motion.omega, motion.attitude, {"omega": omega, "attitude": attitude}),
                      motion.stats["steps"]))
    (e1, n1), (e2, n2) = found
    assert np.log(e1 / e2) / np.log(n2 / n1) > 3.8


# ---- what ends a run early


def test_max_steps_gives_what_was_reached():
    motion = ph.solve(scene("S1"), rtol=1e-9, max_steps=100)
    assert motion.status == "max_steps" and not motion.success and "max_steps" in motion.message
    assert 0 < motion.t.size < 1001 and motion.omega.shape == (motion.t.size, 3)


def test_progress_is_told_and_can_stop():
    seen = []
    long = scene("S1", times=[0.0, 1e5])
    full = ph.solve(scene("S1", times=[0.0, 2e4]), rtol=1e-9,
                    progress=lambda reached, last: seen.append((reached, last)))
    assert full.status == "finished" and seen and all(last == 2e4 and 0 < reached <= 2e4 for reached, last in seen)
    stopped = ph.solve(long, rtol=1e-12, progress=lambda reached, last: False)
    assert stopped.status == "stopped" and not stopped.success and 0 < stopped.stats["steps"]


def test_ctrl_c_ends_a_long_solve_at_once():
    # A shell's background jobs ignore Ctrl-C, and Python with them.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        timer = threading.Timer(0.3, lambda: signal.raise_signal(signal.SIGINT))
        begin = time.perf_counter()
        timer.start()
        with pytest.raises(KeyboardInterrupt):
            ph.solve(scene("S1", times=[0.0, 1e8]), rtol=1e-12, max_steps=10**8)
        assert time.perf_counter() - begin < 5
    finally:
        signal.signal(signal.SIGINT, before)


def test_the_gil_is_released():
    counted = 0
    done = threading.Event()

    def run():
        ph.solve(scene("S1", times=[0.0, 2e4]), rtol=1e-10)
        done.set()

    thread = threading.Thread(target=run)
    thread.start()
    while not done.is_set():
        counted += 1
    thread.join()
    assert counted > 1000


# ---- bad input: always a ValueError with the name of the culprit

BAD_SCENES = [
    ({"omega": (1, 2)}, "omega"), ({"omega": "abc"}, "omega"), ({"omega": (1, 2, np.nan)}, "omega"),
    ({"omega": None}, "omega"), ({"omega": (1, 2, 3j)}, "omega"), ({"omega": ((1, 2, 3),)}, "omega"),
    ({"inertia": (1, 2)}, "inertia"), ({"inertia": (1, 2, 4)}, "inequality|sum"), ({"inertia": (0, 1, 1)}, "positive"),
    ({"inertia": (-1, 1, 1)}, "moment|positive|negative"),
    ({"inertia": [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]}, "symmetric"),
    ({"inertia": None}, "inertia"), ({"attitude": (0, 0, 0, 0)}, "norm 0"), ({"attitude": (0, 0, 0, 2)}, "norm"),
    ({"attitude": (0, 0, 1)}, "attitude"), ({"attitude": (0, 0, np.inf, 1)}, "attitude"),
    ({"times": []}, "times"), ({"times": [np.nan]}, "times"), ({"times": [[0.0, 1.0]]}, "times"),
    ({"times": "now"}, "times"),
    ({"want": ["energy"]}, "want"), ({"want": []}, "want"), ({"want": 3}, "want"), ({"t0": np.inf}, "t0"),
    ({"torques": 5}, "torques"), ({"torques": [lambda t, w, q: w]}, "Custom"), ({"name": 3}, "name"),
]


@pytest.mark.parametrize(("changes", "match"), BAD_SCENES)
def test_bad_scenes_are_refused(changes, match):
    with pytest.raises(ph.InvalidInput, match=match):
        ph.Scene(**{**PARTS["S5"], **changes})


BAD_OPTIONS = [
    {"accuracy": 0}, {"accuracy": -1e-3}, {"accuracy": np.nan}, {"accuracy": 2}, {"accuracy": "high"},
    {"accuracy": [1e-3, 1e-4]},
    {"accuracy": 1e-6, "rtol": 1e-6}, {"rtol": 0}, {"rtol": np.inf}, {"atol": -1}, {"method": "rk5"}, {"method": 5},
    {"step": 0.1}, {"max_steps": 0}, {"max_steps": 1.5}, {"formulation": "newton"}, {"events": 3}, {"events": [3]},
]


@pytest.mark.parametrize("options", BAD_OPTIONS, ids=str)
def test_bad_options_are_refused(options):
    with pytest.raises(ph.InvalidInput):
        ph.solve(scene("S5"), **options)


@pytest.mark.parametrize("act", [ph._core.solve, ph._core.PlannedScene])
def test_the_core_refuses_an_option_that_it_does_not_know(act):
    with pytest.raises(ph.InvalidInput, match="acuracy"):
        act(scene("S5"), {"acuracy": 1e-6})


def test_a_scene_is_asked_for():
    with pytest.raises(ph.InvalidInput, match="Scene"):
        ph.solve({"omega": 1})


def test_too_fine_a_tolerance_is_raised_and_said():
    motion = ph.solve(scene("S5"), rtol=1e-20)
    assert "raised" in motion.message and motion.status == "finished"


# ---- values


def test_scenes_and_motions_are_values():
    one = scene("S5")
    assert one == scene("S5") and hash(one) == hash(scene("S5")) and one != scene("S5", omega=(0.3, 0.2, 3.1))
    again = pickle.loads(pickle.dumps(one))
    assert again == one
    motion = ph.solve(one, rtol=1e-9)
    copy = pickle.loads(pickle.dumps(motion))
    np.testing.assert_array_equal(copy.omega, motion.omega)
    assert copy.drift == motion.drift and copy.success == motion.success
    with pytest.raises(AttributeError):
        one.omega = (1, 2, 3)
    with pytest.raises(ValueError):
        one.times[0] = 5.0
    np.testing.assert_array_equal(ph.solve(one, rtol=1e-9).omega, motion.omega)


def test_energy_and_momentum_are_what_they_say():
    motion = ph.solve(scene("S5"), rtol=1e-12)
    x, y, z, w = motion.attitude.T
    vertical = np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1)
    energy = 0.5 * (motion.omega**2 @ np.array((1, 2, 2.5))) + 2 * vertical @ np.array((0.3, 0.2, 0.5))
    np.testing.assert_allclose(motion.energy, energy, rtol=1e-14)
    np.testing.assert_allclose(motion.angular_momentum[:, 2], np.sum(vertical * motion.omega * (1, 2, 2.5), axis=1),
                               rtol=1e-12)
    assert set(motion.drift) == {"energy", "vertical_momentum"}
    assert set(ph.solve(scene("S1", times=[1.0])).drift) == {"energy", "angular_momentum"}
    assert set(ph.solve(scene("S6", times=[1.0])).drift) == {"jacobi"}
    assert not ph.solve(scene("S7", times=[1.0])).drift
