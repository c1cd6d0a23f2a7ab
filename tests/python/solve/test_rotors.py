"""Rotors in scenes: truth in 113 bits, closed forms of symmetric bodies, the equations of all bodies, skew damping."""

import json
import pickle

import mpmath
import numpy as np
import pytest
from measures import attitude_error, error, rates_error, truth
from mpmath import mpf
from scene_files import write_scene
from scipy.integrate import solve_ivp

import polhode as ph
from polhode import _core

BLOCK = (0.20, 0.40, 0.52)
OMEGA = (1.0, 2.0, 3.0)
TILTED = ph.InertiaTensor.from_moments(BLOCK).rotated(ph.Rotation.from_rotvec((0.3, -0.5, 0.2)))
METHODS = [method["name"] for method in ph.methods()]


def scene(**parts):
    return ph.Scene(**{"inertia": BLOCK, "omega": OMEGA, "times": np.linspace(0, 10, 101),
                       "rotors": [ph.Rotor((0, 0, 1), momentum=0.5)], **parts})


def skew(h):
    """The matrix C of h x omega = -C omega: what Damping takes."""
    return -np.array([[0, -h[2], h[1]], [h[2], 0, -h[0]], [-h[1], h[0], 0]])


def without_rotors(some):
    return some.replace(rotors=(), torques=[*some.torques, ph.torques.Damping(skew(some.rotor_momentum))])


@pytest.mark.parametrize("name, accuracy", [("S10", 1e-6), ("S10", 1e-9), ("S10", 1e-11), ("S11", 1e-6), ("S11", 1e-9)])
def test_claims_hold_against_the_stored_truth(name, accuracy):
    motion = ph.solve(ph.Scene.load(name), accuracy)
    assert motion.error_kind == ("bounded" if motion.error <= accuracy else "limit")
    assert error(motion.omega, motion.attitude, truth(name), motion.scene.omega) < motion.error
    assert set(motion.drift) == {"energy", "angular_momentum"} and max(motion.drift.values()) < 1e-11
    assert (motion.plan.method, motion.plan.model) == ("exact", "gyrostat") and motion.success and motion.error < 5e-15


@pytest.mark.parametrize("accuracy", [1e-6, 1e-9])
@pytest.mark.parametrize("name", ["S10", "S11"])
def test_claims_of_a_stepper_hold_too(name, accuracy):
    motion = ph.solve(ph.Scene.load(name), accuracy, method="taylor")
    assert motion.error_kind == ("bounded" if motion.error <= accuracy else "limit")
    assert error(motion.omega, motion.attitude, truth(name), motion.scene.omega) < motion.error
    assert motion.success or name == "S11"


@pytest.mark.parametrize("name", ["S10", "S11"])
def test_the_long_double_reference_agrees_with_113_bits(name):
    some, stored = ph.Scene.load(name), truth(name)
    omega, attitude = _core.reference(some, 30, 1e-20, 10**6)[:2]
    bound = 1e-14 if name == "S10" else 2e-7   # beside the saddle its rounding of 5e-20 grows by 1e12
    assert max(rates_error(omega, stored["omega"]), attitude_error(attitude, stored["attitude"])) < bound


@pytest.mark.parametrize("inertia", [BLOCK, TILTED], ids=["principal axes", "tilted"])
@pytest.mark.parametrize("method", ["taylor", "dop853", "rk45", "radau"])
def test_rotors_are_skew_damping(method, inertia):
    """h x omega is linear in omega: a torque of polhode that knows no rotors is the check."""
    some = scene(inertia=inertia, rotors=[ph.Rotor((1, -2, 2), momentum=0.7), ph.Rotor((0, 1, 0), momentum=-0.2)])
    np.testing.assert_allclose(some.rotor_momentum, 0.7 / 3 * np.array([1, -2, 2]) + [0, -0.2, 0], rtol=1e-15)
    one, other = (ph.solve(s, method=method, rtol=1e-12) for s in (some, without_rotors(some)))
    assert rates_error(one.omega, other.omega) < 3e-11 and attitude_error(one.attitude, other.attitude) < 3e-10
    free = ph.solve(some.replace(rotors=()), method=method, rtol=1e-12)
    assert rates_error(free.omega, other.omega) > 0.1


