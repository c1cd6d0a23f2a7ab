"""Charts: errors held against mpmath, what the sweep does with failures and budgets, the words, the files."""

import json
import re
import sys
from pathlib import Path

import mpmath
import numpy as np
import pytest

import polhode as ph
from polhode._harness.truth import Truth, compute_errors, find_truth
from polhode.charts import chart, runners
from polhode.charts.candidate import Answer, Candidate, Failure, tolerances
from polhode.charts.candidates import candidates
from polhode.charts.findings import (
    dominated,
    front,
    headline,
    held_by_stability,
    stalls,
    time_ratios,
    time_to_reach,
    under_headline,
    without_answer,
)
from polhode.charts.measure import Point, SceneResult, measure
from polhode.charts.results import document
from polhode.charts.runners import InProcess

TINY = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(1.0, 2.0, 3.0), times=np.linspace(0, 1, 5), name="tiny")


def silent(*_):
    pass


def stored(name):
    return find_truth(ph.Scene.load(name))


# errors


def angle_with_mpmath(q, r):
    with mpmath.workdps(60):
        q, r = ([mpmath.mpf(float(x)) for x in row] for row in (q, r))
        along = abs(mpmath.fdot(q, r)) / mpmath.sqrt(mpmath.fdot(q, q) * mpmath.fdot(r, r))
        return float(2 * mpmath.acos(min(along, mpmath.mpf(1))))


@pytest.mark.parametrize("angle", [1e-15, 1e-12, 1e-8, 1e-3, 0.5, 3.0])
def test_the_angle_is_right_at_every_size(angle):
    rng = np.random.default_rng(5)
    r = rng.normal(size=(20, 4))
    r /= np.linalg.norm(r, axis=1)[:, None]
    axis = rng.normal(size=(20, 3))
    axis *= np.sin(angle / 2) / np.linalg.norm(axis, axis=1)[:, None]
    x, w = r[:, :3], r[:, 3:]
    c = np.cos(angle / 2)
    turned = np.hstack([w * axis + c * x + np.cross(x, axis), c * w - np.sum(x * axis, axis=1)[:, None]])
    turned *= rng.choice([-1.0, 1.0], (20, 1))   # q and -q are one attitude
    for one, other in zip(turned, r, strict=True):
        truth = Truth(np.ones((1, 3)), other[None], "made", "", 0.0, None)
        found = compute_errors(np.ones((1, 3)), one[None], truth)
        # 1.2e-16: the truth is a float64 quaternion, not quite unit, which is what acos of the products sees.
        assert abs(found.attitude - angle_with_mpmath(one, other)) < 1e-14 * angle + 1.2e-16
        assert found.omega == 0


def test_rates_are_relative_to_the_largest():
    truth = Truth(np.array([[3.0, 0, 4.0], [0, 0, 1.0]]), np.tile([0.0, 0, 0, 1], (2, 1)), "made", "", 0.0, None)
    errors = compute_errors(np.array([[3.0, 0, 4.0], [0.5, 0, 1.0]]), truth.attitude, truth)
    assert errors.omega == 0.1 and errors.attitude == 0 and errors.largest == 0.1
    assert np.isnan(compute_errors(np.full((2, 3), np.nan), truth.attitude, truth).largest)


# truth


def test_stored_truth_serves_only_its_own_scene():
    truth = stored("S5")
    assert truth.kind == "stored" and truth.floor == 1.9e-14 and truth.omega.shape == (201, 3)
    other = ph.Scene.load("S5").replace(omega=(0.3, 0.2, 3.1), times=np.linspace(0, 1, 11))
    made = find_truth(other)
    assert made.kind == "made" and made.floor is None and 0 < made.uncertainty < 1e-11


# Those whose stored truth was made from the same float64 numbers: not from angles or degrees in the scene's file.
@pytest.mark.parametrize("name", ["S1", "S2", "S3", "S5", "S6", "S7", "S9", "Z1"])
def test_a_made_truth_is_as_good_as_it_says(name):
    scene = ph.Scene.load(name)
    made = find_truth(scene.replace(name="mine"))
    error = compute_errors(made.omega, made.attitude, stored(name)).largest
    assert made.kind == "made" and "long double, checked by order" in made.source
    # Its inputs' rounding moves the answer more. The racket asks for more than 64 bits: 2e-7 was measured.
    assert error <= made.uncertainty < (1e-6 if name == "S2" else 0.3 * stored(name).floor)


