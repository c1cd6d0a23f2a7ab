"""rk45 with eight bodies side by side: each is what solve() makes of it, bit for bit, at every instruction set."""


import levels
import numpy as np
import pytest
from bodies import scene
from draw import draw_bodies

import polhode as ph

T = ph.torques
RNG = np.random.default_rng(45)
N = 21
MOMENTS, RATES, ATTITUDES = draw_bodies(RNG, N, slowest=0.05)
TIMES = (0.0, 7.5, 1.0, -2.0, 3.0, -0.5, 3.0, 1e-4)
SPACE = T.Constant((0, 0.02, 0.1), frame="space")
TORQUES = {
    "free": [],
    "gravity": [T.Gravity(2, (0.3, 0.2, 0.5))],
    "thruster": [T.Constant((0.1, -0.2, 0.05))],
    "space": [SPACE],
    "damping": [T.Damping([[0.05, 0.01, 0], [-0.02, 0.03, 0.004], [0.003, 0, 0.02]])],
    "gradient": [T.GravityGradient(mean_motion=0.3, phase=0.7)],
    "all": [T.GravityGradient(mean_motion=0.3), T.Gravity(1, (0, 0.1, 0.3)), SPACE, T.Damping((0.01, 0.05, 0.02)),
            T.Constant((0.1, -0.2, 0.05)), T.GravityGradient(mean_motion=-0.1, phase=2), SPACE,
            T.Gravity(0.3, (0.2, 0, 0))],
    "none": [T.Gravity(0, (1, 0, 0)), T.Damping((0, 0, 0)), T.GravityGradient(mean_motion=0)],
}


def make_scenes(torques, times=TIMES, want=("omega", "attitude"), skew=False, scale=1.0, **parts):
    """One scene a body; `skew`: products of inertia, other ones for each."""
    found = []
    for moments, spin, turn, other in zip(MOMENTS, RATES, ATTITUDES, np.roll(ATTITUDES, 1, axis=0), strict=True):
        inertia = ph.InertiaTensor.from_moments(moments * scale)
        found.append(ph.Scene(inertia=inertia.rotated(ph.Rotation(other)) if skew else inertia, omega=spin,
                              attitude=turn,
                              torques=torques, times=times, want=want, **parts))
    return found


def require_same(many, scenes, **options):
    """Bit for bit, signs of zeros apart, and word for word."""
    assert many.lanes.all()
    for i, one in enumerate(scenes):
        alone = ph.solve(one, **options)
        rows = [np.flatnonzero(one.times == t)[0] for t in alone.t]
        for ours, own in ((many.omega, alone.omega), (many.attitude, alone.attitude)):
            if ours is not None:
                assert np.array_equal(ours[i][rows], own)
                assert np.isnan(np.delete(ours[i], [k for k, t in enumerate(one.times) if t in alone.t], axis=0)).all()
        assert many.status[i] == alone.status and many.method[i] == "rk45"
        assert alone.message.startswith(many.message[i])   # solve() adds which invariants moved
        assert many.steps[i] == alone.stats["steps"] and many.success[i] == alone.success
        forward = one.times[one.times >= one.t0]
        if alone.status == "finished":
            assert many.t_reached[i] == (forward.max() if forward.size else one.times.min())
        else:
            assert f"t = {many.t_reached[i]:.6g}"[:8] in alone.message


@pytest.mark.parametrize("torques", TORQUES)
@pytest.mark.parametrize("want", [("omega",), ("omega", "attitude")])
@pytest.mark.parametrize("skew", [False, True])
def test_each_body_is_what_solve_makes_of_it_to_the_bit(torques, want, skew):
    scenes = make_scenes(TORQUES[torques], want=want, skew=skew)
    for rtol, atol in ((1e-3, None), (1e-8, 1e-9)):
        many = ph.solve_many(scenes, method="rk45", rtol=rtol, atol=atol)
        assert set(many.status) == {"finished"} and many.steps.max() > 3 * many.steps.min()
        require_same(many, scenes, method="rk45", rtol=rtol, atol=atol)


