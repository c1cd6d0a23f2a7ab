"""Steps of engines, judged: each is named with its order and step, or not at all."""

import numpy as np
import pytest

import polhode as ph

I = (1.0, 2.0, 2.5)
STEP = 0.03
T = STEP * np.arange(121)
SCENE = ph.Scene(inertia=I, omega=(1, 0.5, 2), times=T)
NAMED = {
    "rk4": (4, "RK4"),
    "euler": (1, "Euler, turned"),
    "semi_euler": (1, "semi-implicit Euler, turned"),
    "jolt": (1, "Euler, momentum restored"),
    "catto": (1, "implicit Euler, one Newton step"),
    "midpoint": (2, "midpoint of the momentum"),
}


def judged(method, step=STEP):
    run = ph.solve(SCENE, method=method, step=step)
    return ph.judge(T, run.attitude, run.omega, scene=SCENE, tolerance=1e-9)


@pytest.mark.parametrize("method", NAMED)
def test_steps_of_engines_are_named_with_order_and_length(method):
    for step in (STEP, STEP / 3) if method != "rk4" else (STEP,):
        found = judged(method, step).findings
        main = found[0]
        assert (main.cause, main.order, main.method) == ("integrator", *NAMED[method]), str(main)
        assert main.step == pytest.approx(step, rel=1e-9) and main.explained > 1 - 1e-9
        assert not [f for f in found[1:] if f.level != "remark"]


@pytest.mark.parametrize("method", ["dmv2", "buss", "split"])
def test_a_method_that_is_not_known_is_not_taken_for_another_fault(method):
    main = judged(method).findings[0]
    assert main.cause == "unknown" or main.cause == "cannot tell" and "integrator" in main.rivals


def test_the_term_that_engines_leave_out_is_named():
    assert judged("ignore").findings[0].cause == "no gyroscopic term"


@pytest.mark.parametrize("method", ["dmv8", "free", "symplectic"])
def test_exact_steps_are_fine(method):
    assert judged(method).fine


MODEL = """<mujoco><option timestep="{}" integrator="{}" gravity="0 0 0"/><worldbody><body><freejoint/>
<inertial pos="0 0 0" mass="1" diaginertia="1 2 2.5"/></body></worldbody></mujoco>"""
MUJOCO = {
    "Euler": (1, "semi-implicit Euler, turned"),
    "implicit": (1, "implicit Euler, one Newton step"),
    "implicitfast": (1, "implicit Euler, one Newton step"),
    "RK4": (4, "RK4, turned"),
}


@pytest.mark.parametrize("name", MUJOCO)
def test_a_free_body_of_mujoco(name):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(MODEL.format(STEP, name))
    data = mujoco.MjData(model)
    data.qvel[3:] = SCENE.omega
    mujoco.mj_forward(model, data)
    attitude, omega = [data.qpos[3:].copy()], [data.qvel[3:].copy()]
    for _ in T[1:]:
        mujoco.mj_step(model, data)
        attitude.append(data.qpos[3:].copy())
        omega.append(data.qvel[3:].copy())
    found = ph.judge(T, attitude, omega, scene=SCENE, order="wxyz", tolerance=1e-9).findings[0]
    assert (found.cause, found.order, found.method) == ("integrator", *MUJOCO[name])
    assert found.step == pytest.approx(STEP, rel=1e-9)


def test_rounding_that_a_motion_amplifies_is_no_fault():
    scene = ph.Scene.load("S2")  # 160 turns next to a separatrix
    motion = ph.solve(scene, 1e-12)
    found = ph.judge(motion.t, motion.attitude, motion.omega, scene=scene, tolerance=1e-10)
    assert found.fine and any("of rounding" in text for text in found.untold)


def test_samples_turns_apart_are_asked_for_the_law_as_declared():
    scene = ph.Scene.load("S1")
    motion = ph.solve(scene, 1e-12)
    rows = slice(0, 200)
    assert ph.judge(motion.t[rows], motion.attitude[rows], motion.omega[rows], scene=scene).fine
    alone = ph.judge(motion.t[rows], motion.attitude[rows], motion.omega[rows])
    assert not alone.fails("error") and any("further apart" in text for text in alone.untold)


def test_a_gap_of_many_turns_is_not_crossed():
    t = np.concatenate([np.linspace(0, 5, 80), np.linspace(1000, 1006, 120)])
    w, q = ph.FreeMotion(I, (1, 0.5, 2)).at(t)
    found = ph.judge(t, q, w + [0.1, 0, 0], inertia=I)
    assert found.findings[0].cause == "bias" and any("80 to 199 were judged" in text for text in found.untold)


def test_causes_that_one_motion_cannot_tell_are_rivals():
    """A lag of a symmetric body is a tilt about its axis."""
    rng = np.random.default_rng(1)
    motion = ph.FreeMotion((1, 1, 1.6), (1, 0.5, 2))
    w, q = motion.at(T)[0], (ph.Rotation.from_quat(motion.at(T)[1])).as_quat()
    w = motion.at(T + 0.01)[0] + 1e-4 * rng.normal(size=w.shape)
    found = ph.judge(T, q, w, inertia=(1, 1, 1.6)).findings[0]
    assert found.cause == "cannot tell" and {"lag", "misaligned"} <= set(found.rivals)
