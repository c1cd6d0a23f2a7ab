"""Shadows on orbits: edges against 50 digits by the true anomaly, and motions through them against 24 digits."""

import json
import math
import pathlib
import pickle

import eclipse_truth
import numpy as np
import pytest

import polhode as ph

DATA = json.loads((pathlib.Path(__file__).parents[2] / "reference" / "eclipse.json").read_text())
CASES = {case["name"]: case for case in DATA["cases"]}
PLATE = ph.Plate(**DATA["plate"])
SUN = DATA["sun"]


def light(orbit, shadow, sun=SUN, **more):
    return ph.torques.SolarPressure(PLATE, sun, DATA["pressure"], orbit=orbit, shadow=shadow, **more)


def scene_of(case, **more):
    parts = dict(inertia=DATA["inertia"], omega=DATA["omega"], attitude=np.array(DATA["attitude"]), times=case["times"],
                 torques=[light(ph.Orbit(1.0, case["r0"], case["v0"]), case["shadow"])])
    parts["attitude"] /= np.linalg.norm(parts["attitude"])
    return ph.Scene(**{**parts, **more})


def find_errors(motion, states):
    states = np.array(states, float)
    rates = np.abs(motion.omega - states[:, :3]).max() / np.linalg.norm(states[:, :3], axis=1).max()
    q = motion.attitude * np.sign(np.sum(motion.attitude * states[:, 3:], axis=1))[:, None]
    return rates, 2 * np.linalg.norm(q - states[:, 3:], axis=1).max()


def random_conics():
    rng = np.random.default_rng(20261125)
    for e in (0.0, 1e-9, 0.1, 0.73, 0.97, 1 - 1e-9, 1.0, 1 + 1e-9, 1.5, 4.2):
        for _ in range(2):
            yield e, rng.uniform(0, 2 * np.pi, 4), rng.uniform(0.3, 0.95), rng.normal(size=3)


@pytest.mark.parametrize(("e", "angles", "shadow", "sun"), list(random_conics()))
def test_edges_are_those_of_classical_anomalies(e, angles, shadow, sun):
    node, tip, periapsis, anomaly = angles
    anomaly = (anomaly - np.pi) * (0.9 if e < 1 else 0.4)
    made = ph.Orbit.from_elements(1.0, periapsis_distance=1.0, e=e, inclination=tip, node=node, periapsis=periapsis,
                                  anomaly=anomaly)
    state = made.at(0.0)
    orbit, truth = ph.Orbit(1.0, *state), eclipse_truth.Conic(1.0, *state)
    expected = truth.edges(sun, shadow, looks=90)
    if truth.e < 1:   # in order from the first that enters
        expected = sorted((t + truth.period * (not enters and t < expected[0][0]), enters) for t, enters in expected)
    span = 1.1 * float(truth.period) if truth.e < 1 and truth.period < 1e4 else 300.0
    found = orbit.eclipses(sun, shadow, -span, span)
    times = [t for t, _ in expected if abs(t) < span]
    if truth.e < 1 and truth.period < 1e4:
        times = [t + k * truth.period for k in range(-3, 4) for t, _ in expected]
    edges = found[np.isfinite(found)]
    assert len(found) == 0 or np.all(np.diff(edges) > 0)
    inside = sorted(t for t in times if abs(t) < 0.99 * span)
    assert len([t for t in edges if abs(t) < 0.99 * span]) == len(inside)
    for t in inside:
        nearest = edges[np.argmin(np.abs(edges - float(t)))]
        assert abs(nearest - t) <= 1.01 * np.spacing(abs(float(t)))


