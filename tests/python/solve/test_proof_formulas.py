"""Proofs of formulas: drawn laws against 113 bits, other torques beside them, and what has no proof."""

import json
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from proofs import count_states_outside, find_outside, make_formula_scene, make_state_scene

import polhode as ph
from polhode.torques import AngularDamping, Constant, Damping, During, Formula, Gravity, GravityGradient

REFERENCE = Path(__file__).parents[2] / "reference"
DRAWN = json.loads((REFERENCE / "formula_proof.json").read_text())
STATES = json.loads((REFERENCE / "state_proof.json").read_text())   # with switches in some


def prove(torques, accuracy=1e-10, **changes):
    scene = ph.Scene(**{"inertia": [1.0, 2.0, 2.5], "omega": [0.3, 1.0, -0.2], "times": np.linspace(-1.0, 3.0, 9),
                        "torques": torques, **changes})
    return ph.solve(scene, accuracy, certify="proof")


def find_width(motion):
    return max((motion.omega_upper - motion.omega_lower).max(), (motion.attitude_upper - motion.attitude_lower).max())


def overlap(one, other):
    """Whether all bounds of two proofs meet, as those of one motion must."""
    return all((a <= b).all() for a, b in ((one.omega_lower, other.omega_upper), (other.omega_lower, one.omega_upper),
                                           (one.attitude_lower, other.attitude_upper),
                                           (other.attitude_lower, one.attitude_upper)))


@pytest.mark.parametrize("number", range(len(DRAWN)))
@pytest.mark.parametrize("accuracy", [1e-5, 1e-11])
def test_drawn_laws_judged_by_113_bits(number, accuracy):
    motion = ph.solve(make_formula_scene(DRAWN[number]), accuracy, certify="proof")
    assert motion.error_kind == "proved" and motion.error <= accuracy
    assert find_outside(motion, np.array(DRAWN[number]["truth"])) == 0


def test_a_number_changed_in_its_last_digits_lies_outside():
    # Bounds are narrow enough to tell 1e-12 apart, so that the test above can fail.
    numbers = dict(DRAWN[0], numbers=[x * (1 + 1e-12) for x in DRAWN[0]["numbers"]])
    motion = ph.solve(make_formula_scene(numbers), 1e-13, certify="proof")
    assert find_outside(motion, np.array(DRAWN[0]["truth"])) > 100


def test_gravity_as_a_formula_has_the_bounds_of_gravity():
    scene = ph.Scene.load("S5")
    gravity = scene.torques[0]
    as_formula = Formula(text="-weight * cross(arm, to_body([0, 0, 1]))", weight=gravity.weight, arm=tuple(gravity.arm))
    for accuracy in (1e-6, 1e-9):
        one = ph.solve(scene, accuracy, certify="proof")
        # It is recognised elsewhere. A proof is about exactly its own numbers.
        other = ph.solve(scene.replace(torques=[as_formula]), accuracy, certify="proof")
        assert other.error_kind == "proved" and overlap(one, other)
        assert find_width(other) < 2 * find_width(one) + 4e-16


def test_a_potential_has_the_bounds_of_its_torque():
    well = Formula(potential=lambda t, attitude, p: p.k * np.exp(p.c * ph.formula.to_body(attitude, (0, 0, 1))[0]),
                   k=0.7, c=0.3)

    def torque(t, omega, attitude, p):
        up = ph.formula.to_body(attitude, (0, 0, 1))
        slope = p.k * p.c * np.exp(p.c * up[0])
        return np.array([0 * slope, slope * up[2], -slope * up[1]])

    one, other = prove([well]), prove([Formula(torque, k=0.7, c=0.3)])
    assert one.error_kind == other.error_kind == "proved" and overlap(one, other)


def test_other_torques_and_rotors_beside_a_formula():
    drag = Formula(text="-c * omega", c=0.125, recognise=False)
    others = [Gravity(0.5, [0.1, -0.2, 0.3]), AngularDamping(0.25), Constant([0.1, 0.0, -0.2], "space"),
              During(Constant([0.3, 0, 0], "body"), [(0.5, 1.5)])]
    free = ph.Rotor(axis=(0.6, 0, 0.8), speed=3.0, inertia=0.1, free=True)
    locked = ph.Rotor(axis=(0.6, 0, 0.8), momentum=0.3)
    full = np.array([[1.2, 0.2, -0.1], [0.2, 2.0, 0.3], [-0.1, 0.3, 1.7]])
    for inertia in (np.diag([1.0, 2.0, 2.5]), full):
        for rotor, more in ((free, []), (locked, [GravityGradient(0.4, 0.3)])):
            one = prove([drag, *others, *more], rotors=[rotor], inertia=inertia)
            other = prove([Damping(0.125 * np.eye(3)), *others, *more], rotors=[rotor], inertia=inertia)
            assert one.error_kind == other.error_kind == "proved" and overlap(one, other)
            assert max(find_width(one), find_width(other)) < 1e-10


