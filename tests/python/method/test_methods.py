"""The methods on the stored scenes, what the engines' steps do to a free body, and everything that may end a run.

What all of them must do alike is in tests/cpp/solve/test_method_conformance.cpp.
"""

import pathlib
import re

import numpy as np
import pytest
from bodies import BLOCK, PARTS, TILTED, scene
from measures import attitude_error, error, truth

import polhode as ph

METHODS = {record["name"]: record for record in ph.methods()}
FIXED = [name for name, record in METHODS.items() if not record["adaptive"]]
ADAPTIVE = [name for name, record in METHODS.items() if record["adaptive"]]


# ---- against stored truth

# The error at two tolerances, with a factor 2 above and 5 below what was measured.
# (S7 holds dop853 at its limit of stability, where what lies between the steps is worse than their ends.)
DOP853 = {"S4": (5.8e-4, 1.9e-8), "S5": (2.9e-6, 1.5e-10), "S6": (5.6e-4, 2.8e-8), "S7": (6.1e-5, 4.2e-7),
          "S9": (4.0e-6, 3.6e-10)}
RADAU = {"S5": (3.5e-6, 2.8e-9), "S7": (1.0e-6, 1.3e-9), "S7b": (1.7e-6, 1.6e-9), "S9": (1.6e-5, 7.5e-9)}


def load(name):
    if name != "S7b":
        return scene(name)
    n = np.array((1, 2, 2)) / 3
    return scene("S7", torques=[ph.torques.Damping(0.01 * np.eye(3) + 1e5 * np.outer(n, n))])


@pytest.mark.parametrize(("method", "name", "reached"), [("dop853", *item) for item in DOP853.items()] +
                         [("radau", *item) for item in RADAU.items()])
def test_error_against_stored_truth(method, name, reached):
    for rtol, level in zip((1e-6, 1e-10), reached, strict=True):
        motion = ph.solve(load(name), method=method, rtol=rtol)
        found = error(motion.omega, motion.attitude, truth(name))
        assert level / 5 < found < 2 * level, (rtol, found)


def test_stiff_damping_takes_radau_few_steps_and_an_explicit_method_very_many():
    stiff = ph.solve(load("S7b"), method="radau", rtol=1e-7)
    assert error(stiff.omega, stiff.attitude, truth("S7b")) < 1e-6 and stiff.stats["steps"] < 200
    assert stiff.stats["derivatives"] < 7.5 * stiff.stats["steps"], "two Newton steps with the right Jacobian"
    explicit = ph.solve(load("S7b"), method="rk45", rtol=1e-7, max_steps=100_000)
    assert explicit.status == "max_steps" and explicit.t[-1] < 10


@pytest.mark.parametrize(("name", "step"), [("S4", 0.05), ("S5", 0.1), ("S6", 31.4159265)])
def test_the_symplectic_map_has_order_four_and_its_energy_stays(name, step):
    runs = [ph.solve(scene(name), method="symplectic", step=step / k) for k in (1, 2)]
    errors = [error(m.omega, m.attitude, truth(name)) for m in runs]
    assert 3.6 < np.log2(errors[0] / errors[1]) < 4.6 and errors[1] < 1e-7
    parts = PARTS[name]
    spans = [parts["times"][-1] * k for k in (1, 10)]
    moved = [max(ph.solve(scene(name, times=np.linspace(0, span, 101)), method="symplectic", step=step).drift.values())
             for span in spans]
    assert moved[1] < 3 * moved[0] < 3e-6, "bounded, not growing"


@pytest.mark.parametrize("moments", [(0.2, 0.4, 0.52), (0.52, 0.2, 0.4), (0.4, 0.52, 0.2), (0.4, 0.2, 0.52),
                                     (0.02, 0.999, 1.0),
                                     (1.0, 1.0 + 1e-9, 1.5), (0.5, 1.0, 1.0 + 1e-12), (0.999, 1.0, 1.001)])
