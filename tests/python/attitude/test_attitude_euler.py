"""Euler angles at every distance from the pole, and their rates, against mpmath."""

import math

import mpmath
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.spatial.transform import Rotation as SciPy
from test_attitude import SEQUENCES

import polhode as ph

LIMIT = 2e-15
PROPER = {seq: seq[0] == seq[2] for seq in SEQUENCES}
POLES = {seq: (0.0, math.pi) if PROPER[seq] else (-math.pi / 2, math.pi / 2) for seq in SEQUENCES}


def turn(letter, angle):
    i = "xyz".index(letter.lower())
    j, k = (i + 1) % 3, (i + 2) % 3
    R = mpmath.eye(3)
    R[j, j] = R[k, k] = mpmath.cos(angle)
    R[k, j], R[j, k] = mpmath.sin(angle), -mpmath.sin(angle)
    return R


def matrix(seq, angles):
    """R_WB of the angles to 40 digits: R_1 R_2 R_3 (intrinsic) or R_3 R_2 R_1 (extrinsic)."""
    turns = [turn(letter, mpmath.mpf(float(angle))) for letter, angle in zip(seq, angles)]
    return turns[0] * turns[1] * turns[2] if seq.isupper() else turns[2] * turns[1] * turns[0]


def rounded(R):
    return np.array(R.tolist(), dtype=float)


def difference(R, given):
    return max(abs(R[i, j] - mpmath.mpf(float(given[i][j]))) for i in range(3) for j in range(3))


def near_pole(seq, end, distance):
    """The pole's double plus or minus the distance, on the inner side."""
    inward = 1 if end == 0 else -1
    return POLES[seq][end] + inward * distance


@pytest.fixture(autouse=True)
def digits():
    with mpmath.workdps(40):
        yield


# Log steps to 1e-300, finer where a double next to the pole still differs from it and rounding takes over.
DISTANCES = [0.0, *np.logspace(0, -17, 35), *np.logspace(-14, -16.5, 11), *np.logspace(-20, -300, 15)]


@pytest.mark.parametrize("seq", SEQUENCES)
@pytest.mark.parametrize("end", [0, 1])
def test_the_matrix_is_right_at_every_distance_from_the_pole(seq, end):
    rng = np.random.default_rng(SEQUENCES.index(seq))
    angles = rng.uniform(-math.pi, math.pi, (len(DISTANCES), 3))
    angles[:, 1] = [near_pole(seq, end, d) for d in DISTANCES]
    truth = [matrix(seq, row) for row in angles]
    given = np.array([rounded(R) for R in truth])
    of_matrix, of_angles = ph.Rotation.from_matrix(given), ph.Rotation.from_euler(seq, angles)
    for rotation in (of_matrix, of_angles):
        back = rotation.as_euler(seq)
        assert np.isfinite(back).all()
        assert (np.abs(back[:, [0, 2]]) <= math.pi).all()
        assert ((back[:, 1] >= POLES[seq][0]) & (back[:, 1] <= POLES[seq][1])).all()
        for row, R, entries, own in zip(back, truth, given, rotation.as_matrix()):
            returned = matrix(seq, row)
            assert difference(returned, entries) <= LIMIT  # the matrix that was given
            assert difference(returned, own) <= LIMIT  # the matrix that the rotation shows
            assert max(abs(entry) for entry in returned - R) <= LIMIT  # the matrix of the angles that were given
        assert_allclose(ph.Rotation.from_euler(seq, back).as_matrix(), rotation.as_matrix(), rtol=0, atol=LIMIT)


@pytest.mark.long
@pytest.mark.parametrize("seq", SEQUENCES)
def test_the_matrix_is_right_at_many_attitudes_near_the_pole(seq):
    rng = np.random.default_rng(99)
    for end in (0, 1):
        angles = rng.uniform(-math.pi, math.pi, (1000, 3))
        angles[:, 1] = near_pole(seq, end, 10 ** rng.uniform(-18, 0, 1000))
        given = np.array([rounded(matrix(seq, row)) for row in angles])
        for row, entries in zip(ph.Rotation.from_matrix(given).as_euler(seq), given):
            assert difference(matrix(seq, row), entries) <= LIMIT