def test_a_made_truth_of_what_has_no_series_is_checked_by_another_method():
    scene = TINY.replace(torques=[ph.torques.Custom(lambda t, w, q: (-0.01 * w[0], -0.02 * w[1], -0.03 * w[2]))])
    made = find_truth(scene)
    known = find_truth(scene.replace(torques=[ph.torques.Damping((0.01, 0.02, 0.03))]))
    error = compute_errors(made.omega, made.attitude, known).largest
    assert "checked by" in made.source and "long double" not in made.source and "long double" in known.source
    assert 0 < error <= made.uncertainty < 3e-11   # about 1e-11, by the cubic that radau draws between its steps


# candidates


def test_every_method_takes_part():
    own = [c.name for c in candidates() if c.family in ("method", "cheap")]
    assert own == [m["name"] for m in ph.methods()]
    assert "peer" not in {c.family for c in candidates(with_peers=False)}


def test_fixed_steps_land_on_the_samples():
    scene = ph.Scene.load("S1")   # a sample a second, 3.7 rad/s
    for candidate in candidates(with_peers=False):
        if candidate.swept == "step":
            values = [value for _, value in candidate.settings(scene)]
            assert values[0] == 0.25 and all(1 / h == round(1 / h) for h in values) and len(values) > 5


@pytest.mark.parametrize(("name", "exact"), [("S1", "FreeMotion"), ("S4", "HeavyTop"), ("S5", None), ("S7", None)])
def test_closed_forms_take_part_where_they_apply(name, exact):
    scene = ph.Scene.load(name)
    found = [c for c in candidates() if c.family == "exact" and not c.refuses(scene)]
    assert [c.name for c in found] == ([exact] if exact else [])
    for candidate in found:
        answer = candidate.run(scene, 0.0, None)
        assert compute_errors(answer.omega, answer.attitude, stored(name)).largest < 1e-14


def test_closed_forms_start_where_and_when_the_scene_does():
    start = {"attitude": np.array([0.1, 0.7, 0.1, 0.7]), "t0": 5.0, "times": np.linspace(4.0, 9.0, 6)}
    top = ph.Scene.load("S4").replace(torques=[ph.torques.Gravity(4.0, (0.0, 0.0, 0.5))], omega=(0.3, 0.1, 6.0),
                                      **start)
    for scene, name in ((TINY.replace(**start), "FreeMotion"), (top, "HeavyTop")):
        answer = next(c for c in candidates() if c.name == name).run(scene, 0.0, None)
        motion = ph.solve(scene, method="rk45", rtol=1e-13)
        truth = Truth(motion.omega, motion.attitude, "made", "", 0.0, None)
        assert compute_errors(answer.omega, answer.attitude, truth).largest < 1e-10


def test_tops_that_have_no_closed_form_are_refused():
    top, refuses_top = ph.Scene.load("S4"), next(c for c in candidates() if c.name == "HeavyTop").refuses
    assert refuses_top(top) == ""
    assert refuses_top(top.replace(inertia=(1.0, 1.1, 0.5))) != ""
    assert refuses_top(top.replace(torques=[ph.torques.Gravity(2.0, (0.1, 0.0, 1.0))])) != ""
    assert refuses_top(top.replace(torques=[])) != ""


@pytest.mark.parametrize("name", ["rk45", "SciPy RK45", "SciPy DOP853"])
def test_a_run_past_its_limit_fails_and_says_so(name):
    candidate = next(c for c in candidates() if c.name == name)
    with pytest.raises(Failure, match="not done within 0 s"):
        candidate.run(ph.Scene.load("S7b"), 1e-6, 0.0)


# the sweep


def fake(run, name="fake", family="method", settings=tolerances(3, 6)):
    return Candidate(name, family, "", settings, lambda scene: lambda value, limit: run(scene, value, limit),
                     lambda scene: "")


def exact(scene, value, limit):
    return Answer(*ph.FreeMotion(scene.inertia, scene.omega).at(scene.times), {"steps": 1})


