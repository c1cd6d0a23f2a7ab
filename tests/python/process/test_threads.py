"""Eight threads that share bodies, scenes, motions and outs give what one thread gives, with and without the lock of
the interpreter."""

import subprocess
import sys
import sysconfig
import threading
import warnings

import numpy as np
import pytest

import polhode as ph

THREADS, ROUNDS = 8, 20
HERE = (0, 0, 0, 1)
TENSOR = ph.InertiaTensor([[3, 0.2, 0.1], [0.2, 4, 0.3], [0.1, 0.3, 5]])
FREE, TOP = ph.FreeMotion(TENSOR, (1, 2, 3)), ph.HeavyTop((2, 2, 1), 3.0, (0.1, 0.2, 9))
TIMES = np.linspace(0, 20, 200)
OMEGA = np.random.default_rng(5).normal(size=(64, 3))
PULL = ph.torques.Gravity(2.0, (0.1, 0.2, 0.5))
SCENE = ph.Scene(inertia=TENSOR, omega=(1, 2, 3), torques=[PULL, ph.torques.Damping((0.1, 0.1, 0.2))], times=TIMES)
CALLED = ph.Scene(inertia=TENSOR, omega=(1, 2, 3), times=TIMES[:20],
                  torques=[ph.torques.Custom(lambda t, w, q: -0.1 * np.asarray(w), uses_time=False)])
MOTION = ph.solve(SCENE, accuracy=1e-8, dense=True)
TURNS = ph.Rotation.random(500, rng=2)


def solved(scene, **options):
    motion = ph.solve(scene, **options)
    return motion.omega, motion.attitude, [motion.error]


def refused():
    for _ in range(50):
        with pytest.raises(ph.InvalidInput):
            ph.InertiaTensor((1, 1, 9))
        with pytest.raises(ph.InvalidInput):
            ph.Scene(inertia=(1, 2, 2.5), omega=(1, 2), times=[1])
    return []


def asked():
    plan = ph.plan(SCENE, accuracy=1e-6)
    return [plan.predicted_error], [len(str(plan)) > 0]


SHARED = {
    "bodies": lambda: (TENSOR.moments, TENSOR.axes, TENSOR.about_axis((1, 1, 1)), [hash(TENSOR) % 1000]),
    "free motion": lambda: FREE.at(TIMES), "heavy top": lambda: TOP.at(TIMES),
    "batch": lambda: ph.free_motion(TENSOR, OMEGA[:, None], HERE, TIMES),
    "scene, accuracy": lambda: solved(SCENE, accuracy=1e-6),
    "scene, tolerance": lambda: solved(SCENE, rtol=1e-8, method="rk45"),
    "torque in Python": lambda: solved(CALLED, rtol=1e-6),
    "motion": lambda: (*MOTION(TIMES), MOTION.omega, [MOTION.error]),
    "lanes": lambda: [ph.solve_many(SCENE, omega=OMEGA, rtol=1e-6, method="rk45").omega],
    "copies": lambda: solved(SCENE.replace(omega=(3, 2, 1), t0=0.5), accuracy=1e-4),
    "rotations": lambda: (TURNS.as_euler("ZXZ"), (TURNS * TURNS.inv()).as_quat(), TURNS.as_rotvec()),
    "mesh": lambda: [ph.MassProperties.from_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
                                                 [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], mass=2).inertia.matrix],
    "plans": asked, "refusals": refused,
}


def in_threads(work):
    """work(number) at once in all threads, each several times; what they raised."""
    gate, failures = threading.Barrier(THREADS), []

    def run(number):
        try:
            gate.wait()
            for _ in range(ROUNDS):
                work(number)
        except BaseException as error:   # else it would be printed alone
            failures.append(error)

    threads = [threading.Thread(target=run, args=(number,)) for number in range(THREADS)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if failures:
        raise failures[0]


def check(name, expected):
    for a, b in zip(SHARED[name](), expected, strict=True):
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("name", SHARED)
def test_threads_share(name):
    expected = SHARED[name]()
    in_threads(lambda _: check(name, expected))


def test_threads_do_all_of_it_at_once():
    expected = {name: work() for name, work in SHARED.items()}
    names = list(SHARED)

    def work(number):
        for k in range(len(names)):
            check(names[(k + 2 * number) % len(names)], expected[names[(k + 2 * number) % len(names)]])

    in_threads(work)


def test_threads_write_their_rows_of_one_array():
    omega = ph.free_motion(TENSOR, OMEGA[:, None], HERE, TIMES, want="omega")
    out = np.full_like(omega, np.nan)

    def work(number):
        rows = slice(8 * number, 8 * number + 8)
        ph.free_motion(TENSOR, OMEGA[rows, None], HERE, TIMES, want="omega", out=out[rows])
        np.testing.assert_array_equal(out[rows], omega[rows])

    in_threads(work)
    np.testing.assert_array_equal(out, omega)


def test_the_first_calls_of_a_process_may_come_from_threads():
    """Modules that are loaded late, caches and constants are made by whoever comes first."""
    script = """
import threading, polhode as ph
gate, done = threading.Barrier(8), []
def work():
    gate.wait()
    scene = ph.Scene.load("S5")
    done.append((ph.solve(scene, accuracy=1e-4).omega.tobytes(), str(ph.plan(scene, 1e-4)) != "",
                 ph.torques.Gravity.__doc__, ph.elliptic.K(0.5), len(ph.methods()),
                 ph.Rotation.from_euler("ZXZ", (1, 2, 3)).as_quat().tobytes()))
threads = [threading.Thread(target=work) for _ in range(8)]
[t.start() for t in threads], [t.join() for t in threads]
assert len(done) == 8 and len(set(done)) == 1, done
"""
    for _ in range(3):
        run = subprocess.run([sys.executable, "-W", "error", "-c", script], capture_output=True, text=True)
        assert run.returncode == 0, run.stderr


@pytest.mark.skipif(not sysconfig.get_config_var("Py_GIL_DISABLED"), reason="needs free-threaded Python")
def test_the_module_leaves_the_lock_off():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not sys._is_gil_enabled()
