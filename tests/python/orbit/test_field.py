"""Magnetic fields against Legendre functions in 40 digits, and torques of moments in them."""

import copy
import pickle

import mpmath
import numpy as np
import pytest

import polhode as ph

mp = mpmath.mp.clone()
mp.dps = 40
ORBIT = ph.Orbit.from_elements(3.986e14, a=7e6, e=0.01, inclination=1.5, node=0.3)
RNG = np.random.default_rng(31)
TIMES = np.linspace(0, 2000, 5)


def make_coefficients(degree):
    g = [[float(x) for x in RNG.normal(size=n + 1) * 1e-5] for n in range(degree + 1)]
    h = [[0.0, *(float(x) for x in RNG.normal(size=n) * 1e-5)] for n in range(degree + 1)]
    g[0] = [0.0]
    return g, h


def potential(radius, g, h, angle, r):
    """V by Legendre functions of the latitude, as they are defined, without the Condon-Shortley phase."""
    x, y, z = (mp.mpf(v) for v in r)
    distance = mp.sqrt(x * x + y * y + z * z)
    s, longitude = z / distance, mp.atan2(y, x) - angle
    total = mp.mpf(0)
    for n in range(1, len(g)):
        for m in range(n + 1):
            # (1 - s^2)^(m/2) d^m P_n / ds^m by Rodrigues' formula: P_n from its polynomial
            terms = [(mp.binomial(n, k) * mp.binomial(2 * n - 2 * k, n) * (-1) ** k / mp.mpf(2) ** n, n - 2 * k)
                     for k in range(n // 2 + 1)]
            for _ in range(m):
                terms = [(c * p, p - 1) for c, p in terms if p > 0]
            legendre = mp.fsum(c * s**p for c, p in terms) * mp.sqrt(1 - s * s) ** m
            norm = 1 if m == 0 else mp.sqrt(2 * mp.factorial(n - m) / mp.factorial(n + m))
            wave = mp.mpf(g[n][m]) * mp.cos(m * longitude) + mp.mpf(h[n][m]) * mp.sin(m * longitude)
            total += (mp.mpf(radius) / distance) ** (n + 1) * norm * legendre * wave
    return radius * total


def true_field(radius, g, h, angle, r):
    """-grad V by central differences in 40 digits."""
    step = mp.mpf(10) ** -12 * radius
    found = []
    for axis in range(3):
        ends = [[mp.mpf(v) + (sign * step if k == axis else 0) for k, v in enumerate(r)] for sign in (1, -1)]
        found.append(float(-(potential(radius, g, h, angle, ends[0]) - potential(radius, g, h, angle, ends[1]))
                           / (2 * step)))
    return np.array(found)


@pytest.mark.parametrize("degree", [1, 2, 3, 6, 13])
def test_gauss_coefficients_are_those_of_the_potential(degree):
    g, h = make_coefficients(degree)
    field = ph.MagneticField.gauss(ORBIT, 6.3712e6, g, h, spin=7.29e-5, phase=0.4)
    for t, r in ((0.0, (7e6, 1e6, -2e6)), (3000.0, (-1e6, 2e6, 6.8e6)), (100.0, (1.0, -2.0, 7e6))):
        expected = true_field(6.3712e6, g, h, mp.mpf(7.29e-5) * t + mp.mpf(0.4), r)
        np.testing.assert_allclose(field.at(t, r), expected, atol=2e-14 * np.linalg.norm(expected))


def test_the_poles_are_places_like_others():
    g, h = make_coefficients(4)
    field = ph.MagneticField.gauss(ORBIT, 6.3712e6, g, h)
    for pole in (7e6, -7e6):
        near = np.mean([field.at(0.0, (x, y, pole)) for x, y in ((10, 0), (-10, 0), (0, 10), (0, -10))], axis=0)
        np.testing.assert_allclose(field.at(0.0, (0, 0, pole)), near, rtol=1e-9, atol=1e-16)


def test_degree_one_is_the_tilted_dipole():
    radius, tilt, phase = 6.3712e6, 2.97, 0.7
    strength = 7.9e15
    # m along (g11, h11, g10): V = m . r / r^3
    m = strength / radius**3 * np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    gauss = ph.MagneticField.gauss(ORBIT, radius, [[0], [m[2], m[0]]], [[0], [0, m[1]]], spin=7.29e-5, phase=phase)
    dipole = ph.MagneticField.dipole(ORBIT, strength, tilt, spin=7.29e-5, phase=phase)
    np.testing.assert_allclose(gauss.at(TIMES), dipole.at(TIMES), rtol=1e-13)


def test_a_dipole_by_its_definition():
    field = ph.MagneticField.dipole(ORBIT, 2.0, 0.4, spin=0.1, phase=0.3)
    for t in (0.0, 5.0):
        r = np.array([1.0, -2.0, 0.5])
        a = 0.1 * t + 0.3
        m, u = np.array([np.sin(0.4) * np.cos(a), np.sin(0.4) * np.sin(a), np.cos(0.4)]), r / np.linalg.norm(r)
        np.testing.assert_allclose(field.at(t, r), 2 / np.linalg.norm(r) ** 3 * (3 * (m @ u) * u - m), rtol=1e-14)
    np.testing.assert_array_equal(field.at([0.0, 5.0]), [field.at(0.0), field.at(5.0)])
    np.testing.assert_allclose(field.at(TIMES), field.at(TIMES, ORBIT.at(TIMES)[0]), rtol=1e-13)


def fields():
    return {"dipole": ph.MagneticField.dipole(ORBIT, 7.9e15, 2.97, spin=7.29e-5),
            "gauss": ph.MagneticField.gauss(ORBIT, 6.3712e6, *make_coefficients(3), spin=7.29e-5)}


@pytest.mark.parametrize("kind", ["dipole", "gauss"])
def test_a_moment_turns_the_body(kind):
    """Against DOP853 with the torque as a function of NumPy: m x R^T B."""
    field = fields()[kind]
    moment = np.array([0.3, -0.2, 0.1])

    def torque(t, omega, attitude):
        return np.cross(moment, ph.Rotation.from_quat(attitude).as_matrix().T @ field.at(t))

    parts = dict(inertia=(1e-3, 2e-3, 2.5e-3), omega=(0.02, 0.01, -0.03), times=np.linspace(0, 600, 4))
    motion = ph.solve(ph.Scene(**parts, torques=[ph.torques.Dipole(moment, field)]), accuracy=1e-9)
    plain = ph.solve(ph.Scene(**parts, torques=[ph.torques.Custom(torque)]), method="dop853", rtol=1e-12)
    assert motion.success and motion.error <= 1e-9
    np.testing.assert_allclose(motion.omega, plain.omega, atol=1e-9 * np.abs(plain.omega).max())


def test_a_moment_may_follow_the_field():
    """B-dot's kind of law: the moment is a function of the rates and of the field in body axes."""
    field = fields()["dipole"]
    torque = ph.torques.Dipole(lambda t, omega, attitude, field, p: p.k * np.cross(field, omega) * 1e9, field, k=30.0)
    q = ph.Rotation.from_rotvec((0.3, 0.5, -0.8))
    b = q.as_matrix().T @ field.at(100.0)
    omega = np.array([0.1, 0.2, -0.3])
    expected = np.cross(3e10 * np.cross(b, omega), b)
    np.testing.assert_allclose(torque.value(100.0, omega, q.as_quat()), expected, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("kind", ["dipole", "gauss"])
def test_fields_are_values(kind, tmp_path):
    field = fields()[kind]
    for other in (copy.deepcopy(field), pickle.loads(pickle.dumps(field))):
        assert other == field and hash(other) == hash(field) and repr(other) == repr(field)
    torque = ph.torques.Dipole((1, 2, 3), field)
    assert pickle.loads(pickle.dumps(torque)) == torque
    given = ph.Scene(inertia=(1, 2, 2.5), omega=(0, 0, 1), torques=[torque], times=[1.0])
    given.save(tmp_path / "scene.toml")
    assert ph.Scene.load(tmp_path / "scene.toml").torques == given.torques


@pytest.mark.parametrize(("call", "words"), [
    (lambda: ph.MagneticField(), "made by MagneticField.dipole or MagneticField.gauss"),
    (lambda: ph.MagneticField.dipole(3.0, 1.0), "orbit: must be an Orbit, got float"),
    (lambda: ph.MagneticField.dipole(ORBIT, np.nan), "strength: must be finite"),
    (lambda: ph.MagneticField.gauss(ORBIT, 0.0, [[0], [1, 2]], [[0], [0, 1]]), "radius: must be positive and finite"),
    (lambda: ph.MagneticField.gauss(ORBIT, 1.0, [[0], [1, 2]], [[0]]), "h: must be as many rows as g, 2"),
    (lambda: ph.MagneticField.gauss(ORBIT, 1.0, [[0], [1]], [[0], [0, 1]]), r"g\[1\]: must be 2 numbers"),
    (lambda: ph.MagneticField.gauss(ORBIT, 1.0, [[0], [1, 2]], [[0], [3, 1]]), r"h\[1\]\[0\]: must be 0"),
    (lambda: ph.MagneticField.gauss(ORBIT, 1.0, [[1], [1, 2]], [[0], [0, 1]]), r"g\[0\]\[0\]: must be 0"),
    (lambda: ph.MagneticField.gauss(ORBIT, 1.0, *make_coefficients(14)), "n from 1 to 13, got 15 rows"),
    (lambda: ph.MagneticField.gauss(ORBIT, 1.0, 3.0, 4.0), "g: must be rows of numbers"),
    (lambda: fields()["dipole"].at(0.0, (0, 0, 0)), "not the centre"),
    (lambda: ph.torques.Dipole((1, 2), fields()["dipole"]), r"must be of shape \(3,\)"),
    (lambda: ph.torques.Dipole(len, fields()["dipole"]), "callable as moment.*, got len"),
    (lambda: ph.torques.Dipole((1, 2, 3), ORBIT), "field: must be a MagneticField, got Orbit"),
])
def test_wrong_fields_are_refused(call, words):
    with pytest.raises(ph.InvalidInput, match=words):
        call()
