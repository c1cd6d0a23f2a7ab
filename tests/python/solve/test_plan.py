"""Accuracy asked is accuracy got: the certificate against stored truth, plans in words, contradicting options."""

import importlib
import json
import pickle

import numpy as np
import pytest
from bodies import BLOCK, PARTS, scene
from measures import error, truth

import polhode as ph
from polhode._solve import calibrate, costs

# ---- the certificate


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9, 1e-11])
@pytest.mark.parametrize("name", ["S5", "S6", "S9"])
def test_the_error_is_within_what_is_reported_and_that_within_what_is_asked(name, accuracy):
    motion = ph.solve(scene(name), accuracy)
    found = error(motion.omega, motion.attitude, truth(name))
    assert motion.success and motion.error_kind == "bounded"
    # it carries its error along
    assert motion.stats["runs"] == 1 if motion.plan.method == "taylor" else motion.stats["runs"] >= 2
    assert found <= motion.error <= accuracy
    assert motion.error <= 1000 * found
    assert "certified" in motion.message


def test_damping_that_is_stiff_is_certified_too():
    motion = ph.solve(scene("S7"), 1e-7)
    assert motion.success and error(motion.omega, motion.attitude, truth("S7")) <= motion.error <= 1e-7


@pytest.mark.parametrize("method", ["rk45", "dop853", "taylor"])
def test_a_method_that_is_asked_for_reports_its_error(method):
    motion = ph.solve(scene("S5"), 1e-7, method=method)
    assert motion.plan.method == method and motion.error_kind == "bounded"
    assert error(motion.omega, motion.attitude, truth("S5")) <= motion.error <= 1e-7
    free = ph.solve(scene("S1", times=np.linspace(0, 20, 21)), 1e-7, method=method)
    assert free.plan.method == method and free.plan.model == "euler" and free.success and 0 < free.error <= 1e-7


def test_what_float64_cannot_give_is_said():
    chaotic = scene("S5", omega=(0.3, 0.2, 2), times=np.linspace(0, 60, 601))
    motion = ph.solve(chaotic, 1e-13)
    assert motion.status == "finished" and not motion.success and motion.error_kind == "limit"
    assert 1e-13 < motion.error < 1e-3 and "1e-13" in motion.message and "not reached" in motion.message
    assert ph.solve(chaotic, max(1e-8, 2 * motion.error)).success


def test_without_certificate_the_error_is_expected():
    motion = ph.solve(scene("S5"), 1e-8, certify=False)
    assert motion.error_kind == "expected" and motion.stats["runs"] == 1
    assert "no certificate was requested" in motion.message
    loose = {"certify": False, "method": "dop853"}
    assert (ph.solve(scene("S5"), 1e-8, **loose).stats["steps"]
            < ph.solve(scene("S5"), 1e-8, method="dop853").stats["steps"])
    assert 0 < motion.error <= 1e-8 and error(motion.omega, motion.attitude, truth("S5")) < 1e-8


def test_rates_alone_are_certified_alone():
    motion = ph.solve(scene("S9", want="omega"), 1e-9)
    assert "attitude" not in motion.plan.state and motion.success and motion.attitude is None
    assert (np.linalg.norm(motion.omega - truth("S9")["omega"], axis=1).max()
            < motion.error * np.linalg.norm(truth("S9")["omega"], axis=1).max())


def test_one_sample_is_compared_at_more_times():
    motion = ph.solve(scene("S5", times=[20.0]), 1e-9)
    assert motion.t.tolist() == [20.0] and motion.omega.shape == (1, 3) and motion.attitude.shape == (1, 4)
    reference = truth("S5")
    assert (error(motion.omega, motion.attitude, {key: reference[key][-1:] for key in ("omega", "attitude")})
            <= motion.error <= 1e-9)
    both = ph.solve(scene("S5", times=[3.0, -2.0, 3.0]), 1e-9)
    assert both.t.tolist() == [3.0, -2.0, 3.0] and both.success
    np.testing.assert_array_equal(both.omega[0], both.omega[2])


