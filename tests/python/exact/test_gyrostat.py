"""Free gyrostats in closed form, against motions computed at 120 digits and confirmed by power series.

The table, `cond` included, comes from tests/reference/gyrostat_reference.py.
"""

import json
import math
import pathlib
import pickle

import numpy as np
import pytest

import polhode as ph

E = 2.2e-16
TABLE = json.loads((pathlib.Path(__file__).parents[2] / "reference" / "gyrostat.json").read_text())
FAMILIES = sorted({row["name"] for row in TABLE})
TILTED = np.array([0.3, 0.1, 0.2, math.sqrt(1 - 0.14)])
BODY = {"inertia": (1.0, 1.6, 2.2), "momentum": (0.3, 0.1, 0.2), "omega": (1.0, 0.5, 0.2), "attitude": TILTED}


def make(row):
    return ph.Gyrostat(row["moments"], momentum=row["momentum"], omega=row["omega"], attitude=row["attitude"])


def errors(row, motion):
    """(omega relative to its largest, angle) of each state of a row."""
    omega, attitude = motion.at(row["t"])
    answer = np.array(row["answer"])
    sign = np.sign(np.sum(attitude * answer[:, 3:], axis=1))[:, None]
    angle = 2 * np.linalg.norm(attitude - sign * answer[:, 3:], axis=1)
    return np.stack([np.linalg.norm(omega - answer[:, :3], axis=1) / row["scale"], angle], axis=1)


def angle_between(a, b):
    sign = np.sign(np.sum(a * b, axis=-1))[..., None]
    return 2 * np.linalg.norm(a - sign * b, axis=-1)


@pytest.mark.parametrize("family", FAMILIES)
def test_error_within_the_promise_in_every_family(family):
    for row in (row for row in TABLE if row["name"] == family and row["t"]):
        bound = 20 * (np.array(row["cond"]) + 4 * E)
        found = errors(row, make(row))
        assert np.all(found <= bound), (row, found / bound)


def test_the_table_covers_what_it_promises():
    assert len(TABLE) >= 150
    assert sum(len(row["t"]) for row in TABLE) >= 700
    assert {"no rotor", "small to large", "axis and plane", "symmetric", "near symmetric", "sphere", "near sphere",
            "needle", "near steady", "racket", "kicked", "no momentum", "rest", "steady", "separatrix",
            "scales"} <= set(FAMILIES)
    assert {make(row).kind for row in TABLE} == {"rest", "steady", "precession", "paired", "single", "separatrix"}
    periods = [max(np.abs(row["t"])) / make(row).period for row in TABLE if 0 < make(row).period < math.inf]
    assert max(periods) > 5e5
    assert min(min(row["t"], default=0) for row in TABLE) < 0


def test_a_momentum_wrong_by_a_part_in_1e12_is_seen():
    row = max((row for row in TABLE if row["name"] == "random" and row["t"]), key=lambda row: max(map(abs, row["t"])))
    wrong = ph.Gyrostat(row["moments"], momentum=np.multiply(row["momentum"], 1 + 1e-12), omega=row["omega"],
                        attitude=row["attitude"])
    assert np.any(errors(row, wrong) > 20 * (np.array(row["cond"]) + 4 * E))


@pytest.mark.parametrize("family", FAMILIES)
def test_energy_and_the_momentum_in_space_are_constant(family):
    for row in (row for row in TABLE if row["name"] == family):
        motion = make(row)
        step = motion.period if 0 < motion.period < math.inf else 1 / (max(map(abs, row["omega"])) or 1)
        omega, attitude = motion.at(step * np.concatenate([np.linspace(-1, 1, 41), np.geomspace(1e1, 1e6, 9)]))
        body = omega * row["moments"]
        momentum = body + row["momentum"]
        size = (np.abs(body).max(axis=1) + np.abs(row["momentum"]).max()).max()
        if size == 0:
            continue
        space = np.array([ph.Rotation(q).apply(m) for q, m in zip(attitude, momentum, strict=True)])
        assert np.all(np.abs(space - motion.angular_momentum) <= 30 * E * size), row
        energy = 0.5 * np.sum(body * omega, axis=1)
        # An error e of omega moves the energy by J omega e.
        scale = np.abs(body).max() * np.abs(omega).max()
        assert np.all(np.abs(energy - motion.energy) <= 30 * E * scale), row