def test_each_body_has_torques_of_its_own():
    # next to each other: orbit angles that the polynomials take, that the library takes, and that pass from one to the
    # other
    scenes = [one.replace(torques=[T.GravityGradient(0.2 + 0.01 * i, (0.5, 3e5, 1e5 - 1)[i % 3]),
                                   T.Gravity(0.1 * i, (0, 0.1, -0.02 * i))])
              for i, one in enumerate(make_scenes([]))]
    many = ph.solve_many(scenes, method="rk45", rtol=1e-6)
    require_same(many, scenes, method="rk45", rtol=1e-6)


@pytest.mark.parametrize(("rtol", "bound"), [(1e-4, 2e-2), (1e-8, 1e-6), (1e-12, 1e-10)])
def test_the_tolerance_is_kept_against_the_closed_form(rtol, bound):
    many = ph.solve_many(make_scenes([]), rtol=rtol)   # rk45 is what solve() takes where only a tolerance is given
    omega, attitude = ph.free_motion(MOMENTS[:, None], RATES[:, None], ATTITUDES[:, None], np.array(TIMES))
    rates = np.linalg.norm(many.omega - omega, axis=-1).max(axis=1) / np.linalg.norm(RATES, axis=1)
    turns = np.minimum(np.linalg.norm(many.attitude - attitude, axis=-1),
                       np.linalg.norm(many.attitude + attitude, axis=-1))
    assert many.lanes.all() and rates.max() < bound and 2 * turns.max() < bound


@pytest.mark.parametrize("torques", ["free", "all"])
def test_neighbours_threads_and_order_change_no_bit(torques):
    scenes = make_scenes(TORQUES[torques])
    whole = ph.solve_many(scenes, method="rk45", rtol=1e-9, threads=1)
    for rows in (np.arange(N)[::-1], RNG.permutation(N), np.arange(5, 9), np.array([20]), np.arange(0, N, 2)):
        part = ph.solve_many([scenes[i] for i in rows], method="rk45", rtol=1e-9)
        assert np.array_equal(part.omega, whole.omega[rows]) and np.array_equal(part.attitude, whole.attitude[rows])
        assert np.array_equal(part.steps, whole.steps[rows])
    for threads in (1, 2, 3):   # several chunks
        many = ph.solve_many(scenes * 13, method="rk45", rtol=1e-9, threads=threads)
        assert all(np.array_equal(many.attitude[k * N:(k + 1) * N], whole.attitude) for k in range(13))


PRINT = """
import hashlib
from test_solve_many_rk45 import *
for torques in TORQUES.values():
    for skew, want in ((False, ("omega",)), (True, ("omega", "attitude"))):
        many = ph.solve_many(make_scenes(torques, want=want, skew=skew), method="rk45", rtol=1e-7)
        bits = many.omega.tobytes() + (many.attitude.tobytes() if many.attitude is not None else b"")
        print(hashlib.sha256(bits).hexdigest(), int(many.steps.sum()))
"""


def test_every_level_gives_the_same_bits():
    found = levels.outputs(PRINT, levels.LEVELS)
    assert len(set(found.values())) == 1 and len(found["avx2"].splitlines()) == 2 * len(TORQUES)


def test_bodies_that_fail_do_so_alone_and_say_what_solve_says():
    tame = make_scenes(TORQUES["gravity"], times=(0, 1, 50))
    growing = [one.replace(torques=[T.Damping((-0.3, -0.3, -0.3))])
               for one in tame[:5]]     # rates grow as exp(0.3 t / I)
    blown = ph.Scene(inertia=(0.01, 0.011, 0.012), omega=(1, 1, 1), torques=[T.Damping((-1, -1, -1))], times=(0, 1, 50))
    huge = blown.replace(torques=[T.Constant((1e308, 1e308, 1e308))])
    late = tame[0].replace(t0=1e17, times=(1e17 + 64,))   # times are 16 s apart there: no step is short enough
    still = [tame[0].replace(times=(0, 0, 0)), tame[1].replace(times=(0, -3, 0)),
             tame[2].replace(omega=(0, 0, 0), torques=[])]
    scenes = [*tame[:3], blown, huge, *growing, *tame[3:], *still, blown, huge]
    options = {"method": "rk45", "rtol": 1e-7, "max_steps": 900}
    many = ph.solve_many(scenes, **options)
    assert {"finished", "failed", "max_steps"} == set(many.status)
    require_same(many, scenes, **options)
    unended = ph.solve_many([late, late], method="rk45", rtol=1e-9)
    assert unended.status[0] == "failed" and "smaller than the spacing" in unended.message[0]
    require_same(unended, [late, late], method="rk45", rtol=1e-9)
    assert any("not finite just beyond" in message for message in many.message)


