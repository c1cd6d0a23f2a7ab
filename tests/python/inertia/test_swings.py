"""Moments from swings: against the motion of the body itself, by Monte Carlo, and refusals."""

import mpmath
import numpy as np
import pytest

import polhode as ph
from polhode.inertia import from_bifilar, from_pendulum


def period_of(moment, weight_arm, amplitude):
    """The period of I a'' = - w sin a by a quadrature of the energy, without an elliptic function."""
    mpmath.mp.dps = 30
    a = mpmath.mpf(amplitude)

    def over(x):   # sin(angle / 2) = sin(a / 2) sin x
        return 1 / mpmath.sqrt(1 - (mpmath.sin(a / 2) * mpmath.sin(x)) ** 2)

    return float(4 * mpmath.sqrt(mpmath.mpf(moment) / weight_arm) * mpmath.quad(over, [0, mpmath.pi / 2]))


@pytest.mark.parametrize("amplitude", [0.0, 0.1, 1.0, 3.0])
def test_a_pendulum_gives_back_its_moment(amplitude):
    moment, mass, distance, g = 0.031, 2.2, 0.17, 9.81
    T = period_of(moment + mass * distance**2, mass * g * distance, amplitude)
    found = from_pendulum(T, mass, distance, g, amplitude)
    assert found.moment == pytest.approx(moment, rel=1e-12) and found.stderr == 0.0


def test_a_pendulum_of_the_library_gives_back_its_moment():
    """The flips of the rate of `ph.solve` are half a period apart."""
    moment, mass, distance, g = 0.031, 2.2, 0.17, 9.81
    I = np.array([moment, 0.02, 0.03]) + mass * distance**2 * np.array([1, 1, 0])
    scene = ph.Scene(inertia=tuple(I), omega=(0, 0, 0), attitude=ph.Rotation.from_euler("x", [40.0], degrees=True),
                     torques=[ph.torques.Gravity(mass * g, (0, 0, -distance))], times=np.linspace(0, 4, 4001))
    rate = ph.solve(scene).omega[:, 0]
    flips = np.flatnonzero(rate[1:-1] * rate[2:] < 0) + 1
    zeros = scene.times[flips] - rate[flips] * 1e-3 / (rate[flips + 1] - rate[flips])
    T = 2 * np.diff(zeros).mean()
    assert from_pendulum(T, mass, distance, g, np.radians(40)).moment == pytest.approx(moment, rel=1e-6)


def test_bifilar_threads_give_back_the_moment():
    """The sum of potential and turning energy of small swings: m g spacing^2 / (4 length) is the stiffness."""
    moment, mass, length, spacing, g = 0.4, 5.0, 2.0, 0.3, 9.81
    stiffness = mass * g * spacing**2 / (4 * length)
    T = 2 * np.pi * (moment / stiffness) ** 0.5
    assert from_bifilar(T, mass, length, spacing, g).moment == pytest.approx(moment)
    T = period_of(moment, stiffness, 0.5)
    assert from_bifilar(T, mass, length, spacing, g, 0.5).moment == pytest.approx(moment, rel=1e-12)


def test_standard_errors_are_those_of_many_trials():
    rng = np.random.default_rng(3)
    given = dict(period=(1.2, 0.002), mass=(2.2, 0.001), distance=(0.17, 0.0005), gravity=9.81, amplitude=(0.2, 0.02))
    found = from_pendulum(**given)
    trials = []
    for _ in range(4000):
        numbers = {k: v[0] + v[1] * rng.normal() if isinstance(v, tuple) else v for k, v in given.items()}
        trials.append(from_pendulum(**numbers).moment)
    assert found.stderr == pytest.approx(np.std(trials), rel=0.05)
    assert sum(found.shares.values()) == pytest.approx(1) and found.shares["gravity"] == 0
    bifilar = from_bifilar((3.0, 0.01), 5.0, (2.0, 0.001), (0.3, 0.0005))
    trials = [from_bifilar(3.0 + 0.01 * a, 5.0, 2.0 + 0.001 * b, 0.3 + 0.0005 * c).moment
              for a, b, c in rng.normal(size=(4000, 3))]
    assert bifilar.stderr == pytest.approx(np.std(trials), rel=0.05)


@pytest.mark.parametrize(("change", "match"), [
    (dict(period=-1), "period: must be positive"), (dict(mass=(1, -0.1)), "mass: must be positive"),
    (dict(amplitude=3.2), "amplitude: must be from 0"), (dict(distance=(1, 2, 3)), "distance: must be a number"),
    (dict(period=0.1), "longer than that of a point"), (dict(gravity=float("nan")), "gravity"),
])
def test_refusals(change, match):
    good = dict(period=1.2, mass=2.2, distance=0.17)
    from_pendulum(**good)
    with pytest.raises(ph.InvalidInput, match=match):
        from_pendulum(**{**good, **change})