def test_edges_on_a_drifting_orbit_have_the_position_on_the_edge():
    orbit = ph.Orbit.from_elements(3.986e14, a=7.1e6, e=0.01, inclination=1.7, node=0.3, j2=1.0826e-3, radius=6378137.0)
    sun, shadow, day = np.array([1.0, 0.4, 0.1]), 6.4e6, 86400.0
    pairs = orbit.eclipses(sun, shadow, 0.0, 30 * day)
    assert 400 < len(pairs) < 450
    s = sun / np.linalg.norm(sun)
    r, v = orbit.at(pairs.ravel())
    along = r @ s
    assert along.max() < 0
    across = np.linalg.norm(r - along[:, None] * s, axis=1)
    # Positions have some units of rounding, and what the rounding of the time moves them.
    assert np.abs(across - shadow).max() < 8 * 7e6 * 2.3e-16 + 7.6e3 * np.spacing(30 * day)
    # And every dark look is in a window, every bright one in none.
    t = np.linspace(0, 30 * day, 20011)
    r, _ = orbit.at(t)
    along = r @ s
    dark = (along < 0) & (np.linalg.norm(r - along[:, None] * s, axis=1) < shadow)
    windows = np.searchsorted(pairs.ravel(), t, side="right") % 2 == 1
    np.testing.assert_array_equal(windows, dark)


def test_a_table_has_its_edges():
    conic = ph.Orbit(1.0, (1.0, 0.0, 0.25), (0.0625, 0.25, -1.0625))
    t = np.linspace(0.0, 20.0, 4001)
    table = ph.Orbit.table(t, *conic.at(t))
    a, b = conic.eclipses(SUN, 0.75, 0.0, 20.0), table.eclipses(SUN, 0.75, 0.0, 20.0)
    np.testing.assert_allclose(b, a, rtol=0, atol=1e-9)
    with pytest.raises(ph.InvalidInput, match="within the table"):
        table.eclipses(SUN, 0.75, 0.0, 21.0)


def circle(height):
    """A circle of radius 1 whose least distance from the axis of the shadow along -x is `height`."""
    return ph.Orbit(1.0, (math.sqrt((1 - height) * (1 + height)), 0.0, height), (0.0, 1.0, 0.0))


def test_an_orbit_that_touches_the_shadow():
    """The window shrinks like a root until it is gone; no edge stays alone."""
    for depth in 10.0 ** -np.arange(1, 17):
        found = circle(0.5).eclipses((1, 0, 0), 0.5 + depth, -4.0, 4.0)
        assert len(found) in (0, 1, 2)
        for begin, end in found:
            # in the plane: sin^2 of the angle from the anti-sun less what the depth allows
            half = math.asin(min(1.0, math.sqrt(depth * (1 + depth) / 0.75)))
            assert (end - begin) == pytest.approx(2 * half, rel=1e-3 if depth > 1e-13 else 1.0)
    assert len(circle(0.5).eclipses((1, 0, 0), 0.5 - 1e-9, -4.0, 4.0)) == 0


def test_a_million_periods():
    orbit = ph.Orbit(1.0, (1, 0, 0), (0, 1, 0))
    found = orbit.eclipses((1, 0, 0), 0.5, 2 * np.pi * 1e6, 2 * np.pi * (1e6 + 1))
    exact = 2 * np.pi * 1e6 + np.pi + 2.449293598294706e-16 * 1e6 + np.pi / 6 * np.array([-1, 1])
    assert len(found) == 1
    np.testing.assert_allclose(found[0], exact, rtol=4e-16)
    assert len(orbit.eclipses((1, 0, 0), 0.5, 0.0, 2 * np.pi * 1e5)) == 100_000


def test_far_out_on_a_hyperbola():
    orbit = ph.Orbit.from_elements(1.0, periapsis_distance=1.0, e=1.5)
    found = orbit.eclipses((1, 0.2, 0), 0.5, -1e9, 1e9)
    r, _ = orbit.at(found[np.isfinite(found)])
    s = np.array([1, 0.2, 0]) / math.hypot(1, 0.2)
    np.testing.assert_allclose(np.linalg.norm(r - np.outer(r @ s, s), axis=1), 0.5, rtol=1e-14)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9, 1e-12])
def test_motions_have_the_error_that_they_state(name, accuracy):
    case = CASES[name]
    motion = ph.solve(scene_of(case), accuracy=accuracy, leave_out=False)
    rates, angle = find_errors(motion, case["states"])
    assert motion.success and motion.error_kind == "bounded"
    assert max(rates, angle) <= motion.error <= accuracy


