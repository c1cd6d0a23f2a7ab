"""Kepler orbits against the classical anomalies in 60 digits, on every conic."""

import copy
import pickle

import mpmath
import numpy as np
import pytest

import polhode as ph

mp = mpmath.mp.clone()
mp.dps = 60
TINY = mp.mpf(10) ** -57


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def solve_kepler(equation, slope, guess, low, high):
    """Newton's steps within a bracket."""
    x = guess
    for _ in range(600):
        miss = equation(x)
        low, high = (low, x) if miss > 0 else (x, high)
        new = x - miss / slope(x)
        if not low < new < high:
            new = (low + high) / 2
        if abs(new - x) <= TINY * max(abs(x), mp.mpf(10) ** -20):
            return new
        x = new
    return x


def by_anomalies(mu, r0, v0, t):
    """Lagrange's f and g by the eccentric or hyperbolic anomaly; Barker's equation for a parabola."""
    mu, t, r0, v0 = mp.mpf(mu), mp.mpf(t), [mp.mpf(x) for x in r0], [mp.mpf(x) for x in v0]
    r, rv, energy = mp.sqrt(dot(r0, r0)), dot(r0, v0), dot(v0, v0) / 2 - mu / mp.sqrt(dot(r0, r0))
    if energy == 0:
        s = rv / mp.sqrt(mu)   # sqrt(mu) t = r x + s x^2 / 2 + x^3 / 6
        n = mp.sqrt(mu) * t
        x = solve_kepler(lambda x: r * x + s * x**2 / 2 + x**3 / 6 - n, lambda x: r + s * x + x**2 / 2,
                         mp.mpf(0), -mp.mpf(10) ** 30, mp.mpf(10) ** 30)
        f, g = 1 - x**2 / (2 * r), t - x**3 / (6 * mp.sqrt(mu))
        place = [f * a + g * b for a, b in zip(r0, v0, strict=True)]
        far = mp.sqrt(dot(place, place))
        fd, gd = -mp.sqrt(mu) * x / (r * far), 1 - x**2 / (2 * far)
        return place, [fd * a + gd * b for a, b in zip(r0, v0, strict=True)]
    a = mu / abs(2 * energy)
    n = mp.sqrt(mu / a**3)
    es = rv / mp.sqrt(mu * a)
    if energy < 0:
        ec = 1 - r / a
        e = mp.sqrt(es**2 + ec**2)
        first = mp.atan2(es, ec) if e != 0 else mp.mpf(0)
        mean = first - es + n * t
        turns = mp.floor(mean / (2 * mp.pi) + mp.mpf(1) / 2)
        rest = mean - 2 * mp.pi * turns
        last = solve_kepler(lambda x: x - e * mp.sin(x) - rest, lambda x: 1 - e * mp.cos(x), rest, -mp.pi, mp.pi)
        d = last + 2 * mp.pi * turns - first
        c, s, part = 1 - mp.cos(d), mp.sin(d), d - mp.sin(d)
    else:
        e = mp.sqrt((1 + r / a) ** 2 - es**2)
        first = mp.asinh(es / e)
        mean = es - first + n * t
        wide = mp.asinh(abs(mean) / e) + mp.cbrt(6 * abs(mean)) + 1
        last = solve_kepler(lambda x: e * mp.sinh(x) - x - mean, lambda x: e * mp.cosh(x) - 1, mp.asinh(mean / e),
                            -wide, wide)
        d = last - first
        c, s, part = mp.cosh(d) - 1, mp.sinh(d), mp.sinh(d) - d
    f, g = 1 - a / r * c, t - part / n
    place = [f * x + g * y for x, y in zip(r0, v0, strict=True)]
    far = mp.sqrt(dot(place, place))
    fd, gd = -mp.sqrt(mu * a) / (r * far) * s, 1 - a / far * c
    return place, [fd * x + gd * y for x, y in zip(r0, v0, strict=True)]