def test_after_a_period_omega_returns_and_the_body_has_turned_about_its_momentum():
    for row in TABLE:
        motion = make(row)
        if not 0 < motion.period < math.inf or row["name"] in ("near steady", "racket", "needle"):
            continue
        omega, attitude = motion.at([0.0, motion.period])
        assert np.linalg.norm(omega[1] - omega[0]) <= 1e-13 * row["scale"], row
        turn = (ph.Rotation(attitude[1]) * ph.Rotation(attitude[0]).inv()).as_rotvec()
        momentum = motion.angular_momentum
        size = np.linalg.norm(momentum)
        if size > 1e-3 * max(map(abs, row["momentum"])):
            assert np.linalg.norm(np.cross(turn, momentum)) <= 1e-13 * size, row


def test_restarting_from_a_state_goes_on_with_the_motion():
    motion = ph.Gyrostat(**BODY)
    omega, attitude = motion.at(3.7)
    on = ph.Gyrostat(BODY["inertia"], momentum=BODY["momentum"], omega=omega, attitude=attitude)
    times = np.linspace(-20, 20, 41)
    a, b = motion.at(3.7 + times), on.at(times)
    assert np.abs(a[0] - b[0]).max() < 2e-14
    assert angle_between(a[1], b[1]).max() < 2e-14


def test_without_a_rotor_the_answers_are_the_free_bodys():
    times = np.linspace(-30, 30, 61)
    for omega in ((1, 2, 3), (1e-9, 5, 1e-9), (0, 2, 0), (0, 0, 0)):
        free = ph.FreeMotion((1, 2, 2.5), omega, TILTED)
        for rotor in ({}, {"momentum": (0, 0, 0)}, {"momentum": (1e-300, 0, 0)}, {"rotors": []}):
            motion = ph.Gyrostat((1, 2, 2.5), **rotor, omega=omega, attitude=TILTED)
            if not any(omega) and rotor.get("momentum", (0,))[0]:
                assert motion.kind == "rest"
                continue
            for a, b in zip(motion.at(times), free.at(times), strict=True):
                assert np.array_equal(a, b)
            assert motion.period == free.period


def test_a_tiny_rotor_comes_near_the_free_body():
    times = np.linspace(-30, 30, 61)
    free = ph.FreeMotion((1, 2, 2.5), (1, 2, 3))
    motion = ph.Gyrostat((1, 2, 2.5), momentum=(1e-17, 2e-17, -1e-17), omega=(1, 2, 3))
    a, b = motion.at(times), free.at(times)
    assert np.abs(a[0] - b[0]).max() < 1e-14
    assert angle_between(a[1], b[1]).max() < 1e-14


def test_a_symmetric_body_with_a_wheel_on_its_axis_is_a_top_without_weight():
    moments, h, omega = (1.0, 1.0, 0.6), 0.45, np.array([0.3, -0.7, 2.0])
    motion = ph.Gyrostat(moments, momentum=(0, 0, h), omega=omega, attitude=TILTED)
    plain = ph.HeavyTop(moments, 0.0, omega + [0, 0, h / moments[2]], TILTED)
    assert motion.kind == "precession"
    for t in (0.0, 0.7, -3.0, 40.0):
        w, q = plain.at(t)
        b = h * t / moments[2]
        turned = ph.Rotation(q) * ph.Rotation.from_rotvec([0, 0, -b])
        c, s = math.cos(b), math.sin(b)
        rates = [c * w[0] - s * w[1], s * w[0] + c * w[1], w[2] - h / moments[2]]
        found = motion.at(t)
        assert np.allclose(found[0], rates, rtol=0, atol=2e-14)
        assert angle_between(found[1], turned.as_quat()) < 3e-14


def test_a_full_tensor_gives_the_same_motion_in_other_axes():
    frame = ph.Rotation([0.1, -0.4, 0.3, math.sqrt(0.74)])
    tensor = ph.InertiaTensor(np.diag(BODY["inertia"])).rotated(frame)
    motion = ph.Gyrostat(**BODY)
    other = ph.Gyrostat(tensor, momentum=frame.apply(BODY["momentum"]), omega=frame.apply(BODY["omega"]),
                        attitude=(ph.Rotation(TILTED) * frame.inv()).as_quat())
    for t in (0.0, 1.0, -7.5, 30.0):
        a, b = motion.at(t), other.at(t)
        assert np.abs(frame.apply(a[0]) - b[0]).max() < 2e-14
        assert angle_between((ph.Rotation(a[1]) * frame.inv()).as_quat(), b[1]) < 2e-14


