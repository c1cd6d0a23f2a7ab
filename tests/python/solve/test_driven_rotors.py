"""Rotors with motors and friction, and the viscous slug, against mpmath and against solutions on one axis."""

import json
import math
import pathlib
import pickle

import numpy as np
import pytest

import polhode as ph
from polhode._sensitivity.parameters import put

REFERENCE = json.loads((pathlib.Path(__file__).parents[2] / "reference/driven_rotors.json").read_text(encoding="utf-8"))
FULL = [[2.0, 0.1, -0.2], [0.1, 2.5, 0.05], [-0.2, 0.05, 1.7]]
SKEW = (1, 2, 2)
X, Y, Z = np.eye(3)


def rotor(axis, inertia, speed, **drive):
    return ph.Rotor(axis, inertia=inertia, speed=speed, free=True, **drive)


PARTS = {
    "three motors": dict(omega=(0.3, -0.2, 0.5), rotors=[rotor(X, 0.05, 3.0, torque=0.04, viscous=0.01),
                                                         rotor(Y, 0.04, -2.0, torque=-0.02),
                                                         rotor(Z, 0.06, 5.0, viscous=0.02)]),
    "by rates": dict(omega=(0.5, 0.4, -0.3), rotors=[rotor(SKEW, 0.2, 4.0, viscous=0.01,
                                                           torque="0.2*omega.x - 0.01*speed")]),
    "of time": dict(omega=(0.1, 1.2, 0.2), rotors=[rotor(SKEW, 0.3, -4.0, torque="0.1*sin(3*t) + 0.05*attitude.x")]),
    "slug": dict(omega=(0.9, -0.4, 1.1), damper=ph.Damper(inertia=0.3, viscous=0.15, rates=(0.2, 0.1, -0.5))),
    "slug and wheel": dict(omega=(0.2, 1.4, 0.3), rotors=[rotor(Z, 0.1, 8.0, torque=0.03, viscous=0.05)],
                           damper=ph.Damper(inertia=0.2, viscous=0.3)),
}
FRICTION = ("slug",)   # those without a motor


def make(name, times=None, **more):
    return ph.Scene(inertia=FULL, times=REFERENCE[name]["t"] if times is None else times, **PARTS[name], **more)


