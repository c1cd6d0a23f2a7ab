"""Which method for which scene: the picture that comes first, and the brief command."""

import json
import sys

import numpy as np
import pytest

import polhode as ph
from polhode._harness.truth import Truth
from polhode._plot.text import to_time
from polhode.charts import chart, choice
from polhode.charts.candidates import candidates
from polhode.charts.measure import SceneResult

pytest.importorskip("matplotlib")

TINY = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(1.0, 2.0, 3.0), times=np.linspace(0, 1, 5), name="tiny")
TRUTH = Truth(np.ones((1, 3)), np.ones((1, 4)), "stored", "", 3e-16, 1e-13)


@pytest.fixture(scope="module")
def charted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("charts")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys.modules["polhode.charts.chart"], "candidates",
                      lambda peers: [c for c in candidates(False) if c.name in ("FreeMotion", "rk45", "rk4")])
        results, content = chart(["S5", TINY], folder, budget=5, peers=False)
    return folder, results, content


def test_the_first_picture_says_which_method_and_how_fast(charted):
    folder, results, content = charted
    assert content["files"][:2] == ["which_method.png", "which_method.svg"]
    text, table = (folder / "which_method.svg").read_text(), choice.rows(results)
    assert [row[0] for row in table] == ["S5", "tiny"] and len(table[0]) == 1 + len(choice.LEVELS)
    for result, row in zip(results, table):
        for level, cell in zip(choice.LEVELS, row[1:]):
            times = {p.candidate: p.seconds for p in result.points if p.answered and p.error <= level}
            slowest_of_all = [p.seconds for p in result.points if p.answered and p.error <= level]
            assert (cell == "–") == (not times)
            if times:
                name, _, time = cell.partition(" ")
                assert time == to_time(min(slowest_of_all)) and name in times and f">{name}<" in text
    assert table[1][1].startswith("FreeMotion") and choice.finding(results).startswith("Fastest of 8 cases: ")
    assert choice.finding([]) == "No method reaches these errors"


def test_no_scene_gets_more_than_what_is_left_of_the_budget(tmp_path, monkeypatch):
    """The first of six may take more than its sixth, but leaves most of the time to the others."""
    module, shares = sys.modules["polhode.charts.chart"], []

    def measured(scene, title, taking_part, share, *_):
        shares.append(share)
        return SceneResult(TINY, "", TRUTH, [], [])

    monkeypatch.setattr(module, "measure", measured)
    monkeypatch.setattr(module, "candidates", lambda peers: candidates(False)[:1])
    for drawing, names in (("choice", ["picture"]), ("pictures", ["work_precision", "overview", "limits"])):
        for name in names:
            monkeypatch.setattr(getattr(module, drawing), name, lambda *_: [])
    chart([TINY.replace(name=f"t{i}") for i in range(6)], tmp_path, budget=60.0, peers=False)
    assert len(shares) == 6 and 1.0 < shares[0] < 60.0 / 2 and max(shares) <= 60.0


def test_the_brief_command_prints_few_lines_and_no_failures(tmp_path, monkeypatch):
    from typer.testing import CliRunner

    from polhode.cli.app import app

    monkeypatch.setattr(sys.modules["polhode.charts.chart"], "candidates",
                        lambda peers: [c for c in candidates(False) if c.name in ("FreeMotion", "euler", "semi_euler")])
    result = CliRunner().invoke(app, ["chart", "S1", "S5", "-o", str(tmp_path), "--budget", "4s", "--no-peers",
                                      "--brief"])
    assert result.exit_code == 0 and result.stderr == ""
    lines = result.stdout.splitlines()
    assert len(lines) <= 6 + 2 and "failed:" not in result.stdout   # two scenes and six more; the demo has twelve
    content = json.loads((tmp_path / "results.json").read_text())
    failed = sum(p["status"] == "failed" for s in content["scenes"] for p in s["points"])
    assert failed > 0 and f" {failed} failed, " in result.stdout and "which_method.png" in lines[-1]
