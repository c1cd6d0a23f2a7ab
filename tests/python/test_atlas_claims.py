"""What polhode says of its own methods in the atlas, held against the truth: the quick sweep of each claim."""

import itertools

import pytest

from polhode.atlas import FAMILIES, claims
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
    assert not [s for s in claims.find_broken([FamilyResult(family, True, LIMIT, {name: points}, 0.0)]) if s.startswith(name + ",")]


def test_conserving_is_not_being_right():
    """Why the atlas shows the attitude: the midpoint rule keeps energy and L to rounding and loses the phase."""
    *_, last = BY_NAME["long"].measure(WHO["midpoint"], True, LIMIT)
    assert max(last.get("energy"), last.get("angular_momentum")) < 1e-12 and last.get("error") > 0.5


@pytest.mark.parametrize(("name", "family", "text"), [("euler", "long", "burst"), ("leapfrog", "gimbal", "burst"),
                                                       ("ignore", "sleeping", "stays up"), ("ignore", "long", "lost"), ("catto", "near", "lost")])
def test_what_fails_is_shown_failing(name, family, text):
    verdict = BY_NAME[family].judge(list(BY_NAME[family].measure(WHO[name], True, LIMIT)))
    assert (verdict.level, verdict.text) == ("fails", text)
