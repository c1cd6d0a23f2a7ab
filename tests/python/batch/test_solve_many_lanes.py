"""Bodies side by side in lanes: none sees its neighbours, and each is the motion that solve() finds."""


import levels
import numpy as np
import pytest
from bodies import scene
from draw import draw_bodies

import polhode as ph

T = ph.torques
RNG = np.random.default_rng(11)
N = 37
MOMENTS, RATES, ATTITUDES = draw_bodies(RNG, N, slowest=0.1)
STARTS = {"inertia": MOMENTS, "omega": RATES, "attitude": ATTITUDES, "method": "taylor"}
TIMES = (0.0, 7.5, 1.0, -2.0, 3.0, -0.5, 3.0)
TORQUES = {
    "free": [],
    "gravity": [T.Gravity(2, (0.3, 0.2, 0.5))],
    "constant": [T.Constant((0.1, -0.2, 0.05)), T.Constant((0, 0.02, 0.1), frame="space")],
    "damping": [T.Damping((0.01, 0.05, 0.02)), T.Gravity(1, (0, 0.1, 0.3))],
    "gradient": [T.GravityGradient(mean_motion=0.3)],
    "all": [T.GravityGradient(mean_motion=0.3), T.Gravity(1, (0, 0.1, 0.3)), T.Constant((0, 0.02, 0.1), frame="space"),
            T.Damping((0.01, 0.05, 0.02)), T.Constant((0.1, -0.2, 0.05))],
}


def common(torques=(), times=TIMES, **parts):
    return ph.Scene(inertia=(1, 1.5, 2), omega=(0, 0, 1), torques=list(torques), times=times, **parts)


def same(a, b):
    return all((x is None and y is None) or np.array_equal(x, y, equal_nan=True)
               for x, y in ((a.omega, b.omega), (a.attitude, b.attitude), (a.steps, b.steps),
                            (a.t_reached, b.t_reached)))


def picked(rows):
    return {k: v[rows] if isinstance(v, np.ndarray) else v for k, v in STARTS.items()}


def distance(attitude, other):
    near = np.minimum(np.linalg.norm(attitude - other, axis=-1), np.linalg.norm(attitude + other, axis=-1))
    return 2 * near.max()


def movement(body):
    """How far a unit in the last place of the start moves the rates, the largest of six: 1e-10 for the chaotic one."""
    def rates(omega):
        return ph.solve(body.replace(omega=omega), method="taylor", rtol=1e-15).omega

    here = rates(body.omega)
    starts = [np.where(np.arange(3) == k, np.nextafter(body.omega, end), body.omega)
              for k in range(3) for end in (np.inf, -np.inf)]
    return max(np.abs(rates(start) - here).max() for start in starts)


@pytest.mark.parametrize("torques", TORQUES)
@pytest.mark.parametrize("want", [("omega",), ("omega", "attitude")])
def test_each_is_the_motion_that_solve_finds(torques, want):
    one = common(TORQUES[torques], want=want)
    many = ph.solve_many(one, rtol=1e-14, **STARTS)
    assert many.lanes.all() and set(many.status) == {"finished"} and (many.t_reached == 7.5).all()
    for i in range(0, N, 3):
        body = one.replace(inertia=MOMENTS[i], omega=RATES[i], attitude=ATTITUDES[i])
        alone = ph.solve(body, method="dop853", rtol=1e-14)
        size = np.abs(alone.omega).max()
        allowed = max(2e-11 * size, 20 * movement(body))
        assert np.abs(many.omega[i] - alone.omega).max() < allowed
        if "attitude" in want:
            assert distance(many.attitude[i], alone.attitude) < max(2e-11, allowed / size) * max(1, size)


@pytest.mark.parametrize(("rtol", "bound"), [(1e-6, 1e-4), (1e-9, 1e-7), (1e-12, 1e-10), (1e-16, 3e-14)])
def test_the_tolerance_is_kept_against_the_closed_form(rtol, bound):
    many = ph.solve_many(common(), rtol=rtol, **STARTS)
    omega, attitude = ph.free_motion(MOMENTS[:, None], RATES[:, None], ATTITUDES[:, None], np.array(TIMES))
    sizes = np.linalg.norm(omega, axis=-1).max(axis=1)
    error = max((np.linalg.norm(many.omega - omega, axis=-1).max(axis=1) / sizes).max(),
                distance(many.attitude, attitude))
    assert error < bound
    assert many.success.all() or rtol == 1e-16   # no drift of 1e-16 can be kept
    assert many.steps.max() > 3 * many.steps.min()   # lanes were left and taken at different times


