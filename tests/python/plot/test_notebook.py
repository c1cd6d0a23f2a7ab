"""What a notebook shows of objects, what completion lists, and the progress of long runs."""

import importlib
import subprocess
import sys
from html.parser import HTMLParser

import numpy as np
import pytest

import polhode as ph
from polhode._solve import progress as shown_progress

BLOCK = (0.20, 0.40, 0.52)


class Cells(HTMLParser):
    """The texts of an HTML table, and the elements that must be closed."""

    def __init__(self, text):
        super().__init__()
        self.open, self.texts = [], []
        self.feed(text)
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)


def texts(thing):
    return Cells(thing._repr_html_()).texts


def test_a_motion_says_its_result_error_drift_and_ends():
    motion = ph.solve(ph.Scene.load("S5"), 1e-6)
    found = texts(motion)
    assert {"✓ Motion", "S5: 201 samples by taylor", motion.message, "20"} <= set(found)
    assert any("(bounded), asked 1e-06" in text for text in found)
    assert any(text.startswith("energy") for text in found) and f"{motion.stats['steps']:,} steps" in " ".join(found)
    stopped = ph.solve(ph.Scene.load("S5"), 1e-6, max_steps=3)
    assert texts(stopped)[0] == "✗ Motion" and stopped.message in texts(stopped)
    bare = ph.solve(ph.Scene(inertia=BLOCK, omega=(1, 2, 3), times=[1.0], want="omega"), rtol=1e-6, method="rk45")
    assert "attitude (x, y, z, w)" not in texts(bare) and "error" not in texts(bare)


@pytest.mark.parametrize("name", ["S1", "S5", "S9"])
def test_a_plan_shows_its_choice_candidates_and_reasons(name):
    plan = ph.plan(ph.Scene.load(name), 1e-6)
    found = texts(plan)
    assert found[0] == f"Plan: {plan.model} by {plan.method}" and set(plan.reasons) <= set(found)
    assert {candidate.name for candidate in plan.candidates} <= set(found)
    assert {candidate.why_not for candidate in plan.candidates if candidate.why_not} <= set(found)


def test_a_plan_of_pieces_and_one_of_tolerances():
    push = ph.torques.During(ph.torques.Constant((0.1, 0, 0)), [(1, 2)])
    scene = ph.Scene(inertia=BLOCK, omega=(1, 2, 3), torques=[push], times=[0.0, 3.0])
    found = texts(ph.plan(scene, 1e-6))
    assert "Constant" in " ".join(found) and "model" in found
    assert "tolerances given" in " ".join(texts(ph.solve(scene, method="rk45", rtol=1e-6).plan))


def test_a_tensor_a_closed_form_and_a_diagnosis():
    tensor = ph.InertiaTensor([[2.0, 0.25, 0], [0.25, 2.0, 0], [0, 0, 2.5]])
    found = texts(tensor)
    assert found.count("0.25") == 2 and {"1.75", "2.25", "2.5"} <= set(found)
    free = ph.FreeMotion(BLOCK, (1, 2, 3))
    assert {"(0.2, 0.4, 0.52)", free.kind.replace("_", " "), f"{free.period:.6g}"} <= set(texts(free))
    for form in (ph.HeavyTop((1, 1, 0.5), 2.0, (0, 0, 6)), ph.Gyrostat(BLOCK, momentum=(0, 0, 1), omega=(1, 2, 3)),
                 ph.DampedFree(BLOCK, 0.5, (1, 2, 3)), ph.Pendulum(BLOCK, 2.0, (0, 0, -0.5), (1, 0, 0))):
        assert texts(form)[0] == type(form).__name__ and len(texts(form)) > 12
    assert texts(ph.inertia.diagnose(np.diag(BLOCK)))[0] == "✓ Diagnosis"
    wrong = ph.inertia.diagnose(np.diag((1, 2, 5.0)))
    assert {"✗ Diagnosis", wrong.findings[0].code, wrong.findings[0].text} <= set(texts(wrong))