def test_events_and_dense_output_belong_to_the_run_that_is_returned():
    def low(t, omega, attitude):
        return omega[2] - 2.9

    motion = ph.solve(scene("S5"), 1e-9, events=[low], dense=True)
    assert motion.success and motion.events and abs(motion(motion.events[0].t)[0][2] - 2.9) < 1e-9
    ended = ph.solve(scene("S5"), 1e-9, events=[ph.Event(low, terminal=True)])
    assert ended.status == "event" and ended.success and ended.error <= 1e-9
    assert ended.t[-1] <= ended.events[0].t < ended.t[-1] + 0.1 and ended.events[0].t == motion.events[0].t
    at_once = ph.solve(scene("S5", times=[20.0]), 1e-9, events=[ph.Event(low, terminal=True)])
    assert at_once.status == "event" and at_once.t.size == 0


def test_runs_that_end_early_claim_nothing():
    motion = ph.solve(scene("S6"), 1e-9, max_steps=50)
    assert motion.status == "max_steps" and not motion.success and np.isnan(motion.error)
    stopped = ph.solve(scene("S9", times=[0.0, 2e4]), 1e-9, progress=lambda reached, last: False)
    assert stopped.status == "stopped" and not stopped.success


def test_lagranges_equations_are_certified_too():
    one = scene("S5", times=np.linspace(0, 0.5, 11))
    motion = ph.solve(one, 1e-9, formulation="lagrangian")
    assert motion.plan.model == "lagrangian" and motion.error_kind == "bounded" and motion.error <= 1e-9


# ---- plans


def test_a_plan_is_carried_out():
    plan = ph.plan(scene("S5"), 1e-8)
    motion = ph.solve(scene("S5"), plan=plan)
    assert motion.asked == 1e-8 and motion.plan.method == plan.method == ph.solve(scene("S5"), 1e-8).plan.method
    np.testing.assert_array_equal(motion.omega, ph.solve(scene("S5"), 1e-8).omega)
    other = ph.solve(scene("S5"), plan=plan, method="rk45")
    assert other.plan.method == "rk45" and other.asked == 1e-8 and other.error_kind == "bounded"
    assert ph.solve(scene("S1"), plan=ph.plan(scene("S1"))).plan.method == "exact"
    assert ph.solve(scene("S5"), plan=ph.plan(scene("S5"), 1e-6, certify=False)).error_kind == "expected"
    assert pickle.loads(pickle.dumps(plan)) == plan and hash(plan) == hash(ph.plan(scene("S5"), 1e-8))
    assert plan != ph.plan(scene("S5"), 1e-7)


@pytest.mark.parametrize("options", [{}, {"certify": False}])
def test_a_plan_is_decided_once(options, monkeypatch):
    """What a second decision would say is changed: the run, its plan and the facts are those of the first."""
    plan = ph.plan(scene("S5"), 1e-8, **options)
    facts = plan.facts
    costs = importlib.import_module("polhode._solve.costs")
    slow = ph._core.CostFactors({plan.method: 1e6})
    for module in ("polhode._solve.costs", "polhode._solve.solve"):
        monkeypatch.setattr(importlib.import_module(module), "factors", lambda: slow)
    assert costs.factors() is slow and ph.plan(scene("S5"), 1e-8, **options).method != plan.method
    motion = ph.solve(scene("S5"), plan=plan, **options)
    assert motion.plan.method == plan.method and motion.plan.facts == facts and motion.plan.reasons == plan.reasons
    assert [c.predicted_seconds for c in motion.plan.candidates] == [c.predicted_seconds for c in plan.candidates]


def test_a_plan_belongs_to_its_scene():
    with pytest.raises(ph.InvalidInput, match="plan: must be made for this scene"):
        ph.solve(scene("S6"), plan=ph.plan(scene("S5")))


def test_a_chain_says_what_ran_in_place_of_a_closed_form():
    """A pendulum's piece that is reached out of its plane is no pendulum: steps run, and the plan says so."""
    gravity, push = ph.torques.Gravity(2.0, (0.0, 0.0, -0.3)), ph.torques.Constant((0.0, 0.01, 0.02))
    windows = [ph.torques.During(push, [(1.0, 2.0)]), gravity]
    swing = ph.Scene(inertia=(1, 2, 2.5), omega=(0.3, 0, 0), torques=windows, times=np.linspace(0, 4, 9))
    motion = ph.solve(swing, 1e-9)
    first, _, last = motion.plan.pieces
    assert (first.model, first.ran) == ("pendulum", None) and motion.success
    planned = "pendulum" if last.method == "exact" else last.model
    assert last.ran is None or last.ran != planned


@pytest.mark.parametrize("options", [{"accuracy": 1e-6}, {"rtol": 1e-6}, {"atol": 1e-6}, {"step": 0.1},
                                     {"formulation": "lagrangian"}])
