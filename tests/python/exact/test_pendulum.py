"""The plane pendulum of any body: the closed form against exact answers, its exact conditions, and its planner."""

import math
import pickle

import numpy as np
import pytest
from measures import attitude_error, rates_error
from tables import numbers, read

import polhode as ph
from polhode import _core

E = 2.2e-16
BODY = (0.3, 0.5, 0.6)
HANGING = {"inertia": BODY, "weight": 2.0, "arm": (0, 0, -0.7), "omega": (1.5, 0, 0)}
GRAVITY = ph.torques.Gravity(2.0, (0, 0, -0.7))
TIMES = np.linspace(0, 20, 41)


@pytest.fixture(scope="module")
def table():
    return read("pendulum.csv")


def start(row):
    omega = np.zeros(3)
    omega[int(row["axis"])] = float(row["omega"])
    inertia = ph.InertiaTensor.from_moments(numbers(row, "I1", "I2", "I3"), physical=False)
    return {"inertia": inertia, "weight": float(row["weight"]), "arm": numbers(row, "r1", "r2", "r3"), "omega": omega,
            "attitude": numbers(row, "x0", "y0", "z0", "w0")}


def errors(row):
    """(error of omega relative to its largest, angle) of one row."""
    omega, attitude = ph.Pendulum(**start(row)).at(float(row["t"]))
    expected = np.zeros(3)
    expected[int(row["axis"])] = float(row["rate"])
    scale = float(row["largest"]) or 1.0
    return np.linalg.norm(omega - expected) / scale, attitude_error(attitude, numbers(row, "x", "y", "z", "w"))


def test_every_energy_about_every_axis(table):
    """The promise is 20 (cond + 4e), cond the answer's move under half a unit in the last place of an input."""
    assert len(table) > 300 and {row["axis"] for row in table} == {"0", "1", "2"}
    for row in table:
        assert max(errors(row)) <= 20 * (float(row["cond"]) + 4 * E), (row, errors(row))


def test_the_errors_are_small_units_of_rounding_wherever_the_data_determine_the_answer(table):
    found = np.array([errors(row) for row in table if float(row["cond"]) < 1e-11])
    assert len(found) > 200
    worst = found.max(axis=0)
    assert 2e-16 < worst[0] < 4e-15 and 2e-16 < worst[1] < 4e-15, worst


def test_exactly_on_the_separatrix_and_at_rest_is_told(table):
    for family, kind in (("separatrix", "separatrix"), ("rest", "rest"), ("upright", "rotating")):
        rows = [row for row in table if row["family"] == family]
        assert rows and all(ph.Pendulum(**start(row)).kind == kind for row in rows)
        if kind == "separatrix":
            for row in rows:
                omega, _ = ph.Pendulum(**start(row)).at(1e6)
                assert np.all(omega == 0) or np.abs(omega).max() < 1e-300


@pytest.mark.parametrize("power", range(-15, 1))
def test_both_sides_of_the_separatrix(power):
    """A hair below it swings, a hair above it rotates; the period is 4 K or 2 K of the modulus."""
    mp = pytest.importorskip("mpmath")
    for sign in (-1, 1):
        omega = 2.0 * (1 + sign * 0.4 * 10.0**power)
        swing = ph.Pendulum((1, 1, 1.5), 1.0, (0, 0, -1.0), (omega, 0, 0))
        assert swing.kind == ("swinging" if sign < 0 else "rotating")
        with mp.workdps(60):
            k = mp.mpf(omega) / 2
            period = 4 * mp.ellipk(k * k) if sign < 0 else 2 * mp.ellipk(1 / (k * k)) / k
        assert swing.period == pytest.approx(float(period), rel=1e-14)
        omega_then, attitude_then = swing.at(swing.period)
        np.testing.assert_allclose(omega_then, (omega, 0, 0), rtol=0, atol=1e-14 * 10.0**-power + 1e-13)


@pytest.mark.parametrize("change", [
    {"omega": (1.5, 1e-300, 0)}, {"omega": (1.5, 0, 5e-324)}, {"arm": (5e-324, 0, -0.7)}, {"omega": (0, 0, 1.5)},
    {"attitude": (0.5, 1e-300, 0.5, math.sqrt(0.5))}, {"attitude": (0.5, 0.5, 0.5, 0.5 + 1e-15)}, {"weight": 0.0},
    {"arm": (0, 0, 0)}, {"attitude": (0, math.sin(0.1), 0, math.cos(0.1))},
    {"inertia": ph.InertiaTensor(((0.3, 5e-324, 0), (5e-324, 0.5, 0), (0, 0, 0.6)))}], ids=repr)
def test_what_is_no_pendulum_to_the_last_bit_is_refused(change):
    parts = HANGING | change
    with pytest.raises(ph.InvalidInput, match="plane pendulum"):
        ph.Pendulum(**parts)