def test_rates_alone_and_a_factor_of_0():
    drag = "-c * norm(omega) * omega"
    plain = prove([Formula(text=drag, c=0.125)], want=["omega"])
    with_attitude = prove([Formula(text=drag + " + k * attitude.xyz", c=0.125, k=0.0)], want=["omega"])
    assert plain.error_kind == with_attitude.error_kind == "proved" and plain.attitude is None
    assert (plain.omega_lower <= with_attitude.omega_upper).all()
    assert (with_attitude.omega_lower <= plain.omega_upper).all()


@pytest.mark.parametrize("text", ["[1 / omega.x, 0, 0]", "[0.1 * log(omega.x - 0.2), 0, 0]", "[-0.2 / omega.x, 0, 0]",
                                  "[-0.6 * sqrt(omega.x), 0, 0]", "0.3 * [-1, 0, atan2(omega.x, -1)]"])
def test_a_proof_ends_before_a_point_where_the_formula_is_not_analytic(text):
    motion = prove([Formula(text=text)], omega=[0.3, 0.0, 0.0], times=np.linspace(0.0, 4.0, 41))
    begin, end = motion.proved_span
    if text == "[1 / omega.x, 0, 0]":   # it grows away from 0
        assert motion.error_kind == "proved"
        exact = np.sqrt(0.09 + 2 * motion.t)
        assert (motion.omega_lower[:, 0] <= exact + 1e-15).all() and (exact - 1e-15 <= motion.omega_upper[:, 0]).all()
    else:
        assert motion.error_kind == "limit" and begin == 0.0 and end < 3.0


@pytest.mark.parametrize("number", range(len(STATES)))
@pytest.mark.parametrize("accuracy", [1e-5, 1e-11])
def test_drawn_states_and_switches_judged_by_113_bits(number, accuracy):
    motion = ph.solve(make_state_scene(STATES[number]), accuracy, certify="proof")
    assert motion.error_kind == "proved" and motion.error <= accuracy
    assert find_width(motion) < 1e4 * ph.solve(motion.scene, accuracy).error
    outside, judged = count_states_outside(motion, STATES[number])
    assert outside == 0 and judged >= 11 * len(motion.t)


def test_a_state_changed_in_its_last_digits_lies_outside():
    numbers = next(numbers for numbers in STATES if numbers["crossings"] > 0)
    moved = dict(numbers, numbers=[x * (1 + 1e-12) for x in numbers["numbers"]])
    motion = ph.solve(make_state_scene(moved), 1e-13, certify="proof")
    assert count_states_outside(motion, numbers)[0] > 50


def follow_bang(times, push, width):
    """theta and theta' about z of theta'' = push where theta' < width, else -push / 2, from rest: exact fractions."""
    fall, turn = Fraction(push), Fraction(width) / Fraction(push)
    rows = []
    for t in map(Fraction, times):
        late = max(t - turn, Fraction(0))
        rows.append(fall * min(t, turn) + fall / 2 * late)
    return rows


def test_a_jump_at_a_known_rate_is_exact():
    # The rate about z rises by 1/4 a second up to 1/2, from there on by 1/8.
    torque = Formula(text="[0, 0, where(omega.z < width, push, 0.5 * push)]", width=0.5, push=0.25, recognise=False)
    times = [0.0, 1.0, 1.999, float(np.nextafter(2.0, 0.0)), 2.0, float(np.nextafter(2.0, 3.0)), 2.5, 4.0]
    motion = prove([torque], inertia=[1.0, 1.0, 1.0], omega=[0.0, 0.0, 0.0], times=times)
    assert motion.error_kind == "proved"
    lower, upper = motion.omega_lower[:, 2], motion.omega_upper[:, 2]
    exact = follow_bang(times, 0.25, 0.5)
    assert all(Fraction(a) <= x <= Fraction(b) for a, x, b in zip(lower, exact, upper, strict=True))
    assert (upper - lower).max() < 1e-15


