"""Free motion against exact answers: the stored table of every regime, and what theory says without a table."""

import csv
import math
import os
import pathlib
import pickle
import subprocess
import sys
import threading

import levels
import numpy as np
import pytest

import polhode as ph

REFERENCE = pathlib.Path(__file__).parents[2] / "reference"
E = 2.2e-16
BLOCK = (0.20, 0.40, 0.52)


def quaternion_product(p, q):
    x, y, z, w = np.moveaxis(p, -1, 0)
    a, b, c, d = np.moveaxis(q, -1, 0)
    return np.stack([w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a,
                     w * c + x * b - y * a + z * d, w * d - x * a - y * b - z * c], axis=-1)


def angle_between(p, q):
    turn = quaternion_product(np.asarray(p) * [-1, -1, -1, 1], np.asarray(q))
    return 2 * np.arcsin(np.minimum(1, np.linalg.norm(turn[..., :3], axis=-1)))


def rotated(q, v):
    q, v = np.broadcast_arrays(np.asarray(q), np.concatenate([v, np.zeros((*np.shape(v)[:-1], 1))], axis=-1))
    return quaternion_product(quaternion_product(q, v), q * [-1, -1, -1, 1])[..., :3]


@pytest.fixture(scope="module")
def table():
    with (REFERENCE / "free_motion.csv").open() as file:
        return list(csv.DictReader(file))


def numbers(row, *names):
    return np.array([float(row[name]) for name in names])


def errors(row):
    """(family, error of omega, angle, cond) of one row."""
    inertia = ph.InertiaTensor.from_moments(numbers(row, "I1", "I2", "I3"), physical=False)
    motion = ph.FreeMotion(inertia, numbers(row, "w1", "w2", "w3"), numbers(row, "x0", "y0", "z0", "w0"))
    omega, attitude = motion.at(float(row["t"]))
    expected = numbers(row, "o1", "o2", "o3")
    scale = np.abs(expected).max() or 1.0
    off = np.linalg.norm((omega - expected) / scale)
    return row["family"], off, float(angle_between(attitude, numbers(row, "x", "y", "z", "w"))), float(row["cond"])


def test_the_table_covers_every_regime(table):
    families = {row["family"] for row in table}
    assert families == {"boxes", "separatrix", "across", "near-symmetric", "near-equatorial", "near-sphere", "needle",
                        "near-steady", "scales", "planar", "exact", "switch"}
    assert len(table) >= 500


def test_every_regime_is_exact_to_twenty_times_what_float64_can_say(table):
    """error <= 20 (cond + 4 e) is promised; cond: how far the exact answer moves with half an ulp of the input."""
    for row in table:
        family, omega, angle, cond = errors(row)
        assert omega <= 20 * (cond + 4 * E), (family, row)
        assert angle <= 20 * (cond + 4 * E), (family, row)


def test_beyond_the_promise_the_answer_is_that_of_the_float64_input_itself(table):
    """Measured: 1.3e-15 at worst, cond or no cond, over 1e9 periods and next to the separatrix too. Bounded on both
    sides,
    so that a change for the worse shows, and one for the better is written down."""
    worst = np.array([errors(row)[1:3] for row in table]).max(axis=0)
    assert 2e-16 < worst[0] < 2e-15 and 2e-16 < worst[1] < 2e-15, worst


def test_energy_and_momentum_stay_the_starts_along_at(table):
    for row in table[::5]:
        moments = numbers(row, "I1", "I2", "I3")
        omega0, q0 = numbers(row, "w1", "w2", "w3"), numbers(row, "x0", "y0", "z0", "w0")
        unit = np.abs(omega0).max() or 1.0
        motion = ph.FreeMotion(ph.InertiaTensor.from_moments(moments, physical=False), omega0, q0)
        omega, attitude = motion.at(np.concatenate([[0.0], float(row["t"]) * np.linspace(-1, 1, 9)]))
        momentum = rotated(attitude, moments * (omega / unit))
        energy = (moments * (omega / unit) ** 2).sum(axis=-1)
        start = rotated(q0, moments * (omega0 / unit))
        size = np.linalg.norm(start) or 1.0
        assert np.linalg.norm(momentum - start, axis=-1).max() <= 20 * E * size
        assert np.abs(energy - (moments * (omega0 / unit) ** 2).sum()).max() <= 20 * E * (energy[0] or 1.0)
        assert np.abs(np.linalg.norm(attitude, axis=-1) - 1).max() <= 4 * E


