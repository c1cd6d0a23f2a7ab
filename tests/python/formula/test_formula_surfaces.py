"""Surfaces of switches by closed forms: touched, met at once, started on; shadows, wheels, no end of switches."""

import mpmath as mp
import numpy as np
import pytest

import polhode as ph
from polhode.torques import Constant, During, Formula

BALL = np.eye(3)   # the rates are integrals of the torque
ACCURACIES = (1e-3, 1e-6, 1e-9, 1e-12)


def solve(text, accuracy, end, omega=(0.0, 0.0, 0.0), inertia=BALL, **more):
    times = np.atleast_1d(np.asarray(end, dtype=float))
    torques = [Formula(text=text, **more)]
    return ph.solve(ph.Scene(inertia=inertia, omega=omega, torques=torques, times=times), accuracy)


@pytest.mark.parametrize("distance", [s * 10.0**-k for k in range(2, 16) for s in (1, -1)] + [0.0])
def test_a_touched_surface(distance):
    """omega.x = w - sin t has its least value at pi / 2; below the level omega.y grows."""
    w = 0.75
    level = w - 1 + distance
    for accuracy in ACCURACIES:
        for end in (4.5, -4.5):
            with mp.workdps(40):
                s = (mp.mpf(w) - mp.mpf(level))
                true = float(mp.sign(end) * 2 * mp.acos(s)) if s < 1 else 0.0
            law = f"[-cos(t), where(omega.x > {level!r}, 0, 1), 0]"
            if end < 0:
                law = law.replace("-cos(t)", "cos(t)")
            motion = solve(law, accuracy, end, (w, 0, 0))
            assert motion.status == "finished"
            # at a smaller distance nobody may know; a bound that is stated holds
            assert motion.error_kind == "bounded" or abs(distance) < 1e-8 or accuracy < 1e-9
            assert abs(motion.omega[0, 1] - true) <= 2 * motion.error
            if motion.error_kind == "bounded":
                assert motion.error <= accuracy


def test_a_state_that_is_not_known_to_cross_has_no_bound():
    """The surface is left alone or crossed for good."""
    law = "[-cos(t) + where(omega.x > -0.25, 0, -1), 0, 0]"
    for accuracy in (1e-6, 1e-9):
        motion = solve(law, accuracy, 6.0, (0.75, 0, 0))
        assert motion.error_kind != "bounded" or motion.error > 0.1


@pytest.mark.parametrize("direction", [1, -1])
def test_two_surfaces_at_once(direction):
    """Both rates come to 0.2 after 1 s, by torques that are equal and written apart."""
    law = (f"[{-0.3 * direction} * cos(t), {-0.3 * direction} * (cos(t / 2)^2 - sin(t / 2)^2), "
           "where(omega.x > 0.2, where(omega.y > 0.2, 0.1, 0.5), where(omega.y > 0.2, 0.7, -0.2))]")
    start = 0.3 * np.sin(1.0) + 0.2
    for accuracy in ACCURACIES:
        motion = solve(law, accuracy, direction * 2.0, (start, start, 0))
        assert motion.success and motion.error_kind == "bounded"
        true = direction * (0.1 - 0.2)
        assert abs(motion.omega[0, 2] - true) <= motion.error + 1e-15


def test_two_surfaces_whose_order_is_in_doubt():
    """Only one of both orders meets a third torque, between two surfaces that are closer than the errors."""
    rng = np.random.default_rng(11)
    for _ in range(60):
        gap, accuracy = 10.0 ** rng.uniform(-13, -3), 10.0 ** rng.integers(-10, -2)
        a, b = rng.uniform(0.5, 1.0, 2).tolist()   # sin(a t) rises for all of the span
        first = rng.choice(["x", "y"])
        # omega.x = 2 - sin(a t) / a and omega.y = 2 - (1 - exp(-b t)) / b, at the time 1 and a gap later
        levels = {"x": float(2 - np.sin(a) / a), "y": float(2 + np.expm1(-b) / b)}
        levels["x" if first == "y" else "y"] -= gap
        law = (f"[-cos({a!r} * t), -exp({-b!r} * t), where(omega.x > {levels['x']!r}, "
               f"where(omega.y > {levels['y']!r}, 0, 5), 0)]")
        motion = solve(law, accuracy, 1.5, (2.0, 2.0, 0.1))
        with mp.workdps(40):
            A, B = mp.mpf(float(a)), mp.mpf(float(b))
            t_x = mp.asin(A * (2 - mp.mpf(float(levels["x"])))) / A
            t_y = -mp.log(1 - B * (2 - mp.mpf(float(levels["y"])))) / B
            true = float(5 * max(t_x - t_y, 0))
        assert abs(motion.omega[0, 2] - 0.1 - true) <= 3 * motion.error


@pytest.mark.parametrize("units", [-1, 0, 1])
def test_a_start_on_a_surface_or_one_unit_beside_it(units):
    level = 0.37
    start = level if units == 0 else np.nextafter(level, level + units)
    for end, side in ((3.0, -1), (-3.0, 1)):
        for accuracy in ACCURACIES:
            motion = solve(f"[-0.3, where(omega.x > {level!r}, 0.2, -0.4), 0]", accuracy, end, (start, 0, 0))
            assert motion.success and motion.error_kind == "bounded"
            assert abs(motion.omega[0, 1] - end * (0.2 if side > 0 else -0.4)) <= motion.error + 2e-15