@pytest.mark.parametrize("name", ["taylor", "dop853", "rk45", "rk4", "radau", "midpoint", "split", "dmv8"])
@pytest.mark.parametrize("torque", [ph.torques.Gravity(2.0, (0.1, 0.2, 0.5)), ph.torques.GravityGradient(0.8),
                                    ph.torques.Constant((0.1, 0.2, -0.1), frame="space"),
                                    ph.torques.Damping((0.1, 0.2, 0.3))], ids=lambda torque: type(torque).__name__)
def test_rotors_beside_every_torque(name, torque):
    some = scene(inertia=TILTED, torques=[torque], times=np.linspace(0, 3, 16))
    adaptive = next(m for m in ph.methods() if m["name"] == name)["adaptive"]
    motion = ph.solve(some, method=name, **({"rtol": 1e-11} if adaptive else {"step": 1e-3}))
    exact = ph.solve(without_rotors(some), method="dop853", rtol=1e-13)
    bound = 1e-8 if adaptive else 3e-5
    assert error(motion.omega, motion.attitude, {"omega": exact.omega, "attitude": exact.attitude}) < bound
    kept = {"Gravity": {"energy", "vertical_momentum"}, "GravityGradient": {"jacobi"}}.get(type(torque).__name__, set())
    assert set(motion.drift) == kept and all(drift < 10 * bound for drift in motion.drift.values())


def test_the_planner_bounds_a_heavy_body_with_a_wheel():
    some = scene(inertia=(1.0, 2.0, 2.5), torques=[ph.torques.Gravity(2.0, (0.3, 0.2, 0.5))])
    motion = ph.solve(some, 1e-10)
    omega, attitude = _core.reference(some, 30, 1e-20, 10**6)[:2]
    assert motion.success and motion.plan.facts["keeps"] == ["energy", "vertical_momentum"]
    assert error(motion.omega, motion.attitude, {"omega": omega, "attitude": attitude}) < motion.error


def test_a_symmetric_body_with_an_axial_wheel_in_closed_form():
    """The plain body with omega3 + h / J3, then a turn back about the axis by h t / J3; 30 digits, by mpmath."""
    moments, h, start = (0.40, 0.40, 0.20), 0.9, (0.5, 0.0, 4.0)
    some = scene(inertia=moments, omega=start, times=np.linspace(0, 50, 51), rotors=[ph.Rotor((0, 0, 1), momentum=h)])
    motion = ph.solve(some, 1e-12)
    with mpmath.workdps(30):
        across, axial = mpf(moments[0]), mpf(moments[2])
        w1, w3 = mpf(start[0]), mpf(start[2]) + mpf(h) / axial
        momentum = mpmath.matrix([across * w1, 0, axial * w3])
        rate = mpmath.norm(momentum) / across
        for t, omega, attitude in zip(motion.t, motion.omega, motion.attitude):
            spin = ((across - axial) / across * w3 - mpf(h) / axial) * mpf(float(t))
            assert abs(omega[0] - w1 * mpmath.cos(spin)) < 1e-11 and abs(omega[1] + w1 * mpmath.sin(spin)) < 1e-11
            half, size = rate * mpf(float(t)) / 2, mpmath.norm(momentum)
            x, z, w = (mpmath.sin(half) * momentum[0] / size, mpmath.sin(half) * momentum[2] / size, mpmath.cos(half))
            s, c = mpmath.sin(spin / 2), mpmath.cos(spin / 2)
            q = [float(v) for v in (x * c, -x * s, z * c + w * s, w * c - z * s)]
            assert min(np.abs(attitude - q).max(), np.abs(attitude + q).max()) < 2e-11
    assert np.abs(motion.omega[:, 2] - 4.0).max() < 1e-14