def miss(found, truth):
    return float(mp.sqrt(sum((mp.mpf(x) - y) ** 2 for x, y in zip(found, truth, strict=True)) / dot(truth, truth)))


def draw(rng, e, nu):
    """mu, a state and the time scale of the periapsis."""
    mu, q = 10 ** rng.uniform(-2, 15), 10 ** rng.uniform(-1, 9)
    r = q * (1 + e) / (1 + e * np.cos(nu))
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    r0 = axes @ (r * np.array([np.cos(nu), np.sin(nu), 0]))
    return mu, r0, axes @ (np.sqrt(mu / (q * (1 + e))) * np.array([-np.sin(nu), e + np.cos(nu), 0])), np.sqrt(q**3 / mu)


CONICS = {"circle": 0.0, "nearly round": 1e-16, "round to 1e-9": 1e-9, "elliptic": 0.4, "long": 0.97,
          "1 - 1e-6": 1 - 1e-6, "1 - 1 ulp": 1 - 2**-53, "1": 1.0, "1 + 1 ulp": 1 + 2**-52, "1 + 1e-9": 1 + 1e-9,
          "1 + 1e-3": 1.001, "hyperbolic": 1.5, "flyby": 4.2, "fast": 900.0}


@pytest.mark.parametrize("name", CONICS)
def test_every_conic_in_60_digits(name):
    e, rng = CONICS[name], np.random.default_rng(len(name))
    worst_r = worst_v = 0.0
    for power in np.linspace(-6, 6 if e < 100 else 3, 37):
        reach = 2.5 if e < 1 else 0.9 * np.arccos(-1 / e)
        mu, r0, v0, scale = draw(rng, e, rng.uniform(-reach, reach))
        t = scale * 10**power * rng.choice([-1, 1])
        r, v = ph.Orbit(mu, r0, v0).at(t)
        true_r, true_v = by_anomalies(mu, r0, v0, t)
        worst_r, worst_v = max(worst_r, miss(r, true_r)), max(worst_v, miss(v, true_v))
    assert worst_r < 3e-15 and worst_v < 8e-15


def test_an_exact_parabola():
    for t in (-1e6, -3.0, 1e-9, 0.7, 1e4, 1e12):
        orbit = ph.Orbit(2.0, (1, 0, 0), (0, 2, 0))
        true_r, true_v = by_anomalies(2.0, (1, 0, 0), (0, 2, 0), t)
        r, v = orbit.at(t)
        assert orbit.kind == "parabolic" and orbit.e == 1 and orbit.period == np.inf
        assert miss(r, true_r) < 2e-15 and miss(v, true_v) < 2e-15


@pytest.mark.parametrize("speed", [0.0, 0.5, 1.9, 2.0, 2.5])
def test_radial_orbits(speed):
    """Along a line up to the centre, which is refused; mu = 2 and r0 = 1 have the escape speed 2."""
    orbit = ph.Orbit(2.0, (1, 0, 0), (speed, 0, 0))
    assert orbit.kind == "radial" and orbit.periapsis_distance == 0
    for t in (-0.05, 0.1, 0.3) if speed < 1.9 else (0.1, 3.0):
        r, v = orbit.at(t)
        true_r, true_v = by_anomalies(2.0, (1, 0, 0), (speed, 0, 0), t)
        assert miss(r, true_r) < 4e-15 and miss(v, true_v) < 4e-15


def test_a_radial_orbit_ends_at_the_centre():
    fall = ph.Orbit(2.0, (2, 0, 0), (0, 0, 0))
    assert np.linalg.norm(fall.at(fall.period * 0.4999)[0]) < 0.02
    for t in (fall.period * 0.5001, -fall.period * 0.5001, 3 * fall.period):
        with pytest.raises(ph.InvalidInput, match="meets the centre"):
            fall.at(t)
    away = ph.Orbit(2.0, (1, 0, 0), (2.5, 0, 0))
    with pytest.raises(ph.InvalidInput, match="meets the centre"):
        away.at(-1.0)