def test_a_satellite_in_and_out_of_a_shadow():
    """A circular orbit as states, a shadow that is a cylinder of 0.6 radii: the torque acts outside of it."""
    def lit(t, omega, attitude, p, s):
        far = np.dot(s.r, s.r)
        hidden = np.where(np.abs(s.r[1]) < p.radius, np.where(s.r[0] < 0, 1.0, 0.0), 0.0)
        return np.array([0.0, 0.0, p.push * (1 - hidden)]), {"r": s.v, "v": -s.r / (far * np.sqrt(far))}

    law = Formula(lit, states={"r": (1.0, 0.0), "v": (0.0, 1.0)}, radius=0.6, push=0.1)
    half = float(np.arcsin(0.6))
    times = np.array([-7.0, -3.0, 3.0, np.pi, 7.0, 20.0])

    def dark(t):
        """The time in the shadow from 0 to t > 0, whose middles are pi, 3 pi, ..."""
        return sum(np.clip(t - (middle - half), 0, 2 * half) for middle in np.pi * np.arange(1, 8, 2))

    true = np.array([np.sign(t) * 0.1 * (abs(t) - dark(abs(t))) for t in times])
    for accuracy in (1e-3, 1e-6, 1e-9, 1e-11):
        motion = ph.solve(ph.Scene(inertia=BALL, omega=(0, 0, 0.5), torques=[law], times=times), accuracy)
        assert motion.success and motion.error_kind == "bounded" and motion.error <= accuracy
        assert np.abs(motion.omega[:, 2] - 0.5 - true).max() <= 2.5 * motion.error + 1e-15
        apart = motion.states["r"] - np.stack([np.cos(times), np.sin(times)], 1)
        assert np.linalg.norm(apart, axis=1).max() <= 1.5 * motion.error + 1e-14


@pytest.mark.parametrize("end", [9.0, -1.5])
def test_a_wheel_that_is_saturated(end):
    """About one axis: a constant slope down to the rate limit / gain, and an exponential behind it."""
    def wheel(t, omega, attitude, p, s):
        push = np.clip(-p.gain * omega, -p.limit, p.limit)
        return push, {"h": -push}

    law = Formula(wheel, states={"h": (0.0, 0.0, 0.1)}, gain=0.8, limit=0.2)
    for accuracy in ACCURACIES:
        motion = ph.solve(ph.Scene(inertia=BALL, omega=(0, 0, 1.0), torques=[law], times=[end]), accuracy)
        knee = (1.0 - 0.25) / 0.2
        true = 1.0 - 0.2 * end if end < knee else 0.25 * np.exp(-0.8 * (end - knee))
        assert motion.success and motion.error_kind == "bounded" and motion.error <= accuracy
        assert abs(motion.omega[0, 2] - true) <= motion.error * max(1.0, true) + 1e-15
        assert abs(motion.states["h"][0, 2] - (1.1 - true)) <= motion.error * 1.1 + 1e-15
    with pytest.raises(ph.InvalidInput, match="Formula with states"):
        ph.solve(ph.Scene(inertia=BALL, omega=(0, 0, 1.0), torques=[law], times=[end]), method="dop853")


def test_a_deadband_lets_go():
    """Braked at 0.1 rad/s^2 down to the edge of the band, from there on free."""
    law = "[0, 0, where(abs(omega.z) < 0.3, 0, -0.1 * sign(omega.z))]"
    for start in (1.0, -1.0):
        motion = solve(law, 1e-9, [-2.0, 5.0, 7.0, np.nextafter(7.0, 8), 7.5, 30.0], (0, 0, start))
        assert motion.success and motion.error_kind == "bounded"
        np.testing.assert_allclose(motion.omega[:, 2], np.sign(start) * np.array([1.2, 0.5, 0.3, 0.3, 0.3, 0.3]),
                                   rtol=0, atol=1e-12)


def test_switches_without_end_say_so():
    """A spiral that comes to the middle in a finite time, after more switches than can be counted."""
    law = "[-sign(omega.x) + 2 * sign(omega.y), -2 * sign(omega.x) - sign(omega.y), 0]"
    motion = solve(law, 1e-6, [0.1, 5.0], (0.3, 0.1, 0))
    assert motion.status in ("failed", "sliding") and len(motion.t) == 1
    assert "switches again and again" in motion.message or "slides" in motion.message


def test_a_motion_that_slides_still_has_its_other_direction():
    law = "-0.5 * [sign(omega.x), 0, 0]"
    motion = solve(law, 1e-9, [-1.0, 0.25, 2.0], (0.25, 0, 0))
    assert motion.status == "sliding" and list(motion.t) == [-1.0, 0.25]
    np.testing.assert_allclose(motion.omega[:, 0], [0.75, 0.125], rtol=0, atol=1e-12)
    windowed = [During(Formula(text=law), [(-3.0, 5.0)]), Constant((0, 0, 0.1))]
    given = ph.Scene(inertia=BALL, omega=(0.25, 0, 0), torques=windowed, times=[0.25, 2.0, 8.0])
    motion = ph.solve(given, 1e-9)
    assert motion.status == "sliding" and list(motion.t) == [0.25] and "t = 0.5 s" in motion.message


def test_many_bodies_under_switches():
    given = ph.Scene(inertia=BALL, omega=(0.1, 0.2, 0.3), torques=[Formula(text="-abs(omega)")], times=[1.0])
    many = ph.solve_many([given] * 3, rtol=1e-10, method="taylor")
    np.testing.assert_allclose(many.omega[:, 0], [ph.solve(given, 1e-10).omega[0]] * 3, rtol=0, atol=1e-9)
