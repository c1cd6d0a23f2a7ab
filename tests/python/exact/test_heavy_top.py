"""Lagrange's top in closed form, against motions computed at 60 and more digits by two other routes.

The table, `cond` included, comes from tests/reference/heavy_top_reference.py.
"""

import json
import math
import pathlib
import pickle

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from measures import attitude_error

import polhode as ph

E = 2.2e-16
TABLE = json.loads((pathlib.Path(__file__).parents[2] / "reference" / "heavy_top.json").read_text())
REGIMES = sorted({row["name"] for row in TABLE})
DOWN = ph.Rotation((1, 0, 0, 0))   # a half turn about x; as plain numbers it gives a warning
TOP = ((1, 1, 0.5), 1.3, (0.1, 0.2, 5.0), (0.3, 0.1, 0.2, math.sqrt(1 - 0.14)))


def make(row):
    attitude = DOWN if row["attitude"] == [1, 0, 0, 0] else row["attitude"]
    return ph.HeavyTop(row["moments"], row["weight_arm"], row["omega"], attitude)


def errors(row):
    """(angle, omega relative to the largest omega) of each state of a row."""
    omega, attitude = make(row).at(row["t"])
    answer = np.array(row["answer"])
    largest = np.linalg.norm(answer[:, :3], axis=1).max()
    if largest < 1e-40:  # at rest, but for what the reference was nudged by
        largest = 1.0
    sign = np.sign(np.sum(attitude * answer[:, 3:], axis=1))[:, None]
    angle = 2 * np.linalg.norm(attitude - sign * answer[:, 3:], axis=1)
    return np.stack([angle, np.linalg.norm(omega - answer[:, :3], axis=1) / largest], axis=1)


@pytest.mark.parametrize("regime", REGIMES)
def test_error_within_the_promise_in_every_regime(regime):
    for row in (row for row in TABLE if row["name"] == regime and row["t"]):
        bound = 20 * (np.array(row["cond"]) + 4 * E)
        assert np.all(errors(row) <= bound), (row, errors(row) / bound)


def test_the_table_covers_what_it_promises():
    assert len(TABLE) >= 200
    assert sum(len(row["t"]) for row in TABLE) >= 800
    assert {"looping", "cuspidal", "monotone", "pendulum", "spherical pendulum", "steady precession", "near steady",
            "sleeping", "near homoclinic", "homoclinic", "hanging", "weight to zero", "negative and positive weight",
            "scales"} <= set(REGIMES)
    assert max(t for row in TABLE for t in row["t"]) >= 1e9


def invariants(row, times):
    """(energy, p_phi, p_psi) and their natural sizes along at(t), from omega and attitude alone."""
    moments, arm = np.array(row["moments"]), row["weight_arm"]
    omega, (x, y, z, w) = (part := make(row).at(times))[0], part[1].T
    up = np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), z * z + w * w - x * x - y * y], axis=1)
    momentum = moments * omega
    kinetic = 0.5 * np.sum(momentum * omega, axis=1)
    size = np.linalg.norm(momentum, axis=1).max()
    values = kinetic + arm * up[:, 2], np.sum(momentum * up, axis=1), momentum[:, 2]
    return np.array(values), np.array([kinetic.max() + abs(arm), size, size])


@pytest.mark.parametrize("regime", REGIMES)
def test_energy_and_momenta_are_conserved_at_every_time(regime):
    for row in (row for row in TABLE if row["name"] == regime):
        top = make(row)
        speed = max(*map(abs, row["omega"]), math.sqrt(abs(row["weight_arm"]) / row["moments"][0])) or 1.0
        period = top.nutation_period if math.isfinite(top.nutation_period) else 0.0
        times = np.concatenate([np.linspace(0, 30, 31), np.geomspace(1e2, 1e9, 15)]) / speed
        values, sizes = invariants(row, np.concatenate([times, period * np.linspace(-1, 1, 41)]))
        if sizes[1] == 0:
            continue
        start = np.array([top.energy, top.p_phi, top.p_psi])[:, None]
        assert np.all(np.abs(values - start) <= 20 * E * sizes[:, None]), row


def test_one_time_or_many_of_any_shape():
    top = ph.HeavyTop(*TOP)
    times = np.linspace(-3, 3, 12).reshape(3, 4)
    omega, attitude = top.at(times)
    assert omega.shape == (3, 4, 3)
    assert attitude.shape == (3, 4, 4)
    one = top.at(float(times[1, 2]))
    np.testing.assert_array_equal(one[0], omega[1, 2])
    np.testing.assert_array_equal(one[1], attitude[1, 2])
    np.testing.assert_array_equal(top.at(times.T)[1], attitude.transpose(1, 0, 2))
    assert top.at([])[0].shape == (0, 3)
    assert top.at(2)[0].shape == (3,)


