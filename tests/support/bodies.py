"""The scenes built by hand, so that the solver's tests need no extra."""

import numpy as np

import polhode as ph

BLOCK = (0.20, 0.40, 0.52)
TILTED = (np.sin(0.25), 0.0, 0.0, np.cos(0.25))   # z-x-z angles (0, 0.5, 0)
N = np.array([1, 2, 2]) / 3

PARTS = {
    "S1": {"inertia": BLOCK, "omega": (1, 2, 3), "times": np.linspace(0, 1000, 1001)},
    "S2": {"inertia": BLOCK, "omega": (1e-4, 5, 1e-4), "times": np.linspace(0, 200, 2001)},
    "S3": {"inertia": (0.4, 0.4, 0.2), "omega": (0.5, 0, 4), "times": np.linspace(0, 1000, 1001)},
    "S4": {"inertia": (1, 1, 0.5), "omega": (0, 0, 6), "attitude": TILTED,
           "torques": [ph.torques.Gravity(2, (0, 0, 1))], "times": np.linspace(0, 100, 1001)},
    "S5": {"inertia": (1, 2, 2.5), "omega": (0.3, 0.2, 3), "attitude": TILTED,
           "torques": [ph.torques.Gravity(2, (0.3, 0.2, 0.5))], "times": np.linspace(0, 20, 201)},
    "S6": {"inertia": (20, 40, 52), "omega": (0.002, 0.004, 0.006),
           "torques": [ph.torques.GravityGradient(1e-3)], "times": np.linspace(0, 62831.853, 1001)},
    "S7": {"inertia": (1, 2, 2.5), "omega": (1, 2, 3), "torques": [ph.torques.Damping((50, 0.01, 0.01))],
           "times": np.linspace(0, 100, 1001)},
    "S9": {"inertia": BLOCK, "omega": (0.1, 0.2, 0.3), "torques": [ph.torques.Constant((0.01, -0.02, 0.03))],
           "times": np.linspace(0, 100, 1001)},
}


def scene(name, **changes):
    return ph.Scene(name=name, **{**PARTS[name], **changes})
