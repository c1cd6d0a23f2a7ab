"""Damping proportional to the angular momentum: the closed form against exact answers, and its planner."""

import math
import pickle

import numpy as np
import pytest
from bodies import BLOCK, scene
from measures import attitude_error, rates_error
from tables import numbers, read

import polhode as ph

E = 2.2e-16
AngularDamping, Damping = ph.torques.AngularDamping, ph.torques.Damping
TIMES = np.linspace(0, 20, 41)


@pytest.fixture(scope="module")
def table():
    return read("damped_free.csv")


def make(row):
    inertia = ph.InertiaTensor.from_moments(numbers(row, "I1", "I2", "I3"), physical=False)
    return ph.DampedFree(inertia, float(row["c"]), numbers(row, "w1", "w2", "w3"), numbers(row, "x0", "y0", "z0", "w0"))


def errors(row):
    """(error of omega relative to its largest, angle) of one row."""
    omega, attitude = make(row).at(float(row["t"]))
    expected = numbers(row, "o1", "o2", "o3")
    scale = max(np.abs(expected).max(), np.abs(numbers(row, "w1", "w2", "w3")).max()) or 1.0
    return np.linalg.norm((omega - expected) / scale), attitude_error(attitude, numbers(row, "x", "y", "z", "w"))


def test_every_regime_is_as_exact_as_the_free_body(table):
    """The promise is 20 (cond + 4e). The slowed time is a double-double, so the error is that of FreeMotion."""
    assert len(table) > 400 and {row["family"] for row in table} > {"separatrix", "needle", "near-sphere", "exact"}
    found = np.array([errors(row) for row in table])
    cond = np.array([float(row["cond"]) for row in table])
    assert np.all(found <= 20 * (cond + 4 * E)[:, None])
    worst = found.max(axis=0)
    assert 2e-16 < worst[0] < 3e-15 and 2e-16 < worst[1] < 3e-15, worst


def test_the_table_has_fast_bodies_whose_slowed_time_needs_more_than_53_bits(table):
    turned = [np.linalg.norm(numbers(row, "w1", "w2", "w3")) / abs(float(row["c"])) for row in table]
    assert max(turned) > 1e8 and min(turned) < 1
    assert sum(float(row["c"]) < 0 for row in table) > 50 and sum(float(row["t"]) < 0 for row in table) > 50


@pytest.mark.parametrize("power", range(-30, 3))
def test_the_slowed_time_at_every_size_of_its_exponent(power):
    """Against mpmath, in steps of the logarithm over the change from the short series to the exponential."""
    mp = pytest.importorskip("mpmath")
    for mantissa in (1.0, 1.9, -1.0, 3.7):
        c, t = 0.3, mantissa * 10.0**power / 0.3
        motion = ph.DampedFree(BLOCK, c, (1, 2, 3))
        with mp.workdps(60):
            x = mp.mpf(c) * mp.mpf(t)
            if x < -50:
                continue
            exact = -mp.expm1(-x) / mp.mpf(c)
            assert abs(mp.mpf(motion.slowed_time(t)) / exact - 1) < 1.2e-16
            omega, _ = motion.at(t)
            free, _ = motion.free.at(float(exact))
            np.testing.assert_allclose(omega, free * float(mp.exp(-x)), atol=4e-15 * max(1, float(mp.exp(-x))))


def test_ten_to_the_twelve_radians_keep_their_phase():
    """A sphere turns about its own axis: the angle is |omega| s, known exactly."""
    mp = pytest.importorskip("mpmath")
    c, rate = 3e-7, 1e6
    motion = ph.DampedFree((2, 2, 2), c, (0, 0, rate))
    for t in (1e3, 1.7e6, 2.5e7, -4e5):
        with mp.workdps(60):
            half = mp.mpf(rate) * -mp.expm1(-mp.mpf(c) * mp.mpf(t)) / mp.mpf(c) / 2
            expected = np.array([0, 0, float(mp.sin(half)), float(mp.cos(half))])
        assert attitude_error(motion.at(t)[1], expected) < 1e-15


def test_what_must_hold_without_a_table():
    motion = ph.DampedFree(BLOCK, 0.05, (1, 2, 3), (0.1, -0.7, 0.4, math.sqrt(1 - 0.66)))
    omega, attitude = motion.at(TIMES)
    momentum = ph.Rotation.from_quat(attitude).apply(np.array(BLOCK) * omega)
    np.testing.assert_allclose(momentum, np.exp(-0.05 * TIMES)[:, None] * momentum[0], atol=4e-15)
    again = ph.DampedFree(BLOCK, 0.05, *motion.at(7.0))      # at(t1 + t2) is at(t2) from at(t1)
    for found, expected in zip(again.at(5.0), motion.at(12.0), strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-14)
    free = ph.FreeMotion(BLOCK, (1, 2, 3))
    for found, expected in zip(ph.DampedFree(BLOCK, 0.0, (1, 2, 3)).at(TIMES), free.at(TIMES), strict=True):
        np.testing.assert_array_equal(found, expected)
    for found, expected in zip(ph.DampedFree(BLOCK, 1e-300, (1, 2, 3)).at(TIMES), free.at(TIMES), strict=True):
        np.testing.assert_allclose(found, expected, atol=3e-15)