def test_crashes_nan_and_lateness_are_points_and_the_others_go_on():
    def crash(scene, value, limit):
        raise ZeroDivisionError("of zero")

    def nothing(scene, value, limit):
        return Answer(np.full((5, 3), np.nan), np.full((5, 4), np.nan), {})

    def late(scene, value, limit):
        raise Failure(f"not done within {limit:.2g} s")

    runs = {"crash": crash, "nothing": nothing, "late": late, "exact": exact}
    result = measure(TINY, "", [fake(run, name) for name, run in runs.items()], 2.0, silent)
    whys = {name: [p.why for p in result.points if p.candidate == name] for name in runs}
    assert whys["crash"] == ["ZeroDivisionError: of zero"] * 4
    assert whys["nothing"] == ["returned NaN or infinity"] * 4
    assert whys["late"][0].startswith("not done within")
    assert set(whys["late"][1:]) == {"a looser setting was not done in time"}
    assert whys["exact"] == [""] * 4 and all(p.repeats == 5 and p.error < 1e-12 for p in result.of("exact"))
    assert without_answer(result) == {name: whys[name][0] for name in ("crash", "nothing", "late")}
    told = under_headline(result)
    assert told.endswith(". Not done in time: late") and told.count("late") == 1 and "crash: " in told


def test_what_does_not_fit_the_budget_is_left_out_and_says_so():
    result = measure(ph.Scene.load("S1"), "", candidates(with_peers=False), 0.1, silent)
    left_out = [p for p in result.points if p.left_out]
    assert left_out and all("s were left" in p.why or "not done in time" in p.why for p in left_out)
    failed = [p for p in result.points if not p.answered and not p.left_out]
    assert all(p.why.startswith("not done within") or "not finite" in p.why for p in failed)
    assert result.seconds < 4 and result.of("rk45")
    assert any(note.startswith("leapfrog: ") for note in result.notes)   # with the reason of `method_refusal`
    assert "leapfrog" not in {p.candidate for p in result.points}   # refused by the run, not failed


def test_time_is_the_median_of_what_the_clock_says(monkeypatch):
    runner = InProcess([fake(exact)])
    runner.enter(TINY)
    runner.start("fake")
    ticks = iter([10.0, 18.0])
    monkeypatch.setattr(runners.time, "thread_time", lambda: next(ticks))
    assert runner.clock("fake", 1e-3, 4) == 2.0
    monkeypatch.undo()
    readings = iter([7.0, 5.0, 1.0, 2.0, 4.0, 3.5])   # the first is the first run again, warm
    monkeypatch.setattr(InProcess, "clock", lambda self, name, value, calls: next(readings))
    (point,) = measure(TINY, "", [fake(exact, settings=tolerances(3, 3))], 60.0, silent).points
    assert (point.seconds, point.fastest, point.slowest, point.repeats) == (3.5, 1.0, 5.0, 5)


def test_a_run_that_answers_otherwise_the_second_time_is_a_failure():
    calls = []

    def forgetful(scene, value, limit):
        calls.append(1)
        answer = exact(scene, value, limit)
        return answer if len(calls) == 1 else answer._replace(omega=answer.omega + 1)

    points = measure(TINY, "", [fake(forgetful, settings=tolerances(3, 3))], 2.0, silent).points
    assert [p.why for p in points] == ["another answer the second time"]


# the words


def made_up(points, **changes):
    truth = Truth(np.ones((1, 3)), np.ones((1, 4)), "stored", "", 3e-16, 1e-13)
    return SceneResult(TINY, "made up", truth, points, [], 1.0, **changes)


def curve(name, family, values, errors, seconds, steps=None):
    steps = steps or [round(100 * v**-0.2) for v in values]
    return [Point(name, family, f"{v:g}", v, error=e, seconds=s, repeats=1, stats={"steps": n})
            for v, e, s, n in zip(values, errors, seconds, steps, strict=True)]


VALUES = [10.0**-k for k in range(3, 13)]


def test_time_to_reach_is_a_power_law_along_the_front():
    points = curve("a", "method", [1e-2, 1e-4, 1e-5], [1e-2, 1e-6, 1e-4], [1.0, 100.0, 1000.0])
    assert [p.seconds for p in front(points)] == [1.0, 100.0]
    assert time_to_reach(points, 1e-4) == pytest.approx(10.0)
    assert time_to_reach(points, 1e-2) == 1 and time_to_reach(points, 1e-6) == pytest.approx(100)   # at its ends too
    assert np.isnan(time_to_reach(points, 1e-7)) and time_to_reach(points, 1.0) == 1


