"""Published check cases (tests/reference/published.json, each with its source) and the stored truth of free bodies."""

import itertools
import json
import tomllib
from pathlib import Path

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from scipy.integrate import solve_ivp

import polhode as ph

ROOT = Path(__file__).parents[3]
CASES = json.loads((ROOT / "tests/reference/published.json").read_text())


def errors(omega, attitude, omega_ref, attitude_ref):
    """The error measure of the scenes: of the rates, relative, and of the attitude [rad]."""
    rates = np.linalg.norm(omega - omega_ref, axis=-1).max() / np.linalg.norm(omega_ref, axis=-1).max()
    both = (np.linalg.norm(attitude + sign * attitude_ref, axis=-1) for sign in (1, -1))
    apart = np.minimum(*both)
    return rates, 4 * np.arcsin(apart.max() / 2)


def turned(q, v):
    """v_W = R(q) v_B, rows of arrays."""
    u, s = q[..., :3], q[..., 3:]
    return v + 2 * np.cross(u, np.cross(u, v) + s * v)


@pytest.mark.parametrize("name", ["S1", "S2", "S3", "Z1", "N2"])
def test_free_scenes_in_closed_form(name):
    scene = tomllib.loads((ROOT / f"scenes/{name}.toml").read_text())
    start = scene["start"].get("omega") or np.radians(scene["start"]["omega_deg"])
    with np.load(ROOT / f"scenes/reference/{name}.npz") as truth:
        found = ph.FreeMotion(scene["body"]["moments"], start).at(truth["t"])
        rates, angle = errors(*found, truth["omega"], truth["attitude"])
    # Degrees are rounded to rad/s on the way in, which costs N2 up to its floor.
    bound = 1.2e-14 if name == "N2" else 4e-15
    assert rates < bound and angle < bound


def test_nesc_tumbling_brick():
    """NESC check case 2: rates after 30 s, within what the flight simulators agree on."""
    case = CASES["nesc_2"]
    moments = np.array(case["moments_slug_ft2"]) * case["kg_m2_per_slug_ft2"]
    omega, _ = ph.FreeMotion(moments, np.radians(case["omega_deg"])).at(case["span"])
    assert np.abs(np.degrees(omega) - case["end_omega_deg"]).max() < case["agreement_deg"] / 20


def test_the_bricks_moments_come_from_its_sides():
    case = CASES["nesc_2"]
    half_sides = np.array(case["sides_inch"]) * 0.0254 / 2
    kilograms = case["mass_slug"] * case["kg_m2_per_slug_ft2"] / 0.3048**2
    block = ph.shapes.box(kilograms, half_sides)
    published = np.array(case["moments_slug_ft2"]) * case["kg_m2_per_slug_ft2"]
    np.testing.assert_allclose(np.diag(block.inertia.matrix), published, rtol=2e-7)  # published with seven digits


@pytest.mark.parametrize("omega", [(2.0, 4.0, -1.3), (0.5, -0.1, 9.0), (1e-3, 2e-3, 3.0), (4.0, -2.0, 0.01)])
def test_kanes_symmetric_body(omega):
    moment, _, axial = CASES["kane_symmetric"]["moments"]
    times = np.array([0.0, 0.3, 7.0, 123.0, -5.5])
    with mpmath.workdps(40):
        w1, w2, w3 = (mpf(w) for w in omega)
        c = w3 * mpf(axial) / mpf(moment)
        s, p = w3 - c, mpmath.sqrt(w1**2 + w2**2 + c**2)
        rates, attitudes = [], []
        for t in times:
            cos_s, sin_s = mpmath.cos(s * mpf(t) / 2), mpmath.sin(s * mpf(t) / 2)
            cos_p, sin_p = mpmath.cos(p * mpf(t) / 2), mpmath.sin(p * mpf(t) / 2) / p
            cos_2s, sin_2s = mpmath.cos(s * mpf(t)), mpmath.sin(s * mpf(t))
            rates.append([float(w1 * cos_2s + w2 * sin_2s), float(w2 * cos_2s - w1 * sin_2s), float(w3)])
            q = (sin_p * (w1 * cos_s + w2 * sin_s), sin_p * (w2 * cos_s - w1 * sin_s),
                 c * sin_p * cos_s + cos_p * sin_s, cos_p * cos_s - c * sin_p * sin_s)  # fmt: skip
            attitudes.append([float(x) for x in q])
    found = ph.FreeMotion([moment, moment, axial], omega).at(times)
    assert max(errors(*found, np.array(rates), np.array(attitudes))) < 3e-15


