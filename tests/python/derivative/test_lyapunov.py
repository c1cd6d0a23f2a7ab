"""The largest Lyapunov exponent: known rates, neighbouring motions, and motions that have none."""

import math

import numpy as np
import pytest

import polhode as ph

BLOCK = np.array([0.2, 0.4, 0.52])


def test_the_unstable_axis_is_left_at_its_rate():
    J1, J2, J3 = BLOCK
    rate = 2.0 * math.sqrt((J2 - J1) * (J3 - J2) / (J1 * J3))
    scene = ph.Scene(inertia=BLOCK, omega=(0, 2, 0), times=[100.0])
    for torques in ((), (ph.torques.Constant((0, 0, 0)),)):   # closed form, and variational equations
        found = ph.lyapunov(scene.replace(torques=torques))
        half = np.searchsorted(found.t, 50.0)
        slope = (found.log_growth[-1] - found.log_growth[half]) / (found.t[-1] - found.t[half])
        assert slope == pytest.approx(rate, rel=1e-8)
        assert found.exponent == pytest.approx(rate, rel=0.05)


def test_a_wheel_steadies_the_unstable_axis():
    scene = ph.Scene(inertia=BLOCK, omega=(0, 2, 0), times=[500.0], rotors=[ph.Rotor(axis=(0, 1, 0), momentum=0.5)])
    assert abs(ph.lyapunov(scene).exponent) < 3 * math.log(500) / 500
    free = ph.Rotor(axis=(0, 1, 0), inertia=0.05, speed=8.0, free=True)
    assert abs(ph.lyapunov(scene.replace(rotors=[free])).exponent) < 3 * math.log(500) / 500


def test_chaos_is_how_neighbours_part():
    scene = ph.Scene.load("S5c").replace(times=np.linspace(0, 60, 61))
    found = ph.lyapunov(scene, 60.0)
    apart = []
    for change in np.eye(3):
        near = ph.solve(scene.replace(omega=scene.omega + 1e-9 * change), 1e-13)
        apart.append(np.linalg.norm(near.omega - ph.solve(scene, 1e-13).omega, axis=1) / 1e-9)
    grown = np.log(np.max(apart, axis=0))
    here = np.interp(np.arange(61), found.t, found.log_growth)
    assert np.abs(grown - here)[20:].max() < 2.5   # of 9: directions and rates of different axes
    assert found.log_growth[-1] > 5
    assert 0.09 < ph.lyapunov(scene, 400.0).exponent < 0.14


def test_regular_motions_have_nearly_none():
    for name in ("S1", "S6", "S10"):
        found = ph.lyapunov(ph.Scene.load(name))
        span = found.t[-1]
        assert abs(found.log_growth[-1]) < 1.5 * math.log(max(span, 1000.0))
        assert found.exponent == pytest.approx(found.log_growth[-1] / span)


def test_windows_and_units_are_kept():
    torque = ph.torques.During(ph.torques.Gravity(2.0, (0.3, 0.2, 0.5)), [[0.0, 3.0], [4.0, 20.0]])
    scene = ph.Scene(inertia=(1, 2, 2.5), omega=(0.3, 0.2, 2.0), torques=[torque], times=[10.0])
    found = ph.lyapunov(scene)
    fast = ph.torques.During(ph.torques.Gravity(2e12, (0.3, 0.2, 0.5)), [[0.0, 3e-6], [4e-6, 2e-5]])
    other = ph.lyapunov(ph.Scene(inertia=(1, 2, 2.5), omega=(0.3e6, 0.2e6, 2e6), torques=[fast], times=[1e-5]))
    assert other.exponent == pytest.approx(found.exponent * 1e6, rel=1e-6)
    whole = ph.solve(scene, 1e-12, sensitivity=("omega", "attitude")).sensitivity.transition[0]
    assert found.log_growth[-1] <= math.log(np.linalg.norm(whole, 2)) + 3


def test_bad_spans_and_custom_torques_are_refused():
    scene = ph.Scene.load("S5c")
    for span in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(ph.InvalidInput, match="span: must be positive"):
            ph.lyapunov(scene, span)
    with pytest.raises(ph.InvalidInput, match="scene: must be"):
        ph.lyapunov("S5c")
    own = scene.replace(torques=[ph.torques.Custom(lambda t, omega, attitude: (0.0, 0.0, 0.0))])
    with pytest.raises(ph.InvalidInput, match="without a formula"):
        ph.lyapunov(own, 10.0)