def test_dark_pieces_have_closed_forms():
    given = scene_of(CASES["four revolutions"])
    text = str(ph.plan(given, accuracy=1e-9, leave_out=False))
    assert "SolarPressure in sunlight" in text and "7 pieces" in text and "3 pieces have closed forms" in text
    alone = given.replace(times=[1.5], t0=1.0, omega=(0.1, 0.2, 1.0))   # between two edges
    assert ph.solve(alone, accuracy=1e-12).plan.method == "exact"


def test_the_shadow_is_a_list_of_windows():
    case = CASES["four revolutions"]
    orbit = ph.Orbit(1.0, case["r0"], case["v0"])
    given = scene_of(case)
    dark = orbit.eclipses(SUN, case["shadow"], 0.0, 25.0)
    lit = [(-np.inf, dark[0, 0]), *zip(dark[:-1, 1], dark[1:, 0], strict=True), (dark[-1, 1], np.inf)]
    plain = given.replace(torques=[ph.torques.During(ph.torques.SolarPressure(PLATE, SUN, DATA["pressure"]), lit)])
    a, b = ph.solve(given, accuracy=1e-9), ph.solve(plain, accuracy=1e-9)
    np.testing.assert_array_equal(a.omega, b.omega)
    np.testing.assert_array_equal(a.attitude, b.attitude)
    np.testing.assert_array_equal(dark.ravel(), np.array([float(t) for t, _ in case["edges"]]))


def test_the_later_side_counts_at_an_edge():
    case = CASES["four revolutions"]
    enter, leave = (float(t) for t, _ in case["edges"][:2])
    given = scene_of(case)
    for t, dark in ((enter, True), (np.nextafter(enter, 0), False), (leave, False), (np.nextafter(leave, 0), True)):
        assert (not given.torque(t, (0, 0, 1), (0, 0, 0, 1)).any()) == dark
    for times in ([enter], [leave], [enter, np.nextafter(enter, 9)], [np.nextafter(leave, 0), leave, 3.0]):
        motion = ph.solve(given.replace(times=times), accuracy=1e-9)
        far = ph.solve(given.replace(times=[*times, 20.0]), accuracy=1e-9)
        np.testing.assert_allclose(motion.omega, far.omega[:len(times)], rtol=0, atol=3e-9)
    # A start on an edge, or a unit beside it, in both directions.
    whole = ph.solve(given.replace(times=[0.0, enter, 1.5, leave, 4.0]), accuracy=1e-12)
    for i, t in ((1, enter), (3, leave)):
        for start in (np.nextafter(t, 0), t, np.nextafter(t, 9)):
            again = ph.solve(given.replace(t0=start, omega=whole.omega[i], attitude=whole.attitude[i],
                                           times=[0.0, 4.0]), accuracy=1e-11)
            assert again.success
            np.testing.assert_allclose(again.omega, whole.omega[[0, 4]], rtol=0, atol=4e-11)


def test_half_of_the_outputs():
    given = scene_of(CASES["four revolutions"])
    both = ph.solve(given, accuracy=1e-9)
    alone = ph.solve(given.replace(want=["omega"]), accuracy=1e-9)
    np.testing.assert_allclose(alone.omega, both.omega, atol=2e-9)


def test_torques_in_the_light_are_values(tmp_path):
    case = CASES["four revolutions"]
    orbit = ph.Orbit(1.0, case["r0"], case["v0"])
    torque = light(orbit, 0.75)
    again = pickle.loads(pickle.dumps(torque))
    assert again == torque and hash(again) == hash(torque) and repr(again) == repr(torque)
    assert torque != light(orbit, 0.5) and torque.sunlight == (orbit, tuple(SUN), 0.75) and torque.windows is None
    given = scene_of(case)
    given.save(tmp_path / "scene.toml")
    text = (tmp_path / "scene.toml").read_text()
    assert 'kind = "solar_pressure"' in text and 'orbit = "main"' in text and "shadow = 0.75" in text
    read = ph.Scene.load(tmp_path / "scene.toml")
    assert read == given and pickle.loads(pickle.dumps(given)) == given
    motion = ph.solve(given, accuracy=1e-9)
    np.testing.assert_array_equal(ph.solve(read, accuracy=1e-9).omega, motion.omega)
    motion.save(tmp_path / "motion.npz")
    assert ph.load(tmp_path / "motion.npz").scene == given