def test_start_is_given_back_and_backwards_is_the_past():
    top = ph.HeavyTop(*TOP)
    omega, attitude = top.at(0.0)
    np.testing.assert_allclose(omega, TOP[2], rtol=0, atol=5e-16 * 5)
    np.testing.assert_allclose(attitude, TOP[3], rtol=0, atol=5e-16)
    before = ph.HeavyTop(TOP[0], TOP[1], *top.at(-4.0))
    np.testing.assert_allclose(before.at(4.0)[1], attitude, rtol=0, atol=2e-14)


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.floats(0.01, 2), st.floats(-3, 3), st.tuples(*[st.floats(-5, 5)] * 3), st.tuples(*[st.floats(-1, 1)] * 4))
def test_equations_of_motion_hold(C, arm, omega, attitude):
    """Central differences of the closed form satisfy Euler's and the kinematic equations."""
    # Smaller numbers are refused where they matter: next to the unstable upright position, or beyond float64.
    omega, attitude, (arm,) = ([c if abs(c) > 1e-30 else 0.0 for c in v] for v in (omega, attitude, (arm,)))
    norm = math.sqrt(math.fsum(c * c for c in attitude))
    assume(norm > 0.1)
    top = ph.HeavyTop((1, 1, C), arm, omega, ph.Rotation(np.array(attitude) / norm))
    h = 1e-3
    w, q = top.at(1.0 + h * np.arange(-3, 4))
    weights = np.array([-1, 9, -45, 0, 45, -9, 1]) / (60 * h)  # sixth order
    dw, dq = weights @ w, weights @ q
    w, (x, y, z, s) = w[3], q[3]
    up = np.array([2 * (x * z - s * y), 2 * (y * z + s * x), 0])
    moments = np.array([1, 1, C])
    torque = np.cross([0, 0, 1], -arm * up)
    np.testing.assert_allclose(moments * dw, torque - np.cross(w, moments * w), atol=1e-8)
    product = 0.5 * np.array([s * w[0] + y * w[2] - z * w[1], s * w[1] + z * w[0] - x * w[2],
                              s * w[2] + x * w[1] - y * w[0], -x * w[0] - y * w[1] - z * w[2]])
    np.testing.assert_allclose(dq, product, atol=1e-8)


@pytest.mark.parametrize("exponent", range(-15, 1))
def test_no_jump_on_the_way_to_sleeping_steady_homoclinic_and_weightless(exponent):
    """Starts ever closer to an exceptional motion stay as close to it as the instability allows."""
    off = 10.0**exponent
    times = np.linspace(0, 3, 7)

    def apart(a, b):
        (w, q), (v, p) = a.at(times), b.at(times)
        sign = np.sign(np.sum(p * q, axis=1))[:, None]
        return max(np.abs(w - v).max(), np.abs(q - sign * p).max())

    body, level, down = (1, 1, 0.5), (math.sqrt(0.5), 0, 0, math.sqrt(0.5)), DOWN
    pairs = [
        ((body, 1, (0, 0, 8), (0, 0, 0, 1)), (body, 1, (off, 0, 8), (0, 0, 0, 1))),
        ((body, 1, (0, 0, 1), (0, 0, 0, 1)), (body, 1, (off, 0, 1), (0, 0, 0, 1))),
        ((body, 1, (0, 1, 2), level), (body, 1, (0, 1 + off, 2), level)),
        ((body, 1, (2, 0, 0), down), (body, 1, (2 + off, 0, 0), down)),
        ((body, 1, (2, 0, 0), down), (body, 1, (2, off, 0), down)),
        ((body, 0, (0.3, 0.4, 2), level), (body, off, (0.3, 0.4, 2), level)),
        ((body, 0, (0.3, 0.4, 2), level), (body, -off, (0.3, 0.4, 2), level)),
        ((body, 1, (0.3, 0.4, 0), level), (body, 1, (0.3, 0.4, off), level)),
    ]
    for exact, near in pairs:
        assert apart(ph.HeavyTop(*exact), ph.HeavyTop(*near)) <= 60 * off + 80 * E, (exact, near)


def test_kinds_and_properties():
    top = ph.HeavyTop(*TOP)
    assert top.kind == "monotone"
    assert top.weight_arm == 1.3
    np.testing.assert_array_equal(top.axis, [0, 0, 1])
    low, high = top.tilt_bounds
    assert 0 < low < high < math.pi
    assert top.p_psi == 2.5
    assert ph.HeavyTop((1, 1, 0.5), 1, (0, 0, 1), DOWN).kind == "hanging"
    steady = ph.HeavyTop((1, 1, 0.5), 1, (0, 1, 2), (math.sqrt(0.5), 0, 0, math.sqrt(0.5)))
    assert steady.kind == "steady_precession"
    assert steady.nutation_period == 0
    assert steady.precession_rate == pytest.approx(1, abs=1e-15)
    tensor = ph.InertiaTensor.from_moments((1, 1, 0.5))
    assert ph.HeavyTop(tensor, *TOP[1:]) == top
    assert ph.HeavyTop(np.diag((1, 1, 0.5)), *TOP[1:]) == top
    assert ph.HeavyTop((0.5, 1, 1), 1.0, (1, 2, 3)).axis.tolist() == [1, 0, 0]