def test_switches_of_time_are_windows():
    push = Constant([0.2, -0.1, 0.3], "space")
    window = During(push, [(0.5, 1.5)])
    switch = Formula(text="where(t > 0.5, where(t > 1.5, 0, 1), 0) * to_body([a, b, c])", a=0.2, b=-0.1, c=0.3)
    edges = [float(np.nextafter(e, e + side)) for e in (0.5, 1.5) for side in (-1, 1)] + [0.5, 1.5]
    times = sorted([*np.linspace(-1.0, 3.0, 9), *edges])
    one, other = prove([window], times=times), prove([switch], times=times)
    assert one.error_kind == other.error_kind == "proved" and overlap(one, other)
    assert max(find_width(one), find_width(other)) < 1e-14


def test_many_crossings_keep_narrow_bounds():
    # 127 zeros each; the set behind a surface is mapped by the saltation matrix, and not boxed.
    for text in ("clip(sin(20 * t + attitude.x), -0.5, 0.5) * [1, 0.3, 0]",
                 "sign(sin(20 * t + attitude.x)) * [0.1, 0.3, 0]"):
        motion = prove([Formula(text=text)], times=np.linspace(0.0, 20.0, 11))
        assert motion.error_kind == "proved" and find_width(motion) < 1e-12


def test_where_a_switch_slides_or_is_touched_the_proof_ends_with_a_reason():
    for text, reason in (("-0.5 * sign(omega)", "slide"), ("-friction(load, omega) * -1", "slide"),
                         ("[abs(attitude.x), 0, 0]", ""),
                         ("[0, 0, t - 1 + 0.5 * (sign(omega.z - 0.1) - 1)]", "touch")):
        # omega.z = 0.1 + (t - 1)^2 / 2 where the sign's guard is touched
        start = {"a": [0.0, 0.0, 0.0], "0": [0.0, 0.0, 0.6]}.get(text[1], [0.3, 0.2, 0.1])
        parameters = {"load": 0.5} if "load" in text else {}
        torque = Formula(text=text, **parameters)
        motion = prove([torque], inertia=[1.0, 1.0, 1.0], omega=start, times=np.linspace(0.0, 4.0, 41))
        assert motion.error_kind == "limit" and reason in motion.message
        assert motion.proved_span[0] == 0.0 and motion.proved_span[1] < 2.0
        inside = motion.t < motion.proved_span[1]
        assert np.isfinite(motion.omega_upper[inside]).all()


def test_a_wheel_whose_momentum_is_a_state_has_the_bounds_of_a_rotor():
    wheel = Formula(text="-cross(omega, h)", states={"h": {"start": (0.1, -0.2, 0.3), "rate": "[0, 0, 0]"}})
    rotors = [ph.Rotor(axis=axis, momentum=h) for axis, h in zip(np.eye(3), (0.1, -0.2, 0.3), strict=True)]
    one, other = prove([wheel], 1e-13), prove([], 1e-13, rotors=rotors)
    assert one.error_kind == other.error_kind == "proved" and overlap(one, other)
    assert find_width(one) < 1e-14
    assert np.abs(one.states_upper["h"] - one.states_lower["h"]).max() < 1e-15
    assert one.plan.state == "omega, attitude, h"


def test_a_state_that_sums_the_time_and_its_square():
    # Of exact numbers: z = t, y = t^2. One starts at 0 with the rate 0.
    clock = Formula(text="[0, 0, 0]", states={"z": {"start": 0.0, "rate": "1"}, "y": {"start": 0.0, "rate": "2 * z"}})
    motion = prove([clock], times=[-1.0, 0.0, 0.1, 0.25, 3.0])
    assert motion.error_kind == "proved"
    for name, power in (("z", 1), ("y", 2)):
        lower, upper = motion.states_lower[name], motion.states_upper[name]
        exact = [Fraction(t) ** power for t in motion.t]
        assert all(Fraction(a) <= x <= Fraction(b) for a, x, b in zip(lower, exact, upper, strict=True))
        assert (upper - lower).max() < 1e-14


def test_states_survive_a_file(tmp_path):
    motion = prove([Formula(text="-z * omega", states={"z": {"start": 0.1, "rate": "omega.x"}})])
    motion.save(tmp_path / "motion.npz")
    loaded = ph.load(tmp_path / "motion.npz")
    for side in ("lower", "upper"):
        assert np.array_equal(getattr(loaded, f"states_{side}")["z"], getattr(motion, f"states_{side}")["z"])
    assert "z_lower" in motion.to_pandas() and "z_upper" in motion.to_xarray()
