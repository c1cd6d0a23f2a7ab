"""Ctrl-C ends every long call within a tenth of a second, on a machine of usual speed that has a core to spare."""

import os
import pathlib
import signal
import tempfile
import threading
import time

import doors
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


class Interrupted(BaseException):
    """What the handler of the signal raises, as that of SIGINT raises KeyboardInterrupt."""


def delay(work, after=0.1):
    """Seconds from a signal during work(), sent after so many seconds, to the end of work()."""
    def handler(*_):
        raise Interrupted

    sent = []

    def send():
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGUSR1)

    before = signal.signal(signal.SIGUSR1, handler)
    timer = threading.Timer(after, send)
    try:
        timer.start()
        work()
        ended = time.perf_counter()
        timer.join()
        pytest.fail(f"the work took {ended - sent[0] + after if sent else 0:.2f} s: not interrupted")
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


def far_orbit():
    return ph.Orbit(1.0, (1, 0, 0), (0, 1.2, 0)).at(np.linspace(0, 1e4, 20_000_000))


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


def points(name, motion=None):
    times = RNG.uniform(0, 1000, 3_000_000)
    return lambda: getattr(motion or FREE, name)(times)


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


def grid(motion):
    times = np.linspace(0, 1000, 12_000_000)
    return lambda: motion.at(times)


def gyrostats():
    omega, times = RNG.normal(size=(200, 1, 3)), RNG.uniform(0, 1000, 20000)
    return lambda: ph.gyrostat(BLOCK, (0.1, 0.2, 0.3), omega, HERE, times, want="omega", threads=1)


def columns(batch):
    omega, times = RNG.normal(size=(40, 1, 3)), RNG.uniform(0, 100, 20000)
    if batch:
        return lambda: ph.free_sensitivity(BLOCK, omega, HERE, times)
    times = RNG.uniform(0, 100, 1_000_000)
    return lambda: ph.FreeMotion(BLOCK, OMEGA).sensitivity(times, ("omega", "attitude", "inertia"))


DRIVEN = {"inertia": BLOCK, "omega": OMEGA, "torques": [ph.torques.Gravity(1.0, (0.3, 0.1, 0.2))]}


def solved(times=2000.0, **options):
    scene = ph.Scene(times=[times], **DRIVEN)
    return lambda: ph.solve(scene, **options)


def exponent():
    scene = ph.Scene(times=[500.0], **DRIVEN)
    return lambda: ph.lyapunov(scene)


def fitted():
    t = np.linspace(0, 40, 400)
    rates = ph.FreeMotion(BLOCK, OMEGA).at(t)[0] + 0.05 * RNG.normal(size=(400, 3))
    return lambda: [ph.fit(ph.measured.Rates(t, rates, 0.05), fit=("omega", "inertia"), seed=k) for k in range(200)]


def judged():
    t = np.linspace(0, 50, 20_000)
    omega, attitude = ph.FreeMotion(BLOCK, OMEGA).at(t)
    return lambda: [ph.judge(t, attitude, omega) for _ in range(20)]


def stepped(count, bodies):
    L, q = RNG.normal(size=(bodies, 3)), np.tile(HERE, (bodies, 1)).astype(float)
    return lambda: ph.step(BLOCK, L, q, 1e-3, count=count, threads=1)


def rows(call, width, n=6_000_000):
    values = RNG.uniform(-1, 1, (n, width))
    return lambda: [call(values) for _ in range(4)]


def tensors(call):
    matrices = np.tile(np.diag(BLOCK), (400_000, 1, 1)) + 1e-3
    return lambda: [call(matrices) for _ in range(10)]


def ensembles():
    recipe = pathlib.Path(tempfile.mkdtemp()) / "recipe.toml"
    recipe.write_text("""count = 2000000
seed = 1
draw = "by-body"
[body]
moments = [1.0, 2.0, 2.5]
[start]
omega = { normal = [[0.0, 0.0, 0.2], 0.05] }
[times]
span = 200.0
samples = 200
""")
    return lambda: ph.ensemble(recipe)