def test_scipys_integrator_agrees_where_it_can():
    from scipy.integrate import solve_ivp

    moments = np.array(BLOCK)

    def rates(t, y):
        w = y[:3]
        quaternion = 0.5 * quaternion_product(y[3:], np.append(w, 0.0))
        return np.concatenate([-np.cross(w, moments * w) / moments, quaternion])

    times = np.linspace(0, 10, 21)
    solution = solve_ivp(rates, (0, 10), [1, 2, 3, 0, 0, 0, 1], "DOP853", times, rtol=1e-13, atol=1e-14).y.T
    omega, attitude = ph.FreeMotion(BLOCK, (1, 2, 3)).at(times)
    np.testing.assert_allclose(omega, solution[:, :3], atol=1e-10)
    assert angle_between(attitude, solution[:, 3:]).max() < 1e-10


def test_the_racket_turns_over_when_the_closed_form_says():
    motion = ph.FreeMotion(BLOCK, (1e-4, 5, 1e-4))
    flips = motion.flip_times(0, 200)
    assert motion.kind == "about_greatest" and len(flips) == 19
    np.testing.assert_allclose(np.diff(flips), motion.period / 2, rtol=1e-12)
    assert np.abs(motion.at(flips)[0][:, 1]).max() < 1e-12
    exact = ph.FreeMotion((2, 5, 6), (1, 0.75, -1))
    assert exact.kind == "separatrix" and exact.period == math.inf and len(exact.flip_times(-1e6, 1e6)) == 1
    with pytest.raises(ph.InvalidInput, match="flips"):
        motion.flip_times(0, 1e20)


def test_the_mean_precession_is_what_the_angle_makes_in_many_periods():
    for omega in ((1, 2, 3), (3, 2, 1), (1, 2, 1.9), (1e-4, 5, 1e-4)):
        motion = ph.FreeMotion(BLOCK, omega)
        # About the encircled axis: put it on z, so that phi is its longitude.
        order = [2, 0, 1] if motion.kind == "about_least" else [0, 1, 2]
        order = [1, 2, 0] if motion.kind == "about_least" else order
        turned = ph.FreeMotion(np.array(BLOCK)[order], np.array(omega)[order])
        t = np.linspace(0, 20 * motion.period, 20001)
        phi = np.unwrap(turned.euler_angles(t)[:, 0])
        assert (phi[-1] - phi[0]) / t[-1] == pytest.approx(turned.precession_rate, rel=1e-9)


def test_euler_angles_rebuild_the_motion():
    motion = ph.FreeMotion(BLOCK, (1, 2, 3), np.array([0.5, -0.1, 0.7, 0.5]))
    t = np.linspace(-3, 3, 13)
    phi, theta, psi = motion.euler_angles(t).T
    momentum = np.linalg.norm(motion.angular_momentum)
    body = momentum * np.stack([np.sin(theta) * np.sin(psi), np.sin(theta) * np.cos(psi), np.cos(theta)], axis=-1)
    np.testing.assert_allclose(motion.at(t)[0] * BLOCK, body, atol=4e-15)
    # phi turns as L (I1 w1^2 + I2 w2^2) / (I1^2 w1^2 + I2^2 w2^2) says (Landau & Lifshitz, Mechanics, section 37).
    w = motion.at(0.5)[0]
    h = 1e-6
    slope = np.diff(motion.euler_angles([0.5 - h, 0.5 + h])[:, 0])[0] / (2 * h)
    expected = momentum * (0.2 * w[0] ** 2 + 0.4 * w[1] ** 2) / (0.04 * w[0] ** 2 + 0.16 * w[1] ** 2)
    assert slope == pytest.approx(expected, rel=1e-8)


