"""One scene from starts at times of their own, and its torque at many states."""

import numpy as np
import pytest

import polhode as ph

T = ph.torques
RNG = np.random.default_rng(17)
SPINS = RNG.normal(size=(9, 3))
TURNS = ph.Rotation.from_rotvec(RNG.normal(size=(9, 3))).as_quat()
STARTS = RNG.uniform(-2, 2, 9)
TIMES = STARTS[:, None] + RNG.uniform(-1, 1, (9, 4))
SCENE = ph.Scene(inertia=(1, 1.5, 2), omega=(0, 0, 1), times=[5.0],
                 torques=[T.Gravity(2, (0.3, 0.2, 0.5)), T.Formula(text="[0.1 * sin(t), 0, 0]")])  # fmt: skip


@pytest.mark.parametrize("options", [{"method": "dop853", "rtol": 1e-10}, {"accuracy": 1e-9}])
def test_each_body_has_its_own_times(options):
    many = ph.solve_many(SCENE, omega=SPINS, attitude=TURNS, t0=STARTS, times=TIMES, **options)
    assert many.omega.shape == (9, 4, 3) and many.success.all()
    for k in range(9):
        one = ph.solve(SCENE.replace(omega=SPINS[k], attitude=TURNS[k], t0=STARTS[k], times=TIMES[k]), **options)
        assert np.array_equal(many.omega[k], one.omega) and np.array_equal(many.attitude[k], one.attitude)


def test_tables_have_the_times_of_each_body():
    pytest.importorskip("pandas")
    table = ph.solve_many(SCENE, t0=STARTS, times=TIMES, accuracy=1e-9).to_pandas()
    assert np.array_equal(table.reset_index()["t"], TIMES.ravel())


def test_starts_alone_and_times_alone():
    late = ph.solve_many(SCENE, t0=STARTS, accuracy=1e-9)
    assert late.omega.shape == (9, 1, 3)
    assert np.array_equal(late.omega[2], ph.solve(SCENE.replace(t0=STARTS[2]), 1e-9).omega)
    many = ph.solve_many(SCENE, times=TIMES, accuracy=1e-9)
    assert np.array_equal(many.omega[3], ph.solve(SCENE.replace(times=TIMES[3]), 1e-9).omega)


def test_derivatives_have_their_own_times():
    many = ph.solve_many(SCENE, t0=STARTS, times=TIMES, sensitivity="omega").sensitivity
    one = ph.solve(SCENE.replace(t0=STARTS[4], times=TIMES[4]), 1e-9, sensitivity="omega").sensitivity
    assert np.array_equal(many.d_omega[4], one.d_omega)


def test_saved_motions_keep_their_times(tmp_path):
    many = ph.solve_many(SCENE, omega=SPINS, t0=STARTS, times=TIMES, accuracy=1e-9)
    many.save(tmp_path / "many.npz")
    again = ph.load(tmp_path / "many.npz")
    assert np.array_equal(again.options["times"], TIMES) and np.array_equal(again.options["t0"], STARTS)
    assert np.array_equal(ph.solve_many(again.scenes, **again.options).omega, many.omega)


@pytest.mark.parametrize("words, message", [
    ({"t0": STARTS, "times": TIMES[:5]}, "starts of one number of bodies, got \\[5, 9\\]"),
    ({"times": TIMES[0]}, "times: must be of shape \\(bodies, samples\\), got \\(4,\\)"),
    ({"times": TIMES[:, :0]}, "times: must be of shape"),
    ({"t0": 1.0}, "t0: must be of shape \\(bodies\\), got \\(\\)"),
    ({"t0": STARTS * np.nan}, "t0|finite"),
])  # fmt: skip
def test_other_shapes_are_refused(words, message):
    with pytest.raises(ph.InvalidInput, match=message):
        ph.solve_many(SCENE, **words)
    with pytest.raises(ph.InvalidInput, match="t0: must be left out with a scene for each body"):
        ph.solve_many([SCENE], t0=STARTS[:1])


def test_the_torque_at_many_states():
    many = SCENE.torque(STARTS, SPINS, TURNS)
    assert many.shape == (9, 3)
    for k in range(9):
        assert np.array_equal(many[k], SCENE.torque(STARTS[k], SPINS[k], TURNS[k]))
    assert np.array_equal(SCENE.torque(0.5, SPINS, ph.Rotation.from_quat(TURNS))[4],
                          SCENE.torque(0.5, SPINS[4], TURNS[4]))  # fmt: skip
    assert np.array_equal(SCENE.torque(STARTS, SPINS[0], TURNS[0])[4], SCENE.torque(STARTS[4], SPINS[0], TURNS[0]))
    assert SCENE.torque(0.0, SPINS[:0], TURNS[:0]).shape == (0, 3)
    for t, omega, attitude, place in ((0, SPINS, TURNS[:4], "attitude"), (STARTS[:1], SPINS, TURNS, "omega"),
                                      (0, SPINS[:, :2], TURNS, "omega"), (STARTS * np.nan, SPINS, TURNS, "t"),
                                      (0, SPINS, 2 * TURNS, "attitude|unit")):  # fmt: skip
        with pytest.raises(ph.InvalidInput, match=place):
            SCENE.torque(t, omega, attitude)
