"""Bounds that were false once: each is compared with stored samples of the exact motion."""

import json
import pathlib

import numpy as np
import pytest

import polhode as ph

ROOT = pathlib.Path(__file__).parents[3]
CLAIMS = json.loads((ROOT / "tests/reference/certificates.json").read_text())["claims"]


def read_scene(claim):
    return eval(claim["scene"], {"ph": ph})   # written by benchmarks/planner/family


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda one: f"{one['kind']}-{one['index']}")
def test_a_bound_holds(claim):
    scene = read_scene(claim)
    motion = ph.solve(scene, claim["accuracy"])
    true_omega, true_attitude = np.array(claim["omega"]), np.array(claim["attitude"])
    rows = claim["samples"]
    largest = max(np.linalg.norm(scene.omega), np.linalg.norm(motion.omega, axis=1).max())
    rates = np.linalg.norm(motion.omega[rows] - true_omega, axis=1).max() / largest
    apart = [np.linalg.norm(motion.attitude[rows] + sign * true_attitude, axis=1) for sign in (-1, 1)]
    found = max(rates, 2 * np.minimum(*apart).max())
    assert 0 < found <= motion.error


def test_a_short_series_of_the_error_does_not_refuse_a_stable_motion():
    claim = next(one for one in CLAIMS if one["kind"] == "long")
    motion = ph.solve(read_scene(claim), claim["accuracy"])
    assert motion.success and motion.error <= claim["accuracy"]
