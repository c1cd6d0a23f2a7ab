"""Ctrl-C ends every long call within a tenth of a second, on a machine of usual speed that has a core to spare."""

import os
import signal
import threading
import time

import numpy as np
import pytest

import polhode as ph

BLOCK, OMEGA, HERE = (1, 2, 2.5), (1, 2, 3), (0, 0, 0, 1)
RNG = np.random.default_rng(3)


# The time of `fixed_work` where a tenth of a second is promised: a server's core of 2020, otherwise idle [s].
USUAL = 0.03


def fixed_work():
    """Seconds of a fixed computation, which is slow where the machine is slow or has others to serve."""
    start = time.perf_counter()
    sum(k * k for k in range(400_000))
    return time.perf_counter() - start


class Interrupted(Exception):
    """What the handler of the signal raises, as that of SIGINT raises KeyboardInterrupt."""


def delay(work):
    """Seconds from a signal during work() to the end of work()."""
    def handler(*_):
        raise Interrupted

    sent = []

    def send():
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGUSR1)

    before = signal.signal(signal.SIGUSR1, handler)
    timer = threading.Timer(0.1, send)
    try:
        timer.start()
        work()
        ended = time.perf_counter()
        timer.join()
        pytest.fail(f"the work took {ended - sent[0] + 0.1 if sent else 0:.2f} s: not interrupted")
    except Interrupted:
        return time.perf_counter() - sent[0]
    finally:
        timer.join()
        signal.signal(signal.SIGUSR1, before)


def many(threads=None, **options):
    scene = ph.Scene.load("S5").replace(times=np.linspace(0, 300, 30))
    omega = RNG.normal(size=(20000, 3))
    return lambda: ph.solve_many(scene, omega=omega, threads=threads, **options)


def closed_form_bodies():
    scene = ph.Scene(inertia=BLOCK, omega=OMEGA, times=np.linspace(0, 300, 20000))
    omega = RNG.normal(size=(2000, 3))
    return lambda: ph.solve_many(scene, omega=omega, accuracy=1e-6, threads=1)


def free_bodies(threads):
    omega, times = RNG.normal(size=(400, 1, 3)), RNG.uniform(0, 1000, 40000)
    out = np.empty((400, 40000, 3))
    return lambda: ph.free_motion(BLOCK, omega, HERE, times, want="omega", out=out, threads=threads)


def free_body(threads):
    times = RNG.uniform(0, 1000, 12_000_000)
    out = np.empty((times.size, 3))
    return lambda: ph.free_motion(BLOCK, OMEGA, HERE, times, want="omega", out=out, threads=threads)


def tops(threads):
    omega, times = RNG.normal(size=(200, 1, 3)), RNG.uniform(0, 1000, 20000)
    out = np.empty((200, 20000, 3))
    return lambda: ph.heavy_top((1, 1, 0.5), 2.0, omega, HERE, times, want="omega", out=out, threads=threads)


def at(motion):
    times = RNG.uniform(0, 1000, 12_000_000)
    return lambda: motion.at(times)


def points(name):
    times = RNG.uniform(0, 1000, 3_000_000)
    return lambda: getattr(ph.FreeMotion(BLOCK, OMEGA), name)(times)


def dense(**torques):
    scene = ph.Scene(inertia=BLOCK, omega=OMEGA, times=[100.0], **torques)
    motion = ph.solve(scene, accuracy=1e-6, dense=True)
    times = RNG.uniform(0, 100, 10_000_000)
    return lambda: motion(times)


def elliptic():
    u = RNG.uniform(0, 10, 3_000_000)
    m = RNG.uniform(0, 1, u.size)
    return lambda: ph.elliptic.jacobi(u, m)


def rotations(convert):
    turns = ph.Rotation.random(4_000_000, rng=1)
    return lambda: convert(turns)


def grid_mesh(n):
    """A closed bumpy sheet of 2 n^2 faces and their mirror images."""
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    a, b = (i * n + j).ravel(), (i * n + (j + 1) % n).ravel()
    c, d = ((i + 1) % n * n + j).ravel(), ((i + 1) % n * n + (j + 1) % n).ravel()
    faces = np.concatenate([np.stack([a, c, b], 1), np.stack([b, c, d], 1)])
    u, v = (2 * np.pi * k.ravel() / n for k in (i, j))
    ring = 3 + np.cos(v)
    return np.stack([ring * np.cos(u), ring * np.sin(u), np.sin(v)], 1), faces


def mesh(soup, broken=False):
    vertices, faces = grid_mesh(1000)
    if soup:
        vertices, faces = vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)
    if broken:
        faces = faces[1:]

    def work():
        for _ in range(20):
            ph.mesh.report(vertices, faces)

    return work


LONG = {
    "solve_many, accuracy": lambda: many(accuracy=1e-3),
    "solve_many, accuracy, one thread": lambda: many(1, accuracy=1e-3),
    "solve_many, lanes": lambda: many(rtol=1e-10),
    "solve_many, lanes, one thread": lambda: many(1, rtol=1e-10),
    "solve_many, closed forms": closed_form_bodies,
    "free_motion, bodies": lambda: free_bodies(None),
    "free_motion, bodies, one thread": lambda: free_bodies(1),
    "free_motion, times": lambda: free_body(None),
    "free_motion, times, one thread": lambda: free_body(1),
    "heavy_top": lambda: tops(None),
    "heavy_top, one thread": lambda: tops(1),
    "FreeMotion.at": lambda: at(ph.FreeMotion(BLOCK, OMEGA)),
    "HeavyTop.at": lambda: at(ph.HeavyTop((1, 1, 0.5), 2.0, OMEGA)),
    "FreeMotion.euler_angles": lambda: points("euler_angles"),
    "FreeMotion.herpolhode": lambda: points("herpolhode"),
    "flip_times": lambda: lambda: ph.FreeMotion(BLOCK, (0.1, 1, 0.1)).flip_times(0, 9e7),
    "motion(t), closed form": dense,
    "motion(t), integrated": lambda: dense(torques=[ph.torques.Damping((0.1, 0.1, 0.2))]),
    "elliptic": elliptic,
    "as_euler": lambda: rotations(lambda turns: turns.as_euler("ZXZ")),
    "mesh": lambda: mesh(False),
    "mesh of an STL file": lambda: mesh(True),
    "open mesh": lambda: mesh(False, True),
}


@pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="needs the signals of POSIX")
@pytest.mark.parametrize("name", LONG)
def test_a_signal_ends_long_work(name):
    work = LONG[name]()
    tries = []
    for _ in range(4):   # the machine may be busy for a moment: the best counts
        before = fixed_work()
        late = delay(work)
        # Between two looks at the signal lies an amount of work, not of time: a slower machine takes longer for it.
        allowed = 0.1 * max(1.0, (before + fixed_work()) / 2 / USUAL)
        if late < allowed:
            return
        tries.append(f"{late:.3f} s after the signal, {allowed:.3f} s are allowed")
    pytest.fail(f"{name}: {'; '.join(tries)}")