@pytest.mark.parametrize("accuracy", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("name", PARTS)
def test_motions_are_those_of_the_equations_of_the_parts(name, accuracy):
    motion = ph.solve(make(name), accuracy=accuracy)
    n = len(PARTS[name].get("rotors", ()))
    y = np.array([[float(value) for value in row] for row in REFERENCE[name]["y"]])
    assert motion.success
    allowed = max(motion.error, 2e-15) * motion.omega_scale
    assert np.abs(motion.omega - y[:, :3]).max() <= allowed
    assert np.abs(motion.attitude - y[:, 6 + n:]).max() <= max(motion.error, 2e-15)
    fastest = max([np.abs(y[:, 3:3 + n]).max(), 1.0]) if n else 1.0
    assert np.abs(motion.rotor_speed - y[:, 3:3 + n]).max(initial=0) <= 20 * max(motion.error, 1e-15) * fastest
    if "damper" in PARTS[name]:
        assert np.abs(motion.damper_rates - y[:, 3 + n:6 + n]).max() <= 20 * allowed


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("name", PARTS)
def test_the_angular_momentum_in_space_stays_and_friction_only_takes_energy(name, accuracy):
    motion = ph.solve(make(name, np.linspace(0, 20, 200)), accuracy=accuracy)
    assert motion.success and motion.drift["angular_momentum"] <= 1e-14
    assert ("energy_rise" in motion.drift) == (name in FRICTION)
    assert motion.drift.get("energy_rise", 0.0) <= 1e-13


def test_a_motion_without_a_damper_has_no_rates_of_it():
    assert ph.solve(make("by rates")).damper_rates.shape == (3, 0)


def test_the_energy_is_that_of_all_parts():
    motion = ph.solve(make("slug and wheel"), accuracy=1e-12)
    n, w, W, sigma = 3, motion.omega, motion.rotor_speed[:, 0], motion.damper_rates
    J = np.array(FULL)
    body = np.array([0.5 * w[i] @ (J - 0.1 * np.outer(Z, Z) - 0.2 * np.eye(3)) @ w[i] for i in range(n)])
    wheel = 0.5 * 0.1 * (W + w @ Z) ** 2
    slug = 0.5 * 0.2 * ((w + sigma) ** 2).sum(axis=1)
    assert np.abs(motion.energy - (body + wheel + slug)).max() <= 1e-13 * motion.energy[0]


def test_a_function_is_traced_to_its_text():
    def motor(t, omega, attitude, p, s):
        return p.k * omega[0] - 0.01 * s.speed

    by_function = rotor(SKEW, 0.2, 4.0, viscous=0.01, torque=motor, parameters={"k": 0.2})
    scene = make("by rates").replace(rotors=[by_function])
    a, b = ph.solve(scene, accuracy=1e-10), ph.solve(make("by rates"), accuracy=1e-10)
    assert np.abs(a.omega - b.omega).max() <= 1e-10
    assert by_function.parameters == {"k": 0.2} and "omega" in str(by_function.let) + by_function.torque


def test_without_a_motor_and_friction_a_rotor_is_free_as_before():
    plain = ph.Rotor(SKEW, inertia=0.2, speed=4.0, free=True)
    zero = rotor(SKEW, 0.2, 4.0, torque=0.0, viscous=0.0, coulomb=0.0)
    scene = make("by rates").replace(rotors=[zero])
    assert zero == plain and ph.plan(scene).model == "gyrostat" and not scene.states


@pytest.mark.parametrize("name", PARTS)
def test_scenes_survive_files_pickles_and_changes(name, tmp_path):
    scene = make(name)
    scene.save(tmp_path / "scene.toml")
    back = ph.Scene.load(tmp_path / "scene.toml")
    assert back == scene and pickle.loads(pickle.dumps(scene)) == scene and scene.replace(name="other") != scene
    assert (ph.solve(back, accuracy=1e-9).omega == ph.solve(scene, accuracy=1e-9).omega).all()
    again = scene.replace(times=(0.0, 2.0))   # its rotors are as given, so their torques are made again
    assert np.abs(ph.solve(again, accuracy=1e-10).omega[-1] - ph.solve(scene, accuracy=1e-10).omega[-1]).max() <= 1e-9
    motion = ph.solve(scene, accuracy=1e-9)
    motion.save(tmp_path / "motion.npz")
    loaded = ph.load(tmp_path / "motion.npz")
    assert (loaded.rotor_speed == motion.rotor_speed).all() and (loaded.energy == motion.energy).all()


def test_many_bodies_start_with_momenta_of_their_own():
    scene, starts = make("slug and wheel"), [(0.2, 1.4, 0.3), (0.1, 0.2, 0.3)]
    many = ph.solve_many(scene, omega=starts)
    for omega, found in zip(starts, many.omega):
        assert np.abs(found - ph.solve(scene.replace(omega=omega), accuracy=1e-10).omega).max() <= 1e-6


def test_pictures_have_the_momentum_of_all_parts():
    pytest.importorskip("matplotlib")
    motion = ph.solve(make("slug and wheel", np.linspace(0, 5, 20)))
    motion.plot("momentum", "energy", "invariants")
    motion.plot()


def one_axis(**drive):
    """A body and a rotor on one axis: the speed has 1/Js + 1/(J - Js) per torque between them."""
    return ph.Scene(inertia=(1.0, 1.2, 1.5), omega=(0, 0, 0.4), times=np.linspace(0, 4, 81),
                    rotors=[rotor(Z, 0.5, 2.0, **drive)]), 1 / 0.5 + 1 / 1.0


def test_dry_friction_brings_a_rotor_to_rest_and_holds_it():
    scene, by = one_axis(coulomb=0.5)
    motion = ph.solve(scene, accuracy=1e-10)
    stop = 2.0 / (by * 0.5)
    expected = np.maximum(2.0 - by * 0.5 * scene.times, 0.0)
    assert 1 < stop < 2 and motion.success
    assert np.abs(motion.rotor_speed[:, 0] - expected).max() <= 1e-9
    assert motion.drift["angular_momentum"] <= 1e-13 and motion.drift["energy_rise"] <= 1e-13


def test_a_rotor_at_rest_slips_where_its_motor_exceeds_the_friction():
    scene = ph.Scene(inertia=(1.0, 1.2, 1.5), omega=(0, 0, 0.4), times=np.linspace(0, 4, 81),
                     rotors=[rotor(Z, 0.5, 0.0, coulomb=0.2, torque="0.1 * t")])
    t = scene.times
    expected = np.where(t > 2, 3.0 * (0.05 * (t**2 - 4) - 0.2 * (t - 2)), 0.0)
    motion = ph.solve(scene, accuracy=1e-10)
    assert motion.success and np.abs(motion.rotor_speed[:, 0] - expected).max() <= 1e-9


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_motor_drives_no_further_than_its_top_speed_and_leaves_it(sign):
    scene = ph.Scene(inertia=(1.0, 1.2, 1.5), omega=(0, 0, 0.4), times=np.linspace(0, 4, 81),
                     rotors=[rotor(Z, 0.5, 0.0, torque=f"{sign} * (1 - 0.5 * t)", max_torque=2.0, max_speed=2.0)])
    t = scene.times
    reach = 2 - math.sqrt(4 - 8 / 3)   # of 3 (t - t^2 / 4) = 2
    expected = np.where(t < reach, 3 * (t - t**2 / 4), np.where(t < 2, 2.0, 2.0 - 0.75 * (t - 2) ** 2))
    motion = ph.solve(scene, accuracy=1e-10)
    assert motion.success and np.abs(motion.rotor_speed[:, 0] - sign * expected).max() <= 1e-9


def test_a_constant_motor_stays_at_its_top_speed():
    scene, by = one_axis(torque=0.5, max_speed=3.0)
    motion = ph.solve(scene, accuracy=1e-10)
    expected = np.minimum(2.0 + by * 0.5 * scene.times, 3.0)
    assert motion.success and np.abs(motion.rotor_speed[:, 0] - expected).max() <= 1e-9


def test_a_motor_gives_no_more_than_its_limit():
    scene, by = one_axis(torque="2 * t - 3", max_torque=0.25)
    t = scene.times
    ramp = np.clip(t, 1.375, 1.625)
    expected = 2.0 + by * (-0.25 * np.minimum(t, 1.375) + (ramp - 1.5)**2 - 0.125**2 + 0.25 * np.maximum(t - 1.625, 0))
    motion = ph.solve(scene, accuracy=1e-10)
    assert motion.success and np.abs(motion.rotor_speed[:, 0] - expected).max() <= 1e-9


@pytest.mark.parametrize("name", ["rotors.0.torque", "rotors.0.viscous", "rotors.0.speed", "rotors.0.inertia", "omega",
                                  "damper.viscous", "inertia"])
def test_columns_are_differences(name):
    at = ("slug and wheel", [1.0, 2.0])
    wheel = dict(axis=Z, inertia=0.1, speed=8.0, free=True, torque=0.03, viscous=0.05)

    def solve(change, columns=None):
        parts = dict(omega=np.array([0.2, 1.4, 0.3]), inertia=np.array([1.7, 2.0, 2.5]))
        own, slug = dict(wheel), dict(inertia=0.2, viscous=0.3)
        field = name.split(".")[-1]
        if name.startswith("rotors"):
            own[field] += change
        elif name.startswith("damper"):
            slug[field] += change
        else:
            parts[name] = parts[name] + change * X
        scene = ph.Scene(times=at[1], rotors=[ph.Rotor(**own)], damper=ph.Damper(**slug), **parts)
        return ph.solve(scene, accuracy=1e-12, **({} if columns is None else {"sensitivity": columns}))

    found = solve(0.0, [name]).sensitivity
    step = 1e-4
    slopes = [(solve(k * step).omega - solve(-k * step).omega) / (2 * k * step) for k in (1, 2)]
    expected = (4 * slopes[0] - slopes[1]) / 3
    scale = max(np.abs(expected).max(), 1e-3)
    assert np.abs(found.d_omega[:, :, 0] - expected).max() <= 1e-8 * scale


@pytest.mark.parametrize("change, words", [
    (dict(viscous=-1.0), "Rotor.viscous: must be zero or positive, and finite, got -1"),
    (dict(coulomb=-2.0), "Rotor.coulomb: must be zero or positive, and finite, got -2"),
    (dict(torque=math.nan), "Rotor.torque: must be finite"),
    (dict(torque=1.0, free=False), "Rotor.torque: must be left out for a rotor that is held"),
    (dict(viscous=1.0, free=False), "Rotor.viscous: must be left out for a rotor that is held"),
    (dict(coulomb=1.0, inertia=None, speed=None, momentum=1.0), "Rotor.coulomb: must be given with an inertia"),
    (dict(torque=1.0, max_speed=2.0), "Rotor.speed: must be at most max_speed, 2"),
    (dict(max_torque=1.0), "Rotor.max_torque: must be left out without a motor"),
    (dict(torque=1.0, max_torque=0.0), "Rotor.max_torque: must be positive"),
    (dict(torque="speed", max_speed=5.0), "Rotor.max_torque: must be given with a max_speed"),
    (dict(torque=1.0, parameters={"k": 1.0}), "Rotor.parameters: must be left out for a torque that is a number"),
    (dict(torque="k", parameters={"inertia": 1.0}), "Rotor.torque: must be a formula whose names are not"),
    (dict(torque="omega"), "Rotor.torque: must be 1 number, got 3"),
    (dict(torque=lambda t: 1.0), "Rotor.torque: must be callable as torque"),
    (dict(torque=lambda t, omega, attitude, p, s: omega), "Rotor.torque: must return a number"),
    (dict(torque=(1.0, 2.0)), "Rotor.torque"),
])
def test_bad_rotors_are_refused_in_one_sentence(change, words):
    with pytest.raises(ph.InvalidInput, match=".*") as refusal:
        ph.Rotor(Z, **{"inertia": 0.1, "speed": 3.0, "free": True, **change})
    assert words in str(refusal.value) and "\n" not in str(refusal.value)


@pytest.mark.parametrize("make_it, words", [
    (lambda: ph.Damper(inertia=0.0, viscous=1.0), "Damper.inertia: must be positive"),
    (lambda: ph.Damper(inertia=1.0, viscous=-1.0), "Damper.viscous: must be zero or positive"),
    (lambda: ph.Damper(inertia=1.0, viscous=1.0, rates=(0, math.inf, 0)), "Damper.rates: must be finite"),
    (lambda: make("slug").replace(damper=3), "scene.damper: must be a polhode.Damper"),
    (lambda: make("slug").replace(damper=ph.Damper(inertia=1.9, viscous=1.0)), "scene.damper.inertia: must be below"),
    (lambda: make("slug").replace(torques=[ph.torques.GravityGradient(mean_motion=0.1)]), "without GravityGradient"),
])
def test_bad_dampers_are_refused_in_one_sentence(make_it, words):
    with pytest.raises(ph.InvalidInput) as refusal:
        make_it()
    assert words in str(refusal.value) and "\n" not in str(refusal.value)


@pytest.mark.parametrize("rotor", [
    ph.Rotor((0, 0, 1), inertia=0.02, speed=10.0, free=True, torque="gain * omega.x - 0.01 * speed", viscous=1e-4,
             coulomb=1e-5, max_torque=0.1, parameters={"gain": 0.3}),
    ph.Rotor((0, 0, 1), inertia=0.02, speed=10.0, during=[]),
    ph.Rotor((0, 0, 1), inertia=0.02, speed=10.0, during=[(0, 1)]),
])
def test_a_trial_of_a_fit_keeps_all_else_of_a_rotor(rotor):
    scene = ph.Scene(inertia=(1, 2, 3), omega=(0.1, 0.2, 0.3), rotors=[rotor], times=[0, 1])
    assert put(scene, "rotors.0.speed", np.array([10.0])).rotors[0] == rotor
    assert put(scene, "rotors.0.speed", np.array([11.0])).rotors[0].speed == 11.0