@pytest.mark.parametrize("axes", [[(0, 0, 1)], [(1, 2, 2), (2, 1, -2)]], ids=["one", "two"])
def test_free_rotors_obey_the_equations_of_all_bodies(axes):
    """SciPy integrates omega and the speeds: I w' + sum Js a W' + w x (I w + sum Js W a) = 0, Js (W' + a.w') = 0."""
    own, speeds = [0.05, 0.03][:len(axes)], [7.0, -4.0][:len(axes)]
    rotors = [ph.Rotor(a, inertia=j, speed=s, free=True) for a, j, s in zip(axes, own, speeds)]
    some = scene(inertia=TILTED, rotors=rotors, times=np.linspace(0, 5, 26))
    I, n = np.asarray(TILTED.matrix), len(axes)
    a = np.array([np.array(axis) / np.linalg.norm(axis) for axis in axes])
    mass = np.block([[I, (np.array(own)[:, None] * a).T], [np.array(own)[:, None] * a, np.diag(own)]])

    def derivative(t, y):
        w, W = y[:3], y[3:]
        return np.linalg.solve(mass, np.concatenate([-np.cross(w, I @ w + (np.array(own) * W) @ a), np.zeros(n)]))

    y = solve_ivp(derivative, (0, 5), [*OMEGA, *speeds], "DOP853", some.times, rtol=1e-12, atol=1e-12).y.T
    motion = ph.solve(some, 1e-10)
    assert rates_error(motion.omega, y[:, :3]) < 1e-10
    np.testing.assert_allclose(motion.rotor_speed, y[:, 3:], atol=1e-9)
    assert np.ptp(motion.rotor_speed[:, 0]) > 0.1 and max(motion.drift.values()) < 1e-12
    momenta = [j * (s + axis @ OMEGA) for j, s, axis in zip(own, speeds, a)]
    same = some.replace(rotors=[ph.Rotor(x, inertia=j, momentum=m, free=True) for x, j, m in zip(axes, own, momenta)])
    assert rates_error(ph.solve(same, 1e-10).omega, motion.omega) < 1e-11
    carrier = ph.InertiaTensor(some.carrier_inertia.matrix, physical=False)
    alone = some.replace(inertia=carrier, rotors=[ph.Rotor(x, momentum=m, free=True) for x, m in zip(axes, momenta)])
    other = ph.solve(alone, 1e-10)
    assert rates_error(other.omega, motion.omega) < 1e-11 and np.isnan(other.rotor_speed).all()


def test_lanes_have_rotors():
    rng = np.random.default_rng(5)
    scenes = [scene(inertia=rng.uniform(1, 1.5, 3), omega=rng.normal(size=3), times=np.linspace(0, 5, 6),
                    rotors=[ph.Rotor(rng.normal(size=3), momentum=rng.normal())]) for _ in range(11)]
    scenes[3] = scenes[3].replace(rotors=())
    for method in ("rk45", "taylor"):
        many = ph.solve_many(scenes, method=method, rtol=1e-11)
        assert many.lanes.all() and many.success.all()
        for some, omega, attitude in zip(scenes, many.omega, many.attitude):
            one = ph.solve(some, method=method, rtol=1e-11)
            if method == "rk45":
                assert np.array_equal(one.omega, omega) and np.array_equal(one.attitude, attitude)
            assert rates_error(omega, one.omega) < 1e-9 and attitude_error(attitude, one.attitude) < 1e-9
    free = scene(rotors=[ph.Rotor((0, 1, 0), inertia=0.1, speed=5.0, free=True)], times=[0.0, 3.0])
    starts = [(1.0, 2.0, 3.0), (3.0, 1.0, 2.0)]   # each start has a rotor of this speed
    many = ph.solve_many(free, omega=starts, accuracy=1e-10)
    for start, omega in zip(starts, many.omega):
        assert rates_error(omega, ph.solve(free.replace(omega=start), 1e-10).omega) < 1e-10


@pytest.mark.parametrize("method", ["symplectic", "leapfrog"])
def test_methods_that_take_no_rotors_say_so(method):
    some = scene(inertia=(1.0, 1.0, 0.5), attitude=ph.Rotation.from_rotvec((0.5, 0, 0)))
    with pytest.raises(ph.InvalidInput, match="no rotors.*got rotors"):
        ph.solve(some, method=method, step=0.01)
    heavy = some.replace(torques=[ph.torques.Damping((1, 2, 3))])
    with pytest.raises(ph.InvalidInput, match="rotors keep their momentum"):
        ph.solve(heavy, method="exact")


