"""The atlas's machinery: who takes part, runs, workers, what it writes, and the command."""

import importlib.util
import json
import math
import re
import sys
from pathlib import Path

import pytest

import polhode as ph
from polhode.atlas import FAMILIES, atlas, claims, pictures, scenes
from polhode.atlas import atlas as atlas_function
from polhode.atlas.entrants import entrants
from polhode.atlas.families import step
from polhode.atlas.family import LEVELS, Point, from_json, measure_cases, to_json, too_long
from polhode.atlas.jobs import Job, find_families, rows_of
from polhode.atlas.page import costs, page
from polhode.atlas.results import FamilyResult, read_family, write_family
from polhode.atlas.run import Failed, Refused, run
from polhode.atlas.work import work
from polhode.cli import _run as command

ROOT = Path(__file__).parents[3]
WHO = {entrant.name: entrant for entrant in entrants()}
BY_NAME = {family.name: family for family in FAMILIES}


# who takes part


def test_every_method_takes_part_by_its_record():
    assert {m["name"] for m in ph.methods()} | {"solve", "exact", "formula", "angles"} == set(WHO)
    assert {e.name for e in rows_of(BY_NAME["step"])} == {m["name"] for m in ph.methods() if not m["adaptive"]}
    assert all({m["name"] for m in ph.methods()} <= {e.name for e in rows_of(f)} for f in FAMILIES if f.name != "step")


# runs


def test_a_run_ends_in_its_time_and_says_so():
    case = scenes.long(1e6)
    with pytest.raises(Failed, match="not done within") as caught:
        run(WHO["rk45"], case.scene, {"rtol": 1e-14}, 0.1)
    assert caught.value.late


def test_a_burst_is_a_point_and_a_refusal_another():
    (burst,) = measure_cases("long", [scenes.long(1e2)], WHO["euler"], 2.0)
    assert burst.status == "failed" and "not finite" in burst.why and burst.get("error") == math.inf
    (refusal,) = measure_cases("long", [scenes.long(1e2)], WHO["leapfrog"], 2.0)
    assert refusal.status == "refused" and "I1 = I2" in refusal.why
    with pytest.raises(Refused):
        run(WHO["exact"], ph.Scene.load("S5"), {}, 1.0)


def test_what_would_take_longer_still_is_left_out():
    found = list(measure_cases("long", map(scenes.long, scenes.LONG), WHO["rk45"], 0.05))
    assert found[-1].status == "left out" and "the one before" in found[-1].why
    assert math.isnan(found[-1].get("error"))


def test_the_longest_step_is_the_one_before_the_first_that_fails(monkeypatch):
    monkeypatch.setattr(step, "passes", lambda e, s, t, h, limit: {"right"} if h < 0.1 or 0.5 < h < 1 else set())
    assert step.limits(WHO["rk4"], (0.2, 0.4, 0.52), False, 1.0)["right"] == pytest.approx(2 * math.pi / 64, rel=0.05)


@pytest.mark.parametrize("last", [1, 3, 511, 512, 513, 725, 2048, 4095, 4096, 10**9])
def test_the_longest_step_is_found_without_trying_all(last):
    counts, tried = step.steps_a_turn(False), []

    def held(count):
        tried.append(count)
        return {"right"} if count >= last else set()

    by_all = [2 * math.pi / count for count in counts if count >= last]
    assert step._longest(counts, held) == {"right": max(by_all, default=0.0), "kept": 0.0, "bounded": 0.0}
    assert len(tried) == len(set(tried)) and sum(tried) < sum(counts)   # nothing twice, and less work


def test_what_takes_too_long_is_foreseen_by_a_power_law():
    assert too_long([], 1e3, 1.0) == too_long([(1e2, 0.5)], 1e3, 1.0) == ""   # nothing, one alone: no law yet
    assert too_long([(1e2, 0.01), (1e3, 0.2)], 1e4, 3.0) == "would take about 4 s"   # 0.2 * 20
    assert too_long([(1e2, 0.01), (1e3, 0.2)], 1e4, 3.5) == ""   # nearly in time: it is tried
    assert too_long([(1e2, 0.01), (1e3, 0.05)], 1e4, 1e-3) == ""   # too short to go by
    assert too_long([(1e2, 0.4), (1e3, 0.2)], 1e4, 0.1) == "would take about 0 s"
    assert "the one before" in too_long([(1e2, math.inf)], 1e3, 1.0)
    assert too_long([(1e2, 2e-4), (1e3, 0.2)], 1e4, 100.0) == "would take about 200 s"   # 0.2 * 1000