TURNS = ph.Rotation.random(3_000_000, rng=1)
FREE, SPUN = ph.FreeMotion(BLOCK, OMEGA), ph.Gyrostat(BLOCK, momentum=(0.1, 0.2, 0.3), omega=OMEGA)
TOP, SWING = ph.HeavyTop((1, 1, 0.5), 2.0, OMEGA), ph.Pendulum(BLOCK, 1.0, (0, 0, -1), (0.5, 0, 0))
DAMPED = ph.DampedFree(BLOCK, 0.01, OMEGA)

# The name begins with the public callable that it is about.
LONG = {
    "solve_many, accuracy": lambda: many(accuracy=1e-3),
    "solve_many, accuracy, one thread": lambda: many(1, accuracy=1e-3),
    "solve_many, lanes": lambda: many(rtol=1e-10),
    "solve_many, lanes, one thread": lambda: many(1, rtol=1e-10),
    "solve_many, closed forms": closed_form_bodies,
    "Orbit.at": lambda: far_orbit,
    "solve_many, derivatives": lambda: many(sensitivity="omega", accuracy=1e-3),
    "solve_many, derivatives, one thread": lambda: many(1, sensitivity="omega", accuracy=1e-3),
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
    "FreeMotion.flip_times": lambda: lambda: ph.FreeMotion(BLOCK, (0.1, 1, 0.1)).flip_times(0, 9e7),
    "Motion.__call__, closed form": dense,
    "Motion.__call__, integrated": lambda: dense(torques=[ph.torques.Damping((0.1, 0.1, 0.2))]),
    "elliptic.jacobi": elliptic,
    "Rotation.as_euler": lambda: rotations(lambda turns: turns.as_euler("ZXZ")),
    "mesh.report": lambda: mesh(False),
    "mesh.report, of an STL file": lambda: mesh(True),
    "mesh.report, open": lambda: mesh(False, True),
    "FreeMotion.at, grid": lambda: grid(FREE),
    "HeavyTop.at, grid": lambda: grid(TOP),
    "Gyrostat.at": lambda: at(SPUN),
    "Gyrostat.at, grid": lambda: grid(SPUN),
    "DampedFree.at": lambda: at(DAMPED),
    "DampedFree.at, grid": lambda: grid(DAMPED),
    "DampedFree.at, steady": lambda: at(ph.DampedFree(BLOCK, 0.01, (0, 1, 0))),
    "Pendulum.at": lambda: at(SWING),
    "Pendulum.at, grid": lambda: grid(SWING),
    "Pendulum.at, rotating": lambda: at(ph.Pendulum(BLOCK, 1.0, (0, 0, -1), (9, 0, 0))),
    "FreeMotion.polhode": lambda: points("polhode"),
    "Gyrostat.euler_angles": lambda: points("euler_angles", SPUN),
    "Gyrostat.polhode": lambda: points("polhode", SPUN),
    "FreeMotion.sensitivity": lambda: columns(False),
    "free_sensitivity": lambda: columns(True),
    "gyrostat": gyrostats,
    "solve": lambda: solved(rtol=1e-12, method="rk45"),
    "solve, accuracy": lambda: solved(20000.0, accuracy=1e-9),
    "solve, proof": lambda: solved(200.0, accuracy=1e-6, certify="proof"),
    "solve, columns": lambda: solved(1000.0, accuracy=1e-9, sensitivity=("omega", "inertia", "gravity.weight")),
    "lyapunov": exponent,
    "fit": fitted,
    "judge": judged,
    "step, one body": lambda: stepped(50_000_000, 1),
    "step, many bodies": lambda: stepped(2000, 20000),
    "ensemble": ensembles,
    "Rotation": lambda: rotations(lambda turns: [ph.Rotation(turns.as_quat()) for _ in range(10)]),
    "Rotation.apply": lambda: rotations(lambda turns: [turns.apply(OMEGA) for _ in range(20)]),
    "Rotation.as_matrix": lambda: rotations(lambda turns: [turns.as_matrix() for _ in range(20)]),
    "Rotation.as_rotvec": lambda: rotations(lambda turns: [turns.as_rotvec() for _ in range(20)]),
    "Rotation.from_rotvec": lambda: rows(ph.Rotation.from_rotvec, 3),
    "Rotation.from_euler": lambda: rows(lambda angles: ph.Rotation.from_euler("ZXZ", angles), 3),
    "Rotation.from_matrix": lambda: rotations(lambda turns: ph.Rotation.from_matrix(turns.as_matrix())),
    "body_rates": lambda: rows(lambda angles: ph.body_rates("ZXZ", angles, OMEGA), 3),
    "euler_rates": lambda: rows(lambda angles: ph.euler_rates("ZXZ", angles, OMEGA), 3),
    "elliptic.K": lambda: rows(lambda m: ph.elliptic.K(abs(m)), 4),
    "elliptic.nome": lambda: rows(lambda m: ph.elliptic.nome(abs(m)), 4),
    "inertia.principal_axes": lambda: tensors(ph.inertia.principal_axes),
}