def test_columns_and_events_go_through_shadows():
    case = CASES["four revolutions"]
    given = scene_of(case)
    columns = ph.solve(given, accuracy=1e-9, sensitivity=("omega", "torques.0.pressure")).sensitivity
    step = 1e-4
    ends = []
    for sign in (1, -1):
        own = ph.torques.SolarPressure(PLATE, SUN, DATA["pressure"] * (1 + sign * step),
                                       orbit=ph.Orbit(1.0, case["r0"], case["v0"]), shadow=0.75)
        ends.append(ph.solve(given.replace(torques=[own]), accuracy=1e-13).omega)
    slope = (ends[0] - ends[1]) / (2 * step * DATA["pressure"])
    np.testing.assert_allclose(columns.d_omega[:, :, -1], slope, atol=1e-6 * np.abs(slope).max())
    with pytest.raises(ph.InvalidInput, match="the windows of torques.0 follow from its orbit"):
        ph.solve(given, accuracy=1e-9, sensitivity="torques.0.windows")


ORBIT = ph.Orbit(1.0, (1.0, 0, 0), (0, 1.1, 0))


def solve_with(torque):
    return ph.Scene(inertia=(1, 2, 3), omega=(0, 0, 1), torques=[torque], times=[1.0])


@pytest.mark.parametrize(("call", "words"), [
    (lambda: light(None, 0.5), r"must be given together, got shadow 0\.5 alone"),
    (lambda: light(ORBIT, None), "must be given together, got orbit alone"),
    (lambda: light(1.0, 0.5), "SolarPressure.orbit: must be an Orbit, got float"),
    (lambda: light(ORBIT, 0.0), "shadow: must be positive and finite, got 0"),
    (lambda: light(ORBIT, np.nan), "shadow: must be positive and finite, got nan"),
    (lambda: light(ORBIT, 0.5, sun=(0, 0, 0)), "sun: must be finite and not 0"),
    (lambda: solve_with(light(ORBIT, 1.5)), r"at most the least distance of the orbit, 1(\.0)? m, got 1\.5"),
    (lambda: ORBIT.eclipses((1, 0, 0), 0.5, 2.0, 1.0), r"end: must be at or after the begin, 2(\.0)?, got 1"),
    (lambda: ORBIT.eclipses((0, 0, 0), 0.5, 0.0, 1.0), "sun: must be finite and not 0"),
    (lambda: ORBIT.eclipses((1, 0, 0), -0.5, 0.0, 1.0), r"shadow: must be positive and finite, got -0\.5"),
    (lambda: ph.torques.During(light(ORBIT, 0.5), (0, 1)), "a torque without windows"),
])
def test_wrong_shadows_are_refused(call, words):
    with pytest.raises(ph.InvalidInput, match=words):
        call()


@pytest.mark.parametrize("size", [1e-310, 1e-200, 1e200, 1e308])
def test_the_sun_is_a_direction_of_any_length(size):
    found, expected = (circle(0.5).eclipses((x, x, 0), 0.75, 0.0, 9.0) for x in (size, 1.0))
    assert len(found) > 0
    np.testing.assert_array_equal(found, expected)


def test_searches_without_an_end_are_refused():
    """Elements or squares that overflow, revolutions that a double does not count, a shadow too thin for the orbit."""
    with pytest.raises(ph.InvalidInput, match="of elements that a double holds"):
        ph.Orbit(1.0, (1e200, 0, 0), (0, 1e-100, 0))
    far = ph.Orbit.from_elements(1.0, periapsis_distance=1e160, e=1.0)
    with pytest.raises(ph.InvalidInput, match="squares are finite"):
        far.eclipses((1, 0, 0), 1e159, 0.0, 1.0)
    with pytest.raises(ph.InvalidInput, match="1e15 revolutions"):
        circle(0.5).eclipses((1, 0, 0), 0.5, -1e155, -1e155)
    thin = ph.Orbit(7.8, (0.138, 0.011, -0.706), (2.6e-127, 3.6e-127, -4.0e-127))
    with pytest.raises(ph.InvalidInput, match="too small for so long an orbit"):
        thin.eclipses((0.01, 0.002, 0.009), 0.4 * thin.periapsis_distance, -8.0, 9.0)
