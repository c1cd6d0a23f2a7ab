"""Derivatives of driven motions: the stored truth, the stated errors, and identities that hold without a table."""

import json
import pathlib

import levels
import numpy as np
import pytest

import polhode as ph

CASES = json.loads((pathlib.Path(__file__).parents[2] / "reference" / "driven_sensitivity.json").read_text())


def torque(given):
    kind = given["kind"]
    if kind == "gravity":
        made = ph.torques.Gravity(given["weight"], given["arm"])
    elif kind == "gravity_gradient":
        made = ph.torques.GravityGradient(given["mean_motion"], given["phase"])
    elif kind == "constant":
        made = ph.torques.Constant(given["torque"], given["frame"])
    elif kind == "damping":
        made = ph.torques.Damping(given["matrix"])
    else:
        made = ph.torques.AngularDamping(given["rate"])
    return ph.torques.During(made, given["windows"]) if "windows" in given else made


def scene_of(case, **changes):
    return ph.Scene(inertia=case["inertia"], omega=case["omega"], attitude=case["attitude"],
                    torques=[torque(given) for given in case["torques"]],
                    rotors=[ph.Rotor(**given) for given in case["rotors"]], times=case["times"]).replace(**changes)


def sizes(columns, scale):
    """The size of six numbers, the last axis: the larger of abs(d omega) / scale and the angle."""
    return np.maximum(np.linalg.norm(columns[..., :3], axis=-1) / scale, np.linalg.norm(columns[..., 3:], axis=-1))


def stacked(s):
    return np.moveaxis(np.concatenate([s.d_omega, s.d_attitude], axis=1), 1, 2)   # (times, columns, 6)


def find_errors(name, accuracy):
    case = CASES[name]
    s = ph.solve(scene_of(case), accuracy, sensitivity=case["groups"]).sensitivity
    assert s.columns == tuple(case["columns"])
    truth = np.moveaxis(np.array(list(case["columns"].values())), 0, 1)
    scale = max(np.linalg.norm(case["omega"]), np.linalg.norm(case["true_omega"], axis=1).max())
    size = sizes(truth, scale)
    found = sizes(stacked(s) - truth, scale)
    assert not found[size == 0].any()   # before a window begins its ends change nothing
    return (found / np.where(size > 0, size, 1.0)).max(axis=0), s


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("accuracy", [1e-7, 1e-10, 1e-12])
def test_columns_have_the_error_that_they_state(name, accuracy):
    errors, s = find_errors(name, accuracy)
    assert (errors <= s.error).all()
    assert s.error.max() <= accuracy + 4e-13
    assert errors.max() < 0.3 * accuracy


def test_without_a_certificate_there_is_one_run_and_no_error():
    case = CASES["wheels"]
    one = ph.solve(scene_of(case), 1e-10, certify=False, sensitivity="inertia").sensitivity
    two = ph.solve(scene_of(case), 1e-10, sensitivity="inertia").sensitivity
    assert one.error is None
    np.testing.assert_array_equal(one.d_omega, two.d_omega)


def test_finer_accuracy_reaches_rounding():
    assert all(find_errors(name, 1e-14)[0].max() < 1e-12 for name in CASES)


def test_the_motion_beside_the_columns_is_the_motion():
    for case in CASES.values():
        motion = ph.solve(scene_of(case), 1e-11, sensitivity="omega")
        s = motion.sensitivity
        assert abs(s.omega - motion.omega).max() < 1e-10 * motion.omega_scale
        assert abs((s.attitude * motion.attitude).sum(axis=1)).min() > 1 - 1e-15


def test_instruction_sets_give_the_same_bits():
    program = ("import hashlib, test_driven_sensitivity as t; "
               "found = [t.find_errors(n, 1e-11)[1] for n in t.CASES]; "
               "rows = [s.d_omega.tobytes() + s.d_attitude.tobytes() for s in found]; "
               "print(hashlib.sha256(b''.join(rows)).hexdigest())")
    assert len(set(levels.outputs(program).values())) == 1


def test_transition_of_two_parts_is_the_product():
    case = CASES["all"]
    whole = ph.solve(scene_of(case, times=[2.0, 5.0]), 1e-12, sensitivity=("omega", "attitude")).sensitivity
    later = scene_of(case, t0=2.0, omega=whole.omega[0], attitude=whole.attitude[0], times=[5.0])
    part = ph.solve(later, 1e-12, sensitivity=("omega", "attitude")).sensitivity
    np.testing.assert_allclose(part.transition[0] @ whole.transition[0], whole.transition[1], rtol=0, atol=1e-11)


def test_sides_differ_by_the_attitude():
    case = CASES["wheels"]
    space = ph.solve(scene_of(case), 1e-12, sensitivity=("inertia", "attitude")).sensitivity
    body = ph.solve(scene_of(case), 1e-12, sensitivity=("inertia", "attitude"), side="body").sensitivity
    R = ph.Rotation.from_quat(space.attitude).as_matrix()
    np.testing.assert_allclose(R @ body.d_attitude[..., :3], space.d_attitude[..., :3], rtol=0, atol=1e-11)
    start = ph.Rotation.from_quat(scene_of(case).attitude).as_matrix()
    np.testing.assert_allclose(R @ body.d_attitude[..., 3:] @ start.T, space.d_attitude[..., 3:], rtol=0, atol=1e-10)