def test_unnormalised_runge_kutta_falls_as_the_fifth_power():
    from polhode.atlas.families.norm import rk4_without_normalising

    assert (math.log2(rk4_without_normalising(0.04, 10.0) / rk4_without_normalising(0.02, 10.0))
            == pytest.approx(5, abs=0.2))


@pytest.mark.parametrize("name", ["rk4", "rk45"])
@pytest.mark.parametrize("family", ["racket", "gimbal", "long", "spin-up", "chaos", "near", "sleeping", "wheel"])
def test_the_quick_sweep_is_a_part_of_the_whole_one(name, family, monkeypatch):
    """Of three values or more: two make no curve. Only the thruster's whole sweep has no more than three."""
    def burst(*_, **__):
        raise Failed("burst")

    for module in [module for place, module in sys.modules.items() if place.startswith("polhode.atlas.")]:
        if getattr(module, "run", None) is run:
            monkeypatch.setattr(module, "run", burst)
    quick, whole = ([(p.series, p.x) for p in BY_NAME[family].measure(WHO[name], short, 9.0)]
                    for short in (True, False))
    assert set(quick) < set(whole) and len(quick) >= min(3, len(whole) - 1)


# workers

WORKER = """
import os, sys, time
from polhode._workers import serve

def answer(job):
    yield {"x": 1.0, "series": "", "values": {"error": 1e-3}, "why": "", "status": "answered", "cpu": 0.5}
    if job.entrant == "crash": os.abort()
    if job.entrant == "leave": os._exit(3)
    if job.entrant == "hang": time.sleep(60)
    while job.entrant == "spin": pass
    if job.entrant == "fault": 1.0 / 0.0
    print("what a library prints is not an answer")

serve(answer)
"""


def test_crashes_hangs_and_faults_cost_one_row_each():
    names = ["good", "crash", "fine", "leave", "hang", "fault", "spin", "last"]
    rows = {}
    work([Job("f", name, True, 0.1) for name in names], lambda job, ps: rows.update({job.entrant: ps}),
         command=(sys.executable, "-c", WORKER), silence=4.0)
    assert set(rows) == set(names)
    assert all(len(rows[n]) == 1 and rows[n][0].values == {"error": 1e-3} for n in ("good", "fine", "last"))
    whys = {name: rows[name][-1].why for name in ("crash", "leave", "hang", "fault", "spin")}
    assert "SIGABRT" in whys["crash"] and "status 3" in whys["leave"]
    assert whys["hang"].startswith("hung: no answer for ")
    assert whys["spin"].startswith("hung") and rows["spin"][-1].cpu >= 1.0   # ten times the limit of a run
    assert whys["fault"] == "ZeroDivisionError: float division by zero"
    # What they said before stays, and the verdict is what happened.
    result = FamilyResult(BY_NAME["norm"], True, 2.0, {"rk4": rows["crash"], "rk45": rows["hang"]})
    assert len(rows["crash"]) == 2
    assert (result.verdict("rk4").level, result.verdict("rk4").text) == ("fails", "crashed")
    assert (result.verdict("rk45").level, result.verdict("rk45").text) == ("fails", "hung")


def test_points_survive_json():
    point = Point(math.nan, "a", {"error": math.inf, "steps": 3}, "why", "failed")
    back = from_json(json.loads(json.dumps(to_json(point), allow_nan=False)))
    assert math.isnan(back.x) and math.isnan(back.values["error"]) and back.values["steps"] == 3
    assert (back.series, back.why, back.status) == ("a", "why", "failed")


# the whole


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("atlas")
    steps = []
    results, content = atlas(["norm", "scales"], folder, quick=True, progress=lambda *a: steps.append(a))
    return folder, results, content, steps