def test_steps_are_counted_in_each_direction_of_time():
    for times in ((0, 0.5, 9), (-9, 0.5), (-0.5, 9, 0, 0.1)):
        scenes = make_scenes([], times=times)
        many = ph.solve_many(scenes, rtol=1e-7, max_steps=100)
        assert 5 < many.status.count("max_steps") < N
        require_same(many, scenes, rtol=1e-7, max_steps=100)


def test_dense_samples_and_one_time():
    for times in (np.linspace(-1, 2, 301), (5.0,), (-5.0,), (0.0,), np.array([1, 1, 2, 2, 0, 0, -1, -1.0])):
        scenes = make_scenes(TORQUES["damping"], times=times)
        require_same(ph.solve_many(scenes, method="rk45", rtol=1e-6), scenes, method="rk45", rtol=1e-6)
    later = make_scenes(TORQUES["gradient"], times=(12.0, 8.0, 10.0), t0=10.0)
    require_same(ph.solve_many(later, rtol=1e-6), later, rtol=1e-6)


@pytest.mark.parametrize("scale", [1e-12, 1e12])
def test_units_make_no_difference(scale):
    plain = ph.solve_many(make_scenes([]), rtol=1e-8)
    heavy = make_scenes([], scale=scale)
    many = ph.solve_many(heavy, rtol=1e-8)
    require_same(many, heavy, rtol=1e-8)
    fast = [one.replace(omega=one.omega * scale, times=tuple(t / scale for t in TIMES)) for one in make_scenes([])]
    quick = ph.solve_many(fast, rtol=1e-8)
    require_same(quick, fast, rtol=1e-8)
    for other in (many, quick):
        assert np.abs(other.attitude - plain.attitude).max() < 1e-6


def test_callables_and_windows_go_by_themselves_beside_the_lanes():
    scenes = make_scenes(TORQUES["gravity"], times=(0.5, 1.0))[:9]
    for i in (2, 7):
        scenes[i] = scenes[i].replace(torques=[T.Custom(lambda t, w, q: (0.1 * t, 0, -w[2]))])
    scenes[4] = scenes[4].replace(torques=[T.During(T.Constant((0.1, 0, 0.2)), [(0.25, 0.75)])])
    for threads in (1, 3):
        many = ph.solve_many(scenes, method="rk45", rtol=1e-8, threads=threads)
        assert many.lanes.tolist() == [i not in (2, 4, 7) for i in range(9)]
        for i, one in enumerate(scenes):
            alone = ph.solve(one, method="rk45", rtol=1e-8)
            assert np.array_equal(many.omega[i], alone.omega) and np.array_equal(many.attitude[i], alone.attitude)


def test_stored_scenes_and_what_is_refused():
    for name in ("S4", "S5", "S6", "S9"):
        pair = [scene(name)] * 2
        require_same(ph.solve_many(pair, method="rk45", rtol=1e-9), pair, method="rk45", rtol=1e-9)
    common = make_scenes([])[0]
    with pytest.raises(ph.InvalidInput, match="body 2.*omega"):
        ph.solve_many(common, omega=[(0, 0, 1), (0, 1, 0), (np.nan, 0, 0)], rtol=1e-6)
    with pytest.raises(ph.InvalidInput, match="step"):
        ph.solve_many([common], method="rk45", rtol=1e-6, step=0.1)
    raised = ph.solve_many([common], rtol=1e-18)
    assert "raised to" in raised.message[0]
    assert not ph.solve_many([common] * 2, method="dop853", rtol=1e-8).lanes.any()