def test_stalling_and_stability_are_told_from_plain_convergence():
    times = [1e-3 * 1.6**k for k in range(10)]
    plain = made_up(curve("rk45", "method", VALUES, VALUES, times))
    stuck = made_up(curve("rk45", "method", VALUES, [max(v, 2e-5) for v in VALUES], times))
    held = made_up(curve("rk45", "method", VALUES, [1e-11] * 10, [0.2] * 10, [1_500_000] * 10))
    orders = made_up(curve("taylor", "method", VALUES, VALUES, times, [100] * 10))
    slow = made_up(curve("rk45", "method", VALUES, [1e4 * v for v in VALUES], times))
    assert [stalls(r, "rk45") for r in (plain, stuck, held, slow)] == [False, True, False, False]
    assert [held_by_stability(r, "rk45") for r in (plain, stuck, held, slow)] == [False, False, True, False]
    assert not held_by_stability(orders, "taylor")
    assert headline(stuck) == "No tolerance takes rk45 below 2e-5"
    assert headline(held) == "Stability holds rk45 to 1.5 million steps and 200 ms at every tolerance"
    assert headline(plain).startswith("rk45 reaches 1e-12 in 68.7 ms")


def test_a_method_that_another_beats_everywhere_is_found():
    times = [1e-3 * 1.6**k for k in range(10)]
    quick = curve("rk45", "method", VALUES, VALUES, times)
    slow = curve("slow", "method", VALUES, VALUES, [1.3 * t for t in times])
    near = curve("near", "peer", VALUES, VALUES, [1.2 * t for t in times])
    good = curve("good", "peer", VALUES, [2 * v for v in VALUES], [2 * t for t in times[:-1]] + [1e-4])
    assert dominated(made_up(quick + slow + near)) == {"slow"}
    assert dominated(made_up(quick + good)) == set()
    assert dominated(made_up(curve("wrong", "method", VALUES[:1], [3.0], [1e-9]) + quick)) == {"wrong"}


def test_speed_is_compared_at_equal_error():
    times = [1e-3 * 10 ** (0.2 * k) for k in range(10)]
    own = curve("rk45", "method", VALUES, VALUES, times)
    peer = curve("SciPy RK45", "peer", VALUES[:4], [10 * v for v in VALUES[:4]], [200 * t for t in times[:4]])
    ratios = time_ratios(made_up(own + peer), ["SciPy RK45"])
    # The peer's errors are ten times as large; the first is looser than any of ours, whose quickest point is then
    # enough.
    np.testing.assert_allclose(ratios, [200, *[200 * 10**0.2] * 3], rtol=1e-12)
    assert "SciPy takes 200 to 320 times as long at equal error" in headline(made_up(own + peer))


def test_a_program_is_judged_by_whichever_of_its_candidates_is_fastest_at_each_error():
    times = [1e-3 * 10 ** (0.2 * k) for k in range(10)]
    own = curve("taylor", "method", VALUES, VALUES, times)
    loose = curve("Odeint low", "peer", VALUES[:3], VALUES[:3], [0.5 * t for t in times[:3]])
    tight = curve("Odeint high", "peer", VALUES, VALUES, [2 * t for t in times])
    ratios = time_ratios(made_up(own + loose + tight), ["Odeint low", "Odeint high"])
    np.testing.assert_allclose(ratios, [0.5] * 3 + [2] * 7, rtol=1e-12)
    assert "Odeint takes 0.5 to 2 times as long" in headline(made_up(own + loose + tight))


# the whole


def three(peers):
    return [c for c in candidates(False) if c.name in ("FreeMotion", "rk45", "rk4")]


@pytest.fixture(scope="module")
def charted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("charts")
    said = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys.modules["polhode.charts.chart"], "candidates", three)
        results, content = chart(["S5", TINY], folder, budget=6.5, peers=False,
                                 progress=lambda i, text: said.append(text))
    return folder, results, content, said


def test_files_of_a_chart(charted):
    folder, _, content, said = charted
    assert sorted(p.name for p in folder.iterdir()) == sorted(content["files"])
    assert {"S5.png", "S5.svg", "tiny.png", "overview.png", "which_method.png", "results.json"} <= set(content["files"])
    assert all((folder / name).stat().st_size > 5000 for name in content["files"] if name.endswith(".png"))
    assert "S5: rk45" in said and "pictures: overview" in said
    text = (folder / "S5.svg").read_text()
    assert "rk45" in text and "input rounding 2e-14" in text


