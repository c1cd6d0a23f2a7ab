"""Scenes of all kinds are judged: with formulas, orbits, windows and rotors. Others are refused in one sentence."""

import numpy as np
import pytest

import polhode as ph

T = np.linspace(0, 6, 100)
PARTS = {"inertia": (1.0, 2.0, 2.5), "omega": (1, 0.5, 2), "times": T}
SCENES = {
    "a formula": {"torques": [ph.torques.Formula(text="[-0.2 * omega.x, 0.1 * sin(t), -0.1 * omega.z]")]},
    "a formula with a switch": {"torques": [ph.torques.Formula(text="[-0.1 * sign(omega.x), 0, 0]")]},
    "a torque in a window": {"torques": [ph.torques.During(ph.torques.Constant((0.1, 0, 0.2)), (2, 3))]},
    "an orbit": {"torques": [ph.torques.GravityGradient(
        orbit=ph.Orbit.from_elements(periapsis_distance=1.0, e=0.3, mu=0.3))]},
    "an own function": {"torques": [ph.torques.Custom(lambda t, w, q: -0.1 * w)]},
    "a held rotor": {"rotors": [ph.Rotor((0, 0, 1), momentum=1.0)]},
    "a free rotor with a speed": {"rotors": [ph.Rotor((0, 0, 1), inertia=0.2, speed=5.0, free=True)]},
    "a rotor in a window": {"rotors": [ph.Rotor((1, 0, 0), momentum=0.5, during=(0, 20))],
                            "torques": [ph.torques.Gravity(weight=1.0, arm=(0.1, 0, 0.2))]},
}  # fmt: skip


def judged(scene, omega=0.0):
    motion = ph.solve(scene, 1e-11)
    return ph.judge(T, motion.attitude, motion.omega + omega, scene=scene, tolerance=1e-9)


@pytest.mark.parametrize("name", SCENES)
def test_a_right_motion_is_fine_and_a_bias_is_found(name):
    scene = ph.Scene(**PARTS, **SCENES[name])
    assert judged(scene).fine
    found = judged(scene, [0.02, 0, 0]).findings[0]
    assert found.cause == "bias" and np.allclose(found.size, [0.02, 0, 0], atol=1e-5), str(found)


@pytest.mark.parametrize("name", ["a held rotor", "a free rotor with a speed"])
def test_steps_of_bodies_with_rotors_are_named(name):
    scene = ph.Scene(**PARTS, **SCENES[name])
    run = ph.solve(scene, method="rk4", step=T[1])
    found = ph.judge(T, run.attitude, run.omega, scene=scene, tolerance=1e-9).findings[0]
    assert (found.cause, found.order, found.method) == ("integrator", 4, "RK4")


@pytest.mark.parametrize("parts, words", [
    ({"torques": [ph.torques.Formula(text="[-h, 0, 0]", states={"h": {"start": 1.0, "rate": "-h"}})]},
     "no formulas with states of their own, got h"),
    ({"rotors": [ph.Rotor((0, 0, 1), inertia=0.2, speed=1.0, free=True, torque=0.1)]}, "no motors or friction"),
    ({"inertia": ph.Changing.ramp((1, 2, 2.5), (1, 2, 2.4), (0, 5))}, "a body of constant inertia"),
    ({"damper": ph.Damper(inertia=0.1, viscous=0.1)}, "no damper"),
    ({"controllers": [ph.Controller(0.1, lambda t, m, s, p: -m.omega)]}, "no controllers"),
])  # fmt: skip
def test_scenes_with_more_states_are_refused(parts, words):
    scene = ph.Scene(**(PARTS | parts))
    with pytest.raises(ph.InvalidInput, match=f"scene: must have {words}") as refused:
        ph.judge(T, omega=np.ones((100, 3)), scene=scene)
    assert "\n" not in str(refused.value)
