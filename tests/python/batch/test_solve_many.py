"""Many driven bodies: each is what solve() makes of it, whatever the threads, and each fails alone. Lanes apart."""

import numpy as np
import pytest
from bodies import scene

import polhode as ph

T = ph.torques
RNG = np.random.default_rng(7)
MOMENTS = 1 + RNG.uniform(0, 0.9, (13, 3))
SPINS = RNG.normal(size=(13, 3))
TURNS = ph.Rotation.from_rotvec(RNG.normal(size=(13, 3))).as_quat()
TIMES = np.linspace(0, 3, 5)
COMMON = ph.Scene(inertia=(1, 1.5, 2), omega=(0, 0, 1), torques=[T.Gravity(2, (0.3, 0.2, 0.5))], times=TIMES)


@pytest.mark.parametrize("method", ["dop853", "rk45"])
def test_each_body_is_what_solve_makes_of_it(method):
    many = ph.solve_many(COMMON, inertia=MOMENTS, omega=SPINS, attitude=TURNS, method=method, rtol=1e-9)
    assert many.omega.shape == (13, 5, 3) and many.attitude.shape == (13, 5, 4)
    for i in range(13):
        one = ph.solve(COMMON.replace(inertia=MOMENTS[i], omega=SPINS[i], attitude=TURNS[i]), method=method, rtol=1e-9)
        assert (many.omega[i] == one.omega).all() and (many.attitude[i] == one.attitude).all()
        assert many.status[i] == one.status == "finished" and many.steps[i] == one.stats["steps"]
        assert many.method[i] == method and many.t_reached[i] == 3 and many.success[i] == one.success


def test_threads_and_division_change_nothing():
    parts = {"inertia": MOMENTS, "omega": SPINS, "attitude": TURNS, "method": "taylor", "rtol": 1e-12}
    one = ph.solve_many(COMMON, threads=1, **parts)
    for threads in (2, 3, 8):
        other = ph.solve_many(COMMON, threads=threads, **parts)
        assert (one.omega == other.omega).all() and (one.attitude == other.attitude).all()
    half = ph.solve_many(COMMON, **{**parts, **{k: parts[k][6:] for k in ("inertia", "omega", "attitude")}})
    assert (half.omega == one.omega[6:]).all()


def test_results_are_compared_by_their_numbers():
    one, same, other = (ph.solve_many(COMMON, inertia=MOMENTS, omega=SPINS, rtol=rtol) for rtol in (1e-6, 1e-6, 1e-7))
    assert one == same and hash(one) == hash(same) and one != other and one != one.omega.tolist()


def test_scenes_of_their_own():
    scenes = [scene("S5", times=TIMES), scene("S9", times=TIMES), scene("S6", times=TIMES)]
    many = ph.solve_many(scenes, method="dop853", rtol=1e-10)
    for i, one in enumerate(scenes):
        assert (many.attitude[i] == ph.solve(one, method="dop853", rtol=1e-10).attitude).all()
    rates = ph.solve_many([s.replace(want=("omega",)) for s in scenes])
    assert rates.attitude is None and rates.omega.shape == (3, 5, 3)
    assert ph.solve_many([]).status == ()


def test_starts_of_one_body():
    many = ph.solve_many(COMMON, omega=SPINS, rtol=1e-8, method="rk45")
    one = ph.solve(COMMON.replace(omega=SPINS[4]), rtol=1e-8, method="rk45")
    assert (many.attitude[4] == one.attitude).all()


def test_a_body_fails_alone():
    wild = ph.Scene(inertia=(1, 2, 3), omega=(1, 1, 1), torques=[T.Damping((-1, -1, -1))], times=(0, 1, 5000))
    many = ph.solve_many([wild, wild.replace(torques=[])], method="taylor", rtol=1e-6, max_steps=2000)
    assert many.status[0] in ("failed", "max_steps") and not many.success[0] and many.t_reached[0] < 5000
    assert np.isfinite(many.omega[0, :2]).all() and np.isnan(many.omega[0, 2]).all()
    assert np.isfinite(many.omega[1]).all() or many.status[1] == "max_steps"


def test_what_cannot_be_is_refused_with_the_body():
    with pytest.raises(ph.InvalidInput, match="body 2"):
        ph.solve_many(COMMON, omega=[(0, 0, 1), (0, 1, 0), (np.nan, 0, 0)])
    with pytest.raises(ph.InvalidInput, match="one number of bodies"):
        ph.solve_many(COMMON, omega=SPINS, inertia=MOMENTS[:4])
    with pytest.raises(ph.InvalidInput, match="one number of bodies"):
        ph.solve_many(COMMON, omega=(0, 0, 1))
    with pytest.raises(ph.InvalidInput, match="shape"):
        ph.solve_many(COMMON, omega=np.zeros((2, 4)))
    with pytest.raises(ph.InvalidInput, match=r"scenes\[1\]"):
        ph.solve_many([COMMON, COMMON.replace(times=(0, 1))])
    with pytest.raises(ph.InvalidInput, match="omega"):
        ph.solve_many([COMMON], omega=SPINS)
    with pytest.raises(ph.InvalidInput, match="threads"):
        ph.solve_many([COMMON], threads=0)


def test_a_python_torque_and_its_error_come_through():
    def broken(t, omega, attitude):
        if t > 1:
            raise KeyError("out of fuel")
        return 0, 0, 0.1

    with pytest.raises(KeyError, match="fuel"):
        ph.solve_many([COMMON.replace(torques=[T.Custom(broken)])] * 3, threads=2, method="rk45")