@pytest.mark.parametrize(("inertia", "omega"), [
    (BLOCK, (0, 0, 0)), ((2, 2, 2), (1, 2, 3)), (BLOCK, (0, 4, 0)), ((1, 1, 2), (1, 0, 3)), (BLOCK, (1, 2, 3)),
    ((3, 4, 6), (2, 1, 1)), (BLOCK, (1e-4, 5, 1e-4)),
])
@pytest.mark.parametrize("torque", [AngularDamping(0.3), AngularDamping(-0.02)], ids=["brake", "drive"])
def test_the_planner_takes_it_for_every_body(inertia, omega, torque):
    motion = ph.solve(ph.Scene(inertia=inertia, omega=omega, torques=[torque], times=TIMES), accuracy=1e-13)
    assert (motion.plan.method, motion.plan.model) == ("exact", "damped_free")
    assert motion.success and motion.error < 5e-15 and motion.stats["steps"] == 0
    if omega[0] == 1e-4:
        return      # beside the separatrix a stepper loses digits at each flip; the table has such bodies
    stepped = ph.solve(ph.Scene(inertia=inertia, omega=omega, torques=[torque], times=TIMES), 1e-11, method="taylor")
    assert rates_error(motion.omega, stepped.omega, (1e-9, 0, 0)) < 1e-14 + stepped.error
    assert attitude_error(motion.attitude, stepped.attitude) < 1e-14 + stepped.error


def test_the_plan_says_why():
    plan = ph.plan(scene("S1", torques=[AngularDamping(0.01)]))
    assert any("slowed time" in reason for reason in plan.reasons)
    other = ph.plan(scene("S1", torques=[Damping((1, 2, 3))]))
    assert other.method != "exact" and any("no multiple of the inertia" in reason for reason in other.reasons)
    with pytest.raises(ph.InvalidInput, match="no multiple of the inertia"):
        ph.solve(scene("S1", torques=[Damping((1, 2, 3))]), method="exact")


@pytest.mark.parametrize("rate", [0.1, 0.3, 1 / 3, 1e-9, 7.7e5, -0.013])
@pytest.mark.parametrize("inertia", [np.diag(BLOCK), np.diag((0.5, 0.7, 0.3)),
                                     np.array([[3, 0.1, 0.2], [0.1, 4, 0.3], [0.2, 0.3, 5]]) / 7])
def test_a_matrix_is_recognised_bit_by_bit(rate, inertia):
    """Every entry is the float64 rounding of c I_ij, and one bit away it is not."""
    times = np.linspace(0, 0.1, 3)

    def model(matrix):
        scene = ph.Scene(inertia=inertia, omega=(1, 2, 3), torques=[Damping(matrix)], times=times)
        return ph.plan(scene, leave_out=False).model

    matrix = rate * inertia
    assert model(matrix) == "damped_free"
    for i, j in ((0, 0), (1, 1), (2, 2), (0, 1)):
        moved = matrix.copy()
        moved[i, j] = np.nextafter(matrix[i, j], np.inf)
        # A last bit more on one entry alone is no other rate, if the others pin the rate down.
        moved[i, j] = np.nextafter(moved[i, j], np.inf)
        moved[i, j] = np.nextafter(moved[i, j], np.inf)
        assert model(moved) == "euler"


def test_a_rounded_matrix_is_in_the_bound():
    matrix = 0.1 * np.array(BLOCK)
    parts = {"times": np.linspace(0, 200, 21)}
    exact = ph.solve(scene("S1", torques=[AngularDamping(0.1)], **parts))
    rounded = ph.solve(scene("S1", torques=[Damping(matrix)], **parts))
    assert rounded.plan.model == "damped_free" and exact.error < 5e-15 < rounded.error < 1e-13
    powers = ph.solve(scene("S1", torques=[Damping(0.125 * np.array(BLOCK))], **parts))
    assert powers.error == exact.error      # every product is exact
    several = ph.solve(scene("S1", torques=[AngularDamping(0.0625), AngularDamping(0.0625)], **parts))
    np.testing.assert_array_equal(several.omega, powers.omega)


@pytest.mark.parametrize("torques", [
    [AngularDamping(0.1), ph.torques.Constant((1e-9, 0, 0))], [AngularDamping(0.1), ph.torques.Gravity(1, (0, 0, 1))],
    [Damping(((0, 0, 1e-3), (0, 0, 0), (-1e-3, 0, 0)))]])
