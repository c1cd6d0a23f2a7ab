"""Random scenes for the planner: bodies, starts, torques, spans and accuracies over several decades, seeds fixed.

A body is a solid box of unit mass with half sides 10^U(-1, 0); |omega| = 10^U(-1, 1), every direction and attitude
alike; 10^U(0, 2.5) turns at the start's rate; up to 1002 even samples. Half of the damped scenes have one axis damped
10^U(2, 5) times as much (class "stiff").
"""

import ctypes
import pathlib
import subprocess
import tempfile
from dataclasses import dataclass

import numpy as np

import polhode as ph

CLASSES = ("free", "constant", "heavy", "gradient", "damped", "stiff")


@dataclass
class Drawn:
    """One scene of the family, with the numbers that truth is computed from."""

    kind: str
    scene: ph.Scene
    accuracy: float
    numbers: np.ndarray      # I, w, q, constant torque, weight x arm, mean motion, damping


def isotropic(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def draw(rng):
    a, b, c = 10 ** rng.uniform(-1, 0, 3)
    moments = np.array([b * b + c * c, a * a + c * c, a * a + b * b]) / 3
    rate = 10 ** rng.uniform(-1, 1)
    omega = rate * isotropic(rng)
    attitude = rng.normal(size=4)
    attitude /= np.linalg.norm(attitude)
    turns = 10 ** rng.uniform(0, 2.5)
    span = 2 * np.pi * turns / np.linalg.norm(omega)
    count = 2 + int(10 ** rng.uniform(0.5, 3))
    L = moments * omega
    class_ = rng.uniform()
    kind, torques = "free", []
    constant, moment, mean_motion, damping = np.zeros(3), np.zeros(3), 0.0, np.zeros(3)
    if 0.25 <= class_ < 0.5:
        kind = "constant"
        constant = np.linalg.norm(L) * rate * 10 ** rng.uniform(-3, -0.5) * isotropic(rng)
        torques = [ph.torques.Constant(constant)]
    elif 0.5 <= class_ < 0.75:
        kind = "heavy"
        moment = (L @ omega) * 10 ** rng.uniform(-2, 1) * isotropic(rng)
        torques = [ph.torques.Gravity(1.0, moment)]
    elif 0.75 <= class_ < 0.85:
        kind = "gradient"
        mean_motion = rate * 10 ** rng.uniform(-3, -0.5)
        torques = [ph.torques.GravityGradient(mean_motion)]
    elif class_ >= 0.85:
        kind = "damped"
        damping = moments * rate * 10 ** rng.uniform(-3, 0, 3)
        if rng.uniform() < 0.5:
            kind = "stiff"
            damping[rng.integers(3)] *= 10 ** rng.uniform(2, 5)
        torques = [ph.torques.Damping(damping)]
    accuracy = 10 ** -rng.uniform(2, 12)
    want = ("omega", "attitude") if rng.uniform() < 0.7 else ("omega",)
    scene = ph.Scene(inertia=moments, omega=omega, attitude=attitude, torques=torques, want=want,
                     times=np.linspace(0, span, count), name=kind)
    numbers = np.concatenate([moments, omega, scene.attitude, constant, moment, [mean_motion],
                              np.diag(damping).ravel()])
    return Drawn(kind, scene, accuracy, numbers)


class Truth:
    """The long-double Taylor series of truth.cpp, compiled once."""

    def __init__(self):
        self._folder = tempfile.TemporaryDirectory()
        library = pathlib.Path(self._folder.name) / "truth.so"
        source = pathlib.Path(__file__).with_name("truth.cpp")
        subprocess.run(["g++", "-O2", "-std=c++20", "-shared", "-fPIC", str(source), "-o", str(library)], check=True)
        self._call = ctypes.CDLL(str(library)).polhode_truth
        self._call.restype = ctypes.c_double
        double = np.ctypeslib.ndpointer(np.float64, flags="C")
        self._call.argtypes = [double, ctypes.c_long, double, double, ctypes.c_long]

    def __call__(self, drawn, most_steps=200_000):
        """Return turns, omega and attitude; None where it would take too long."""
        times = np.ascontiguousarray(drawn.scene.times)
        out = np.empty((times.size, 7))
        turns = self._call(np.ascontiguousarray(drawn.numbers), times.size, times, out, most_steps)
        if turns < 0 or not np.isfinite(out).all():
            return None
        return turns, np.ascontiguousarray(out[:, :3]), np.ascontiguousarray(out[:, 3:])


def error(motion, truth):
    """The larger of the error of omega, relative to the largest, and of the attitude's angle, of what was wanted."""
    _, omega, attitude = truth
    if len(motion) < len(omega):
        return np.inf   # it did not arrive
    found = [0.0]
    if motion.omega is not None:
        found.append(np.linalg.norm(motion.omega - omega, axis=1).max() / np.linalg.norm(omega, axis=1).max())
    if motion.attitude is not None:
        near = np.minimum(np.linalg.norm(motion.attitude - attitude, axis=1),
                          np.linalg.norm(motion.attitude + attitude, axis=1))
        found.append(4 * np.arcsin(np.minimum(1, near.max() / 2)))
    return float(max(found))
