"""Samples that are wrong: they are named where the others fit, and a motion that fits too few is no success."""

import numpy as np
import pytest
import toutatis

import polhode as ph
from polhode import measured

INERTIA, OMEGA, START = np.array([0.3, 0.5, 0.62]), np.array([1.0, -2.0, 0.7]), np.array([0.5, -0.1, 0.7, 0.5])


def made(wrong, count=60, seed=3):
    """Attitudes over six turns; those at the places `wrong` are turned by 0.5 to 1.5 rad."""
    rng = np.random.default_rng(seed)
    t = np.sort(rng.uniform(0, 17, count))
    noise = 0.01 * rng.normal(size=(count, 3))
    noise[wrong] += rng.uniform(0.5, 1.5, (len(wrong), 1)) * np.eye(3)[rng.integers(3, size=len(wrong))]
    q = ph.Rotation.from_quat(ph.FreeMotion(INERTIA, OMEGA, START).at(t)[1])
    return measured.Attitudes(t, q * ph.Rotation.from_rotvec(noise), 0.01)


def test_the_attitudes_of_toutatis_give_its_body_and_both_periods():
    """Periods of 5.41 and 7.35 days: Hudson and Ostro (1995). Moments 3.0836, 3.235, 1: Takahashi and others (2013)."""
    t, attitude, _ = toutatis.read()
    found = ph.fit(measured.Attitudes(t, attitude, np.radians(5)))
    assert found.success and not found.outliers
    assert found.inertia == pytest.approx(toutatis.RATIOS, abs=0.04)
    body = found.candidates[0]
    assert body.nutation == pytest.approx(5.41, abs=0.1) and body.precession == pytest.approx(7.35, abs=0.15)


def test_two_rates_of_toutatis_are_named_as_outliers():
    """The rates of 7 and 14 December are some 45 degrees a day off; no motion fits all samples."""
    t, attitude, rates = toutatis.read()
    data = [measured.Attitudes(t, attitude, np.radians(5)), measured.Rates(t, rates, np.radians(3))]
    found = ph.fit(data)
    assert found.success and "fits without 2 outliers: Rates at t = 4.81944, 11.4236" in found.message
    assert [list(places) for places in found.outliers] == [[], [5, 12]]
    assert found.dof == 2 * 3 * 17 - 2 * 3 - 8 and found.chi2 <= found.dof + 4 * np.sqrt(2 * found.dof)
    assert found.inertia == pytest.approx(toutatis.RATIOS, abs=0.03)
    off = np.degrees(np.linalg.norm(rates - found.predict(t).omega, axis=1))
    assert (off[[5, 12]] > 40).all() and (np.delete(off, [5, 12]) < 15).all()


def test_outliers_are_named_and_the_others_fitted():
    found = ph.fit(made([4, 30, 51]))
    assert found.success and "fits without 3 outliers: Attitudes at t = " in found.message
    assert list(found.outliers[0]) == [4, 30, 51]
    assert found.inertia == pytest.approx(INERTIA / 0.62, abs=0.01) and found.omega == pytest.approx(OMEGA, abs=0.02)
    assert found.dof == 3 * 57 - 8


def test_under_a_loss_success_has_the_same_limit_without_the_outliers():
    found = ph.fit(made([4, 30, 51]), loss="soft_l1")
    assert found.success and list(found.outliers[0]) == [4, 30, 51]
    scene = ph.Scene(inertia=tuple(INERTIA), omega=tuple(OMEGA * 1.5), attitude=START, times=[1.0])
    wrong = ph.fit(made([]), scene, fit=("attitude",), start="scene", loss="soft_l1")
    assert not wrong.success and "the model does not fit" in wrong.message


def test_too_many_outliers_are_no_success():
    scene = ph.Scene(inertia=tuple(INERTIA), omega=tuple(OMEGA), attitude=START, times=[1.0])
    found = ph.fit(made(list(range(0, 60, 3))), scene, start="scene")
    assert not found.success and not found.outliers