def test_orekits_tumbling_body_keeps_its_momentum():
    case = CASES["orekit_torque_free"]
    w, x, y, z = np.array(case["attitude_wxyz_space_to_body"]) / np.linalg.norm(case["attitude_wxyz_space_to_body"])
    start = np.array([-x, -y, -z, w])
    times = np.arange(*case["times"], 0.01)
    runs = [(m, case["omega"]) for m in itertools.permutations(case["moments"])]
    runs += [(case["moments"], w) for w in itertools.permutations(case["omega"])]
    for moments, spin in runs:
        omega, attitude = ph.FreeMotion(moments, spin, start).at(times)
        momentum = turned(attitude, np.array(moments) * omega)
        first = turned(start, np.array(moments) * np.array(spin))
        sizes, size = np.linalg.norm(momentum, axis=1), np.linalg.norm(first)
        assert (np.linalg.norm(np.cross(momentum, first), axis=1) / (sizes * size)).max() < case["momentum_angle"]
        np.testing.assert_allclose(sizes, size, rtol=2e-15)


def test_lagranges_top_in_closed_form():
    """S4 against its stored truth, within two floors: the start angle is rounded on the way in."""
    scene = tomllib.loads((ROOT / "scenes/S4.toml").read_text())
    torque, start = scene["torques"][0], scene["start"]
    attitude = ph.Rotation.from_euler(start["euler"]["sequence"], start["euler"]["angles"]).as_quat()
    top = ph.HeavyTop(scene["body"]["moments"], torque["weight"] * torque["arm"][2], start["omega"], attitude)
    with np.load(ROOT / "scenes/reference/S4.npz") as truth:
        rates, angle = errors(*top.at(truth["t"]), truth["omega"], truth["attitude"])
    assert rates < 3e-14 and angle < 3.2e-13


def test_sciml_rigid_body():
    """Three equations with a forcing, of a body no mass can have: against SciPy on the published equations."""
    case = CASES["sciml_rigid_body"]
    a, b, c = case["coefficients"]
    i1, i2, i3 = case["moments"]
    assert [(i2 - i3) / i1, (i3 - i1) / i2, (i1 - i2) / i3] == case["coefficients"]
    times = np.linspace(0.0, case["span"], 41)

    def published(t, y):
        return [a * y[1] * y[2], b * y[0] * y[2], c * y[0] * y[1] + case["force_amplitude"] * np.sin(t) ** 2]

    def force(t, omega, attitude):
        return [0.0, 0.0, i3 * case["force_amplitude"] * np.sin(t) ** 2]

    truth = solve_ivp(published, (0, case["span"]), case["omega"], "DOP853", times, rtol=2.3e-14, atol=1e-15).y.T
    with pytest.raises(ph.InvalidInput, match="triangle"):
        ph.InertiaTensor.from_moments((i1, i2, i3))
    body = ph.InertiaTensor.from_moments((i1, i2, i3), physical=False)
    scene = ph.Scene(inertia=body, omega=case["omega"], torques=[ph.torques.Custom(force)], times=times, want=["omega"])
    motion = ph.solve(scene, rtol=1e-12, atol=1e-14)
    assert np.abs(motion.omega - truth).max() < 1e-10
