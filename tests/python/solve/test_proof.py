"""Proofs: the exact motion lies inside every bound, the bounds are narrow, and what has no proof is refused."""

import importlib.util
import json
import math
import pickle
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from proofs import find_outside, make_scene

import polhode as ph
from polhode import torques
from polhode._solve import solve

REFERENCE = Path(__file__).parents[2] / "reference"
TRUTH = np.load(REFERENCE / "proof.npz")
DRAWN = json.loads((REFERENCE / "proof_scenes.json").read_text())
# Scene and the accuracy at which its whole span is proved.
GOALS = {"S2": 1e-6, "S3": 1e-10, "S4": 1e-10, "S5": 1e-9, "S5c": 1e-9, "S6": 1e-8, "S7": 1e-8, "S9": 1e-9, "N2": 1e-9}


def load(name):
    """A reference scene from exactly the stored float64 start, at the stored times."""
    return ph.Scene.load(name).replace(omega=TRUTH[f"{name}_omega0"], attitude=TRUTH[f"{name}_attitude0"],
                                       times=TRUTH[f"{name}_t"])


def find_width(motion):
    """The widest bounds: of omega relative to the largest rate, of the attitude as they are."""
    rate = max(np.linalg.norm(motion.omega, axis=1).max(), np.linalg.norm(motion.scene.omega))
    return max((motion.omega_upper - motion.omega_lower).max() / rate,
               (motion.attitude_upper - motion.attitude_lower).max())


def find_error(motion, truth):
    """The error of the samples, as `accuracy` is defined."""
    exact = truth[..., 0] + truth[..., 1]
    rate = max(np.linalg.norm(motion.omega, axis=1).max(), np.linalg.norm(motion.scene.omega))
    distance = np.linalg.norm(motion.attitude - exact[:, 3:], axis=1)
    return max(np.linalg.norm(motion.omega - exact[:, :3], axis=1).max() / rate, 4 * np.arcsin(distance.max() / 2))


@pytest.mark.parametrize("name", GOALS)
def test_the_113_bit_truth_lies_inside_every_bound(name):
    accuracy = GOALS[name]
    motion = ph.solve(load(name), accuracy, certify="proof")
    assert motion.error_kind == "proved" and motion.success and motion.error <= accuracy
    assert find_outside(motion, TRUTH[f"{name}_truth"]) == 0
    assert find_width(motion) <= 4 * accuracy
    assert find_error(motion, TRUTH[f"{name}_truth"]) <= motion.error + 4e-16   # float64 rounds the measure itself
    for middle, lower, upper in ((motion.omega, motion.omega_lower, motion.omega_upper),
                                 (motion.attitude, motion.attitude_lower, motion.attitude_upper)):
        assert (lower <= middle).all() and (middle <= upper).all()
    assert motion.proved_span == (0.0, TRUTH[f"{name}_t"][-1])


@pytest.mark.parametrize("name", ["S4", "S5"])
def test_a_start_changed_in_its_last_digits_lies_outside(name):
    # Bounds are narrow enough to tell 1e-11 apart, so that the test above can fail.
    moved = load(name)
    moved = moved.replace(omega=moved.omega * (1 + 1e-11))
    assert find_outside(ph.solve(moved, 1e-10, certify="proof"), TRUTH[f"{name}_truth"]) > 100


@pytest.mark.parametrize("number", range(len(DRAWN)))
@pytest.mark.parametrize("accuracy", [1e-4, 1e-9])
def test_scenes_of_many_kinds_judged_by_100_digits(number, accuracy):
    numbers = DRAWN[number]
    motion = ph.solve(make_scene(numbers), accuracy, certify="proof")
    assert motion.error_kind == "proved"
    assert find_outside(motion, np.array(numbers["truth"])) == 0
    assert find_width(motion) <= 4 * accuracy


@pytest.mark.long
@pytest.mark.skipif(importlib.util.find_spec("flint") is None, reason="needs python-flint")
def test_the_evaluator_in_100_digits_itself():
    subprocess.run([sys.executable, REFERENCE / "proof_arb.py"], check=True)


@pytest.mark.long
@pytest.mark.skipif(importlib.util.find_spec("gmpy2") is None, reason="needs gmpy2")
def test_a_million_operations_on_intervals_against_mpfr():
    subprocess.run([sys.executable, REFERENCE / "interval_mpfr.py"], check=True)


def make_chaotic(span, samples=41, **changes):
    """S5c over a longer span."""
    return ph.Scene.load("S5c").replace(times=np.linspace(0, span, samples), **changes)