@pytest.mark.parametrize("seq", SEQUENCES)
@pytest.mark.parametrize("degrees", [False, True])
def test_at_the_pole_the_angles_are_scipys_and_the_flag_is_up(seq, degrees):
    rng = np.random.default_rng(3)
    angles = rng.uniform(-math.pi, math.pi, (100, 3))
    for pole in POLES[seq]:
        angles[:, 1] = pole
        for rotation in (
            ph.Rotation.from_euler(seq, np.rad2deg(angles) if degrees else angles, degrees),
            ph.Rotation.from_matrix(SciPy.from_euler(seq, angles).as_matrix()),
        ):
            assert rotation.gimbal_lock(seq).all()
            back = rotation.as_euler(seq, degrees)
            assert (back[:, 2] == 0).all() and (back[:, 1] == (np.rad2deg(pole) if degrees else pole)).all()
            scipy = SciPy(rotation.as_quat()).as_euler(seq, degrees, suppress_warnings=True)
            gap = np.abs(back - scipy)[:, 0] % (360 if degrees else 2 * math.pi)  # -pi and pi are one
            assert (np.minimum(gap, (360 if degrees else 2 * math.pi) - gap) < (2e-13 if degrees else 4e-15)).all()


@pytest.mark.parametrize("seq", SEQUENCES)
def test_the_flag_is_down_where_the_angles_are_determined(seq):
    for end in (0, 1):
        for distance in (1.0, 1e-3, 1e-8, 1e-12, 2e-15):
            angles = [0.3, near_pole(seq, end, distance), -0.7]
            rotation = ph.Rotation.from_euler(seq, angles)
            assert rotation.gimbal_lock(seq) is False
            # The outer angles are known as well as rounding over the distance allows.
            assert_allclose(rotation.as_euler(seq), angles, rtol=0, atol=3e-15 + 6e-16 / distance)
        assert ph.Rotation.from_euler(seq, [0.3, near_pole(seq, end, 1e-16), -0.7]).gimbal_lock(seq) is True


@pytest.mark.parametrize("seq", [s for s in SEQUENCES if PROPER[s]])
def test_a_small_nutation_keeps_all_its_digits(seq):
    # The middle angle near 0 is relative, not absolute: 2 atan2 of small components.
    for theta in (1e-3, 1e-9, 1e-14):
        assert ph.Rotation.from_euler(seq, [0.3, theta, -0.7]).as_euler(seq)[1] == pytest.approx(theta, rel=1e-15)


@pytest.mark.parametrize("seq", [s for s in SEQUENCES if not PROPER[s]])
def test_small_angles_keep_all_their_digits(seq):
    for size in (1e-3, 1e-9, 1e-100, 1e-300):
        angles = size * np.array([0.3, -0.5, 0.7])
        back = ph.Rotation.from_euler(seq, angles).as_euler(seq)
        assert_allclose(back, angles, rtol=3 * size + 1e-15 if size < 1e-6 else 1e-13)


def test_the_identity_and_the_axes_of_half_turns_never_give_nan():
    special = [[0, 0, 0, 1], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, -1], [-0.0, -1, -0.0, -0.0]]
    halves = [[a / 2, b / 2, c / 2, d / 2] for a in (1, -1) for b in (1, -1) for c in (1, -1) for d in (1, -1)]
    quat = np.array(special + halves)
    for seq in SEQUENCES:
        for one, angles in zip(quat, ph.Rotation(quat).as_euler(seq)):
            assert difference(matrix(seq, angles), ph.Rotation(one).as_matrix()) <= LIMIT


@pytest.mark.parametrize("seq", SEQUENCES)
def test_from_euler_against_mpmath(seq):
    rng = np.random.default_rng(17)
    angles = np.concatenate([rng.uniform(-7, 7, (20, 3)), rng.uniform(-1e5, 1e5, (10, 3)), [[1e9, 1e15, -1e20]]])
    for row, mine in zip(angles, ph.Rotation.from_euler(seq, angles).as_matrix()):
        assert difference(matrix(seq, row), mine) <= 1.5e-15
    # Degrees are turned into radians by one product, which rounds: half an ulp of the largest angle, 6.2.
    degrees = rng.uniform(-360, 360, (20, 3))
    for row, mine in zip(degrees, ph.Rotation.from_euler(seq, degrees, degrees=True).as_matrix()):
        R = mpmath.eye(3)
        for letter, angle in zip(seq, row):
            step = turn(letter, mpmath.mpf(float(angle)) * mpmath.pi / 180)
            R = R * step if seq.isupper() else step * R
        assert difference(R, mine) <= 4e-15


# ---- rates