def test_with_anything_else_the_scene_is_stepped(torques):
    assert ph.plan(scene("S1", torques=torques, times=TIMES)).method != "exact"


def test_windows_chain_it_with_the_rest():
    brake = ph.torques.During(Damping(0.3 * np.array(BLOCK)), [(2, 5), (9, 11)])
    kick = ph.torques.During(ph.torques.Constant((0.05, -0.02, 0.03)), [(6, 7)])
    one = scene("S1", torques=[brake], times=TIMES)
    motion = ph.solve(one, accuracy=1e-11)
    assert [piece.model for piece in motion.plan.pieces] == ["triaxial", "damped_free"] * 2 + ["triaxial"]
    assert motion.success and motion.stats["steps"] == 0
    stepped = ph.solve(one, method="taylor", accuracy=1e-11)
    assert rates_error(motion.omega, stepped.omega) < motion.error + stepped.error
    assert attitude_error(motion.attitude, stepped.attitude) < motion.error + stepped.error
    both = ph.solve(scene("S1", torques=[brake, kick], times=TIMES), accuracy=1e-10)
    assert both.success and [piece.model for piece in both.plan.pieces].count("damped_free") == 2


def test_another_start_time_and_times_before_it():
    times = np.array([3.0, -2.0, 0.0, 7.5]) + 0.1
    motion = ph.solve(scene("S1", torques=[AngularDamping(0.2)], times=times, t0=0.1), dense=True)
    omega, attitude = ph.DampedFree(BLOCK, 0.2, (1, 2, 3)).at(times - 0.1)
    np.testing.assert_array_equal(motion.omega, omega)
    np.testing.assert_array_equal(motion.attitude, attitude)
    assert 5e-15 < motion.error < 1e-13
    np.testing.assert_allclose(motion(3.1)[0], omega[0], rtol=1e-14)
    slow = ph.solve(scene("S1", torques=[AngularDamping(0.2)], times=[0, 60]),
                    events=[ph.Event(lambda t, w, q: np.linalg.norm(w) - 1e-3, terminal=True)])
    assert slow.status == "event" and abs(np.linalg.norm(slow.events[0].omega) - 1e-3) < 1e-12


def test_a_drive_beyond_float64_is_refused():
    for call in (lambda: ph.DampedFree(BLOCK, -1.0, (1, 2, 3)).at(800.0),
                 lambda: ph.solve(scene("S1", torques=[AngularDamping(-1.0)], times=[0, 800.0]))):
        with pytest.raises(ph.InvalidInput, match="drives the body.*shorten the span"):
            call()
    with pytest.raises(ph.InvalidInput, match="rotated faster"):
        ph.DampedFree(BLOCK, 1.0, (1, 2, 3)).at(-800.0)
    with pytest.raises(ph.InvalidInput, match="1e25"):
        ph.DampedFree(BLOCK, 1e-30, (1, 2, 3)).at(1e27)
    for bad in (np.nan, np.inf):
        with pytest.raises(ph.InvalidInput, match="finite"):
            ph.DampedFree(BLOCK, 1.0, (1, 2, 3)).at(bad)
        with pytest.raises(ph.InvalidInput, match="damping"):
            ph.DampedFree(BLOCK, bad, (1, 2, 3))
        with pytest.raises(ph.InvalidInput, match="AngularDamping.rate"):
            AngularDamping(bad)
    omega, _ = ph.DampedFree(BLOCK, 1.0, (1, 2, 3)).at(1e6)
    assert np.all(np.abs(omega) < 1e-300)


def test_objects_are_values():
    motion = ph.DampedFree(BLOCK, 0.3, (1, 2, 3), (0.5, 0.5, 0.5, 0.5))
    again = pickle.loads(pickle.dumps(motion))
    assert again == motion and hash(again) == hash(motion) and repr(again) == repr(motion)
    assert motion != ph.DampedFree(BLOCK, 0.4, (1, 2, 3), (0.5, 0.5, 0.5, 0.5))
    assert motion.total_angle == pytest.approx(math.sqrt(14) / 0.3) and motion.free.kind == "about_greatest"
    one, many = motion.at(3.3), motion.at(np.full((2, 5), 3.3))
    for single, rows in zip(one, many, strict=True):
        assert rows.shape[:2] == (2, 5)
        np.testing.assert_allclose(rows, np.broadcast_to(single, rows.shape), atol=1e-15)


@pytest.mark.parametrize("power", [-100, 12, 100])
def test_nothing_depends_on_units(power):
    s = 2.0**power
    omega, attitude = ph.DampedFree(BLOCK, 0.3, (1, 2, 3)).at(TIMES)
    scaled, turned = ph.DampedFree(np.array(BLOCK) * s, 0.3 * s, np.array((1, 2, 3)) * s).at(TIMES / s)
    np.testing.assert_array_equal(scaled, omega * s)
    np.testing.assert_array_equal(turned, attitude)