@pytest.mark.parametrize("omega", [(1, 2, 3), (-3, 1e-3, 2), (0.3, -4, 1e-7)])
def test_the_drift_of_the_symplectic_map_is_the_free_motion(moments, omega):
    """By series of every order, in several parts, and where that would be long by the closed form."""
    for step in np.geomspace(1e-3, 4, 12):
        one = scene("S1", inertia=moments, omega=omega, times=[0.0, step, 2 * step])
        found, exact = ph.solve(one, method="symplectic", step=step), ph.solve(one, method="exact")
        # rounding of the fastest rate
        least = max(5e-15, 4e-16 * 2 * step * max(moments) / min(moments) * np.linalg.norm(omega))
        assert error(found.omega, found.attitude, {"omega": exact.omega, "attitude": exact.attitude}) < least


RACKETEERS = [("symplectic", {"step": 0.0625}, 5e-12), ("radau", {"rtol": 1e-13}, 5e-9)]


@pytest.mark.parametrize(("method", "setting", "least"), RACKETEERS)
@pytest.mark.parametrize("closeness", [1e-2, 1e-6, 1e-12])
def test_separatrix_variables_keep_the_racket(method, setting, least, closeness):
    """Through flips that forget every digit of omega that is not carried along."""
    one = scene("S1", inertia=(0.4, 0.52, 0.2), omega=(5, closeness, closeness), times=np.arange(0, 401) * 0.5)
    found, exact = ph.solve(one, method=method, **setting), ph.solve(one, method="exact")
    assert error(found.omega, found.attitude, {"omega": exact.omega, "attitude": exact.attitude}) < least


@pytest.mark.parametrize(("method", "setting", "least"), [*RACKETEERS, ("radau", {"rtol": 1e-10}, 2e-6)])
@pytest.mark.parametrize("torque", [ph.torques.Constant((1e-9, 2e-9, -1e-9), frame="body"),
                                    ph.torques.Gravity(1e-8, (0.3, 0.2, 0.5))])
def test_separatrix_variables_keep_a_racket_that_is_pushed(method, setting, least, torque):
    """taylor is the witness, in a body with other axes: turning 5 rad/s there and back rounds the small rates."""
    turn = ph.Rotation.from_rotvec((0.3, -0.5, 0.7))
    R = turn.as_matrix()
    inertia = R @ np.diag((0.2, 0.4, 0.52)) @ R.T
    one = scene("S1", inertia=(inertia + inertia.T) / 2, omega=R @ (1e-6, 5, 1e-6), torques=[torque],
                times=np.arange(0, 81) * 0.5)
    witness = ph.solve(one, method="taylor", rtol=1e-16)
    found = ph.solve(one, method=method, **setting)
    assert (error(found.omega, found.attitude, {"omega": witness.omega, "attitude": witness.attitude})
            < max(least, 1e-10))


# ---- the engines' steps (the reference figures are of prototypes in another program, to two digits)

AT_40_SECONDS = {   # S1's body at h = 0.02: T/T0 - 1, |L|/|L0| - 1
    "euler": (61, 6.2), "semi_euler": (61, 6.2), "jolt": (0.19, None), "catto": (-0.22, -0.085), "buss": (2.1e-3, None),
    "split": (6.4e-6, None), "rk4": (-4.7e-8, -1.8e-8),
}


@pytest.mark.parametrize("name", AT_40_SECONDS)
def test_what_a_step_does_to_energy_and_momentum(name):
    motion = ph.solve(scene("S1", times=[0.0, 40.0]), method=name, step=0.02)
    L = np.linalg.norm(motion.angular_momentum, axis=1)
    for found, known in zip((motion.energy[1] / motion.energy[0] - 1, L[1] / L[0] - 1), AT_40_SECONDS[name],
                            strict=True):
        assert abs(found) < 2e-14 if known is None else abs(found / known - 1) < 0.03


