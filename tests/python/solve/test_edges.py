"""Samples within some units in the last place of the ends of windows: proofs, plain runs, dense output."""

import math
import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from ball_edges import SPANS, Ball

import polhode as ph

FOLDER = Path(__file__).parents[3] / "benchmarks/planner"
sys.path.insert(0, str(FOLDER))
from family.edges import CLOCKS, draw_edges, make_scene  # noqa: E402
from family.exact import compute_exact, count_outside  # noqa: E402

sys.path.remove(str(FOLDER))


@pytest.mark.parametrize("kind", ["torque", "rotor"])
@pytest.mark.parametrize("name", SPANS)
def test_proofs_hold_next_to_edges(kind, name):
    ball = Ball(kind, name)
    scene, exact = ball.scene, ball.rates()
    motion = ph.solve(scene, 1e-6, certify="proof")
    bounds = zip(motion.omega_lower[:, 2].tolist(), exact, motion.omega_upper[:, 2].tolist(), strict=True)
    assert all(lower <= rate <= upper for lower, rate, upper in bounds)
    assert motion.error_kind == "proved" or (kind, name) == ("torque", "least")   # steps end at 2^-900


@pytest.mark.parametrize("method", [None, "exact", "taylor", "dop853"])
@pytest.mark.parametrize("name", SPANS)
@pytest.mark.parametrize("last_at_edge", [False, True])
def test_samples_and_dense_output_of_rotors_at_edges(method, name, last_at_edge):
    ball = Ball("rotor", name, last_at_edge)
    scene, exact = ball.scene, ball.rates()
    motion = ph.solve(scene, 1e-9, method=method, dense=True)
    rates = np.array([float(rate) for rate in exact])
    near = 2e-15 * np.abs(rates).max()
    assert np.abs(motion.omega[:, 2] - rates).max() < near
    assert np.abs([motion(t)[0][2] for t in scene.times] - rates).max() < near


@pytest.mark.parametrize("method", [None, "taylor", "dop853", "rk45"])
@pytest.mark.parametrize("name", SPANS)
@pytest.mark.parametrize("kind", ["torque", "formula"])
def test_samples_and_dense_output_of_torques_at_edges(method, name, kind):
    ball = Ball(kind, name)
    scene, exact = ball.scene, ball.rates()
    motion = ph.solve(scene, 1e-9, method=method, dense=True)
    rates = np.array([float(rate) for rate in exact])
    near = 1e-14 * np.abs(rates).max()
    assert motion.error_kind == "bounded" or name.startswith("far")   # pairs move the ends by two units: a limit there
    assert np.abs(motion.omega[:, 2] - rates).max() < near
    assert np.abs([motion(t)[0][2] for t in scene.times] - rates).max() < near


def test_bounds_of_a_proof_that_ends_hold_next_to_edges():
    torque = ph.torques.During(ph.torques.Constant((0, 0, 1e3)), [(1e6, 2e6)])
    scene = ph.Scene(inertia=(1, 1, 1), omega=(0, 0, 1e-6), torques=[torque], times=[1e6, 1e6 + 1e-5])
    motion = ph.solve(scene, 1e-15, certify="proof")
    rate = Fraction(1e-6) + 1000 * (Fraction(1e6 + 1e-5) - 10**6)
    assert Fraction(motion.omega_lower[1, 2]) <= rate <= Fraction(motion.omega_upper[1, 2])
    assert motion.stats["steps"] < 100   # slow until then: one long step


@pytest.mark.parametrize("index", range(len(CLOCKS)))
def test_random_scenes_in_fixed_point(index):
    numbers = draw_edges(1, index)
    motion = ph.solve(make_scene(numbers), numbers["accuracy"], certify="proof")
    truth = compute_exact(numbers)
    outside, judged = count_outside(motion, numbers, truth)
    assert outside == 0 and judged > 20


def test_a_proof_that_ends_early_holds_as_far_as_it_goes():
    """Back in time damping makes rates of two million rad/s: a proof to the end takes millions of steps."""
    numbers = draw_edges(90431, 135)
    motion = ph.solve(make_scene(numbers), numbers["accuracy"], certify="proof", max_steps=400)
    assert motion.status == "max_steps" and motion.proved_span[0] < numbers["t0"] < motion.proved_span[1]
    outside, judged = count_outside(motion, numbers)
    assert outside == 0 and judged > 50


def test_a_truth_of_other_numbers_lies_outside():
    numbers = draw_edges(1, 0)
    motion = ph.solve(make_scene(numbers), numbers["accuracy"], certify="proof")
    changed = {**numbers, "omega": [rate * (1 + 1e-9) for rate in numbers["omega"]]}
    assert count_outside(motion, changed)[0] > 20


@pytest.mark.parametrize("span", [1e-12, 1e3, 1e8, 1e20])
def test_a_body_at_rest_takes_one_step(span):
    motion = ph.solve(ph.Scene(inertia=(1, 2, 2.5), omega=(0, 0, 0), times=[span]), certify="proof")
    assert motion.error_kind == "proved" and motion.stats["steps"] == 1
    assert np.abs(motion.omega_upper).max() * span < 1e-20 and math.isfinite(motion.error)
