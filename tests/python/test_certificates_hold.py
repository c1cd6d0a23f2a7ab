"""Bounds that were false once: each is compared with stored samples of the exact motion."""

import json
import pathlib
import sys

import numpy as np
import pytest

import polhode as ph

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "benchmarks/planner"))
import family  # noqa: E402

sys.path.remove(str(ROOT / "benchmarks/planner"))
CLAIMS = json.loads((ROOT / "tests/reference/certificates.json").read_text())["claims"]


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda one: f"{one['kind']}-{one['index']}")
def test_a_bound_holds(claim):
    scene = family.draw(31, claim["kind"], claim["index"]).scene
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
    motion = ph.solve(family.draw(31, claim["kind"], claim["index"]).scene, claim["accuracy"])
    assert motion.success and motion.error <= claim["accuracy"]