@pytest.mark.parametrize("power", [-300, -40, 40, 300])
def test_powers_of_two_scale_out_exactly(power):
    scale = 2.0**power
    motion = ph.Gyrostat(**BODY)
    h, w = np.array(BODY["momentum"]), np.array(BODY["omega"])
    faster = ph.Gyrostat(BODY["inertia"], momentum=h * scale, omega=w * scale, attitude=TILTED)
    heavier = ph.Gyrostat(np.array(BODY["inertia"]) * scale, momentum=h * scale, omega=w, attitude=TILTED)
    a, b, c = motion.at(7.7), faster.at(7.7 / scale), heavier.at(7.7)
    assert np.array_equal(a[0] * scale, b[0])
    assert np.array_equal(a[1], b[1])
    assert np.array_equal(a[0], c[0])
    assert np.array_equal(a[1], c[1])
    assert faster.period == motion.period / scale


def test_steady_turns_about_any_axis_stay():
    moments, h = np.array([2.0, 3.0, 4.0]), np.array([3.0, -4.0, 5.0])
    motion = ph.Gyrostat(moments, momentum=h, omega=(-1, 1, -1))   # M = -omega
    assert (motion.kind, motion.period) == ("steady", 0.0)
    omega, attitude = motion.at([0.0, 1e6])
    assert np.abs(omega - [-1, 1, -1]).max() < 1e-15
    half = 0.5e6 * math.sqrt(3)
    axis = np.array([-1, 1, -1]) / math.sqrt(3)
    assert angle_between(attitude[1], np.append(axis * math.sin(half), math.cos(half))) < 1e-9
    rest = ph.Gyrostat(moments, momentum=h, omega=(0, 0, 0), attitude=TILTED)
    assert rest.kind == "rest"
    assert np.array_equal(rest.at(1e9)[0], np.zeros(3))
    assert angle_between(rest.at(1e9)[1], TILTED) < 1e-15


def test_euler_angles_and_the_polhode():
    motion = ph.Gyrostat(**BODY)
    times = np.linspace(-5, 5, 11)
    omega, attitude = motion.at(times)
    momentum = motion.angular_momentum
    assert np.allclose(motion.polhode(times), omega * BODY["inertia"] + BODY["momentum"], rtol=0, atol=1e-15)
    z = momentum / np.linalg.norm(momentum)
    half = np.append(np.cross([0, 0, 1], z), 1 + z[2])
    shortest = ph.Rotation(half / np.linalg.norm(half))
    for angles, q in zip(motion.euler_angles(times), attitude, strict=True):
        built = shortest * ph.Rotation.from_euler("ZXZ", angles)
        assert angle_between(built.as_quat(), q) < 1e-14
    with pytest.raises(ph.InvalidInput, match="total"):
        ph.Gyrostat((1, 1, 1), momentum=(-1, 0, 0), omega=(1, 0, 0)).euler_angles(0.0)


def test_rotors_are_summed():
    wheels = [ph.Rotor((1, 0, 0), momentum=0.3), ph.Rotor((0, 1, 0), inertia=0.05, speed=2.0),
              ph.Rotor((0, 0, 1), momentum=0.2)]
    motion = ph.Gyrostat(BODY["inertia"], rotors=wheels, omega=BODY["omega"], attitude=TILTED)
    assert motion == ph.Gyrostat(**BODY)
    free = ph.Gyrostat((1.0, 1.6, 2.2), rotors=[ph.Rotor((0, 0, 1), inertia=0.1, speed=4.0, free=True)],
                       omega=(1.0, 0.5, 0.2))
    assert np.allclose(free.inertia.moments, (1.0, 1.6, 2.1), rtol=1e-15)
    assert np.allclose(free.momentum, (0, 0, 0.1 * 4.2), rtol=1e-15)
    with pytest.raises(ph.InvalidInput, match="momentum"):
        ph.Gyrostat(BODY["inertia"], rotors=wheels, momentum=(1, 0, 0), omega=BODY["omega"])
    with pytest.raises(ph.InvalidInput, match=r"rotors\[0\]: must be a polhode.Rotor, got 'wheel'"):
        ph.Gyrostat(BODY["inertia"], rotors=["wheel"], omega=BODY["omega"])
    with pytest.raises(ph.InvalidInput, match=r"rotors\[0\]: must be one that always turns"):
        ph.Gyrostat(BODY["inertia"], rotors=[ph.Rotor((1, 0, 0), momentum=1, during=(0, 1))], omega=(1, 0, 0))
    with pytest.raises(ph.InvalidInput, match="below the body's moment about the rotor's axis"):
        ph.Gyrostat(BODY["inertia"], rotors=[ph.Rotor((1, 0, 0), inertia=1, speed=1, free=True)], omega=(1, 0, 0))


