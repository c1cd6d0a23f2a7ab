"""Two ways to know an error: carried along by one run, or the difference of two. What is claimed holds, and is not far
above.

The error that is carried is an estimate (docs/notes/certificates.md).
"""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from bodies import BLOCK, scene
from measures import error, truth

import polhode as ph
from polhode._core import reference

ROOT = Path(__file__).parents[3]
TILTED = (np.sin(0.25), 0.0, 0.0, np.cos(0.25))
TIMES = np.linspace(0, 30, 61)


def compute_truth(one):
    """The same motion by a series in long doubles, which shares nothing with the methods."""
    found = reference(one, 28, 1e-20, 100_000)
    return {"omega": found[0], "attitude": found[1]}


def turned(angle_axis, **parts):
    """A body given in axes that are not its principal ones."""
    R = ph.Rotation.from_rotvec(angle_axis).as_matrix()
    tensor = R @ np.diag(BLOCK) @ R.T
    return ph.Scene(inertia=(tensor + tensor.T) / 2, times=TIMES, **parts)


SCENES = {
    "heavy": ph.Scene(inertia=BLOCK, omega=(1, 2, 3), attitude=TILTED, torques=[ph.torques.Gravity(1, (0.1, 0.2, 0.3))],
                      times=TIMES),
    "gradient": ph.Scene(inertia=BLOCK, omega=(0.1, 0.3, 2), torques=[ph.torques.GravityGradient(0.5)], times=TIMES),
    "thruster": ph.Scene(inertia=BLOCK, omega=(1, 2, 3), torques=[ph.torques.Constant((0.01, -0.02, 0.03))],
                         times=TIMES),
    "space torque": ph.Scene(inertia=BLOCK, omega=(1, 2, 3),
                             torques=[ph.torques.Constant((0.1, 0.05, 0.02), frame="space")], times=TIMES),
    "damped": ph.Scene(inertia=BLOCK, omega=(1, 2, 3), torques=[ph.torques.Damping(np.diag((0.002, 0.004, 0.001)))],
                       times=TIMES),
    "full tensor": turned((0.3, -0.5, 0.2), omega=(1, 2, 3), torques=[ph.torques.Gravity(1, (0.3, 0.1, 0.2))]),
    "next to the separatrix": ph.Scene(inertia=BLOCK, omega=(0.001, 3, 0.001),
                                       torques=[ph.torques.Constant((0, 1e-5, 0))], times=TIMES),
    "rates alone": ph.Scene(inertia=BLOCK, omega=(1, 2, 3), torques=[ph.torques.Gravity(1, (0.1, 0.2, 0.3))],
                            times=TIMES, want="omega"),
}


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("name", SCENES)
def test_what_is_carried_along_is_the_error(name, accuracy):
    one = SCENES[name]
    motion = ph.solve(one, accuracy, method="taylor")
    true = compute_truth(one)
    if motion.attitude is None:
        found = np.linalg.norm(motion.omega - true["omega"], axis=1).max() / np.linalg.norm(true["omega"], axis=1).max()
    else:
        found = error(motion.omega, motion.attitude, true)
    assert motion.success and found <= 1.5 * motion.error and max(found, motion.error) <= accuracy
    assert motion.error <= 300 * found


@pytest.mark.parametrize("name", ["S5", "S6", "S9"])
def test_both_certificates_agree(name):
    carried, pair = (ph.solve(scene(name), 1e-7, method=method) for method in ("taylor", "dop853"))
    assert carried.stats["runs"] == 1 and pair.stats["runs"] >= 2
    for motion in (carried, pair):
        found = error(motion.omega, motion.attitude, truth(name))
        assert found <= motion.error <= 1e-7 and motion.error <= 300 * found


def test_what_is_carried_follows_the_tolerance():
    """Of two runs whose tolerances are a thousand apart the errors are, too. Loose ones are five times tighter."""
    loose, middle, tight = (ph.solve(SCENES["heavy"], accuracy, method="taylor") for accuracy in (1e-4, 1e-7, 1e-9))
    assert loose.plan.rtol / middle.plan.rtol == pytest.approx(1000)
    assert middle.plan.rtol / tight.plan.rtol == pytest.approx(100 / 5, rel=0.01)
    assert 200 < loose.error / middle.error < 5000


