"""Numbers of Basilisk's tests of reaction wheels and of its gravity gradient (AVSLab/basilisk, commit babdff7).

test_reactionWheelStateEffector_integrated.py, cases BalancedWheels and BOE: hub, wheels Honeywell HR16 with 100 N m s
at 6000 rpm and at most 0.2 N m, commands, and the MRP after 1 s to nine digits. The hub's inertia has the wheels in.
test_gravityGradient.py, case 0: the orbit about the Earth, the hub and its attitude.
"""

import math

import numpy as np
import pytest

import polhode as ph

RPM = 2 * math.pi / 60
JS = 100 / (6000 * RPM)
X, Y, Z = np.eye(3)


def wheel(axis, speed, torque):
    return ph.Rotor(axis, inertia=JS, speed=speed * RPM, free=True, torque=torque, max_torque=0.2)


@pytest.mark.parametrize("accuracy", [1e-6, 1e-9, 1e-12])
def test_balanced_wheels(accuracy):
    scene = ph.Scene(inertia=(900, 800, 600), omega=(0.08, 0.01, 0), times=[0.5, 1.0], rotors=[
        wheel(X, 500, "where(t < 0.5, 0.2, 0)"), wheel(Y, 200, "where(t < 0.5, 0.1, 0)"),
        wheel(Z, -150, "where(t < 0.5, -0.5, 0)")])   # which the motor cuts to -0.2
    motion = ph.solve(scene, accuracy=accuracy)
    sigma = motion.rotation[-1].as_mrp()
    assert motion.success
    printed = (1.99853994e-02, 2.45647716e-03, 8.45356279e-06)
    assert np.abs(sigma - printed).max() < 5e-11 + motion.error
    without = ph.solve(scene.replace(rotors=[ph.Rotor(r.axis, inertia=JS, speed=r.speed, free=True)
                                             for r in scene.rotors]), accuracy=accuracy)
    assert np.abs(without.rotation[-1].as_mrp() - printed).max() > 1e-6   # the motors are seen


def test_a_wheel_whose_motor_starts_after_five_seconds():
    body, torque, start = 2.0, 0.2, 0.35
    scene = ph.Scene(inertia=(2, 2, body + JS), omega=(0, 0, start), times=[2, 4, 6, 8, 10],
                     rotors=[wheel(Z, 100, "where(t < 5, 0, 0.2)")])
    motion = ph.solve(scene, accuracy=1e-12)
    since = np.maximum(scene.times - 5, 0)
    assert motion.success
    assert np.abs(motion.omega[:, 2] - (start - torque / body * since)).max() < 1e-14
    angle = 4 * np.arctan(motion.rotation.as_mrp()[:, 2])
    expected = start * scene.times - 0.5 * torque / body * since**2
    turns = (angle - expected) / (2 * math.pi)
    assert np.abs(turns - np.round(turns)).max() < 1e-13
    speed = 100 * RPM + (body + JS) / (body * JS) * torque * since
    assert np.abs(motion.rotor_speed[:, 0] / speed - 1).max() < 1e-14


def test_the_gravity_gradient_on_an_orbit():
    mu, inertia = 0.3986004415e15, np.diag([500.0, 800.0, 350.0])
    orbit = ph.Orbit.from_elements(mu, a=7e6, e=1e-4, inclination=math.radians(33.3), node=math.radians(48.2),
                                   periapsis=math.radians(347.8), anomaly=math.radians(85.3))
    scene = ph.Scene(inertia=inertia, omega=(0, 0, 0), attitude=ph.Rotation.from_mrp((0.1, 0.2, -0.3)),
                     torques=[ph.torques.GravityGradient(orbit=orbit)], times=np.linspace(0, 3600, 11))
    motion = ph.solve(scene, accuracy=1e-11)
    assert motion.success
    for t, omega, attitude in zip(motion.t, motion.omega, motion.attitude):
        r = orbit.at(t)[0]
        up = ph.Rotation.from_quat(attitude).inv().apply(r / np.linalg.norm(r))
        expected = 3 * mu / np.linalg.norm(r) ** 3 * np.cross(up, inertia @ up)
        assert np.abs(scene.torque(t, omega, attitude) - expected).max() < 1e-10 * np.abs(expected).max()