def test_the_plan_tells_of_rotors():
    plan = ph.plan(scene(rotors=[ph.Rotor((0, 0, 2), momentum=0.5)]))
    assert plan.facts["rotor_momentum"] == (0.0, 0.0, 0.5) and not plan.facts["free"]
    assert plan.facts["keeps"] == ["energy", "angular_momentum"] and "1 rotor;" in str(plan)
    assert any("rotor 0 was not a unit vector" in reason for reason in plan.reasons)
    assert not any("unit vector" in reason for reason in ph.plan(scene()).reasons)
    assert ph.plan(scene(rotors=[ph.Rotor((0, 0, 1), momentum=0.0)])).method == "exact"
    opposite = [ph.Rotor((0, 0, 1), momentum=0.5), ph.Rotor((0, 0, 1), inertia=0.1, speed=-5.0)]
    assert ph.plan(scene(rotors=opposite)).model == "triaxial"


def test_units_change_no_answer():
    """Everything scales when inertia or time is multiplied by a power of two."""
    one = ph.solve(scene(), 1e-10)
    for mass, rate in ((2.0**-40, 1.0), (2.0**40, 1.0), (1.0, 2.0**-40), (1.0, 2.0**40)):
        some = scene(inertia=np.array(BLOCK) * mass, omega=np.array(OMEGA) * rate, times=scene().times / rate,
                     rotors=[ph.Rotor((0, 0, 1), momentum=0.5 * mass * rate)])
        assert np.array_equal(ph.solve(some, 1e-10).omega / rate, one.omega)


def test_rotors_are_values():
    rotor = ph.Rotor((3, 0, 4), inertia=0.1, speed=2.0, free=True)
    assert rotor.axis.tolist() == [0.6, 0.0, 0.8] and rotor.momentum is None and rotor.free and rotor.during is None
    assert pickle.loads(pickle.dumps(rotor)) == rotor == eval(repr(rotor), {"polhode": ph}) and rotor != 1
    assert hash(rotor) == hash(pickle.loads(pickle.dumps(rotor)))
    held = ph.Rotor((0, 0, 1), momentum=1.0, during=[(5, 6), (1, 2)])
    assert held.during == ((1.0, 2.0), (5.0, 6.0)) and held != rotor
    some = scene(rotors=[rotor, held])
    assert pickle.loads(pickle.dumps(some)) == some != scene() and some.rotors == (rotor, held)
    assert "2 rotors" in repr(some) and some.replace(omega=(0, 0, 1)).rotors == (rotor, held)
    np.testing.assert_allclose(some.carrier_inertia.matrix, np.diag(BLOCK) - 0.1 * np.outer(rotor.axis, rotor.axis))


NAN = float("nan")
BAD_ROTORS = [
    (((0, 0, 0),), {"momentum": 1}, r"Rotor.axis: must be a direction, got \(0, 0, 0\) \(a zero vector"),
    (((0, NAN, 1),), {"momentum": 1}, "Rotor.axis: must be finite, got nan in component 1"),
    (((0, 1),), {"momentum": 1}, r"Rotor.axis: must be three numbers, got shape \(2,\)"),
    (((0, 0, 1),), {"momentum": NAN}, "Rotor.momentum: must be finite"),
    (((0, 0, 1),), {"inertia": 1, "speed": float("inf")}, "Rotor.speed: must be finite"),
    (((0, 0, 1),), {"inertia": -1, "speed": 1}, r"Rotor.inertia: must be positive, got -1 \(the sense of rotation"),
    (((0, 0, 1),), {"inertia": 1}, r"Rotor.speed: must be given with an inertia.*locked rotor"),
    (((0, 0, 1),), {"speed": 1}, "Rotor.inertia: must be given with a speed, got the speed alone"),
    (((0, 0, 1),), {}, "Rotor.momentum: must be given, or inertia and speed in its place, got none"),
    (((0, 0, 1),), {"momentum": 1, "speed": 1}, r"Rotor.momentum: must be left out beside a speed, got 1 \(give iner"),
    (((0, 0, 1),), {"inertia": 1e300, "speed": 1e300}, "Rotor.speed: must be such that inertia times speed is finite"),
    (((0, 0, 1),), {"momentum": 1, "free": True, "during": (0, 1)}, r"Rotor.during: must be left out.*always rotates"),
    (((0, 0, 1),), {"momentum": 1, "during": (1, 0)}, r"Rotor.during: must be pairs.*begin and end are swapped"),
    (((0, 0, 1),), {"momentum": 1, "free": 1}, "Rotor.free: must be True or False, got 1"),
]


@pytest.mark.parametrize("axis, numbers, words", BAD_ROTORS)
def test_bad_rotors_are_refused(axis, numbers, words):
    with pytest.raises(ph.InvalidInput, match=words):
        ph.Rotor(*axis, **numbers)