def test_results_json(charted):
    folder, results, content, _ = charted
    assert json.loads((folder / "results.json").read_text()) == json.loads(json.dumps(content, allow_nan=False))
    assert set(content) == {"format", "measure", "seconds", "polhode", "machine", "versions", "missing", "files",
                            "scenes"}
    assert content["polhode"]["version"] == ph.__version__
    assert content["machine"]["cores"] >= 1 and "numpy" in content["versions"]
    scene = content["scenes"][0]
    assert scene["name"] == "S5" and scene["reference"]["kind"] == "stored" and scene["finding"] == headline(results[0])
    assert content["scenes"][1]["reference"]["kind"] == "made"
    points = {p["setting"]: p for p in scene["points"] if p["candidate"] == "rk45"}
    assert list(points) == [f"1e-{k:02d}" for k in range(3, 15)]
    for point in points.values():
        assert point["status"] == "answered" and point["seconds"] > 0 and point["repeats"] >= 1
        assert point["error"] == max(point["error_omega"], point["error_attitude"]) and point["counts"]["steps"] > 0
        assert set(point["drift"]) == {"energy", "vertical_momentum"}
    assert points["1e-06"]["error"] < 1e-4 and points["1e-12"]["error"] < 1e-10
    motion = ph.solve(ph.Scene.load("S5"), method="rk45", rtol=1e-6)
    assert points["1e-06"]["drift"] == pytest.approx(motion.drift)
    assert all(points["1e-06"]["counts"][key] == motion.stats[key] for key in ("steps", "rejected", "derivatives"))


def test_numbers_that_are_none_are_null():
    lost = Point("a", "method", "x", 1.0, why="failed")
    point = document([made_up([lost])], 1.0, [])["scenes"][0]["points"][0]
    assert point["status"] == "failed" and point["error"] is None and point["seconds"] is None


def test_failing_scenes_have_their_picture(tmp_path):
    from polhode.charts import pictures

    times = [1e-3 * 1.6**k for k in range(10)]
    stuck = made_up(curve("rk45", "method", VALUES, [max(v, 2e-5) for v in VALUES], times))
    held = made_up(curve("rk45", "method", VALUES, [1e-11] * 10, [0.2] * 10, [1_500_000] * 10))
    paths = pictures.limits([stuck, held], tmp_path)
    text = next(p for p in paths if p.suffix == ".svg").read_text()
    assert "above 2e-5" in text and re.search(r"stability asks rk45 for 1,500,000 steps", text)
    assert pictures.limits([made_up(curve("rk45", "method", VALUES, VALUES, times))], tmp_path) == []


def test_the_command_prints_tables_uncut(tmp_path, monkeypatch):
    from typer.testing import CliRunner

    from polhode.cli.app import app

    monkeypatch.setattr(sys.modules["polhode.charts.chart"], "candidates", three)
    result = CliRunner().invoke(app, ["chart", "S5", "-o", str(tmp_path), "--budget", "4s", "--no-peers"])
    assert result.exit_code == 0, result.output
    row = next(line for line in result.stdout.splitlines() if re.match(r"rk45 +1e-09", line))
    assert re.fullmatch(r"rk45 +1e-09 +\d\.\de-\d\d( +[\d.]+ (µs|ms)){3} +\d +[\d,]+ +[\d,]+ +\de-\d\d +\de-\d\d *",
                        row)
    assert str(Path(tmp_path) / "overview.png") in result.stdout and "input rounding 2e-14" in result.stdout
    arguments = ["chart", "S5", "-o", str(tmp_path), "--budget", "0.06min", "--no-peers", "--json"]
    content = CliRunner().invoke(app, arguments)
    assert json.loads(content.stdout)["scenes"][0]["name"] == "S5"


@pytest.mark.parametrize(("arguments", "words"), [
    ({"scenes": []}, "none given"), ({"scenes": [TINY, TINY]}, "'tiny' is given twice"),
    ({"scenes": [TINY], "budget": float("nan")}, "budget: must be positive"),
    ({"scenes": [TINY], "budget": 0.0}, "budget: must be positive"),
    ({"scenes": [TINY.replace(want=["omega"])]}, "want: must be omega and attitude"),
])  # fmt: skip
def test_bad_input(arguments, words, tmp_path):
    with pytest.raises(ph.InvalidInput, match=words):
        chart(folder=tmp_path, **arguments)