def test_a_proof_that_ends_says_how_far_it_goes():
    scene = make_chaotic(1500.0)
    motion = ph.solve(scene, 1e-9, certify="proof")
    begin, end = motion.proved_span
    assert begin == 0.0 and 60.0 < end < 1500.0
    assert motion.error_kind == "limit" and not motion.success
    assert motion.status == "finished" and motion.t.size == scene.times.size   # the motion itself goes on
    proved = motion.t <= end
    assert proved.any() and not proved.all()
    assert (motion.omega_upper - motion.omega_lower)[proved].max() < 1e-8
    unbounded = np.isinf(motion.omega_upper).any(axis=1)
    assert unbounded[-1] and not unbounded[proved].any()
    assert np.isfinite(motion.omega).all() and np.isfinite(motion.attitude).all()
    assert math.isinf(motion.error)
    assert "no failure of the motion" in motion.message and f"{end:g}"[:3] in motion.message


def test_a_proof_forwards_and_backwards_with_samples_in_any_order():
    times = [3.0, -2.0, 0.0, 1.0, -5.0]
    scene = ph.Scene.load("S5").replace(times=times)
    motion = ph.solve(scene, 1e-10, certify="proof")
    assert motion.t.tolist() == times and motion.proved_span == (-5.0, 3.0)
    for t, row in zip(times, motion.omega, strict=True):
        alone = ph.solve(scene.replace(times=[t]), 1e-10, certify="proof")
        np.testing.assert_allclose(alone.omega[0], row, rtol=0, atol=1e-14)


def test_rates_alone_or_the_attitude_alone():
    rates = ph.solve(ph.Scene.load("S9").replace(want=["omega"]), certify="proof")
    assert rates.attitude is rates.attitude_lower is rates.attitude_upper is None
    assert rates.omega_lower.shape == rates.omega_upper.shape == rates.omega.shape
    turns = ph.solve(ph.Scene.load("S9").replace(want=["attitude"]), certify="proof")
    assert turns.omega is turns.omega_lower is None and turns.attitude_lower.shape == turns.attitude.shape
    assert turns.error_kind == rates.error_kind == "proved"


def test_units_do_not_matter():
    scene = ph.Scene.load("S5").replace(times=[4.0])
    usual = ph.solve(scene, certify="proof")
    for scale in (2.0**-40, 2.0**40):
        gravity = torques.Gravity(2.0 * scale**2, [0.3, 0.2, 0.5])
        fast = scene.replace(omega=scene.omega * scale, times=[4.0 / scale], torques=[gravity])
        np.testing.assert_array_equal(ph.solve(fast, certify="proof").attitude, usual.attitude)
        weight = torques.Gravity(2.0 * scale, [0.3, 0.2, 0.5])
        heavy = scene.replace(inertia=scene.inertia.matrix * scale, torques=[weight])
        np.testing.assert_array_equal(ph.solve(heavy, certify="proof").attitude_upper, usual.attitude_upper)


def test_a_body_at_rest_stays_at_rest():
    motion = ph.solve(ph.Scene(inertia=[1.0, 2.0, 2.5], omega=[0, 0, 0], times=[0.0, 1e3]), certify="proof")
    assert motion.error_kind == "proved" and (motion.omega == 0).all()
    assert 0 <= motion.omega_upper.max() < 1e-30


def test_start_alone():
    attitude = np.array([0.1, -0.2, 0.3, 0.9])
    attitude /= np.linalg.norm(attitude)
    scene = ph.Scene(inertia=[1.0, 2.0, 2.5], omega=[1, 2, 3], attitude=attitude, t0=7.5, times=[7.5])
    motion = ph.solve(scene, 1e-12, certify="proof")
    assert motion.omega.tolist() == [[1, 2, 3]] and motion.proved_span == (7.5, 7.5)
    np.testing.assert_allclose(motion.attitude[0], attitude, atol=2e-16)


@pytest.mark.parametrize("options, why", [
    ({"method": "taylor"}, "one method"), ({"rtol": 1e-9}, "for an accuracy"), ({"step": 0.1}, "for an accuracy"),
    ({"dense": True}, "scene's times"), ({"events": [lambda t, w, q: t - 1]}, "no known bounds"),
    ({"formulation": "lagrangian"}, "Euler's equations"), ({"method": "exact"}, "one method")])
def test_options_without_a_proof_are_refused(options, why):
    with pytest.raises(ph.InvalidInput, match=why):
        ph.solve(ph.Scene.load("S1"), certify="proof", **options)


@pytest.mark.parametrize("windows", [None, [(0.0, 1.0)]])
def test_a_custom_torque_is_refused_with_the_reason(windows):
    custom = torques.Custom(lambda t, w, q: -0.1 * w)
    scene = ph.Scene(inertia=[1.0, 2.0, 2.5], omega=[1, 2, 3], times=[1.0],
                     torques=[custom if windows is None else torques.During(custom, windows)])
    with pytest.raises(ph.InvalidInput, match="a proof needs bounds on them at every state nearby"):
        ph.solve(scene, certify="proof")
    assert ph.solve(scene).success