@pytest.mark.parametrize("torques", ["free", "all"])
def test_neighbours_threads_and_order_change_no_bit(torques):
    one = common(TORQUES[torques])
    whole = ph.solve_many(one, rtol=1e-12, threads=1, **STARTS)
    for threads in (2, 3):
        assert same(whole, ph.solve_many(one, rtol=1e-12, threads=threads, **STARTS))
    for rows in (np.arange(N)[::-1], RNG.permutation(N), np.arange(5, 9), np.array([20]), np.arange(0, N, 2)):
        part = ph.solve_many(one, rtol=1e-12, **picked(rows))
        assert np.array_equal(part.omega, whole.omega[rows]) and np.array_equal(part.attitude, whole.attitude[rows])
        assert np.array_equal(part.steps, whole.steps[rows])


def test_many_chunks_and_threads():
    wide = {k: np.tile(v, (20, 1)) if isinstance(v, np.ndarray) else v for k, v in STARTS.items()}
    one = common(times=(0.5,))
    alone = ph.solve_many(one, rtol=1e-9, **STARTS)
    for threads in (1, 3):
        many = ph.solve_many(one, rtol=1e-9, threads=threads, **wide)
        assert np.array_equal(many.attitude.reshape(20, N, 1, 4), np.broadcast_to(alone.attitude, (20, N, 1, 4)))


PRINT = """
import hashlib
from test_solve_many_lanes import *
for torques in TORQUES:
    for want in (("omega",), ("omega", "attitude")):
        for rtol in (1e-7, 1e-16):
            many = ph.solve_many(common(TORQUES[torques], want=want), rtol=rtol, **STARTS)
            bits = many.omega.tobytes() + (many.attitude.tobytes() if many.attitude is not None else b"")
            print(hashlib.sha256(bits).hexdigest(), int(many.steps.sum()))
"""


def test_avx2_and_avx512_give_the_same_bits():
    found = levels.outputs(PRINT)
    assert len(found["avx2"].splitlines()) == 24 and found["avx2"] == found["avx512"]


def test_a_failing_body_leaves_its_neighbours_alone():
    wild = [T.Damping((-1, -1, -1))]   # rates grow as exp(t / I)
    huge = common([T.Constant((1e308, 1e308, 1e308))], times=(0, 1, 50))
    tame = [common(times=(0, 1, 50)).replace(omega=RATES[i], inertia=MOMENTS[i]) for i in range(10)]
    blown = common(wild, times=(0, 1, 50)).replace(inertia=(0.01, 0.011, 0.012), omega=(1, 1, 1))
    damped = [one.replace(torques=[T.Damping((0.1, 0.1, 0.1))]) for one in tame]
    quiet = ph.solve_many(tame + damped, method="taylor", rtol=1e-9)
    assert set(quiet.status) == {"finished"}
    many = ph.solve_many(tame[:3] + [blown, huge] + tame[3:] + damped + [blown], method="taylor", rtol=1e-9,
                         max_steps=3000)
    good = [i for i in range(23) if i not in (3, 4, 22)]
    assert np.array_equal(many.omega[good], quiet.omega) and np.array_equal(many.attitude[good], quiet.attitude)
    for i in (3, 4, 22):
        assert many.status[i] in ("failed", "max_steps") and not many.success[i] and many.t_reached[i] < 50
        assert np.isfinite(many.omega[i, 0]).all() and np.isnan(many.omega[i, 2]).all()
        assert "at t =" in many.message[i]


def test_too_many_steps_are_told_and_what_was_reached_is_kept():
    one = common(times=(0, 0.5, 400))
    many = ph.solve_many(one, rtol=1e-10, max_steps=30, **STARTS)
    alone = [ph.solve(one.replace(inertia=MOMENTS[i], omega=RATES[i], attitude=ATTITUDES[i]), method="taylor",
                      rtol=1e-10, max_steps=30)
             for i in range(N)]
    assert many.status == tuple(motion.status for motion in alone) and "max_steps" in many.status
    stopped = [i for i in range(N) if many.status[i] == "max_steps"]
    assert (many.steps[stopped] == 30).all() and np.isnan(many.omega[stopped, 2]).all()
    assert all("max_steps = 30" in many.message[i] for i in stopped)
    back = ph.solve_many(common(times=(-400, 0.5)), rtol=1e-10, max_steps=30,
                         **STARTS)   # who fails there goes no further
    assert back.status.count("max_steps") > 5 and all(
        np.isnan(back.omega[i, 1]).all() == (back.status[i] == "max_steps") for i in range(N))