def test_pickles_and_compares_by_value():
    top = ph.HeavyTop(*TOP)
    again = pickle.loads(pickle.dumps(top))
    assert again == top
    assert hash(again) == hash(top)
    np.testing.assert_array_equal(again.at(3.3)[1], top.at(3.3)[1])
    assert top != ph.HeavyTop(TOP[0], 1.4, *TOP[2:])
    assert "weight_arm=1.3" in repr(top)


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({0: (1, 2, 2.5)}, "inertia"),
        ({0: (1, 1, 3)}, "inertia"),
        ({0: (1, 1, math.nan)}, "inertia"),
        ({0: (1, 1)}, "inertia"),
        ({0: (1, 1, -0.5)}, "inertia"),
        ({0: (1, 1, 0)}, "inertia"),
        ({0: "top"}, "inertia"),
        ({0: (5e-324, 5e-324, 5e-324)}, "inertia"),
        ({1: math.inf}, "weight_arm"),
        ({1: "heavy"}, "weight_arm"),
        ({1: (1, 2)}, "weight_arm"),
        ({2: (0, math.nan, 1)}, "omega"),
        ({2: (0, 1)}, "omega"),
        ({2: (1e308, 0, 1)}, "omega"),
        ({3: (0, 0, 0, 0)}, "attitude"),
        ({3: (0, 0, 0, 1.1)}, "attitude"),
        ({3: (0, 0, 1)}, "attitude"),
    ],
)
def test_bad_input_is_refused_by_name(change, name):
    arguments = [change.get(i, good) for i, good in enumerate(TOP)]
    with pytest.raises(ph.InvalidInput, match=f"^{name}:"):
        ph.HeavyTop(*arguments)


@pytest.mark.parametrize("t", [math.nan, math.inf, 1e30, [0.0, math.nan], "now", None, 1j])
def test_bad_times_are_refused(t):
    with pytest.raises(ph.InvalidInput, match="^t:"):
        ph.HeavyTop(*TOP).at(t)


def test_nutations_beyond_count_are_refused():
    """Next to the homoclinic motion nutations are counted in a double; beyond 2^52 of them the state was NaN."""
    top = ph.HeavyTop((1, 1, 0.5), 1.0, (-0.07, 0, 0.5))
    assert np.isfinite(top.at(4e16)[0]).all()
    for t in (1e17, -1e21):
        with pytest.raises(ph.InvalidInput, match="too few digits"):
            top.at(t)


def test_what_float64_cannot_hold_is_refused_when_asked_for():
    top = ph.HeavyTop((1e200, 1e200, 1e200), 0.0, (0, 1e100, 1e100))
    with pytest.raises(ph.InvalidInput, match="^energy:"):
        _ = top.energy
    assert np.isfinite(top.at(1e-100)[0]).all()


def test_weight_over_moment_may_be_beyond_float64():
    """Moments of 2^-520 under a weight of 2^520: rates of 2^520, and all bits but the exponents."""
    tilted = ph.Rotation.from_euler("ZXZ", (0.1, 0.7, 0.2)).as_quat()
    w, q = ph.HeavyTop((1, 1, 0.5), 1.0, (0, 0, 0), tilted).at([0.0, 1.5])
    fast, same = ph.HeavyTop((2.0**-520, 2.0**-520, 2.0**-521), 2.0**520, (0, 0, 0), tilted).at([0.0, 1.5 * 2.0**-520])
    np.testing.assert_array_equal(same, q)
    np.testing.assert_array_equal(fast, w * 2.0**520)


@pytest.mark.parametrize("attitude", [(0.5, 0.5, 0.5, 0.5), (0.1, 0.2, 0.3, math.sqrt(0.86))])
@pytest.mark.parametrize("power", [-950, -965, -1013, -1017, -1022])
def test_a_weight_next_to_the_smallest_numbers_does_not_act(attitude, power):
    """A sphere with such a weight spins on about its axis; the fuzzer found NaN."""
    t = np.array([0.5, 3.0, -1e6])
    omega, q = ph.HeavyTop((1.0, 1.0, 1.0), 2.0**power, (0, 0, -21.8), attitude).at(t)
    free = ph.FreeMotion((1.0, 1.0, 1.0), (0, 0, -21.8), attitude).at(t)
    np.testing.assert_allclose(omega, free[0], rtol=0, atol=1e-14)
    assert attitude_error(q, free[1]) < 1e-14
