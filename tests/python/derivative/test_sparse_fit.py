"""Fits of sparse data over many turns: the two frequencies are found first, and bodies that fit as well are named."""

import numpy as np
import pytest

import polhode as ph
from polhode import measured
from polhode._spectrum import attitudes, curve, scan, shapes

SIGMA = 0.01


def make_body(seed, speed=2.0):
    """Moments, omega and attitude of a box."""
    rng = np.random.default_rng([31, seed])
    half = rng.uniform(0.1, 1, 3) ** 2
    omega, q = rng.normal(size=3), rng.normal(size=4)
    return half.sum() - half, speed * omega / np.linalg.norm(omega), q / np.linalg.norm(q), rng


def make_attitudes(motion, t, rng, sigma=SIGMA):
    noise = ph.Rotation.from_rotvec(sigma * rng.normal(size=(t.size, 3)))
    return measured.Attitudes(t, ph.Rotation.from_quat(motion.at(t)[1]) * noise, sigma)


def check(found, inertia, omega):
    assert found.success, found.message
    assert found.inertia / found.inertia.max() == pytest.approx(inertia / inertia.max(), abs=0.03)
    assert found.omega == pytest.approx(omega, abs=0.04)


@pytest.mark.parametrize(("count", "turns", "shift"),
                         [(50, 250, 0.0), (20, 120, 0.0), (50, 2500, 0.0), (50, 200, -0.5)])
def test_sparse_attitudes_give_the_body(count, turns, shift):
    """Five to fifty turns between samples, and times on both sides of the start."""
    for seed in range(3):
        inertia, omega, q, rng = make_body(seed)
        t = np.sort(rng.uniform(shift, 1 + shift, count)) * turns * np.pi
        found = ph.fit(make_attitudes(ph.FreeMotion(inertia, omega, q), t, rng))
        check(found, inertia, omega)
        assert (found.attitude.inv() * ph.Rotation.from_quat(q)).magnitude() < 0.03
        assert "frequencies of nutation and precession" in found.message
        assert len(found.candidates) == 1 and not found.twins


@pytest.mark.parametrize(("axis", "turns"), [((0, 0, 1), 200), ((0, 1, 0), 200), ((0.48, 0.6, 0.64), 150)])
def test_one_axis_seen_less_than_once_a_turn_gives_the_body(axis, turns):
    """Moments are found up to the exchange of the two other axes where a principal axis is seen."""
    for seed in (1, 3):
        inertia, omega, q, rng = make_body(seed)
        t = np.sort(rng.uniform(0, 1, 80)) * turns * np.pi
        R = ph.Rotation.from_quat(ph.FreeMotion(inertia, omega, q).at(t)[1])
        found = ph.fit(measured.Axis(t, R.apply(np.array(axis)) + SIGMA * rng.normal(size=(80, 3)), SIGMA, axis))
        assert found.success and "frequencies of nutation" in found.message, found.message
        labels = [[0, 1, 2]]
        if np.count_nonzero(axis) == 1:
            others = [k for k in range(3) if not axis[k]]
            swapped = [0, 1, 2]
            swapped[others[0]], swapped[others[1]] = others[1], others[0]
            labels.append(swapped)
        near = [max(np.abs(one.inertia - inertia[p] / inertia.max()).max(),
                    0.5 * np.abs(np.abs(one.omega) - np.abs(omega[p])).max())
                for one in found.candidates for p in labels]
        assert min(near) < 0.06


def test_the_table_of_shapes_holds_free_motions():
    """Each curve obeys dm/dt = m x (g m) with its frequency 1, and bodies made from it have the frequencies asked."""
    table = shapes.table(4, 3)
    for k in range(len(table.u)):
        m, g = table.m[k], np.array([table.u[k], table.v[k], 0.0])
        assert np.linalg.norm(m, axis=1) == pytest.approx(1)
        rate = curve.derivative(m)
        assert rate == pytest.approx(np.cross(m, g * m), abs=2e-3 * np.abs(rate).max())
        moments, omega, _ = table.bodies(np.array([k]), np.array([5]), 0.7, np.array([2.0 + 0.7 * (abs(g).max() + 2)]))
        if len(moments):
            motion = ph.FreeMotion(tuple(moments[0]), omega[0])
            assert 2 * np.pi / abs(motion.period) == pytest.approx(0.7, rel=0.1)


def test_a_body_near_the_separatrix_needs_more_harmonics():
    inertia, rng = np.array([0.3, 0.5, 0.62]), np.random.default_rng(4)
    motion = ph.FreeMotion(inertia, (0.02, 2.0, 0.05), (0.5, -0.1, 0.7, 0.5))
    t = np.sort(rng.uniform(0, 100 * np.pi, 60))
    found = ph.fit(make_attitudes(motion, t, rng))
    check(found, inertia, (0.02, 2.0, 0.05))


def test_the_least_eigenvalue_is_that_of_the_noise_at_the_nutation_alone():
    inertia, omega, q, rng = make_body(7)
    motion = ph.FreeMotion(inertia, omega, q)
    data = make_attitudes(motion, np.sort(rng.uniform(0, 300, 50)), rng)
    found = attitudes.nutations(attitudes.samples_of(data), 0.001, 4.0, 4)
    left, nu, _ = found[0]
    assert nu == pytest.approx(2 * np.pi / motion.period, abs=0.1 / 300)
    assert left == pytest.approx(2 / 3 * (3 * 50 - 16) * SIGMA**2, rel=0.5)
    assert len(found) == 1 or found[1][0] > 5 * left