def test_times_in_any_order_and_at_the_start():
    free = ph.solve_many(common(times=(3, -4, 0, 3, 9, -1)), rtol=1e-13, **STARTS)
    assert np.array_equal(free.omega[:, 2], RATES) and np.array_equal(free.omega[:, 0], free.omega[:, 3])
    times = np.array((3, -4, 0, 3, 9, -1.0))
    omega, attitude = ph.free_motion(MOMENTS[:, None], RATES[:, None], ATTITUDES[:, None], times)
    assert distance(free.attitude, attitude) < 1e-11
    still = ph.solve_many(common(times=(0.0,)), rtol=1e-13, **STARTS)
    assert np.array_equal(still.omega[:, 0], RATES) and (still.steps == 0).all() and set(still.status) == {"finished"}
    at_rest = ph.solve_many(common(times=(5.0,)), omega=np.zeros((3, 3)), method="taylor", rtol=1e-9)
    assert (at_rest.omega == 0).all() and set(at_rest.status) == {"finished"}
    later = ph.solve_many(common(times=(12.0, 8.0), t0=10.0), rtol=1e-13, **STARTS)
    assert np.array_equal(later.omega.shape, (N, 2, 3)) and distance(
        later.attitude, ph.free_motion(MOMENTS[:, None], RATES[:, None], ATTITUDES[:, None],
                                       np.array((2.0, -2.0)))[1]) < 1e-11


@pytest.mark.parametrize("scale", [1e-12, 1e12])
def test_units_make_no_difference(scale):
    many = ph.solve_many(common(), rtol=1e-10, **STARTS)
    fast = ph.solve_many(common(times=tuple(t / scale for t in TIMES)),
                         **{**STARTS, "omega": RATES * scale, "rtol": 1e-10})
    assert distance(many.attitude, fast.attitude) < 1e-8
    heavy = ph.solve_many(common(), **{**STARTS, "inertia": MOMENTS * scale, "rtol": 1e-10})
    assert distance(many.attitude, heavy.attitude) < 1e-8


@pytest.mark.parametrize("rtol", [1e-4, 1e-8, 1e-12])
def test_lanes_take_an_order_that_suits_the_tolerance(rtol):
    """A low order would take many times the steps of solve(), whose order follows the tolerance, too."""
    scene = ph.Scene.load("S4").replace(times=[20.0])
    alone = ph.solve(scene, rtol=rtol, method="taylor").stats["steps"]
    many = ph.solve_many([scene] * 8, rtol=rtol, method="taylor")
    assert many.lanes.all() and 0.3 * alone < many.steps.max() < 3 * alone


def test_stored_scenes_in_lanes_and_the_rest_by_themselves():
    scenes = [scene(name) for name in ("S4", "S5", "S6", "S9")]
    for one in scenes:
        many = ph.solve_many([one, one], method="taylor", rtol=1e-13)
        alone = ph.solve(one, method="taylor", rtol=1e-13)
        assert many.lanes.all() and distance(many.attitude[1], alone.attitude) < 1e-9
    assert not ph.solve_many(scenes[1:2] * 2, rtol=1e-8, method="dop853").lanes.any()
    with pytest.raises(ph.InvalidInput, match="body 1.*Custom"):
        ph.solve_many([scenes[0], scenes[0].replace(torques=[T.Custom(lambda t, w, q: (0, 0, 0))])], method="taylor")
    with pytest.raises(ph.InvalidInput, match="rtol"):
        ph.solve_many(common(), rtol=-1, **STARTS)
    raised = ph.solve_many(common(), rtol=1e-18, **STARTS)
    assert all("raised to 1e-16" in message for message in raised.message)


def test_what_has_a_certificate_goes_by_itself():
    many = ph.solve_many(common(TORQUES["gravity"], times=(0.5,)), accuracy=1e-6, **picked(np.arange(3)))
    assert not many.lanes.any() and (many.error <= 1e-6).all()
