"""Smoke tests of what a body carries, and the scene of all smoke tests."""

import datetime

import numpy as np

import polhode as ph

BLOCK = (0.20, 0.40, 0.52)
OMEGA = (1.0, 2.0, 3.0)
TIMES = np.linspace(0.0, 1.0, 5)


def scene(**changes):
    return ph.Scene(**{"inertia": BLOCK, "omega": OMEGA, "times": TIMES, "name": "block", **changes})


def smoke_rotor():
    wheel = ph.Rotor((0, 0, 1), inertia=0.1, speed=5.0)
    assert wheel.axis.tolist() == [0, 0, 1] and scene(rotors=[wheel]).rotor_momentum.tolist() == [0, 0, 0.5]


def smoke_damper():
    slug = ph.Damper(inertia=0.1, viscous=0.2)
    assert slug.rates.tolist() == [0, 0, 0] and scene(damper=slug).damper == slug


def smoke_changing():
    boom = ph.Changing.ramp((1, 2, 2.5), (2, 3, 3.5), (0, 1))
    assert boom.at(0.5).tolist() == [1.5, 2.5, 3.0] and scene(inertia=boom).changing == boom


def smoke_controller():
    law = ph.Controller(0.5, lambda t, m, s, p: -m.omega)
    assert len(ph.solve(scene(controllers=[law], times=[0.0, 1.0])).ticks[0].t) == 2


def smoke_measure():
    assert ph.Measure(seed=3).seed == 3 and ph.Measure() == ph.Measure()


def smoke_attitude_ephemeris():
    body, t = ph.FreeMotion(BLOCK, OMEGA), np.linspace(0, 5, 100)
    found = ph.AttitudeEphemeris(t, body.at(t)[1], 1e-6, datetime.datetime(2026, 3, 1))
    assert np.allclose(np.abs(np.sum(found(t[:50] + 0.02) * body.at(t[:50] + 0.02)[1], axis=1)), 1, rtol=0, atol=1e-12)