def test_wishes_beside_a_plan_are_refused(options):
    with pytest.raises(ph.InvalidInput, match=r"with plan="):
        ph.solve(scene("S5"), plan=ph.plan(scene("S5")), **options)


def test_only_plans_are_plans():
    with pytest.raises(ph.InvalidInput, match="plan"):
        ph.solve(scene("S5"), plan="exact")
    with pytest.raises(ph.InvalidInput, match="tolerances"):
        ph.solve(scene("S5"), plan=ph.solve(scene("S5"), rtol=1e-6).plan)
    with pytest.raises(ph.InvalidInput, match="Scene"):
        ph.plan({"omega": 1})


@pytest.mark.parametrize("accuracy", [0, -1e-9, np.nan, np.inf, 1.5, "high", [1e-3, 1e-4]])
def test_accuracies_that_mean_nothing_are_refused(accuracy):
    for act in (ph.plan, ph.solve):
        with pytest.raises(ph.InvalidInput, match="accuracy"):
            act(scene("S5"), accuracy)


@pytest.mark.parametrize(("options", "match"), [
    ({"method": "rk5"}, "method"), ({"method": "rk4"}, "step"), ({"method": "exact"}, "closed form"),
    ({"method": "leapfrog"}, "leapfrog|step"), ({"formulation": "newton"}, "formulation"),
    ({"method": "taylor", "formulation": "lagrangian"}, "formulation")])
def test_methods_that_cannot_do_what_is_wanted_are_refused(options, match):
    for act in (ph.plan, ph.solve):
        with pytest.raises(ph.InvalidInput, match=match):
            act(scene("S5"), **options)


@pytest.mark.parametrize(("name", "model", "says"), [
    ("S1", "triaxial", ["triaxial", "no drift", "not free|-"]), ("S2", "triaxial", ["separatrix"]),
    ("S3", "symmetric", ["Two moments are equal"]),
    ("S4", "heavy_top", ["Lagrange's top"]), ("S5", "euler", ["Gravity acts", "no closed form", "certified"]),
    ("S6", "euler", ["GravityGradient", "energy less n L_z"]),
    ("S7", "euler", ["decay", "No torque depends on the attitude"]),
    ("S9", "euler", ["spin the body up"])])
def test_plans_read_like_advice(name, model, says):
    plan = ph.plan(scene(name))
    assert plan.model == model and (plan.method == "exact") == (model != "euler")
    text = str(plan)
    assert all(any(part in text for part in one.split("|")) for one in says), text
    assert text.count("\n> ") == 1                            # one choice
    assert len(plan.reasons) >= 1 and len(plan.candidates) >= 9
    chosen = [one for one in plan.candidates if one.name in (plan.model, plan.method)]
    assert len(chosen) == 1 and not chosen[0].why_not and chosen[0].predicted_error <= 1e-9
    assert json.loads(json.dumps(plan.as_dict(), allow_nan=False))["method"] == plan.method


def test_stiff_damping_is_left_to_the_implicit_method():
    n = np.array([1, 2, 2]) / 3
    stiff = scene("S7", torques=[ph.torques.Damping(0.01 * np.eye(3) + 1e5 * np.outer(n, n))])
    for accuracy in (1e-4, 1e-6, 1e-9):
        plan = ph.plan(stiff, accuracy)
        assert plan.method == "radau" and plan.predicted_seconds < 0.1
        assert any("stiff" in reason for reason in plan.reasons)
    motion = ph.solve(stiff, 1e-6)
    # The end as SciPy's Radau at 1e-9, 1e-11 and 1e-13 agrees on it to 8 digits.
    np.testing.assert_allclose(motion.omega[-1], (0.47002718, -0.71327629, 0.47827028), atol=1e-6)
    assert motion.success and motion.plan.method == "radau"


def test_the_attitude_is_left_out_where_nobody_needs_it():
    assert any("attitude" in text for text in ph.plan(scene("S9", want="omega")).reasons)
    assert ph.plan(scene("S9", want="omega")).state == "omega"
    assert ph.plan(scene("S5", want="omega")).state == "omega, attitude"
    vanished = ph.plan(scene("S9", torques=[*PARTS["S9"]["torques"], ph.torques.Damping((0, 0, 0))]))
    assert any("Damping" in text for text in vanished.reasons) and vanished.left_out == ()