def test_where_the_wrong_steps_end():
    """The clamp ends at T = L^2 / 2 I2, Buss at L^2 / 2 I1; Catto's as a spin about the axis of the greatest moment."""
    for name, axis, step in (("jolt", 1, 0.02), ("buss", 0, 0.05), ("catto", 2, 0.02)):
        motion = ph.solve(scene("S1", times=[0.0, 4000.0]), method=name, step=step)
        w = motion.omega[-1]
        assert abs(w[axis]) > 0.99 * np.linalg.norm(w), (name, w)
    ignored = ph.solve(scene("S1", times=[0.0, 40.0]), method="ignore", step=0.02)
    np.testing.assert_allclose(ignored.omega[1], (1, 2, 3), rtol=1e-14)


def test_conserving_is_not_being_right():
    """After a hundred turns: energy and momentum to rounding, and the attitude lost, or not."""
    turn = 2 * np.pi / np.sqrt(14)
    exact = ph.FreeMotion(BLOCK, (1, 2, 3)).at(np.array([100 * turn]))
    for name, steps_a_turn, low, high in (("midpoint", 38, 1.4, 1.9), ("dmv2", 40, 2.0, 2.8), ("dmv6", 20, 5e-5, 5e-4),
                                          ("dmv8", 20, 1e-7, 1e-6)):
        motion = ph.solve(scene("S1", times=[100 * turn]), method=name, step=turn / steps_a_turn)
        assert max(motion.drift.values()) < 1e-13
        assert low < attitude_error(motion.attitude, exact[1]) < high


def test_a_torque_within_a_step_is_of_order_one_and_about_a_step_of_two():
    reference = truth("S9")
    end = {"omega": reference["omega"][-1:], "attitude": reference["attitude"][-1:]}
    for name, order in (("semi_euler", 1), ("jolt", 1), ("catto", 1), ("buss", 2), ("split", 2), ("midpoint", 2),
                        ("dmv8", 2),
                        ("rk4", 4)):
        h = {1: 1e-3, 2: 4e-3, 4: 0.05}[order]
        runs = [ph.solve(scene("S9", times=[100.0]), method=name, step=h / k) for k in (1, 2)]
        found = [error(m.omega, m.attitude, end) for m in runs]
        assert abs(np.log2(found[0] / found[1]) - order) < 0.35, (name, found)


def test_damping_keeps_the_order_two_of_the_half_kicks():
    """A half kick by the torque at its start alone would make this order 1."""
    mild = {"torques": [ph.torques.Damping((0.3, 0.2, 0.1))], "times": [5.0]}
    exact = ph.solve(scene("S7", **mild), method="dop853", rtol=1e-13)
    for name in ("split", "midpoint", "dmv6"):
        found = [error(m.omega, m.attitude, {"omega": exact.omega, "attitude": exact.attitude})
                 for m in (ph.solve(scene("S7", **mild), method=name, step=h) for h in (0.02, 0.01))]
        assert abs(np.log2(found[0] / found[1]) - 2) < 0.2, (name, found)


def test_a_full_tensor_turns_as_its_principal_axes_do():
    turn = ph.Rotation.from_rotvec((0.3, -0.5, 0.7))
    R = turn.as_matrix()
    times = np.linspace(0, 3, 13)
    parts = {"torques": [ph.torques.Gravity(2, (0.3, 0.2, 0.5))]}
    turned = {"inertia": R.T @ np.diag((1, 2, 2.5)) @ R, "omega": R.T @ (0.3, 0.2, 3),
              "attitude": (ph.Rotation.from_quat(TILTED) * turn).as_quat(),
              "torques": [ph.torques.Gravity(2, R.T @ (0.3, 0.2, 0.5))]}
    turned["inertia"] = (turned["inertia"] + turned["inertia"].T) / 2
    for name in FIXED:
        plain = scene("S5", times=times, **parts)
        if METHODS[name]["needs"] and name != "symplectic":
            continue
        a = ph.solve(plain, method=name, step=0.01)
        b = ph.solve(scene("S5", times=times, **turned), method=name, step=0.01)
        np.testing.assert_allclose(b.omega @ R.T, a.omega, atol=1e-11)
        assert attitude_error((ph.Rotation.from_quat(b.attitude) * turn.inv()).as_quat(), a.attitude) < 1e-11


