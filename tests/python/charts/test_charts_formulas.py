"""Torques as formulas among the candidates of charts and the entrants of the atlas."""

import numpy as np
import pytest

import polhode as ph
from polhode._harness.formulas import to_formulas, why_no_formulas
from polhode._harness.truth import compute_errors, find_truth
from polhode.atlas import scenes
from polhode.atlas.entrants import entrants
from polhode.atlas.run import Refused, run
from polhode.charts.candidates import candidates

FORMULA = next(c for c in candidates(with_peers=False) if c.name == "formula")
ENTRANT = next(e for e in entrants() if e.name == "formula")


@pytest.mark.parametrize("name", ["S4", "S5", "S6", "S7"])
def test_formulas_answer_scenes_of_built_in_torques(name):
    scene = ph.Scene.load(name)
    assert not FORMULA.refuses(scene)
    answer = FORMULA.run(scene, 1e-13, None)
    assert compute_errors(answer.omega, answer.attitude, find_truth(scene)).largest < 1e-10
    written = to_formulas(scene)
    assert all(isinstance(torque, ph.torques.Formula) and not torque.recognise for torque in written.torques)
    at = dict(t=0.3, omega=(0.4, -0.2, 0.7), attitude=np.array((0.1, 0.2, 0.3, 0.9)) / np.sqrt(0.95))
    np.testing.assert_allclose(written.torque(**at), scene.torque(**at), rtol=1e-14, atol=1e-15)


def test_scenes_without_a_law_are_refused():
    custom = ph.Scene.load("S5").replace(torques=[ph.torques.Custom(lambda t, w, q: -0.1 * w)])
    assert "Custom" in FORMULA.refuses(custom) and "Custom" in why_no_formulas(custom)
    assert "torque" in FORMULA.refuses(ph.Scene.load("S1"))
    with pytest.raises(Refused, match="torque"):
        run(ENTRANT, ph.Scene.load("S1"), {"rtol": 1e-9}, 1.0)
    windows = custom.replace(torques=[ph.torques.During(custom.torques[0], [(0.0, 1.0)])])
    assert "Custom" in FORMULA.refuses(windows)


def test_windows_stay():
    scene = ph.Scene.load("S5").replace(torques=[ph.torques.During(ph.torques.Gravity(2.0, (0.3, 0.2, 0.5)), [(1, 2)])])
    (written,) = to_formulas(scene).torques
    assert written.windows == ((1.0, 2.0),) and isinstance(written.torque, ph.torques.Formula)


def test_the_atlas_takes_torques_as_formulas():
    motion = run(ENTRANT, scenes.spin_up(100.0).scene, {"rtol": 1e-14}, 20.0)
    assert motion.plan.method == "taylor" and motion.status == "finished"


def test_the_fastest_of_polhode_is_never_one_that_stands_for_users():
    from polhode.charts.choice import OWN
    assert FORMULA.family not in OWN