def omega_of(seq, angles, rates):
    """w_B from R^T dR/dt, the derivative of the product of turns written out, to 40 digits."""
    turns = [turn(letter, mpmath.mpf(float(angle))) for letter, angle in zip(seq, angles)]
    spins = []
    for letter, rate in zip(seq, rates):
        W = mpmath.zeros(3)
        i = "xyz".index(letter.lower())
        j, k = (i + 1) % 3, (i + 2) % 3
        W[k, j], W[j, k] = mpmath.mpf(float(rate)), -mpmath.mpf(float(rate))
        spins.append(W)
    factors = list(zip(turns, spins))
    if seq.islower():
        factors.reverse()
    R, dR = mpmath.eye(3), mpmath.zeros(3)
    for step, W in factors:
        R, dR = R * step, dR * step + R * step * W
    W_B = R.T * dR
    return [W_B[2, 1], W_B[0, 2], W_B[1, 0]]


@pytest.mark.parametrize("seq", SEQUENCES)
def test_body_rates_are_the_derivative_of_the_attitude(seq):
    rng = np.random.default_rng(23)
    angles, rates = rng.uniform(-7, 7, (20, 3)), rng.normal(size=(20, 3))
    for row, rate, omega in zip(angles, rates, ph.body_rates(seq, angles, rates)):
        assert_allclose(omega, [float(w) for w in omega_of(seq, row, rate)], rtol=0, atol=2e-15)


@pytest.mark.parametrize("seq", SEQUENCES)
@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
def test_euler_rates_invert_body_rates(seq, scale):
    rng = np.random.default_rng(29)
    angles, rates = rng.uniform(-7, 7, (200, 3)), scale * rng.normal(size=(200, 3))
    distance = np.abs(np.sin(angles[:, 1]) if PROPER[seq] else np.cos(angles[:, 1]))[:, None]
    back = ph.euler_rates(seq, angles, ph.body_rates(seq, angles, rates))
    assert (np.abs(back - rates) < 4e-15 * scale / distance).all()


def test_the_textbooks_rates():
    # z-x-z, body axes: as in docs/conventions.md
    phi, theta, psi, dphi, dtheta, dpsi = 0.3, 0.5, 0.7, 1.1, -0.4, 2.3
    s, c = math.sin(theta), math.cos(theta)
    expected = [
        dphi * s * math.sin(psi) + dtheta * math.cos(psi),
        dphi * s * math.cos(psi) - dtheta * math.sin(psi),
        dphi * c + dpsi,
    ]
    assert_allclose(ph.body_rates("ZXZ", [phi, theta, psi], [dphi, dtheta, dpsi]), expected, rtol=1e-15)
    assert_allclose(ph.euler_rates("ZXZ", [phi, theta, psi], expected), [dphi, dtheta, dpsi], rtol=2e-15)


@pytest.mark.parametrize("seq", SEQUENCES)
def test_euler_rates_grow_towards_the_pole_and_are_refused_at_it(seq):
    for end, pole in enumerate(POLES[seq]):
        for distance in (1e-3, 1e-8, 1e-14):
            angles = [0.2, near_pole(seq, end, distance), 0.9]
            rates = ph.euler_rates(seq, angles, [0.3, 0.4, 0.5])
            assert np.abs(rates).max() > 0.01 / distance
        for at_pole in (pole, pole + 2 * math.pi, pole - 2 * math.pi):
            with pytest.raises(ph.InvalidInput, match=rf"angles: must be away from gimbal lock, which for '{seq}'"):
                ph.euler_rates(seq, [0.2, at_pole, 0.9], [0.3, 0.4, 0.5])
        assert np.isfinite(ph.body_rates(seq, [0.2, pole, 0.9], [0.3, 0.4, 0.5])).all()
    if PROPER[seq]:  # theta itself is known to the last digit, so that nothing is wrong at 1e-300
        rates = ph.euler_rates(seq, [0.2, 1e-300, 0.9], [0.3, 0.4, 0.5])
        assert np.isfinite(rates).all()


def test_rates_broadcast_and_name_the_row():
    angles, omega = np.full((4, 3), 0.5), np.ones(3)
    assert ph.euler_rates("ZYX", angles, omega).shape == ph.body_rates("ZYX", angles, omega).shape == (4, 3)
    assert ph.body_rates("ZYX", angles[:, None], np.ones((5, 3))).shape == (4, 5, 3)
    assert ph.body_rates("ZYX", omega, omega).shape == (3,)
    assert ph.body_rates("ZYX", np.ones((0, 3)), omega).shape == (0, 3)
    assert_array_equal(ph.body_rates("ZYX", angles, omega)[2], ph.body_rates("ZYX", angles[2], omega))
    angles[2, 1] = math.pi / 2
    with pytest.raises(ph.InvalidInput, match=r"angles\[2\]"):
        ph.euler_rates("ZYX", angles, omega)