def test_the_planned_method_is_the_one_that_runs():
    for name in ("S5", "S6", "S7", "S9"):
        for accuracy in (1e-3, 1e-8):
            assert ph.solve(scene(name), accuracy).plan.method == ph.plan(scene(name), accuracy).method


def test_a_motions_plan_explains_itself():
    motion = ph.solve(scene("S5"), 1e-8)
    assert "no closed form" in str(motion.plan) and motion.plan.rtol > 0
    by_hand = ph.solve(scene("S5"), rtol=1e-8)
    assert np.isnan(by_hand.plan.accuracy) and "nothing was planned" in str(by_hand.plan)
    assert ph.solve(scene("S5"), 1e-8, method="rk45").plan.reasons != motion.plan.reasons


# ---- torques that lie


@pytest.mark.parametrize(("function", "claims", "named"), [
    (lambda t, w, q: (q[0], 0, 0), {"uses_attitude": False}, "uses_attitude"),
    (lambda t, w, q: (w[1] ** 3, 0, 0), {"uses_rates": False}, "uses_rates"),
    (lambda t, w, q: (0, np.sin(t), 0), {"uses_time": False}, "uses_time"),
    (lambda t, w, q: (0, 0, q[2] if t > 0.05 else 0.0), {"uses_attitude": False}, "uses_attitude")])
def test_claims_that_are_false_are_found_out(function, claims, named):
    one = ph.Scene(inertia=BLOCK, omega=(1, 2, 3), torques=[ph.torques.Custom(function, **claims)],
                   times=np.linspace(0, 1, 5))
    for options in ({"accuracy": 1e-6}, {"rtol": 1e-6}):
        with pytest.raises(ph.InvalidInput, match=rf"torques\[0\].*{named}"):
            ph.solve(one, **options)


def test_claims_that_are_true_are_believed():
    torque = ph.torques.Custom(lambda t, w, q: (0.1 * np.cos(t), 0, 0), uses_attitude=False, uses_rates=False)
    motion = ph.solve(ph.Scene(inertia=BLOCK, omega=(1, 2, 3), torques=[torque], times=[0, 1.0], want="omega"), 1e-7)
    assert motion.success and "attitude" not in motion.plan.state


# ---- the costs of this machine


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("POLHODE_CACHE", str(tmp_path))
    costs._load.cache_clear()
    yield tmp_path / "costs.json"
    costs._load.cache_clear()


def test_without_a_cache_the_shipped_costs_are_used(cache):
    assert costs._read()[0] == {} and "polhode calibrate" in str(ph.plan(scene("S5")))


def test_a_cache_changes_what_is_predicted(cache):
    before = ph.plan(scene("S1")).predicted_seconds
    content = {"polhode": ph.__version__, "machine": costs._machine(), "date": "today", "factors": {"triaxial": 3.0}}
    cache.write_text(json.dumps(content))
    costs._load.cache_clear()
    assert ph.plan(scene("S1")).predicted_seconds == pytest.approx(3 * before)
    assert "measured on this machine, today" in str(ph.plan(scene("S1")))
    assert ph.solve(scene("S1")).success


@pytest.mark.parametrize(("text", "named"), [
    ("{", "damaged"), ("[]", "damaged"), ('{"factors": {"rk45": "x"}}', "damaged"),
    ('{"factors": {"rk45": -1}}', "damaged"),
    (json.dumps({"polhode": "0.0.0", "machine": "x", "factors": {"rk45": 2}}), "polhode 0.0.0"),
    (json.dumps({"polhode": ph.__version__, "machine": "another", "factors": {"rk45": 2}}), "another machine")])
def test_a_stale_or_damaged_cache_is_ignored_and_named(cache, text, named):
    cache.write_text(text)
    costs._load.cache_clear()
    assert costs._read()[0] == {} and named in costs.describe() and str(cache) in costs.describe()


def test_calibrate_measures_everything_that_plans_choose_from(cache, monkeypatch):
    monkeypatch.setattr(calibrate, "MOST_SECONDS", 0.1)
    found = calibrate.calibrate()
    assert ({"rest", "spherical", "steady", "symmetric", "separatrix", "triaxial", "heavy_top", "rk45", "taylor"}
            <= set(found))
    assert cache.exists() and all(0 < value < 1000 for value in found.values())
    assert "measured on this machine" in costs.describe() and costs._read()[0] == pytest.approx(found)