def test_other_words_than_proof_are_refused():
    with pytest.raises(ph.InvalidInput, match="True, False or 'proof'"):
        ph.solve(ph.Scene.load("S1"), certify="prove")


def test_max_steps_and_progress_end_a_proof():
    scene = ph.Scene.load("S5")
    short = ph.solve(scene, certify="proof", max_steps=20)
    assert short.status == "max_steps" and 0 < short.t.size < scene.times.size and not short.success
    assert np.isfinite(short.omega_upper).all() and short.omega_upper.shape == short.omega.shape
    calls = []
    stopped = ph.solve(make_chaotic(4000.0), certify="proof", progress=lambda t, last: calls.append((t, last)) or False)
    assert stopped.status == "stopped" and len(calls) == 1 and calls[0][1] == 4000.0


def test_a_proof_that_ends_backward_says_when():
    """Back in time damping makes the rates grow without end, and the steps become short."""
    scene = ph.Scene(inertia=(1, 1.5, 2), omega=(0.1, 0.2, 0.3), torques=[ph.torques.Damping((0.9, 1, 1.1))], t0=1.0,
                     times=[-30.0, -2.0, 0.0, 2.0])
    motion = ph.solve(scene, 1e-6, certify="proof", max_steps=400)
    assert motion.status == "max_steps" and motion.stats["steps"] == 400
    ended = float(re.search(r"ended at t = (\S+) s", motion.message)[1])
    assert -30 < ended < 0 and motion.proved_span[1] == 2.0 and ended <= motion.proved_span[0]


def test_a_proof_has_fewer_steps_than_a_run_unless_asked(monkeypatch):
    """A proof of an hour is not what a call without max_steps wants."""
    scene = ph.Scene.load("S5")
    assert solve.DEFAULT_STEPS[1] <= 1_000_000
    monkeypatch.setattr(solve, "DEFAULT_STEPS", (7, 5))
    assert ph.solve(scene, certify="proof").stats["steps"] == 5
    assert ph.solve(scene, method="taylor", certify=False).stats["steps"] == 7
    assert ph.solve(scene, certify="proof", max_steps=6).stats["steps"] == 6


def test_plan_of_a_proof():
    scene = ph.Scene.load("S5")
    plan = ph.plan(scene, 1e-9, certify="proof")
    assert plan.certify == "proof" and plan.method == "enclosure" and plan.as_dict()["certify"] == "proof"
    assert "rigorous remainder" in str(plan)
    motion = ph.solve(scene, plan=plan)
    assert motion.error_kind == "proved" and motion.plan == plan and motion.plan.reasons == plan.reasons
    for made, certify in ((plan, False), (ph.plan(scene, 1e-9), "proof")):
        with pytest.raises(ph.InvalidInput, match="certify: must be left out"):
            ph.solve(scene, plan=made, certify=certify)


def test_a_motion_without_a_proof_has_no_bounds():
    motion = ph.solve(ph.Scene.load("S5"))
    assert motion.omega_lower is motion.attitude_upper is motion.proved_span is None


def test_bounds_are_pickled():
    motion = pickle.loads(pickle.dumps(ph.solve(load("S4"), 1e-10, certify="proof")))
    assert find_outside(motion, TRUTH["S4_truth"]) == 0 and motion.proved_span == (0.0, 100.0)


def test_the_command_writes_the_bounds(tmp_path):
    file = tmp_path / "S5.csv"
    done = subprocess.run([sys.executable, "-m", "polhode", "run", "S5", "--proof", "-o", file], text=True, check=True,
                          capture_output=True)
    assert "proof   from 0 to 20 s; widest bounds: omega" in done.stdout
    table = np.genfromtxt(file, delimiter=",", names=True)
    assert (table["omega_x_lower"] <= table["omega_x"]).all() and (table["omega_x"] <= table["omega_x_upper"]).all()
    motion = ph.solve(ph.Scene.load("S5"), certify="proof")
    np.testing.assert_array_equal(table["attitude_w_upper"], motion.attitude_upper[:, 3])


def test_infinite_bounds_are_null_in_json():
    from polhode.cli.files import to_json

    content = json.loads(json.dumps(to_json(ph.solve(make_chaotic(600.0, 11), certify="proof")), allow_nan=False))
    assert content["error"] is None and content["omega_upper"][-1] == [None] * 3
    assert content["omega_upper"][1][0] > content["omega"][1][0] and content["proved_span"][0] == 0.0