def test_an_atlas_is_written_whole(made):
    folder, results, content, steps = made
    assert [r.family.name for r in results] == ["scales", "norm"]   # in the order of the list
    assert {p.name for p in folder.iterdir()} == set(content["files"])
    assert json.loads((folder / "atlas.json").read_text()) == content
    assert content["broken_claims"] == [] and content["machine"]["cores"]
    assert content["polhode"]["version"] == ph.__version__
    assert content["matrix"]["exact"]["norm"]["level"] == "holds"
    assert content["matrix"]["rk4 plain"]["norm"]["level"] == "fails"
    done = [s for s in steps if ": " in s[2] and not s[2].startswith("picture")]
    assert done[-1][0] == done[-1][1] == sum(len(rows_of(r.family)) for r in results)


def test_what_every_row_cost_is_written_down(made):
    folder, results, content, _ = made
    for result in results:
        spent = content["families"][result.family.name]["cpu_seconds"]
        assert set(spent) == set(result.rows) and list(spent.values()) == sorted(spent.values(), reverse=True)
        assert json.loads((folder / f"{result.family.name}.json").read_text())["cpu_seconds"] == spent
        assert all(p.cpu > 0 for points in result.rows.values() for p in points)
    assert content["cpu_seconds"] == pytest.approx(sum(sum(r.cpu.values()) for r in results), abs=0.1)
    assert costs({"slow": 12.4, "fast": 0.3}) == "13 s of CPU, of them slow 12 s"
    assert costs({"fast": 0.3}) == "0 s of CPU"


def test_pictures_name_everyone_and_every_level(made):
    folder, _, content, _ = made
    text = (folder / "matrix.svg").read_text()
    for name in content["matrix"]:
        assert f">{name}<" in text
    for symbol in "●✕":
        assert symbol in text
    assert "rk4 plain" in (folder / "norm.svg").read_text()


def test_a_picture_goes_from_easy_to_hard_on_panels_broader_than_high(tmp_path, monkeypatch):
    """A throw close to the axis is hard, as is a long time: the one stands at the right as the other does."""
    figures = []
    monkeypatch.setattr(pictures.style, "save", lambda figure, *_: figures.append(figure) or [])
    for name, values in (("racket", scenes.RACKET), ("long", scenes.LONG)):
        found = [Point(x, BY_NAME[name].series[0][0], {"error": 1e-9, "flip": 1e-9, "energy": 1e-9,
                                                       "angular_momentum": 1e-9}) for x in values]
        pictures.draw_family(FamilyResult(BY_NAME[name], False, 2.0, {"rk4": found, "dmv8": found[:2]}), tmp_path)
    for figure, (easy, hard) in zip(figures, ((1e-1, 1e-12), (1e2, 1e6)), strict=True):
        for axes in [axes for axes in figure.axes if axes.get_visible()]:
            left, right = axes.transData.transform([(easy, 1e-9), (hard, 1e-9)])[:, 0]
            assert axes.bbox.x0 <= left < right <= axes.bbox.x1 and axes.get_xscale() == "log"
            assert 1 < axes.bbox.width / axes.bbox.height < 2


def test_the_least_departure_of_a_norm_from_one_is_in_its_picture():
    assert BY_NAME["norm"].y_limits[0] < 2.0**-53 < 1e-15   # of doubles just below 1


def test_what_is_finished_is_kept(made, monkeypatch):
    folder, results, _, _ = made
    module = sys.modules["polhode.atlas.atlas"]
    monkeypatch.setattr(module, "work", lambda jobs, *a, **k: pytest.fail("ran again") if jobs else None)
    again, content = atlas(["norm"], folder, quick=True, draw=False)
    assert len(again) == 1 and list(content["families"]) == ["scales", "norm"]   # the matrix is of all that is there
    assert again[0].kept and again[0].rows.keys() == results[1].rows.keys()
    assert content["matrix"]["rk4"]["norm"] == made[2]["matrix"]["rk4"]["norm"]
    assert (read_family(folder / "norm.json", (False, 2.0))
            is read_family(folder / "norm.json", (True, 3.0)) is None)   # other settings
    (folder / "norm.json").write_text("{")
    assert read_family(folder / "norm.json", (True, 2.0)) is None    # not whole
    write_family(results[1], folder)