def test_the_conditions_do_not_depend_on_the_length_of_the_quaternion():
    h = math.sqrt(0.5)
    for length in (1.0, 1 + 3e-7, 1 - 2e-16):
        for axis, q, arm in ((0, (h * 0.6, h * 0.6, h * 0.8, h * 0.8), (0, 0, -1)),
                             (1, (-h * 0.6, h * 0.6, h * 0.8, h * 0.8), (0.3, 0, 0.2)),
                             (2, (h * 0.8, -h * 0.6, h * 0.6, h * 0.8), (0.1, 0.4, 0))):
            omega = np.eye(3)[axis]
            motion = ph.Pendulum(BODY, 3.0, arm, omega, np.array(q) * length)
            np.testing.assert_array_equal(motion.axis, omega)


def test_energy_and_the_plane_are_kept(table):
    for row in table[::5]:
        parts = start(row)
        motion = ph.Pendulum(**parts)
        if motion.kind == "rest":
            continue
        k = int(row["axis"])
        moment = numbers(row, "I1", "I2", "I3")[k]
        times = np.linspace(-20, 20, 101) / max(motion.frequency, abs(float(row["omega"])))
        omega, attitude = motion.at(times)
        assert np.all(np.delete(omega, k, axis=1) == 0)
        np.testing.assert_allclose(np.linalg.norm(attitude, axis=1), 1, atol=4e-15)
        height = ph.Rotation.from_quat(attitude).apply(parts["arm"])[:, 2]
        energy = 0.5 * moment * omega[:, k] ** 2 + parts["weight"] * height
        scale = (0.5 * moment * omega[:, k] ** 2).max() + abs(parts["weight"]) * np.linalg.norm(parts["arm"])
        assert np.abs(energy - energy[50]).max() < 40 * E * scale


def test_a_restart_continues_the_motion():
    motion = ph.Pendulum(**HANGING)
    again = ph.Pendulum(**HANGING | dict(zip(("omega", "attitude"), motion.at(3.0), strict=True)))
    for found, expected in zip(again.at(4.0), motion.at(7.0), strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-14)
    for found, expected in zip(again.at(-3.0), motion.at(0.0), strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-14)


@pytest.mark.parametrize(("omega", "q", "axis_of_arm"), [
    ((1.5, 0, 0), (0, 0, 0, 1), 2), ((0, -20, 0), (0, 0, 0, 1), 2), ((0, 0, 0), (math.sin(1), 0, 0, math.cos(1)), 2),
    ((0, 0, 0.1), (0.5, 0.5, 0.5, 0.5), 1), ((0, 0, 0), (0, 0, 0, 1), 2)])
def test_the_planner_takes_it(omega, q, axis_of_arm):
    arm = np.zeros(3)
    arm[axis_of_arm] = -0.7
    one = ph.Scene(inertia=BODY, omega=omega, attitude=q, torques=[ph.torques.Gravity(2.0, arm)], times=TIMES)
    motion = ph.solve(one, accuracy=1e-13)
    assert (motion.plan.method, motion.plan.model) == ("exact", "pendulum")
    assert motion.success and motion.error < 5e-15
    stepped = ph.solve(one, 1e-11, method="taylor")
    rate = max(np.abs(stepped.omega).max(), 1e-9)
    assert np.abs(motion.omega - stepped.omega).max() / rate < 1e-14 + stepped.error
    assert attitude_error(motion.attitude, stepped.attitude) < 1e-14 + stepped.error


def test_a_symmetric_body_gives_lagranges_top():
    for omega, tilt in ((1.5, 0.0), (0.0, 1.0), (4.0, 0.3), (1e-6, 0.0)):
        q = (math.sin(tilt / 2), 0, 0, math.cos(tilt / 2))
        top = ph.HeavyTop((0.5, 0.5, 0.6), -1.4, (omega, 0, 0), q)
        pendulum = ph.Pendulum((0.5, 0.5, 0.6), 1.4, (0, 0, -1), (omega, 0, 0), q)
        for found, expected in zip(pendulum.at(TIMES), top.at(TIMES), strict=True):
            sign = np.sign(np.sum(found * expected, axis=1, keepdims=True)) if expected.shape[1] == 4 else 1
            np.testing.assert_allclose(found, sign * expected, atol=5e-15 * max(1, omega))


def test_the_plan_says_why():
    def scene(omega, q=(0, 0, 0, 1)):
        return ph.Scene(inertia=BODY, omega=omega, attitude=q, torques=[GRAVITY], times=TIMES)

    assert any("plane pendulum" in reason for reason in ph.plan(scene((1, 0, 0))).reasons)
    reasons = ph.plan(scene((1, 1e-9, 0))).reasons
    assert any("omega is not along one of the body axes" in reason for reason in reasons)
    with pytest.raises(ph.InvalidInput, match="horizontal"):
        ph.solve(scene((1, 0, 0), (0, math.sin(0.1), 0, math.cos(0.1))), method="exact")