def test_leapfrog_in_angles_fails_near_the_vertical_and_refuses_other_bodies():
    error_at = []
    for tilt in (0.5, 0.03):
        body = ph.Scene(inertia=(0.4, 0.4, 0.2), omega=(0, 2, 4), attitude=(np.sin(tilt / 2), 0, 0, np.cos(tilt / 2)),
                        times=[20.0])
        motion = ph.solve(body, method="leapfrog", step=1e-3)
        exact = ph.FreeMotion((0.4, 0.4, 0.2), (0, 2, 4), body.attitude).at(np.array([20.0]))
        error_at.append(attitude_error(motion.attitude, exact[1]))
    assert error_at[0] < 1e-4 and error_at[1] > 5e-3
    for changes in ({}, {"inertia": (1, 1, 0.5), "torques": [ph.torques.Gravity(2, (0.1, 0, 1))]}):
        with pytest.raises(ph.InvalidInput, match="I1 = I2"):
            ph.solve(scene("S5", **changes), method="leapfrog", step=0.01)


# ---- options


@pytest.mark.parametrize("name", FIXED)
def test_a_fixed_step_is_asked_for_and_tolerances_are_refused(name):
    with pytest.raises(ph.InvalidInput, match="step"):
        ph.solve(scene("S1"), method=name)
    for options in ({"rtol": 1e-6}, {"atol": 1e-6}, {"accuracy": 1e-6}, {"step": 0.0}, {"step": np.nan},
                    {"formulation": "lagrangian"}):
        if name == "rk4" and "formulation" in options:
            continue
        with pytest.raises(ph.InvalidInput):
            ph.solve(scene("S4"), method=name, **{"step": 0.1, **options})


# ---- what may end a run, by every method: everything up to there is returned



def run(name, body, **options):
    fine = {"rtol": 1e-8} if METHODS[name]["adaptive"] else {"step": 0.001}
    try:
        return ph.solve(body, method=name, **fine, **options)
    except ph.InvalidInput as refused:
        if "must be used with" in str(refused):
            pytest.skip(f"{name} does not take the scene")
        raise


def watched(function, **claims):
    times = np.linspace(0, 2, 21)
    return ph.Scene(inertia=BLOCK, omega=(1, 2, 3), torques=[ph.torques.Custom(function, **claims)], times=times)


@pytest.mark.parametrize("name", METHODS)
def test_nan_on_the_way_ends_the_run_there(name):
    motion = run(name, watched(lambda t, w, q: (0.0, 0.0, 0.01 if t < 1.05 else np.nan), uses_attitude=False,
                               uses_rates=False))
    assert motion.status == "failed" and not motion.success and "not finite" in motion.message
    np.testing.assert_array_equal(motion.t, np.linspace(0, 2, 21)[:11])
    assert np.isfinite(motion.omega).all() and np.isfinite(motion.attitude).all()


@pytest.mark.parametrize("name", METHODS)
def test_what_a_callable_raises_comes_through(name):
    def broken(t, w, q):
        if t > 1:
            raise ZeroDivisionError("out of fuel")
        return (0.0, 0.0, 0.01)

    with pytest.raises(ZeroDivisionError, match="out of fuel"):
        run(name, watched(broken, uses_attitude=False, uses_rates=False))


@pytest.mark.parametrize("name", METHODS)
def test_blow_up_in_finite_time_ends_with_what_was_reached(name):
    """w3' = w3^2 about a principal axis: infinite at t = 1 / w3(0) = 1."""
    body = ph.Scene(inertia=(1, 1.5, 2), omega=(0, 0, 1), times=np.linspace(0, 2, 21),
                    torques=[ph.torques.Custom(lambda t, w, q: (0.0, 0.0, 2 * float(w[2]) * float(w[2])),
                                               uses_attitude=False)])
    motion = run(name, body, max_steps=200_000)
    assert motion.status == "failed" and not motion.success
    assert 9 <= motion.t.size <= 12 and np.isfinite(motion.omega).all()
    if METHODS[name]["adaptive"]:
        np.testing.assert_allclose(motion.omega[:9, 2], 1 / (1 - motion.t[:9]), rtol=1e-5)


