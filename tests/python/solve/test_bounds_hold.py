"""Bounds that were false: next to an upright rest, of a heavy needle, and where rounding cancelled the loss."""

from fractions import Fraction

import numpy as np
import pytest

import polhode as ph
from polhode._core import reference

# The needle's and the last truth: heyoka's series with 113 bits.
NEEDLE = ph.Scene(
    inertia=(1, 0.9999998056476144, 1.9435240512013297e-07), times=[-17.31447716913935],
    omega=(0.3637896937018557, -0.6282485218950254, 0.30166203396578023),
    attitude=(-0.6707439944841876, 0.3997650773635643, -0.0902877023510404, -0.6181735254668137),
    torques=[ph.torques.Gravity(0.059617759739077306, (0.596865561929034, 0.04995248460920002, -0.41436745058893404))])
NEEDLE_ATTITUDE = (-0.71711079736942954, -0.16708077253475846, 0.32870725400749646, -0.59142849179610925)
DAMPED = ph.Scene(
    inertia=(0.14689918023802237, 0.19302229503364973, 0.3276155487698108), t0=70.91179101248068,
    omega=(0.007578599793681754, 0.7611304759300314, 0.34853696825102326), times=[117.1099139929419],
    attitude=(0.8928630919157169, -0.048633724858548395, -0.3188565726536191, 0.3142622248643265),
    rotors=[ph.Rotor((-0.6315303477820245, -0.3037789993849614, 0.713363679593366), momentum=-0.20634811592375046,
                     free=True)],
    torques=[ph.torques.Constant((0.0009466211449274791, 0.000502684493784895, 0.0013177618027720279), frame="space"),
             ph.torques.Gravity(0.592143393294141, (-0.1503808817622145, -0.11321103292136125, 0.043395573321379076)),
             ph.torques.Damping([[0.009534892635878827, -0.002543537127060662, 0.0007363591496313544],
                                 [-0.002543537127060662, 0.0009875562438901523, 0.0005366222117121701],
                                 [0.0007363591496313544, 0.0005366222117121701, 0.006051413589930883]])])
DAMPED_ATTITUDE = (-0.6013519610754735, -0.6138160081977869, -0.42787693171146063, -0.2802267979690781)


def measure_angle(p, q):
    return 2 * min(np.linalg.norm(p - np.array(q)), np.linalg.norm(p + np.array(q)))


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
@pytest.mark.parametrize("sign", [-1, 1])
def test_omega_alone_next_to_an_upright_rest(sign, scale):
    """The vertical is along body x exactly: the spin about z grows as cosh, and rounding adds no torque."""
    half, slow = 0.5 ** 0.5, 1e-12 / scale
    scene = ph.Scene(inertia=(0.4, 0.46, 0.6), omega=(0, 0, slow), attitude=(half, 0, half, 0), times=[sign * scale],
                     torques=[ph.torques.Gravity(1.7 / scale ** 2, (13, 0, 0))], want=("omega",))
    motion = ph.solve(scene, 1e-9)
    true = np.array([0, 0, slow * np.cosh(np.sqrt(1.7 * 13 / 0.6))])
    assert motion.success
    assert np.linalg.norm(motion.omega[0] - true) <= motion.error * true[2]
    many = ph.solve_many([scene], rtol=1e-12)
    assert np.linalg.norm(many.omega[0][0] - true) <= 1e-9 * true[2]


def see_vertical(q):
    """R^T e_z from a quaternion, exactly."""
    x, y, z, w = map(Fraction, q)
    size = x * x + y * y + z * z + w * w
    return [2 * (x * z - w * y) / size, 2 * (y * z + w * x) / size, (z * z + w * w - x * x - y * y) / size]


# Attitudes whose arm along x or y is vertical up to some 1e-13.
TILTED = {"x": ((0.16829860473061573, -0.6867864148669, 0.1682986047306145, 0.6867864148668977), 0),
          "y": ((-0.3197321344086743, 0.6306911781741099, -0.6306911781742358, 0.3197321344078833), 1)}