def test_a_scene_mass_properties_and_rotations():
    scene = ph.Scene.load("S5")
    found = texts(scene)
    assert found[0] == "Scene" and "S5" in found and repr(scene.torques[0]) in found and "omega, attitude" in found
    body = ph.shapes.box(12.0, (0.3, 0.2, 0.1))
    assert {"MassProperties", "12", "(0, 0, 0)", "(0.2, 0.4, 0.52)"} <= set(texts(body))
    turn = ph.Rotation.from_euler("ZXZ", [90, 0, 0], degrees=True)
    assert {"Rotation", "90", "(0, 0, 1)"} <= set(texts(turn))
    assert any("30 rotations, the first 10" in text for text in texts(ph.Rotation.random(30, rng=1)))
    assert "" not in texts(ph.Rotation.identity()) and "0" in texts(ph.Rotation.identity())


def test_many_motions_and_a_fit():
    scene = ph.Scene.load("S5")
    motions = ph.solve_many([scene] * 12, accuracy=1e-6)
    found = texts(motions)
    assert found[0] == "Motions" and found.count("taylor") == 10 and "12 bodies, 12 with success" in " ".join(found)
    times = np.linspace(0, 5, 40)
    rates = ph.FreeMotion(BLOCK, (1, 2, 3)).at(times)[0]
    noise = 1e-3 * np.random.default_rng(1).normal(size=rates.shape)
    fit = ph.fit(ph.measured.Rates(times, rates + noise, 1e-3))
    found = " ".join(texts(fit))
    assert found.startswith("✓ FitResult") and all(name in found for name in fit.parameters)
    assert fit.message in found and "not observable" in found
    assert np.allclose(fit.moments / fit.moments.max(), np.array(BLOCK) / max(BLOCK), rtol=0.05)


def test_names_cannot_break_the_notebook():
    scene = ph.Scene(inertia=BLOCK, omega=(1, 2, 3), times=[1.0], name="<script>alert(1)</script>")
    for thing in (ph.solve(scene), ph.plan(scene)):
        assert "<script>" not in thing._repr_html_() and "&lt;script&gt;" in thing._repr_html_()


@pytest.mark.parametrize("name", ["polhode", "polhode.inertia", "polhode.charts", "polhode.atlas", "polhode.report",
                                  "polhode.recipe", "polhode.schema", "polhode.shapes", "polhode.torques"])
def test_completion_lists_all_of_a_module(name):
    program = (f"import importlib; m = importlib.import_module({name!r}); late = {{'polhode.inertia': ['robots']}}; "
               f"names = [*getattr(m, '__all__', []), *getattr(m, '_LATE', []), *late.get({name!r}, [])]; "
               "assert set(names) <= set(dir(m)), set(names) - set(dir(m)); [getattr(m, n) for n in names]")
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert importlib.import_module(name)


def test_progress_is_shown_after_a_second_and_not_before(monkeypatch, capsys):
    scene = ph.Scene.load("S5")
    ph.solve(scene, 1e-9, progress=True)
    assert capsys.readouterr().err == ""
    clock = iter(np.arange(0, 1000, 0.3))
    monkeypatch.setattr(shown_progress.time, "monotonic", lambda: next(clock))
    with shown_progress.shown(True, "solving S5") as callback:
        assert all(callback(k, 40) for k in range(41))
    lines = capsys.readouterr().err.splitlines()
    assert lines == [f"solving S5: {k} %" for k in range(0, 101, 10)]
    with shown_progress.shown(False, "") as callback:
        assert callback is None
    with shown_progress.shown(print, "") as callback:
        assert callback is print


def test_a_terminal_gets_a_bar_where_rich_is_there(monkeypatch):
    console = pytest.importorskip("rich.console")
    made = []

    class Terminal(console.Console):
        def __init__(self, **options):
            super().__init__(force_terminal=True, width=80, **options)
            made.append(self)

    monkeypatch.setattr(console, "Console", Terminal)
    monkeypatch.setattr(shown_progress, "PATIENCE", -1.0)
    with shown_progress.shown(True, "solving") as callback:
        callback(1.0, 4.0)
        bar = callback._bar
        assert bar.tasks[0].completed == 0.25 and bar.live.is_started
    assert made and not bar.live.is_started


def test_the_answer_with_progress_is_the_same():
    scene = ph.Scene.load("S5")
    assert np.array_equal(ph.solve(scene, progress=True).omega, ph.solve(scene).omega)
