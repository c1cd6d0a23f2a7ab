"""The column for engines: the error per turn at 1/60 s."""

import numpy as np
import pytest
from bodies import scene
from test_charts import Point, made_up

import polhode as ph
from polhode.charts.engines import engine_line, find_errors_per_turn


def test_the_error_per_turn_is_that_against_the_closed_form():
    s1 = scene("S1")
    found = find_errors_per_turn(s1)
    assert set(found) == {r["name"] for r in ph.methods() if not r["adaptive"] and r["name"] != "leapfrog"}
    end = 10 * 2 * np.pi / np.linalg.norm(s1.omega)
    _, truth = ph.FreeMotion(s1.inertia, s1.omega).at(end)
    for name in ("split", "midpoint"):
        q = ph.solve(s1.replace(times=np.array([end])), method=name, step=1 / 60).attitude[0]
        angle = 4 * np.arcsin(min(np.linalg.norm(q - truth), np.linalg.norm(q + truth)) / 2)
        assert found[name] == pytest.approx(angle / 10, rel=1e-6)
    assert found["free"] < 1e-13 and 1e-15 < found["dmv8"] < 1e-12 and found["rk4"] > 1e-8 and found["jolt"] > 0.05


def test_a_body_at_rest_has_no_turns():
    assert find_errors_per_turn(scene("S1", omega=(0, 0, 0))) == {}


def test_the_overview_names_a_step_that_holds_at_long_steps():
    errors = {"free": 1e-11, "dmv8": 1e-2, "jolt": 3.0}
    points = [Point(name, "cheap", "0.25 s", 0.25, "step", error=error) for name, error in errors.items()]
    result = made_up(points, per_turn={"free": 5e-15, "dmv8": 1e-15, "jolt": 0.6, "rk4": 1e-7})
    assert engine_line([result]).startswith("For an engine at 1/60 s take free;")
    assert "dmv8 1e-15" in engine_line([result]) and "jolt lost" in engine_line([result])
    assert engine_line([made_up([], per_turn={})]) == ""
