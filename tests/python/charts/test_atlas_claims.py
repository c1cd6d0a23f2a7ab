"""What polhode says of its own methods in the atlas, held against the truth: the quick sweep of each claim."""

import itertools
import re

import numpy as np
import pytest

import polhode as ph
from polhode._harness.truth import Truth, attitude_errors
from polhode.atlas import FAMILIES, claims, scenes
from polhode.atlas.case import stored
from polhode.atlas.entrants import entrants
from polhode.atlas.family import LEVELS
from polhode.atlas.results import FamilyResult

WHO = {entrant.name: entrant for entrant in entrants()}
BY_NAME = {family.name: family for family in FAMILIES}
LIMIT = 60.0   # seconds of CPU a point: generous, a busy machine is no failure
# More than a second each.
SLOW = {("solve", "damping"), ("taylor", "damping"), ("taylor", "chaos"), ("rk45", "near"),
        ("radau", "sleeping"), ("radau", "spin-up"), ("symplectic", "step"), ("symplectic", "spin-up"),
        ("symplectic", "long")}


CLAIMED = [
    pytest.param(name, family, marks=[pytest.mark.long] if (name, family) in SLOW else [], id=f"{name}-{family}")
    for name, families in claims.CLAIMS.items()
    for family in families
    if name in WHO
]


@pytest.mark.parametrize(("name", "family"), CLAIMED)
def test_a_claim_holds(name, family):
    points = list(BY_NAME[family].measure(WHO[name], True, LIMIT))
    verdict = BY_NAME[family].judge(points)
    least = claims.CLAIMS[name][family]
    assert verdict.level in LEVELS[: LEVELS.index(least) + 1], verdict
    assert all(p.status == "answered" for p in points), [p.why for p in points]


PROMISES = [name for name, entrant in WHO.items() if {"energy", "L"} & set(entrant.record.get("keeps", "").split(", "))]


@pytest.mark.parametrize("name", PROMISES)
def test_what_a_record_keeps_is_kept_through_a_thousand_turns(name):
    family = BY_NAME["long"]
    points = list(itertools.islice(family.measure(WHO[name], True, LIMIT), 2))
    if all(p.status == "refused" for p in points):
        pytest.skip("the free block is not for it")
    assert not [s for s in claims.find_broken([FamilyResult(family, True, LIMIT,
                                                            {name: points})]) if s.startswith(name + ",")]


def test_conserving_is_not_being_right():
    """Why the atlas shows the attitude: the midpoint rule keeps energy and L to rounding and loses the phase."""
    *_, last = BY_NAME["long"].measure(WHO["midpoint"], True, LIMIT)
    assert max(last.get("energy"), last.get("angular_momentum")) < 1e-12 and last.get("error") > 0.5


@pytest.mark.parametrize("span", [1e3, pytest.param(1e4, marks=pytest.mark.long)])
def test_what_a_plan_foresees_grows_as_the_work_of_a_spin_up_does(span):
    """Within a factor 2, over turns that grow as the square of the time: by the last rate, not the first."""
    def price(case):
        motion = ph.solve(case.scene, 1e-6)
        return motion.plan.predicted_seconds / motion.stats["steps"]

    assert 0.5 < price(scenes.spin_up(span)) / price(scenes.spin_up(1e2)) < 2


def test_what_a_plan_foresaw_stands_beside_what_a_spin_up_took():
    for point in BY_NAME["spin-up"].measure(WHO["solve"], True, LIMIT):
        assert point.values["foreseen"] > 0 and point.values["took"] > 0


@pytest.mark.parametrize("accuracy", [0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-9, 1e-12])
def test_past_the_horizon_of_float64_solve_says_how_far_it_holds(accuracy):
    scene, rows = scenes.chaos(), stored("chaos")
    motion = ph.solve(scene, accuracy)
    assert (motion.status, motion.success, motion.error_kind) == ("finished", False, "limit") and motion.t.size == 401
    said = float(re.search(r"it holds for the first ([\d.]+) s", motion.message)[1])
    rates = np.linalg.norm(motion.omega - rows[:, :3], axis=1) / np.linalg.norm(rows[:, :3], axis=1).max()
    truth = Truth(rows[:, :3], rows[:, 3:], "", "", 0.0, None)
    errors = np.maximum(rates, attitude_errors(motion.attitude, truth))
    assert errors[motion.t <= said].max() <= accuracy   # and what it returns is that good for so long
    assert motion.t[errors > accuracy][0] - said <= 85   # 79 s at 1e-4
    # doubles at their best are lost at 219 to 260 s, by luck; at 246 s before any method was tuned
    if accuracy == 0.1:
        # A certificate is on the safe side of it. 180 s: errors are held to a third of the accuracy, as a limit is
        # three times the estimate; 196 s without that, while at 1e-2 those 196 s were 12 s too many.
        assert 246 - 75 <= said <= 246


@pytest.mark.parametrize(("name", "family", "text"), [("euler", "long", "burst"), ("leapfrog", "gimbal", "burst"),
                                                       ("ignore", "sleeping", "stays up"), ("ignore", "long", "lost"),
                                                      ("catto", "near", "lost")])
def test_what_fails_is_shown_failing(name, family, text):
    verdict = BY_NAME[family].judge(list(BY_NAME[family].measure(WHO[name], True, LIMIT)))
    assert (verdict.level, verdict.text) == ("fails", text)
