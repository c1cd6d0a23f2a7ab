"""Solvers of one's own in charts: what they may be, how they are measured, and what is refused."""

import numpy as np
import pytest

import polhode as ph
from polhode.charts.candidates import candidates
from polhode.charts.entrant import Entrant, read_entrants
from polhode.charts.measure import measure
from polhode.charts.runners import Both, InProcess

pytest.importorskip("matplotlib")

SCENE = ph.Scene(inertia=(1, 2, 2.5), omega=(1, 2, 3), times=np.linspace(0, 2, 11), name="throw")


def closed(scene, value):
    return ph.FreeMotion(scene.inertia, scene.omega, scene.attitude).at(scene.times)


def off_by_the_setting(scene, rtol):
    omega, attitude = closed(scene, 0.0)
    return omega * (1 + rtol), attitude, {"steps": 7}


def found_by(*entrants, others=()):
    taking_part = read_entrants(entrants, list(others))
    result = measure(SCENE, "", [*others, *taking_part], 3.0, lambda text: None,
                     Both(taking_part, InProcess(list(others))))
    return {(p.candidate, p.setting): p for p in result.points}


def test_an_entrant_is_measured_beside_the_others():
    rk45 = next(c for c in candidates(False) if c.name == "rk45")
    found = found_by(off_by_the_setting, Entrant("exact", closed, swept=""), others=[rk45])
    mine = found["off_by_the_setting", "1e-06"]
    assert mine.answered and mine.seconds > 0 and mine.stats == {"steps": 7} and mine.family == "peer"
    errors = [found["off_by_the_setting", f"1e-{k:02d}"].error for k in range(3, 9)]
    assert np.allclose(errors, 10.0 ** -np.arange(3, 9), rtol=1e-3)
    assert found["exact", "closed form"].error < 1e-14 and found["rk45", "1e-06"].answered


def test_wrong_answers_and_exceptions_are_failed_points():
    def raises(scene, rtol):
        raise ValueError("no such luck")

    def short(scene, rtol):
        omega, attitude = closed(scene, 0)
        return omega[1:], attitude

    lost = Entrant("nan", lambda scene, rtol: [a * np.nan for a in closed(scene, rtol)])
    found = found_by(raises, short, lambda scene, rtol: None, lost)
    why = {name: found[name, "1e-03"].why for name in ("raises", "short", "<lambda>", "nan")}
    assert why["raises"] == "ValueError: no such luck" and "(11, 3), got (10, 3)" in why["short"]
    assert "must return omega and attitude, got NoneType" in why["<lambda>"] and "NaN" in why["nan"]


def test_settings_and_refusals():
    stepped = Entrant("mine", closed, swept="step").as_candidate()
    values = [value for _, value in stepped.settings(SCENE)]
    assert len(values) == 11 and np.allclose(np.divide(values[:-1], values[1:]), 2)
    given = Entrant("mine", closed, settings=(1e-2, 1e-5), refuses=lambda scene: "not today").as_candidate()
    assert given.settings(SCENE) == (("0.01", 0.01), ("1e-05", 1e-05)) and given.refuses(SCENE) == "not today"
    for wrong, why in ((dict(name=" "), "name"), (dict(solve=3), "solve"), (dict(swept="speed"), "swept"),
                       (dict(settings=(1e-5, 1e-2)), "settings"), (dict(settings=()), "settings")):
        with pytest.raises(ph.InvalidInput, match=f"^{why}: must"):
            Entrant(**{"name": "mine", "solve": closed, **wrong})


def test_what_is_no_entrant_is_refused():
    own = candidates(False)
    for wrong, why in (([3], "got int"), (closed, "must be a list"), ([Entrant("rk45", closed)], "another candidate"),
                       ([closed, closed], "another candidate")):
        with pytest.raises(ph.InvalidInput, match=why):
            read_entrants(wrong, own)


def test_a_peer_is_an_entrant():
    pytest.importorskip("scipy")
    found = read_entrants([ph.charts.peers.scipy], candidates(False))
    assert {c.name for c in found} == {"SciPy RK45", "SciPy DOP853", "SciPy LSODA", "SciPy Radau"}
    assert read_entrants([ph.charts.peers.scipy], candidates(True)) == []


def test_a_chart_has_the_entrant_in_its_picture_and_results(tmp_path):
    results, content = ph.charts.chart([SCENE], tmp_path, budget=6, peers=False,
                                       entrants=[Entrant("Mine", off_by_the_setting, settings=(1e-3, 1e-6))])
    points = [p for p in content["scenes"][0]["points"] if p["candidate"] == "Mine"]
    assert [p["setting"] for p in points] == ["0.001", "1e-06"] and all(p["status"] == "answered" for p in points)
    assert "Mine" in (tmp_path / "throw.svg").read_text() and results[0].of("rk45")