def test_gravity_scales_with_the_inertia():
    # weight and all moments together change nothing: weight d/d weight + sum of J d/dJ = 0
    case = CASES["S5"]
    s = ph.solve(scene_of(case), 1e-12, sensitivity=("gravity.weight", "inertia")).sensitivity
    factors = [2.0, *case["inertia"]]
    assert abs(s.d_omega @ factors).max() < 1e-11 * abs(s.d_omega).max()
    assert abs(s.d_attitude @ factors).max() < 1e-11 * abs(s.d_attitude).max()


def test_free_bodies_have_their_closed_form():
    scene = ph.Scene(inertia=(0.2, 0.4, 0.52), omega=(1, 2, 3), times=[3.0, 7.0], t0=2.0)
    s = ph.solve(scene, sensitivity=("omega", "inertia")).sensitivity
    exact = ph.FreeMotion((0.2, 0.4, 0.52), (1, 2, 3)).sensitivity([1.0, 5.0])
    assert s.error is None
    np.testing.assert_array_equal(s.d_omega, exact.d_omega)
    # the same body with a torque of zero has its equations integrated
    same = ph.solve(scene.replace(torques=[ph.torques.Constant((0, 0, 0))]), 1e-12, sensitivity=("omega", "inertia"))
    np.testing.assert_allclose(same.sensitivity.d_omega, exact.d_omega, rtol=0, atol=1e-11)
    np.testing.assert_allclose(same.sensitivity.d_attitude, exact.d_attitude, rtol=0, atol=1e-10)


@pytest.mark.parametrize("factor", [1e-12, 1e12])
def test_errors_do_not_depend_on_units(factor):
    case = CASES["S5"]
    plain = ph.solve(scene_of(case), 1e-10, sensitivity=("omega", "gravity.weight")).sensitivity
    heavy = scene_of(case, inertia=np.multiply(case["inertia"], factor),
                     torques=[ph.torques.Gravity(2.0 * factor, case["torques"][0]["arm"])])
    s = ph.solve(heavy, 1e-10, sensitivity=("omega", "gravity.weight")).sensitivity
    np.testing.assert_allclose(s.d_omega[..., 3] * factor, plain.d_omega[..., 3], rtol=1e-9, atol=1e-10)
    fast = scene_of(case, omega=np.multiply(case["omega"], factor), times=np.divide(case["times"], factor),
                    torques=[ph.torques.Gravity(2.0 * factor**2, case["torques"][0]["arm"])])
    s = ph.solve(fast, 1e-10, sensitivity=("omega", "gravity.weight")).sensitivity
    np.testing.assert_allclose(s.d_omega[..., :3], plain.d_omega[..., :3], rtol=1e-9, atol=1e-9)
    assert s.error.max() < 1e-9


def test_a_body_at_rest_is_differentiated():
    scene = ph.Scene(inertia=(1, 2, 2.5), omega=(0, 0, 0), times=[0.0, 2.0],
                     torques=[ph.torques.Constant((0.1, 0, 0))])
    s = ph.solve(scene, 1e-12, sensitivity=("omega", "constant.torque", "inertia")).sensitivity
    np.testing.assert_allclose(s.d_omega[1, 0], [1, 0, 0, 2, 0, 0, -0.2, 0, 0], atol=1e-14)   # t tau / J
    np.testing.assert_allclose(s.d_attitude[1, 0], [2, 0, 0, 2, 0, 0, -0.2, 0, 0], atol=1e-13)


@pytest.mark.parametrize(("names", "message"), [
    ("weight", "'torques.0.weight'"), ("gravity.mass", "Gravity, which has 'weight', 'arm'"),
    ("torques.1.weight", "the scene has 1"), ("rotors.0.momentum", "the scene has 0"), (("omega", "omega"), "once"),
    ((), "names such as"), (3, "names such as"), ("torques.0.windows", "'weight', 'arm'")])
def test_wrong_names_are_refused_in_words(names, message):
    with pytest.raises(ph.InvalidInput, match="sensitivity: .*" + message):
        ph.solve(scene_of(CASES["S5"]), sensitivity=names)


def test_what_cannot_be_differentiated_is_refused():
    scene = scene_of(CASES["S5"])
    own = scene.replace(torques=[ph.torques.Custom(lambda t, omega, attitude: (0.0, 0.0, 0.0))])
    with pytest.raises(ph.InvalidInput, match="without a formula"):
        ph.solve(own, sensitivity="omega")
    with pytest.raises(ph.InvalidInput, match="events: must be left out with sensitivity"):
        ph.solve(scene, sensitivity="omega", events=[lambda t, omega, attitude: omega[0]])
    with pytest.raises(ph.InvalidInput, match="rtol: must be left out with sensitivity"):
        ph.solve(scene, rtol=1e-6, sensitivity="omega")
    with pytest.raises(RuntimeError, match="more than 3 steps"):
        ph.solve(scene, sensitivity="omega", max_steps=3)
