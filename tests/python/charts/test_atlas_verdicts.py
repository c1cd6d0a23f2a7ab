"""The atlas's truth and its verdicts."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import polhode as ph
from polhode._harness.truth import attitude_errors, compute_errors
from polhode.atlas import FAMILIES, claims, scenes
from polhode.atlas.case import Case, key, stored, truth_of
from polhode.atlas.entrants import entrants
from polhode.atlas.families import damping, racket, scales, sleeping, step
from polhode.atlas.family import Point, to_short
from polhode.atlas.results import FamilyResult

WHO = {entrant.name: entrant for entrant in entrants()}
BY_NAME = {family.name: family for family in FAMILIES}


# truth


def angle(q, r):
    q, r = np.atleast_2d(q), np.atleast_2d(r)
    along = np.sum(q * r, axis=1)
    d = np.sign(along)[:, None] * q - r
    vector = r[:, 3:] * d[:, :3] - d[:, 3:] * r[:, :3] - np.cross(r[:, :3], d[:, :3])
    return 2 * np.arctan2(np.linalg.norm(vector, axis=1), np.abs(along)).max()


def test_the_stored_truth_is_that_of_the_scenes_where_both_are():
    table = np.load(Path(ph._core.__file__).parent / "scenes/reference/S9.npz")
    rows = truth_of("spin-up", scenes.spin_up(1e2))
    assert np.abs(rows.omega - table["omega"][::100]).max() < 1e-14
    assert angle(rows.attitude, table["attitude"][::100]) < 1e-14
    table = np.load(Path(ph._core.__file__).parent / "scenes/reference/S5c.npz")
    chaos = stored("chaos")
    assert angle(chaos[:61, 3:], table["attitude"][::10]) < 1e-9   # the start was rounded: chaos makes 1e-16 that


def derivative(scene):
    """Euler's equations and the quaternion's, written out."""
    inertia = np.diag(scene.inertia.matrix)

    def rate(t, y):
        w, (x, y_, z, s) = y[:3], y[3:]
        torque = np.cross(inertia * w, w)
        for one in scene.torques:
            if isinstance(one, ph.torques.Gravity):
                up = np.array([2 * (x * z - s * y_), 2 * (y_ * z + s * x),
                               1 - 2 * (x * x + y_ * y_)])   # e_z, body axes
                torque = torque - one.weight * np.cross(one.arm, up)
            else:
                torque = torque - one.matrix @ w
        turn = [s * w[0] + y_ * w[2] - z * w[1], s * w[1] + z * w[0] - x * w[2], s * w[2] + x * w[1] - y_ * w[0]]
        return np.concatenate([torque / inertia, 0.5 * np.array([*turn, -(x * w[0] + y_ * w[1] + z * w[2])])])

    return rate


@pytest.mark.parametrize(
    ("family", "case", "within"),
    [
        ("damping", scenes.damped(1e3), 1e-6),
        ("gimbal", scenes.gimbal("top", 0.03), 1e-9),
        ("gimbal", scenes.gimbal("free", 1e-3), 1e-9),
    ],
)
def test_scipy_agrees_with_the_stored_truth(family, case, within):
    truth, scene = truth_of(family, case), case.scene
    rate, start = derivative(scene), np.concatenate([scene.omega, scene.attitude])
    method, rtol = ("Radau", 1e-8) if family == "damping" else ("DOP853", 1e-11)
    answer = solve_ivp(rate, (0, scene.times[-1]), start, method=method, t_eval=scene.times, rtol=rtol, atol=rtol)
    assert np.abs(answer.y[:3].T - truth.omega).max() < within * 10
    assert angle(answer.y[3:].T, truth.attitude) < within


def test_every_case_has_its_truth():
    wanted = {
        "racket": map(scenes.racket, scenes.RACKET), "long": map(scenes.long, scenes.LONG),
        "damping": map(scenes.damped, scenes.STIFF), "spin-up": map(scenes.spin_up, scenes.SPIN_UP),
        "gimbal": [scenes.gimbal(kind, d) for kind in ("free", "top") for d in scenes.GIMBAL],
        "near": [scenes.near(kind, gap) for kind in ("sphere", "symmetric") for gap in scenes.NEAR],
    }
    for family, cases in wanted.items():
        for case in cases:
            assert stored(key(family, case)).shape == (case.scene.times.size, 7)
    assert stored("sleeping").shape == (len(scenes.SLEEPING),)
    assert stored("wheel").shape == (len(scenes.WHEEL),)


def test_the_wheel_keeps_the_turn_above_its_critical_momentum_and_leaves_it_below():
    angles = dict(zip(scenes.WHEEL, stored("wheel"), strict=True))
    assert all(angle < 1e-4 for excess, angle in angles.items() if excess >= 1e-3)
    assert all(angle > 1e-2 for excess, angle in angles.items() if excess <= -1e-3)
    # Two steady turns branch off at the angle where the energies' curvature vanishes: its size grows as the root of s.
    assert angles[-0.1] / angles[-0.01] == pytest.approx(10**0.5, rel=0.2)


def test_the_first_flips_follow_the_logarithm_of_the_closeness():
    flips = stored("racket/flips")
    gaps = np.diff(flips[2:, 0]) / np.log(100.0)   # a hundred times closer: later by ln(100) / rate
    rate = 5 * math.sqrt((0.4 - 0.2) * (0.52 - 0.4) / (0.2 * 0.52))   # of growth, omega near the intermediate axis
    assert np.abs(gaps * rate - 1).max() < 1e-6


# what a flip is


@pytest.mark.parametrize("shift", [0.0, 1e-9, -3e-4, 0.04, -0.3])
def test_a_flip_is_found_where_it_is(shift):
    t = 3.0 + np.arange(-50, 51) * 0.01
    motion = type("M", (), {"t": t, "omega": np.outer(-5 * np.tanh(2.4 * (t - 3.0 - shift)), [0, 1, 0])})
    assert abs(racket.find_flip(motion, 3.0, -12.0) - shift) < 1e-7


def test_no_flip_is_not_a_number():
    t = 3.0 + np.arange(-50, 51) * 0.01
    motion = type("M", (), {"t": t, "omega": np.tile([0.0, 5.0, 0.0], (101, 1))})
    assert math.isnan(racket.find_flip(motion, 3.0, -12.0))


def test_tilt_is_right_where_it_is_small():
    for theta in (1e-9, 1e-3, 1.0, math.pi - 1e-3):
        q = np.array([math.sin(theta / 2) * 0.6, math.sin(theta / 2) * 0.8, 0.0, math.cos(theta / 2)])
        assert scenes.tilt(q) == pytest.approx(theta, rel=1e-12)


# verdicts


def points(**values):
    """One point for each x: a value, or None for a run that broke off."""
    name = next(iter(values))
    return [Point(x, "", {} if v is None else {name: v}, "broke" if v is None else "",
                  "failed" if v is None else "answered")
            for x, v in values[name].items()]


def level(family, found):
    return BY_NAME[family].judge(found).level


def test_thresholds_are_where_they_are_said_to_be():
    for right, said in ((0.0982, "holds"), (0.0981, "degrades"), (0.0123, "degrades"), (0.0122, "fails"),
                        (0.0, "fails")):
        found = points(right={1.0: 0.5, 0.1: right})
        for p in found:
            p.values["kept"] = 1.0
        assert level("step", found) == said
    for error, flip, said in ((1e-9, 0.0, "holds"), (2e-9, 1e-3, "degrades"), (2e-9, -2e-3, "fails"),
                              (3.0, math.nan, "fails")):
        found = points(error={1e-1: 1e-12, 1e-2: error})
        for p in found:
            p.values["flip"] = flip
        assert level("racket", found) == said
    for near, said in ((1.9e-6, "holds"), (2.1e-6, "degrades"), (0.09, "degrades"), (0.11, "fails"), (None, "fails")):
        assert level("gimbal", points(error={0.5: 1e-6, 1e-3: near})) == said
    for error, energy, said in ((1e-7, 0.0, "holds"), (2e-7, 1.0, "degrades"), (2.0, 1e-3, "degrades"),
                                (2.0, 2e-3, "fails")):
        found = points(error={1e2: 1e-12, 1e4: error})
        for p in found:
            p.values |= {"energy": energy, "angular_momentum": 0.0}
        assert level("long", found) == said
    for family, good, bad in (("near", 1e-9, 0.1), ("spin-up", 1e-6, 0.1)):
        assert [level(family, points(error={1.0: e})) for e in (good, 2 * good, bad, 2 * bad, None)] == \
            ["holds", "degrades", "degrades", "fails", "fails"]
    assert [level("chaos", points(horizon={1e-9: h})) for h in (180.0, 179.0, 60.0, 59.0, None)] == \
        ["holds", "degrades", "degrades", "fails", "fails"]
    assert [level("scales", points(error={150.0: e})) for e in (0.0, 1e-12, 2e-12)] == ["holds", "holds", "fails"]
    assert ([level("norm", points(norm={0.1: e})) for e in (1e-15, 2e-15, 1e-6, 2e-6)]
            == ["holds", "degrades", "degrades", "fails"])
    assert ([level("damping", points(steps={10.0: 50, 1e6: n})) for n in (10_000, 10_001, None)]
            == ["holds", "degrades", "fails"])
    askew = damping.judge(points(steps={damping.ASKEW: None, 10.0: 50, 1e6: 60}))
    assert (askew.level, askew.text) == ("fails", "not S7b")
    assert damping.judge(points(steps={10.0: 50, 1e6: None})).text == "to c = 1e1"


def test_a_refused_scale_is_not_a_wrong_one():
    found = points(error={60.0: 0.0, 150.0: None})
    found[1].values["named"] = 1.0
    assert level("scales", found) == "degrades"
    found[1].values["named"] = 0.0   # a NaN
    assert level("scales", found) == "fails"


def test_the_sleeping_tops_verdict_is_about_the_side():
    def top(**tilts):
        return [Point(x, "", {"tilt": t, "true": true, "off": abs(t / true - 1)}) for x, (t, true) in
                zip((0.1, 1e-5, -1e-3), tilts.values(), strict=True)]

    good, close, fallen = (2.4e-6, 2.4e-6), (2.1e-4, 2.1e-4), (0.0894, 0.0894)
    assert sleeping.judge(top(a=good, b=close, c=fallen)).level == "holds"
    assert sleeping.judge(top(a=good, b=(9e-5, 2.1e-4), c=(0.07, 0.0894))).level == "degrades"
    for wrong, text in (({"a": (0.5, 2.4e-6), "b": close, "c": fallen}, "falls"),
                        ({"a": good, "b": close, "c": (1e-5, 0.0894)}, "stays up")):
        verdict = sleeping.judge(top(**wrong))
        assert (verdict.level, verdict.text) == ("fails", text)


@pytest.mark.parametrize("family", FAMILIES, ids=lambda f: f.name)
def test_what_was_not_tried_is_not_judged(family):
    refused = family.judge([Point(1.0, status="refused", why="not mine")])
    assert (refused.level, refused.why) == ("none", "not mine")
    assert family.judge([Point(1.0, status="left out", why="too slow")]).level == "unknown"


def test_families_say_what_they_are():
    assert len({f.name for f in FAMILIES}) == len(FAMILIES) == 12
    for f in FAMILIES:
        assert all((f.title, f.sweeps, f.truth, f.holds, f.degrades, f.about, f.summary, f.x_label, f.y_label))
        assert f.about.count(". ") in (1, 2, 3, 4) and f.about.endswith("."), f.name   # a short paragraph


@pytest.mark.parametrize(("value", "text"), [(2.3e-5, "2e-5"), (0.12, "0.1"), (42.4, "42"), (12345.0, "1e4"),
                                             (0.0, "0"),
                                             (math.inf, "inf"), (math.nan, "-"), (0.0123, "1e-2"), (9.6, "10")])
def test_short_numbers(value, text):
    assert to_short(value) == text


@pytest.mark.parametrize(("count", "text"), [(35, "35"), (3500, "3.5k"), (799_000, "799k"), (1_545_000, "1.5M")])
def test_few_digits_of_a_count(count, text):
    assert damping.to_few(count) == text


def test_cases_of_scenes_that_are_stored_take_their_truth():
    assert truth_of("damping", Case(1.0, ph.Scene.load("S7b"))).kind == "stored"


def test_a_stated_error_that_is_too_small_is_found():
    def found(**values):
        result = FamilyResult(BY_NAME["near"], True, 2.0, {"solve": [Point(0.1, "sphere", values)]})
        return [s for s in claims.find_broken([result]) if "states" in s]

    assert (found(error=2e-12, stated=1e-12)
            == ["solve, near, at 0.1 sphere: states an error of 1.0e-12, but the error is 2.0e-12"])
    assert not found(error=1e-12, stated=1e-12) and not found(error=2e-12)   # nothing stated, nothing claimed


def test_a_chaotic_answer_that_claims_too_much_fails():
    def judged(**values):
        return BY_NAME["chaos"].judge([Point(1e-9, "tolerance", {"horizon": 250.0, "lost": 1.0, **values})])

    assert judged(claims=1.0, stated=1e-9).text == "overclaims"
    assert judged(claims=0.0, stated=1e-9).level == "holds" and judged(claims=1.0, stated=3.0).level == "holds"


def test_errors_sample_by_sample_are_those_of_the_charts():
    case = scenes.racket(1e-2)
    truth, motion = truth_of("racket", case), ph.solve(case.scene, method="rk4", step=0.03)
    errors = attitude_errors(motion.attitude, truth)
    assert errors.shape == (101,)
    assert errors.max() == compute_errors(motion.omega, motion.attitude, truth).attitude > 1e-4
    rotated = np.array([[math.sin(0.15), 0, 0, math.cos(0.15)]])
    other_sign = truth._replace(attitude=np.array([[0.0, 0, 0, -1]]))
    assert attitude_errors(rotated, other_sign)[0] == pytest.approx(0.3, rel=1e-14)


def test_the_three_of_the_longest_step_tell_conserving_from_being_right():
    omega, times = np.array([1.0, 1.0, 1.0]) / math.sqrt(3), 2 * math.pi * np.arange(1, 101)
    scene = ph.Scene(inertia=(0.2, 0.4, 0.52), omega=omega, times=times)
    rates, attitudes = ph.FreeMotion((0.2, 0.4, 0.52), omega).at(times)
    truth = truth_of("racket", scenes.racket(1e-1))._replace(omega=rates, attitude=attitudes)
    step_ = 2 * math.pi / 64
    found = {n: step.passes(WHO[n], scene, truth, step_, 5.0) for n in ("ignore", "dmv8", "euler", "rk4")}
    assert found == {"ignore": {"bounded", "kept"}, "dmv8": {"bounded", "kept", "right"}, "euler": set(),
                     "rk4": {"bounded", "kept", "right"}}


@pytest.mark.parametrize(("faster", "held"), [(1.04, {"bounded", "kept"}), (1.06, {"bounded"}), (1.4, {"bounded"}),
                                              (1.45, set()), (0.96, {"bounded", "kept"}), (0.94, {"bounded"})])
def test_kept_is_within_ten_per_cent_and_bounded_within_a_factor_two(faster, held, monkeypatch):
    """Rates k times as large have k times the momentum and k^2 times the energy; the attitude is lost in any case."""
    times = 2 * math.pi * np.arange(1, 21)
    scene = ph.Scene(inertia=(0.2, 0.4, 0.52), omega=np.ones(3) / math.sqrt(3), times=times)
    rates, attitudes = ph.FreeMotion((0.2, 0.4, 0.52), scene.omega).at(times)
    truth = truth_of("racket", scenes.racket(1e-1))._replace(omega=rates, attitude=attitudes)
    lost = attitudes @ np.array([[0, 0, 0, 1], [0, 0, 1, 0], [0, -1, 0, 0], [-1, 0, 0, 0]])   # half a turn away
    motion = type("M", (), {"omega": faster * rates, "attitude": lost})
    monkeypatch.setattr(step, "run", lambda *_: motion)
    assert step.passes(WHO["rk4"], scene, truth, 0.1, 1.0) == held


def test_an_attitude_is_lost_where_it_is_off_by_more_than_a_tenth(monkeypatch):
    """A tenth of a radian itself is not lost yet: the atlas says "off by more"."""
    case = scenes.racket(1e-1)
    off = np.zeros(case.scene.times.size)
    off[40], off[60] = 0.1, 0.1001
    monkeypatch.setattr(racket, "attitude_errors", lambda *_: off)
    points = list(racket.measure(WHO["exact"], True, 60.0))
    assert points[0].values["lost"] == case.scene.times[60]


@pytest.mark.parametrize("what", ["inertia", "rates"])
def test_scaled_scenes_are_the_same_motion(what):
    plain, far = scales.scaled("S4", what, 0), scales.scaled("S4", what, 12)
    heavier = far.inertia.matrix[0, 0] / plain.inertia.matrix[0, 0]
    faster = far.omega[2] / plain.omega[2]
    assert (heavier > 0.9e12, faster > 0.9e12) == ((True, False) if what == "inertia" else (False, True))
    arms = [scene.torques[0].weight * scene.torques[0].arm[2] for scene in (plain, far)]
    assert arms[1] == arms[0] * heavier * faster**2 and far.times[-1] * faster == plain.times[-1]
    assert math.log2(heavier * faster) % 1 == 0   # a power of two