def test_the_page_is_made_of_the_results(made):
    folder, _, content, _ = made
    text = (folder / "atlas.md").read_text()
    assert text == page(content)
    for family in content["families"].values():
        assert family["about"] in text and family["sweeps"] in text
    assert text.count("| ● holds |") == 2 and "✕ 4e-4" in text


def test_unknown_families_and_folders_are_refused(tmp_path):
    with pytest.raises(ph.InvalidInput, match=r"family: must be one of step, racket.*'nonsense'"):
        find_families(["nonsense"])
    (tmp_path / "file").write_text("")
    with pytest.raises(ph.InvalidInput, match="output"):
        atlas_function(["norm"], tmp_path / "file")
    with pytest.raises(ph.InvalidInput, match="limit"):
        atlas_function(["norm"], tmp_path, limit=0.0)
    with pytest.raises(ph.InvalidInput, match="processes"):
        atlas_function(["norm"], tmp_path, processes=0)


# claims


def test_a_broken_claim_is_found():
    family = BY_NAME["near"]
    result = FamilyResult(family, True, 2.0, {"exact": [Point(0.0, "sphere", {"error": 1e-3})]})
    (sentence,) = [s for s in claims.find_broken([result]) if s.startswith("exact")]
    assert "near: degrades (1e-3), but should be at least holds" in sentence
    good = FamilyResult(family, True, 2.0, {"exact": [Point(0.0, "sphere", {"error": 1e-15})]})
    assert not [s for s in claims.find_broken([good]) if s.startswith("exact")]


def test_a_record_that_promises_too_much_is_found():
    rows = {"dmv2": [Point(1e2, "", {"error": 2.0, "energy": 1e-6, "angular_momentum": 1e-14})]}
    (sentence,) = [s for s in claims.find_broken([FamilyResult(BY_NAME["long"], True, 2.0, rows)]) if "dmv2" in s]
    assert "its record says that it conserves energy, which drifted by 1.0e-06" in sentence


def test_claims_name_what_there_is():
    for name, claimed in claims.CLAIMS.items():
        assert set(claimed) <= set(BY_NAME) and set(claimed.values()) <= set(LEVELS[:2]), name


# the command


def test_the_command(made, capsys, monkeypatch):
    folder, *_ = made
    for name in ("draw_family", "draw_matrix"):   # seen elsewhere, and slow
        monkeypatch.setattr(sys.modules["polhode.atlas.pictures"], name, lambda *_: [folder / "matrix.png"])
    assert command(["atlas", "norm", "--quick", "-o", str(folder)]) == 0
    out = capsys.readouterr().out
    assert "holds: every quaternion returned is unit" in out and "✕ 4e-4" in out and "matrix.png" in out
    assert command(["atlas", "norm", "--quick", "-o", str(folder), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["families"]["norm"]["kept"] is True
    monkeypatch.setitem(claims.CLAIMS, "exact", {"norm": "nothing"})
    monkeypatch.setattr(claims, "LEVELS", ("nothing", *LEVELS))
    assert command(["atlas", "norm", "--quick", "-o", str(folder)]) == 1
    assert "FINDING: exact, norm" in capsys.readouterr().out
    assert command(["atlas", "nonsense"]) == 2
    assert "family: must be one of" in capsys.readouterr().err


def test_the_docs_are_made_of_their_results():
    spec = importlib.util.spec_from_file_location("docs_of_the_atlas", ROOT / "benchmarks/atlas.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    content = json.loads(module.RESULTS.read_text())
    assert module.PAGE.read_text() == module.render(content)
    assert list(content["families"]) == [f.name for f in FAMILIES] and not content["quick"]
    assert content["broken_claims"] == []


def test_the_docs_list_the_families():
    page = (ROOT / "docs/atlas.md").read_text()
    listed = re.findall(r"^\| \[([\w-]+)\]\(results/atlas.md#\1\) \| (.*) \|$", page, flags=re.M)
    assert listed == [(family.name, family.title) for family in FAMILIES]