def test_a_million_periods():
    mu, r0, v0 = 3.986e14, (7e6, 1e5, -3e5), (100.0, 7546, 900)
    orbit = ph.Orbit(mu, r0, v0)
    for t in (1e6 * orbit.period + 100.0, -3.3e5 * orbit.period):
        true_r, true_v = by_anomalies(mu, r0, v0, t)
        assert miss(orbit.at(t)[0], true_r) < 2e-15 and miss(orbit.at(t)[1], true_v) < 2e-15


@pytest.mark.parametrize("e", [0.0, 0.1, 0.97, 1.0, 1.5, 4.2])
def test_elements_are_states(e):
    given = dict(periapsis_distance=7e6, e=e, inclination=0.9, node=0.3, periapsis=0.8, anomaly=-0.7, t0=20.0)
    orbit = ph.Orbit.from_elements(3.986e14, **given)
    r0, v0 = orbit.at(20.0)
    other = ph.Orbit(3.986e14, r0, v0, t0=20.0)
    assert orbit.e == e and orbit.periapsis_distance == 7e6 and other.e == pytest.approx(e, abs=1e-14)
    assert np.linalg.norm(r0) == pytest.approx(7e6 * (1 + e) / (1 + e * np.cos(0.7)), rel=1e-15)
    h = np.cross(r0, v0)
    axis = np.sin(0.3) * np.sin(0.9), -np.cos(0.3) * np.sin(0.9), np.cos(0.9)
    np.testing.assert_allclose(h / np.linalg.norm(h), axis, atol=1e-15)
    for t in (-5e3, 0.0, 1e4):
        np.testing.assert_allclose(orbit.at(t)[0], other.at(t)[0], rtol=1e-11)
    if e < 1:
        assert orbit == ph.Orbit.from_elements(3.986e14, **given) and orbit.period == pytest.approx(
            2 * np.pi * np.sqrt((7e6 / (1 - e)) ** 3 / 3.986e14), rel=1e-14)
        by_axis = ph.Orbit.from_elements(3.986e14, a=7e6 / (1 - e), **{**given, "periapsis_distance": None})
        np.testing.assert_allclose(by_axis.at(1e4)[0], orbit.at(1e4)[0], rtol=1e-12)


def test_secular_rates_of_j2():
    """A satellite at 98 degrees follows the sun, and one at 63.4 degrees keeps its periapsis."""
    mu, radius, j2 = 3.986004418e14, 6378137.0, 1.08262668e-3
    sun = ph.Orbit.from_elements(mu, a=7.1781e6, e=0.001, inclination=np.radians(98.6), j2=j2, radius=radius)
    days = 10.0
    h = [np.cross(*sun.at(t)) for t in (0.0, days * 86400)]
    moved = np.degrees(np.arctan2(*(lambda a: (a[0], -a[1]))(h[1])) - np.arctan2(*(lambda a: (a[0], -a[1]))(h[0])))
    assert moved / days == pytest.approx(0.9856, rel=0.02)    # degrees a day: the sun's mean motion
    frozen = ph.Orbit.from_elements(mu, a=2.6562e7, e=0.74, inclination=np.arcsin(np.sqrt(0.8)), j2=j2, radius=radius)
    t = np.array([1e5, 2e5])
    r, v = frozen.at(t)
    step = 1.0
    np.testing.assert_allclose((frozen.at(t + step)[0] - frozen.at(t - step)[0]) / (2 * step), v, rtol=1e-5)
    plain = ph.Orbit.from_elements(mu, a=2.6562e7, e=0.74, inclination=np.arcsin(np.sqrt(0.8)))
    assert np.abs(np.linalg.norm(plain.at(0.0)[0]) / np.linalg.norm(frozen.at(0.0)[0]) - 1) < 1e-15


