"""Motions that other people published with their numbers: NESC check case 2 by five simulators, DETEST B5."""

import json
from pathlib import Path

import numpy as np
import pytest

import polhode as ph

ROOT = Path(__file__).parents[3]
CASES = json.loads((ROOT / "tests/reference/published.json").read_text())
SIMULATORS = sorted(CASES["nesc_2_attitude"]["worst_rate_deg"])


def compare_nesc(simulator):
    """The largest differences of a simulator from the closed form: of the rates [deg/s] and of the attitude [deg]."""
    case, about = CASES["nesc_2"], CASES["nesc_2_attitude"]
    path = ROOT / f"tests/reference/nesc/sim_{simulator}.csv"
    rows = np.genfromtxt(path, delimiter=",", names=True)
    moments = np.array(case["moments_slug_ft2"]) * case["kg_m2_per_slug_ft2"]
    zero = np.array([[0.0, 0, -1], [0, 1, 0], [1, 0, 0]])   # columns: north, east and down on the equator
    free = ph.FreeMotion(moments, np.radians(case["omega_deg"]), ph.Rotation.from_matrix(zero))
    omega, attitude = free.at(rows["time"])
    rates = np.stack([rows[f"bodyAngularRateWrtEi_deg_s_{name}"] for name in ("Roll", "Pitch", "Yaw")], axis=1)
    east = about["earth_rate"] * rows["time"] + np.radians(rows["longitude_deg"])
    turned = ph.Rotation.from_rotvec(np.outer(east, (0.0, 0, 1)))
    angles = np.stack([rows[f"eulerAngle_deg_{name}"] for name in ("Yaw", "Pitch", "Roll")], axis=1)
    theirs = turned * ph.Rotation.from_matrix(zero) * ph.Rotation.from_euler("ZYX", angles, degrees=True)
    apart = (theirs.inv() * ph.Rotation.from_quat(attitude)).magnitude()
    return float(np.abs(np.degrees(omega) - rates).max()), float(np.degrees(np.max(apart)))


@pytest.mark.parametrize("simulator", SIMULATORS)
def test_nesc_case_2_by_each_simulator(simulator):
    about = CASES["nesc_2_attitude"]
    rate, angle = compare_nesc(simulator)
    for found, most in ((rate, about["worst_rate_deg"][simulator]), (angle, about["worst_angle_deg"][simulator])):
        assert most / 30 < found <= most


def test_the_page_has_the_table_of_the_simulators():
    page = (ROOT / "docs/evidence/external.md").read_text()
    for simulator in SIMULATORS:
        rate, angle = compare_nesc(simulator)
        assert f"| {simulator} | {rate:.1e} | {angle:.1e} |" in page


def test_detest_b5():
    case = CASES["detest_b5"]
    one, two, three = case["moments"]
    own = np.array([(two - three) / one, (three - one) / two, (one - two) / three])
    ratio = np.array(case["coefficients"]) / own          # s2 s3 / s1 and so on, of rates that are s times y
    scale = np.sqrt(np.array([ratio[1] * ratio[2], ratio[2] * ratio[0], ratio[0] * ratio[1]]))
    assert (ratio > 0).all()
    omega, _ = ph.FreeMotion(case["moments"], scale * case["start"]).at(case["span"])
    np.testing.assert_allclose(omega / scale, case["end"], rtol=0, atol=5e-15)