@pytest.mark.parametrize("accuracy", [1e-4, 1e-9, 1e-11])
@pytest.mark.parametrize("inertia", [(0.04, 0.11, 0.08), (0.14, 0.1, 0.05), (0.1, 0.39, 0.3), (0.05, 0.09, 0.11)])
@pytest.mark.parametrize("axis", TILTED)
def test_a_body_at_rest_next_to_upright_or_hanging(axis, inertia, accuracy):
    """The rates of so small a tilt are linear: I w_i'' = +-W a w_i about each horizontal axis, from exact tilts."""
    attitude, k = TILTED[axis]
    times, arm = np.linspace(0.1, 2, 20), np.zeros(3)
    arm[k] = 1.5
    scene = ph.Scene(inertia=inertia, omega=(0, 0, 0), attitude=attitude, times=times,
                     torques=[ph.torques.Gravity(0.5, arm)])
    motion = ph.solve(scene, accuracy)
    assert motion.success == (motion.error <= accuracy)   # float64 attitudes lose the tilt about some axes
    g = see_vertical(scene.attitude)
    true = np.zeros((20, 3))
    for i, j, sign in (((k + 1) % 3, (k + 2) % 3, 1), ((k + 2) % 3, (k + 1) % 3, -1)):
        grows = complex(float(g[k]) * 0.5 * 1.5 / inertia[i]) ** 0.5
        true[:, i] = (np.sinh(grows * times) / grows).real * sign * 0.5 * 1.5 / inertia[i] * float(g[j])
    found = np.linalg.norm(motion.omega - true, axis=1).max() / np.linalg.norm(true, axis=1).max()
    assert found <= motion.error + 1e-13


@pytest.mark.parametrize("accuracy", [5.4e-6, 1e-7, 1e-8, 1.7e-9, 3e-10, 1e-10])
@pytest.mark.parametrize("want", [("omega",), ("omega", "attitude")])
def test_errors_of_a_slow_swing_between_the_ends_of_steps(want, accuracy):
    """It hangs: w_i = w_i(0) cos(nu_i t) about both horizontal axes. A step is longer than half a period."""
    inertia, rates, torque = np.array((0.092, 0.139, 0.166)), np.array((-1.3e-14, -1.4e-14, 0)), 1.1e-3
    times = -np.linspace(0, 55, 92)
    scene = ph.Scene(inertia=inertia, omega=rates, attitude=(0, 1, 0, 0), times=times, want=want,
                     torques=[ph.torques.Gravity(torque, (0, 0, 1))])
    motion = ph.solve(scene, accuracy)
    true = rates * np.cos(np.sqrt(torque / inertia) * times[:, None])
    found = np.linalg.norm(motion.omega - true, axis=1).max() / np.linalg.norm(true, axis=1).max()
    assert motion.success and found <= motion.error + 1e-13


@pytest.mark.parametrize("accuracy", [1e-9, 6.6e-11, 1e-12])
def test_rounding_of_separatrix_variables_of_a_sleeping_top(accuracy):
    """Equal errors of u and v leave w1 as it is: a sample of rounding must have unlike ones. Truth: long doubles."""
    scene = ph.Scene(inertia=(0.3680306743398652, 0.36393493490331885, 0.4984513184614062), times=[90, 120, 179.3],
                     omega=(-3.19926484e-09, 1.63723871e-08, 0.252644834),
                     torques=[ph.torques.Gravity(0.0222341, (0, 0, 1))],
                     attitude=(-1.80415171e-08, -2.2034778e-08, 0.32791834, 0.944706072))
    motion, true = ph.solve(scene, accuracy), reference(scene, 28, 1e-20, 100_000)[0]
    found = np.linalg.norm(motion.omega - true, axis=1).max() / motion.omega_scale
    assert 1e-10 < found <= motion.error


@pytest.mark.parametrize("accuracy", [2.5e-12, 1.4e-8, 2.6e-6])
def test_limits_next_to_upright_count_what_rounding_became(accuracy):
    """Enlarged errors that were made smaller vanished below the attitude's last place."""
    scene = ph.Scene(inertia=(0.09729207248620265, 0.38870030608168954, 0.3011720549510456),
                     omega=(-3.17e-16, 2.75e-16, 3.64e-16), times=np.linspace(-1, -44, 44),
                     attitude=(0.3980255179292033, -0.5844447682007167, 0.3980255179292033, 0.5844447682007167),
                     torques=[ph.torques.Gravity(0.05537624394622634, (1.7010329562811228, 0, 0))])
    motion = ph.solve(scene, accuracy)
    assert not motion.success and motion.error_kind == "limit" and motion.error > 0.1