@pytest.mark.parametrize("rotors, words", [
    ([ph.Rotor((0, 0, 1), inertia=0.6, speed=1, free=True)],
     r"scene.rotors\[0\].inertia: must be below the body's moment about the rotor's axis, 0.52, got 0.6 \(the body's"),
    ([ph.Rotor((0, 0, 1), inertia=0.3, speed=1, free=True)] * 2, "free rotors that leave the body three positive"),
    ([ph.Rotor((0, 0, 1), momentum=1e308)] * 2, "scene.rotors: must be of finite momenta together"),
    ([1.0], r"scene.rotors\[0\]: must be a polhode.Rotor, got 1.0"),
])
def test_scenes_refuse_rotors_that_do_not_fit(rotors, words):
    with pytest.raises(ph.InvalidInput, match=words):
        scene(rotors=rotors)


def test_gravity_gradient_refuses_free_rotors_with_an_inertia():
    gradient = ph.torques.GravityGradient(0.1)
    for torque in (gradient, ph.torques.During(gradient, (0, 1))):
        with pytest.raises(ph.InvalidInput, match="without GravityGradient beside free rotors"):
            scene(torques=[torque], rotors=[ph.Rotor((0, 0, 1), inertia=0.1, speed=1, free=True)])


ROTORS = """
[[rotors]]
axis = [0.0, 3.0, 4.0]
momentum = 0.5
during = [[0.0, 1.0]]
[[rotors]]
axis = [0.0, 0.0, 1.0]
{rotor}
"""


def test_rotors_of_scene_files(tmp_path):
    def write(rotor):
        return write_scene(tmp_path / "wheel.toml", ROTORS.format(rotor=rotor), times="values = [0.0, 1.0]")

    held, free = ph.Scene.load(write("inertia = 0.1\nspeed = 2.0\nfree = true")).rotors
    assert held == ph.Rotor((0, 0.6, 0.8), momentum=0.5, during=(0, 1))
    assert free == ph.Rotor((0, 0, 1), inertia=0.1, speed=2, free=True)
    for rotor, words in (("inertia = -1.0\nspeed = 1.0", "wheel.toml: rotors[1]: Rotor.inertia: must be positive"),
                         ("speed = 1.0", "wheel.toml: rotors[1]: Rotor.inertia: must be given"),
                         ("moment = 1.0", "wheel.toml: rotors.1.moment: unknown key, did you mean 'moments'?"),
                         ("momentum = nan", "wheel.toml: rotors.1.momentum: must be a finite number")):
        file = write(rotor)
        with pytest.raises(ph.InvalidInput) as failure:
            ph.Scene.load(file)
        assert str(failure.value).startswith(words) and "\n" not in str(failure.value)
    from polhode.schema import scene_model

    assert '"rotors"' in json.dumps(scene_model().model_json_schema())


def test_pictures_of_a_body_with_rotors():
    matplotlib = pytest.importorskip("matplotlib")
    assert ph.solve(scene(), 1e-9).plot() is not None and matplotlib


def test_programs_that_are_fed_equations_get_the_rotors():
    from polhode.charts.equations import derivatives, refuses

    for some in (scene(inertia=TILTED), scene(rotors=[ph.Rotor((1, 1, 0), inertia=0.1, speed=9.0, free=True)])):
        h, J, w = some.rotor_momentum, some.carrier_inertia.matrix, np.array(OMEGA)
        found = derivatives(some, 0.0, [*OMEGA, 0.0, 0.0, 0.0, 1.0])[:3]
        np.testing.assert_allclose(found, np.linalg.solve(J, np.cross(J @ w + h, w)), rtol=1e-13)
    assert refuses(scene(rotors=[ph.Rotor((0, 0, 1), momentum=1.0, during=(0, 1))]))


def test_a_second_run_with_free_rotors_has_the_same_inertia():
    """dop853 is certified by a run with perturbed inputs, which must not take the axial moments twice."""
    some = scene(rotors=[ph.Rotor((0, 0, 1), inertia=0.1, speed=9.0, free=True)])
    motion = ph.solve(some, 1e-8, method="dop853")
    assert motion.success and motion.error_kind == "bounded" and rates_error(
        motion.omega, ph.solve(some, 1e-11).omega) < motion.error