@pytest.mark.parametrize("accuracy", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("axis", [0, 1])
def test_a_braked_swing_carries_its_error_in_the_plane(axis, accuracy):
    """About the intermediate axis, too, where a start beside the plane would leave it. The error of the brake grows in
    the last swings."""
    brake = ph.torques.During(ph.torques.AngularDamping(0.4), [(4, 6)])
    one = ph.Scene(inertia=BODY, omega=1.5 * np.eye(3)[axis], torques=[GRAVITY, brake], times=np.linspace(0, 300, 301))
    motion = ph.solve(one, accuracy)
    assert [piece.model for piece in motion.plan.pieces] == ["pendulum", "euler", "pendulum"]
    truth = _core.reference(one, 30, 1e-20, 10**6)
    assert motion.success and rates_error(motion.omega, truth[0]) <= motion.error
    assert attitude_error(motion.attitude, truth[1]) <= motion.error


def test_windows_chain_it_with_the_rest():
    let_go = ph.Scene(inertia=BODY, omega=(1.5, 0, 0), torques=[ph.torques.During(GRAVITY, [(0, 7)])], times=TIMES)
    motion = ph.solve(let_go, accuracy=1e-11)
    assert [piece.model for piece in motion.plan.pieces] == ["pendulum", "steady"]
    stepped = ph.solve(let_go, 1e-11, method="taylor")
    assert motion.success and motion.stats["steps"] == 0
    assert np.abs(motion.omega - stepped.omega).max() < 4 * (motion.error + stepped.error)
    assert attitude_error(motion.attitude, stepped.attitude) < motion.error + stepped.error


def test_bad_input_and_times_too_long():
    for change in ({"weight": np.nan}, {"arm": (0, 0, np.inf)}, {"omega": (np.nan, 0, 0)}):
        with pytest.raises(ph.InvalidInput):
            ph.Pendulum(**HANGING | change)
    for t in (np.nan, np.inf, 1e30):
        with pytest.raises(ph.InvalidInput, match="t: must be finite"):
            ph.Pendulum(**HANGING).at(t)
    with pytest.raises(ph.InvalidInput, match="choose other units"):
        ph.Pendulum(**HANGING | {"omega": (1e-200, 0, 0)})


def test_objects_are_values():
    motion = ph.Pendulum(**HANGING)
    again = pickle.loads(pickle.dumps(motion))
    assert again == motion and hash(again) == hash(motion) and repr(again) == repr(motion)
    assert motion != ph.Pendulum(**HANGING | {"weight": 2.5})
    one, many = motion.at(3.3), motion.at(np.full(3000, 3.3))
    for single, rows in zip(one, many, strict=True):
        np.testing.assert_allclose(rows, np.broadcast_to(single, rows.shape), atol=2e-15)


@pytest.mark.parametrize("power", [-100, 12, 100])
def test_nothing_depends_on_units(power):
    s = 2.0**power
    omega, attitude = ph.Pendulum(**HANGING).at(TIMES)
    scaled = ph.Pendulum(np.array(BODY) / s, 2.0 * s, (0, 0, -0.7), (1.5 * s, 0, 0)).at(TIMES / s)
    np.testing.assert_array_equal(scaled[0], omega * s)
    np.testing.assert_array_equal(scaled[1], attitude)


@pytest.mark.parametrize("arm, spin", [((0, 0, 0.7), 0.0), ((0, 0.4, 0.7), 0.0), ((0, 0, 0.7), 1e-7)])
@pytest.mark.parametrize("span", [1e-7, 1e-6, 1e-5, 1e-4])
def test_next_to_rest_the_bound_has_the_rounding_of_faster_rates(arm, spin, span):
    """From rest omega = I^-1 tau t, up to t^3: from Euler's equation by hand. `spin` makes it Lagrange's top."""
    moments, weight, tilt = np.array((1.3, 1.3, 0.5)), 2.0, 1.0
    times = span * np.linspace(0, 1, 9)
    scene = ph.Scene(inertia=moments, omega=(0, 0, spin), attitude=ph.Rotation.from_rotvec((tilt, 0, 0)), times=times,
                     torques=[ph.torques.Gravity(weight, arm)])
    down = np.array((0, -math.sin(tilt), -math.cos(tilt)))
    rate = np.cross(arm, weight * down) / moments
    omega = np.outer(times, rate) + (0, 0, spin)
    cubic = weight * 0.9 / 0.5 * span**2   # of omega, above what t^3 and the turning of the torque by the spin leave
    largest = np.linalg.norm(omega, axis=1).max()

    exact = ph.solve(scene, 1e-4, method="exact")
    assert exact.plan.model == ("heavy_top" if spin else "pendulum")
    error = np.linalg.norm(exact.omega - omega, axis=1).max() / largest
    assert error <= exact.error + cubic and exact.error < 1e3 * E / span

    tight = ph.solve(scene, 1e-12)
    assert tight.success and tight.plan.method != "exact"
    assert np.linalg.norm(tight.omega - omega, axis=1).max() / largest <= tight.error + cubic + 2 * E
    assert "rounding of faster ones" in str(ph.plan(scene, 1e-12))