def test_polhode_and_herpolhode():
    motion = ph.FreeMotion(BLOCK, (1, 2, 3), np.array([0.5, -0.1, 0.7, 0.5]))
    t = np.linspace(0, 50, 101)
    polhode, herpolhode = motion.polhode(t), motion.herpolhode(t)
    np.testing.assert_allclose((np.array(BLOCK) * polhode**2).sum(axis=-1), 1, rtol=4e-15)
    np.testing.assert_allclose(herpolhode @ motion.angular_momentum, math.sqrt(2 * motion.energy), rtol=4e-15)


def test_shapes_values_and_copies():
    motion = ph.FreeMotion(BLOCK, (1, 2, 3))
    omega, attitude = motion.at(np.zeros((2, 0, 5)))
    assert omega.shape == (2, 0, 5, 3) and attitude.shape == (2, 0, 5, 4)
    omega, attitude = motion.at(3)
    assert omega.shape == (3,) and attitude.shape == (4,)
    np.testing.assert_array_equal(motion.at([3.0])[0][0], omega)
    np.testing.assert_array_equal(motion.at(np.array([[1.0, 9.0], [3.0, 9.0]])[:, 0])[1][1], attitude)
    copy = pickle.loads(pickle.dumps(motion))
    assert copy == motion and hash(copy) == hash(motion)
    assert motion != ph.FreeMotion(BLOCK, (1, 2, 3.5))
    assert "FreeMotion(InertiaTensor(" in repr(motion)
    q = np.array([0.3, -0.2, 0.1, 0.9]) / np.linalg.norm([0.3, -0.2, 0.1, 0.9])
    tilted = ph.FreeMotion(BLOCK, (1, 2, 3), q)
    assert pickle.loads(pickle.dumps(tilted)) == tilted


def test_constants():
    motion = ph.FreeMotion(BLOCK, (1, 2, 3))
    assert motion.energy == pytest.approx(0.5 * (0.2 + 1.6 + 4.68), rel=1e-15)
    np.testing.assert_allclose(motion.angular_momentum, [0.2, 0.8, 1.56], rtol=1e-15)
    rest = ph.FreeMotion(BLOCK, (0, 0, 0))
    assert rest.kind == "rest" and rest.energy == 0 and rest.period == 0 and not rest.angular_momentum.any()
    assert not rest.at(5.0)[0].any()


@pytest.mark.parametrize("arguments, name", [
    ((BLOCK, (1, 2)), "omega"),
    ((BLOCK, (1, 2, math.nan)), "omega"),
    ((BLOCK, "fast"), "omega"),
    ((BLOCK, (1, 2, 3), (0, 0, 0, 0)), "attitude"),
    ((BLOCK, (1, 2, 3), (0, 0, 0, 2)), "attitude"),
    (((1, 2), (1, 2, 3)), "inertia"),
    (((1, 2, 4), (1, 2, 3)), "inertia|moments"),
    (((0, 1, 1), (1, 2, 3)), "inertia"),
    (((-1, 1, 1), (1, 2, 3)), "inertia|moments"),
])
def test_refusals(arguments, name):
    with pytest.raises(ph.InvalidInput, match=name):
        ph.FreeMotion(*arguments)


def test_times_that_no_float_can_answer_are_refused():
    motion = ph.FreeMotion(BLOCK, (1, 2, 3))
    for t in (math.nan, math.inf, 1e26, "now", 1j):
        with pytest.raises(ph.InvalidInput, match="t: "):
            motion.at(t)
        with pytest.raises(ph.InvalidInput, match="t: "):
            motion.at([0.0, t])
    with pytest.raises(ph.InvalidInput, match="energy"):
        ph.FreeMotion(BLOCK, (1e160, 1, 1)).energy  # noqa: B018
    with pytest.raises(ph.InvalidInput, match="period"):
        ph.FreeMotion(BLOCK, (1e-309, 1e-309, 1e-309)).period  # noqa: B018