@pytest.mark.parametrize("change, message", [
    ({"momentum": (math.nan, 0, 0)}, "momentum"), ({"omega": (math.inf, 0, 0)}, "omega"),
    ({"inertia": (0, 1, 1)}, "inertia"), ({"inertia": (1, 1, 3)}, "inertia"), ({"attitude": (0, 0, 0, 2)}, "attitude"),
    ({"momentum": (1, 0)}, "momentum"),
])
def test_bad_input_is_refused(change, message):
    with pytest.raises(ph.InvalidInput, match=message):
        ph.Gyrostat(**{**BODY, **change})


def test_times_without_a_reliable_phase_are_refused():
    motion = ph.Gyrostat(**BODY)
    for t in (1e26, -math.inf, math.nan):
        with pytest.raises(ph.InvalidInput, match="t: "):
            motion.at(t)


def test_pickling_equality_and_text():
    motion = ph.Gyrostat(**BODY)
    again = pickle.loads(pickle.dumps(motion))
    assert again == motion
    assert hash(again) == hash(motion)
    assert np.array_equal(again.at(2.0)[1], motion.at(2.0)[1])
    assert motion != ph.Gyrostat(**{**BODY, "momentum": (0.3, 0.1, 0.3)})
    assert "momentum=[0.3, 0.1, 0.2]" in repr(motion)


def bodies(count, seed):
    rng = np.random.default_rng(seed)
    q = rng.normal(size=(count, 4))
    return (rng.uniform(0.5, 0.9, (count, 3)), rng.normal(size=(count, 3)) * 10 ** rng.uniform(-3, 1, (count, 1)),
            rng.normal(size=(count, 3)), q / np.linalg.norm(q, axis=1, keepdims=True))


def test_a_batch_has_the_bits_of_the_class_for_any_threads():
    moments, h, omega, q = bodies(40, 1)
    times = np.linspace(0, 30, 65)
    found = ph.gyrostat(moments[:, None], h[:, None], omega[:, None], q[:, None], times)
    for threads in (1, 2, 5):
        again = ph.gyrostat(moments[:, None], h[:, None], omega[:, None], q[:, None], times, threads=threads)
        assert all(np.array_equal(a, b) for a, b in zip(found, again, strict=True))
    for k in range(0, 40, 7):
        one = ph.Gyrostat(moments[k], momentum=h[k], omega=omega[k], attitude=q[k]).at(times)
        assert all(np.array_equal(a[k], b) for a, b in zip(found, one, strict=True))
    long = np.linspace(0, 1e3, 50000)
    one = [ph.gyrostat(moments[0], h[0], omega[0], q[0], long, threads=n) for n in (1, 2)]
    assert all(np.array_equal(a, b) for a, b in zip(*one, strict=True))


def test_a_batch_writes_in_place_and_marks_bad_rows():
    moments, h, omega, q = bodies(9, 2)
    out = np.empty((9, 4))
    assert ph.gyrostat(moments, h, omega, q, 2.5, want="attitude", out=out) is out
    h[3, 0] = math.nan
    with pytest.warns(RuntimeWarning, match="1 row"):
        rates, attitude = ph.gyrostat(moments, h, omega, q, 2.5)
    assert np.isnan(rates[3]).all()
    assert np.array_equal(np.delete(attitude, 3, axis=0), np.delete(out, 3, axis=0))
    tensor = ph.InertiaTensor(np.diag(moments[0]))
    assert np.array_equal(ph.gyrostat(tensor, h[0], omega[0], q[0], 2.5)[1], out[0])
    moments[5] = (1, 1, 9)
    with pytest.raises(ph.InvalidInput, match=r"body\[5\]"):
        ph.gyrostat(moments, h, omega, q, 2.5)