def test_a_chaotic_body_is_run_again_at_the_right_tolerance():
    chaotic = scene("S5", omega=(0.3, 0.2, 2), times=np.linspace(0, 60, 601))
    motion = ph.solve(chaotic, 1e-8, method="taylor")
    assert motion.success and 2 <= motion.stats["runs"] <= 3
    assert error(motion.omega, motion.attitude, compute_truth(chaotic)) <= 3 * motion.error <= 1e-8


def test_errors_do_not_depend_on_units():
    one, s = SCENES["heavy"], 2.0**40
    scaled = ph.Scene(inertia=np.array(BLOCK) * s, omega=(1, 2, 3), attitude=TILTED,
                      torques=[ph.torques.Gravity(s, (0.1, 0.2, 0.3))], times=TIMES)
    assert ph.solve(scaled, 1e-8).error == ph.solve(one, 1e-8).error
    faster = ph.Scene(inertia=BLOCK, omega=np.array((1, 2, 3)) * s, attitude=TILTED,
                      torques=[ph.torques.Gravity(s * s, (0.1, 0.2, 0.3))],
                      times=TIMES / s)
    assert ph.solve(faster, 1e-8).error == pytest.approx(ph.solve(one, 1e-8).error, rel=1e-6)


def test_only_the_samples_count():
    """The error of the only sample, at the end of a motion that has been damped away, is relative to what is left."""
    torques = [ph.torques.Damping(np.diag(np.array(BLOCK) * 0.1))]
    end = ph.solve(ph.Scene(inertia=BLOCK, omega=(1, 2, 3), torques=torques, times=[60.0], want="omega"), 1e-9,
                   method="taylor")
    many = ph.solve(ph.Scene(inertia=BLOCK, omega=(1, 2, 3), torques=torques, times=np.linspace(0, 60, 121),
                             want="omega"), 1e-9, method="taylor")
    assert end.success and many.success and len(end) == 1
    assert (np.linalg.norm(end.omega[0] - many.omega[-1])
            <= (end.error + many.error) * np.linalg.norm(end.omega[0]) * 500)


def test_a_pair_does_not_share_its_inputs():
    """Both runs have a sphere's rates to the last bit: what is left is what eight units in the last place of them do.

    The runs take the same steps, so that 30 times the difference is claimed.
    """
    sphere = ph.Scene(inertia=(2, 2, 2), omega=(1, 2, 3), times=TIMES, want="omega")
    assert 30 * 1e-16 < ph.solve(sphere, 1e-9, method="rk45").error < 30 * 4e-13


def test_a_heavy_body_whose_losses_add_up_keeps_its_bound():
    # The losses of its steps have one sign where the last terms of the series have two.
    scene = ph.Scene(
        inertia=(0.16986926673817143, 0.04431168594563485, 0.16516783229660312),
        omega=(-0.4460294525570051, -1.9716615117934364, -2.2631621055978064),
        attitude=(0.9370226475003608, 0.04900432494541409, 0.3416217830227285, 0.05368138944206456), want=("omega",),
        torques=[ph.torques.Gravity(0.4960776946512235,
                                    (0.8611047078435747, 0.02931340969462944, -0.1470821451173165))],
        times=[0.0, 13.40369455304652])
    motion = ph.solve(scene, accuracy=3.54e-9, method="taylor")
    omega = ph._core.reference(scene, 24, 1e-20, 100_000)[0]
    error = np.linalg.norm(motion.omega - omega, axis=1).max() / np.linalg.norm(omega, axis=1).max()
    assert motion.success and error <= motion.error <= 3.54e-9


def test_no_carried_error_is_below_the_truth_on_scenes_drawn_anew():
    carried = importlib.util.spec_from_file_location("carried", ROOT / "benchmarks/planner/carried.py")
    module = importlib.util.module_from_spec(carried)
    carried.loader.exec_module(module)
    bounds, asked, _, _ = module.judge(seed=5, count=60)
    assert bounds.min() > 1 and asked.min() > 1   # 1.3 was the least of 600 with another seed
    assert np.median(bounds) < 10