def test_a_table_is_a_cubic():
    t = np.array([0.0, 1, 3, 7])
    r, v = np.stack([t**3, t**2 - t, 2 * t], axis=1), np.stack([3 * t**2, 2 * t - 1, 2 + 0 * t], axis=1)
    orbit = ph.Orbit.table(t, r, v)
    at = np.array([0.0, 0.3, 1.0, 2.9, 5.5, 7.0])
    np.testing.assert_allclose(orbit.at(at)[0], np.stack([at**3, at**2 - at, 2 * at], axis=1), atol=1e-13)
    np.testing.assert_allclose(orbit.at(at)[1], np.stack([3 * at**2, 2 * at - 1, 2 + 0 * at], axis=1), atol=1e-13)
    assert orbit.kind == "table" and np.isnan(orbit.mu)
    for outside in (np.nextafter(0, -1), np.nextafter(7, 8), np.nan):
        with pytest.raises(ph.InvalidInput, match="within the table"):
            orbit.at(outside)


ORBITS = [ph.Orbit(1.0, (1, 0, 0), (0, 1.1, 0), t0=2.0), ph.Orbit.from_elements(1.0, a=2.0, e=0.1, j2=1e-3, radius=1.0),
          ph.Orbit.table([0, 1], [(1, 0, 0), (0, 1, 0)], [(0, 1, 0), (-1, 0, 0)], mu=1.0)]


@pytest.mark.parametrize("orbit", ORBITS, ids=lambda orbit: orbit.kind)
def test_orbits_are_values(orbit):
    for again in (pickle.loads(pickle.dumps(orbit)), copy.deepcopy(orbit)):
        assert again == orbit and hash(again) == hash(orbit) and repr(again) == repr(orbit)
        np.testing.assert_array_equal(again.at(0.5)[0], orbit.at(0.5)[0])
    assert orbit != ORBITS[0] or orbit is ORBITS[0]
    if orbit.kind != "table":
        assert eval(repr(orbit), {"polhode": ph}) == orbit


@pytest.mark.parametrize(("make", "words"), [
    (lambda: ph.Orbit(0.0, (1, 0, 0), (0, 1, 0)), "mu: must be positive"),
    (lambda: ph.Orbit(1.0, (0, 0, 0), (0, 1, 0)), "r0: must be not the centre"),
    (lambda: ph.Orbit(1.0, (1, 0, np.nan), (0, 1, 0)), "r0: must be finite"),
    (lambda: ph.Orbit(1.0, (1, 0), (0, 1, 0)), "r0: must be of shape"),
    (lambda: ph.Orbit.from_elements(1.0, a=1.0, e=1.2), "a: must be left out with e >= 1"),
    (lambda: ph.Orbit.from_elements(1.0, a=1.0, e=-0.1), "e: must be at least 0"),
    (lambda: ph.Orbit.from_elements(1.0, e=0.1), "one of them"),
    (lambda: ph.Orbit.from_elements(1.0, a=1.0, periapsis_distance=1.0), "one of them"),
    (lambda: ph.Orbit.from_elements(1.0, periapsis_distance=-1.0), "periapsis_distance: must be positive"),
    (lambda: ph.Orbit.from_elements(1.0, periapsis_distance=1.0, e=2.0, anomaly=2.2), "asymptotes"),
    (lambda: ph.Orbit.from_elements(1.0, periapsis_distance=1.0, j2=1e-3), "radius: must be positive"),
    (lambda: ph.Orbit.from_elements(1.0, periapsis_distance=1.0, e=1.0, j2=1e-3, radius=1.0), "j2: must be left out"),
    (lambda: ph.Orbit.table([0, 0], np.eye(3)[:2], np.eye(3)[:2]), "t: must be increasing"),
    (lambda: ph.Orbit.table([0], np.eye(3)[:1], np.eye(3)[:1]), "at least two"),
    (lambda: ph.Orbit.table([0, 1], np.eye(3), np.eye(3)[:2]), "one row"),
    (lambda: ph.Orbit(1.0, (1, 0, 0), (0, 1, 0)).at(np.inf), "t: must be finite")])
def test_what_is_refused(make, words):
    with pytest.raises(ph.InvalidInput, match=words):
        make()