def test_a_curve_gives_back_its_body_and_its_precession():
    """2 kappa is the rate of the phase of (w + iz)^2 over a period, in a frame whose third axis is L."""
    inertia = np.array([0.3, 0.5, 0.62])
    motion = ph.FreeMotion(inertia, (0.3, 0.9, 1.7))
    period, L = motion.period, np.linalg.norm(inertia * motion.at(0.0)[0])
    m = motion.at(period * np.arange(64) / 64)[0] * inertia / L
    made = curve.make_curve(m, 2 * np.pi / period)
    assert (made.u, made.v) == pytest.approx(L * (1 / inertia[:2] - 1 / inertia[2]), rel=1e-10)
    l = ph.Rotation.from_quat(motion.at(0.0)[1]).apply(m[0])
    third = ph.Rotation.align_vectors([[0, 0, 1.0]], [l])[0]
    q = np.stack([(third * ph.Rotation.from_quat(a)).as_quat() for a in motion.at(period * np.arange(401) / 400)[1]])
    phase = np.unwrap(2 * np.angle(q[:, 3] + 1j * q[:, 2]))
    kappa2 = (phase[-1] - phase[0]) / period
    moments, omega = made.bodies(np.array([kappa2]))
    assert moments[0] * L == pytest.approx(inertia, rel=1e-8)
    assert omega[0] == pytest.approx([0.3, 0.9, 1.7], rel=1e-8)


def test_coarse_rates_on_an_even_grid_name_the_aliases():
    """1.5 samples a period: several bodies fit, and one that fits worse than the truth is never called a success."""
    inertia, omega, _, rng = make_body(2)
    motion = ph.FreeMotion(inertia, omega)
    t = np.linspace(0, 40 * motion.period, 60)
    found = ph.fit(measured.Rates(t, motion.at(t)[0] + 0.02 * rng.normal(size=(60, 3)), 0.02), fit=("omega", "inertia"))
    near = [np.abs(one.inertia - inertia / inertia.max()).max() for one in found.candidates]
    assert found.success and min(near) < 0.03
    assert found.candidates[0].chi2 == pytest.approx(found.chi2) and found.twins
    assert all(one.chi2 <= found.chi2 + 25 for one in found.candidates)
    assert "samples at random times" in found.twins[-1] and f"{t[1]:.6g} s" in found.twins[-1]
    here = found.candidates[int(np.argmin(near))]
    assert here.nutation == pytest.approx(motion.period, rel=1e-3)


def test_sparse_rates_at_random_times_give_the_body():
    for seed in range(3):
        inertia, omega, _, rng = make_body(seed)
        motion = ph.FreeMotion(inertia, omega)
        t = np.sort(rng.uniform(0, 40 * motion.period, 60))
        found = ph.fit(measured.Rates(t, motion.at(t)[0] + 0.02 * rng.normal(size=(60, 3)), 0.02),
                       fit=("omega", "inertia"))
        check(found, inertia, omega)


def test_periods_of_a_candidate_are_those_of_its_motion():
    """A symmetric body precesses at L / I1 and nutates at (I1 - I3) w3 / I1."""
    inertia, omega = np.array([0.5, 0.5, 0.3]), np.array([0.4, 0.0, 1.0])
    t = np.linspace(0, 30, 90)
    data = make_attitudes(ph.FreeMotion(inertia, omega), t, np.random.default_rng(5), 1e-6)
    one = ph.fit(data).candidates[0]
    assert one.precession == pytest.approx(2 * np.pi * 0.5 / np.hypot(0.2, 0.3), rel=1e-3)
    assert one.nutation == pytest.approx(2 * np.pi * 0.5 / 0.2, rel=1e-3)


def test_the_largest_eigenvalue_is_lapacks():
    A = np.random.default_rng(6).normal(size=(200, 3, 3))
    A = A @ A.transpose(0, 2, 1)
    assert scan.largest_eigenvalue(A) == pytest.approx(np.linalg.eigvalsh(A)[:, -1], rel=1e-10)
    assert scan.largest_eigenvalue(np.eye(3)[None]) == pytest.approx([1.0])


def test_fastest_is_the_largest_rate_of_the_scans():
    inertia, omega, q, rng = make_body(1)
    data = make_attitudes(ph.FreeMotion(inertia, omega, q), np.sort(rng.uniform(0, 400, 40)), rng)
    check(ph.fit(data, fastest=3.0), inertia, omega)
    with pytest.raises(ph.InvalidInput, match="fastest: must be positive"):
        ph.fit(data, fastest=0.0)


def test_one_direction_seen_less_than_once_a_turn_gives_the_body():
    """The Sun in body axes, 80 samples over 60 to 300 turns."""
    rng = np.random.default_rng([5001, 3])
    half = rng.uniform(0.1, 1, 3) ** 2
    inertia, omega, q = half.sum() - half, rng.normal(size=3), rng.normal(size=4)
    omega = 2 * omega / np.linalg.norm(omega)
    t = np.sort(rng.uniform(0, 1, 80)) * rng.uniform(60, 300) * np.pi
    R = ph.Rotation.from_quat(ph.FreeMotion(inertia, omega, q / np.linalg.norm(q)).at(t)[1])
    seen = R.inv().apply(np.array([0, 0, 1.0])) + SIGMA * rng.normal(size=(80, 3))
    found = ph.fit(measured.Direction(t, seen, SIGMA, (0, 0, 1)))
    assert found.success and "frequencies of nutation" in found.message, found.message
    assert found.inertia / found.inertia.max() == pytest.approx(inertia / inertia.max(), abs=0.06)
    assert np.abs(found.omega) == pytest.approx(np.abs(omega), abs=0.12)