@pytest.mark.parametrize("name", [n for n in METHODS if METHODS[n]["implicit"] and not METHODS[n]["adaptive"]
                                  and n != "catto"])
def test_an_implicit_step_without_a_solution_says_so(name):
    motion = ph.solve(scene("S1", times=np.linspace(0, 100, 11)), method=name, step=10.0)
    assert motion.status == "failed" and "no solution near" in motion.message and 1 <= motion.t.size < 11


def test_nan_at_the_start_is_refused_by_name():
    with pytest.raises(ph.InvalidInput, match="component 1"):
        ph.solve(watched(lambda t, w, q: (0.0, np.nan, 0.0)))


def test_a_callable_may_keep_and_change_what_it_is_given():
    seen = []

    def keep(t, w, q):
        seen.append((t, w, q[1:]))
        return np.array([0.01, -0.02, 0.03])

    one = ph.solve(watched(keep), method="rk45", rtol=1e-6)
    assert len(seen) == one.stats["derivatives"] + 1 and len({id(w) for _, w, _ in seen}) == len(seen)
    assert np.linalg.norm(np.array([w for _, w, _ in seen])[0] - (1, 2, 3)) == 0

    def change(t, w, q):
        w[:] = 7.0
        q[:] = 7.0
        return [0.01, -0.02, 0.03]

    other = ph.solve(watched(change), method="rk45", rtol=1e-6)
    np.testing.assert_array_equal(one.omega, other.omega)


# ---- tables


def test_the_tableau_of_dop853_is_scipys():
    table = pytest.importorskip("scipy.integrate._ivp.dop853_coefficients")
    text = (pathlib.Path(__file__).parents[3] / "cpp/include/polhode/ode/tableaus/dormand_prince853.hpp").read_text()

    def numbers(name):
        body = re.search(rf"double {name}\[[^=]*= (\{{.*?\}});", text, flags=re.S)[1]
        rows = re.findall(r"\{([^{}]*)\}", body)
        return [[float(eval(x)) for x in row.replace("\n", " ").split(",") if x.strip()] for row in rows]

    for i, row in enumerate(numbers("a")):
        np.testing.assert_array_equal(row, table.A[i, :len(row)])
        assert not table.A[i, len(row):].any()
    np.testing.assert_array_equal(numbers("c")[0], table.C)
    np.testing.assert_array_equal(numbers("error")[0], table.E5)
    np.testing.assert_array_equal(numbers("error_low")[0], table.E3)
    np.testing.assert_array_equal(numbers("dense"), table.D)


def test_every_record_says_what_it_is():
    for record in METHODS.values():
        assert record["doc"].endswith(".") and record["source"]
        assert set(record["keeps"].split(", ")) <= {"nothing", "energy", "|L|", "L", "L_z"}
        assert 0 <= record["driven_order"] <= record["order"] and record["dense_order"] >= 1
    assert sum(record["comparison"] for record in METHODS.values()) == 13
    assert not any(record["comparison"] and record["adaptive"] for record in METHODS.values())


def test_steps_for_comparison_are_run_but_not_offered():
    offered = [name for name, record in METHODS.items() if not record["comparison"]]
    with pytest.raises(ph.InvalidInput) as refused:
        ph.solve(ph.Scene.load("S5"), method="runge")
    assert f"one of {', '.join(offered)}, got 'runge'" in str(refused.value)
    parameter = re.search(r"method : str.*?certify :", ph.solve.__doc__, flags=re.S)[0]
    assert set(re.findall(r'"(\w+)"', parameter)) == {*offered, "exact"}
    assert ph.solve(ph.Scene.load("S5"), method="dmv8", step=1e-3).status == "finished"