# An ensemble ends its processes first [s].
PROMISED = {"ensemble": 1.5}


# What the test leaves out, by the reason: whole groups by the beginning of the name.
OUT = {
    "sets up one body, in microseconds": (
        "DampedFree", "FreeMotion", "Gyrostat", "HeavyTop", "Pendulum", "DampedFree.slowed_time", "Event", "Rotor",
        "Changing", "Changing.at", "Changing.ramp", "Changing.table", "Damper", "Orbit", "Orbit.from_elements",
        "Orbit.table", "MagneticField", "MagneticField.at", "Plate",
        "Controller", "Controller.replace", "Measure",
        "InertiaTensor", "MassProperties", "PrincipalAxes", "shapes.", "torques.", "formula.", "generalised_forces",
        "effect",
        "inertia.check", "inertia.diagnose", "inertia.equivalent_box", "inertia.equivalent_ellipsoid",
        "inertia.from_bifilar", "inertia.from_pendulum", "inertia.SwingMoment",
        "inertia.Diagnosis", "inertia.Finding", "inertia.Flaw"),
    "holds a result, or is an exception": (
        "AttitudeEphemeris", "FitResult", "Ensemble", "IntegrationFailure", "InvalidInput", "Judgement", "Lyapunov",
        "Motion", "Motions", "Plan", "Sensitivity", "charts.Entrant", "recipe.Draw", "recipe.Recipe", "build_info",
        "cmake_prefix", "methods"),
    "copies arrays, or is a few passes of NumPy's, which has no place for an interrupt": (
        "Scene", "Rotation.", "measured.", "MassProperties.from_points"),
    "plans: its pilots have at most some hundred steps": ("plan",),
    "is a loop of Python's, which hears signals between its lines": (
        "AttitudeEphemeris.__call__", "atlas.", "charts.", "report.", "recipe.", "schema.", "load", "mesh.read",
        "MassProperties.from_file", "animate", "plot", "save", "to_pandas", "to_xarray", "Ensemble."),
    "does what mesh.report does": ("MassProperties.from_mesh",),
}
LAST = ("animate", "plot", "save", "to_pandas", "to_xarray")


def reasons(name):
    """The reasons that hold for a callable: it is listed, its module or class is, or its last part."""
    return [why for why, names in OUT.items()
            if name in names or any(one.endswith(".") and name.startswith(one) for one in names)
            or (name.split(".")[-1] in LAST and name.split(".")[-1] in names)
            or (name.rpartition(".")[0] in names and name.split(".")[-1] not in ("at", "__call__"))]


def test_every_public_callable_is_interrupted_or_has_a_reason():
    tried = {name.partition(",")[0] for name in LONG}
    public = doors.public()
    assert not tried - set(public), "these are no public callables"
    assert not [name for name in public if name not in tried and not reasons(name)]


@pytest.mark.skipif(not hasattr(signal, "SIGUSR1"), reason="needs the signals of POSIX")
@pytest.mark.parametrize("after", [0.1, pytest.param(0.25, marks=pytest.mark.long)])
@pytest.mark.parametrize("name", LONG)
def test_a_signal_ends_long_work(name, after):
    work = LONG[name]()
    tries = []
    for _ in range(4):   # the machine may be busy for a moment: the best counts
        before = fixed_work()
        late = delay(work, after)
        # Between two looks at the signal lies an amount of work, not of time: a slower machine takes longer for it.
        allowed = PROMISED.get(name, 0.1) * max(1.0, (before + fixed_work()) / 2 / USUAL)
        if late < allowed:
            return
        tries.append(f"{late:.3f} s after the signal, {allowed:.3f} s are allowed")
    pytest.fail(f"{name}: {'; '.join(tries)}")