def test_many_threads_may_share_one_motion():
    motion = ph.FreeMotion(BLOCK, (1, 2, 3))
    t = np.linspace(0, 1e4, 2000)
    expected, results = motion.at(t), [None] * 4

    def work(i):
        results[i] = motion.at(t)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for omega, attitude in results:
        np.testing.assert_array_equal(omega, expected[0])
        np.testing.assert_array_equal(attitude, expected[1])


PRINT = """
import sys
import numpy as np
import polhode as ph
from tables import read
answers = []
for row in read("free_motion.csv"):
    number = lambda *names: [float(row[name]) for name in names]
    inertia = ph.InertiaTensor.from_moments(number("I1", "I2", "I3"), physical=False)
    motion = ph.FreeMotion(inertia, number("w1", "w2", "w3"), number("x0", "y0", "z0", "w0"))
    t = float(row["t"])
    times = t * np.linspace(1, 0, 11)          # one block of eight and a rest
    omega, attitude = motion.at(times)
    for i in (0, 3, 10):
        one = motion.at(float(times[i]))
        assert (one[0] == omega[i]).all() and (one[1] == attitude[i]).all(), "an element depends on its place"
    answers.append(np.concatenate([omega.ravel(), attitude.ravel()]))
sys.stdout.buffer.write(np.array(answers).tobytes())
"""


@pytest.fixture(scope="module")
def by_level(table):
    """{level: the answers to the whole table}, each from a process capped at that level."""
    found = levels.outputs(PRINT, [level for level in levels.LEVELS if level in levels.there()])
    return {level: np.frombuffer(text).reshape(len(table), -1) for level, text in found.items()}


def test_the_same_bits_on_avx2_and_avx512(by_level):
    if len(by_level) < 3:
        pytest.skip("this machine lacks a level")
    assert by_level["avx2"].tobytes() == by_level["avx512"].tobytes()
    assert by_level["avx2"].tobytes() != by_level["baseline"].tobytes(), "the cap has no effect"


def test_every_level_keeps_the_promise(by_level, table):
    for answers in by_level.values():
        for row, answer in zip(table, answers, strict=True):
            expected = numbers(row, "o1", "o2", "o3")
            off = np.linalg.norm((answer[:3] - expected) / (np.abs(expected).max() or 1.0))
            angle = float(angle_between(answer[33:37], numbers(row, "x", "y", "z", "w")))
            assert max(off, angle) < 2e-15


def test_a_level_that_does_not_exist_is_refused():
    run = subprocess.run([sys.executable, "-c", "import polhode; polhode.build_info()"], capture_output=True, text=True,
                         env={**os.environ, "POLHODE_SIMD": "mmx"})
    assert run.returncode != 0 and "POLHODE_SIMD" in run.stderr


@pytest.mark.parametrize("omega", [(1.7e308, 1e-3, 1e-3), (1e-160, -22.0, 1e160), (0.0, 1.0, 1e-320),
                                   (0.0, -1e-3, 5.8e303)])
@pytest.mark.parametrize("moments", [(1.0, 1.0, 1.0), (1.0, 1.5, 2.0), (1.0, 1.0, 1.5)])
def test_rates_that_vanish_beside_another_are_refused(moments, omega):
    """Divided by the largest they are no normal numbers, and the phase would be NaN."""
    with pytest.raises(ph.InvalidInput, match="below 1e-286 of the largest"):
        ph.FreeMotion(moments, omega)
    with pytest.warns(RuntimeWarning, match="1 "):
        w, q = ph.free_motion(moments, [omega, (1, 2, 3)], (0, 0, 0, 1), 0.5)
    assert np.isnan(w[0]).all() and np.isnan(q[0]).all() and np.isfinite(w[1]).all()
    least = [rate if rate == max(omega) else 0.0 for rate in omega]   # 0 is no vanishing rate
    assert np.isfinite(ph.FreeMotion(moments, least).at(0.0)[0]).all()