@pytest.mark.parametrize("accuracy", [8.415e-4, 8.4174e-4, 8.42e-4])
def test_a_heavy_needle_backwards(accuracy):
    motion = ph.solve(NEEDLE, accuracy)
    assert motion.success
    assert measure_angle(motion.attitude[0], NEEDLE_ATTITUDE) <= motion.error


@pytest.mark.parametrize("accuracy", [3e-10, 1e-10, 3e-11])
def test_rounding_does_not_cancel_the_loss(accuracy):
    motion = ph.solve(DAMPED, accuracy)
    assert 0 < measure_angle(motion.attitude[0], DAMPED_ATTITUDE) <= motion.error


def test_columns_that_miss_the_accuracy_are_named():
    scene = ph.Scene.load("S5c").replace(times=np.linspace(0, 60, 5))
    motion = ph.solve(scene, 1e-12, sensitivity=("omega",))
    assert (motion.sensitivity.error > 1e-12).all()
    assert "the sensitivity misses the accuracy of 1e-12 in 3 of 3 columns" in motion.message
    assert "misses" not in ph.solve(scene.replace(times=[1.0]), 1e-8, sensitivity=("omega",)).message


def test_column_of_the_axes_of_a_slender_body():
    """Truth: the derivative by finite differences with 40 digits."""
    body = ph.FreeMotion((1.0000000441994334, 1.000547598011091, 0.0005476422105243905),
                         omega=(-0.20521140912481278, 0.5438470464030751, -0.8137067455070409))
    true = np.array([-1.2295713581500079956e-6, 0.0013457811368072596413, 4.5685066716705201011e-7])
    column = body.sensitivity(0.0021743565836000725, ("axes",)).column("axes_y")[0].reshape(-1)
    assert np.linalg.norm(column - true) <= 20 * 2.2e-16 * np.linalg.norm(true)


@pytest.mark.parametrize("accuracy", [1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize("speed", [0.0, 1e-17, 1e-12])
def test_limits_of_a_body_that_stands_upright(speed, sign, accuracy):
    """Truth: exactly at rest for ever; with a spin about the vertical, that spin alone."""
    half = 0.5 ** 0.5
    scene = ph.Scene(
        inertia=(0.06652143, 0.18703833, 0.24235623), omega=(0, speed, 0), attitude=(-half, 0, 0, half),
        torques=[ph.torques.Gravity(0.01861226794656813, (0, 0.2113714947937306, 0))],
        times=sign * np.linspace(0, 160.0, 4))
    motion = ph.solve(scene, accuracy, method="taylor")
    error = np.abs(motion.omega - (0, speed, 0)).max()
    assert motion.error_kind == "limit" and error > 0
    assert error <= motion.error * speed or motion.error == np.inf


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize("want", [("omega",), ("attitude",), ("omega", "attitude")])
def test_columns_and_events_next_to_an_upright_rest(want, sign, scale):
    half, slow, growth = 0.5 ** 0.5, 1e-12 / scale, np.sqrt(1.7 * 13 / 0.6)
    scene = ph.Scene(inertia=(0.4, 0.46, 0.6), omega=(0, 0, slow), attitude=(half, 0, half, 0), times=[sign * scale],
                     torques=[ph.torques.Gravity(1.7 / scale ** 2, (13, 0, 0))], want=want)
    found = ph.solve(scene, 1e-9, sensitivity=("omega",)).sensitivity
    column = np.asarray(found.column("omega_z")[0]).reshape(-1)
    true = np.array((0, 0, np.cosh(growth)))
    assert np.linalg.norm(column - true) <= found.error.max() * true[2] < 1e-11 * true[2]
    motion = ph.solve(scene, 1e-9, events=[lambda t, omega, attitude: t - sign * scale / 2])
    if "omega" in want:
        assert np.linalg.norm(motion.omega[0] - slow * true) <= motion.error * slow * true[2]
    assert motion.error_kind in ("bounded", "limit")
