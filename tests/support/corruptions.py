"""The known corruptions of inertia data, written here a second time: what diagnose must find and name."""

import numpy as np

import polhode as ph

ENTRY = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
URDF = ("xx", "xy", "xz", "yy", "yz", "zz")
MUJOCO = ("xx", "yy", "zz", "xy", "xz", "yz")


def reordered(m, written, read):
    out = np.empty((3, 3))
    for name, place in zip(written, read):
        i, j = ENTRY[place]
        out[i, j] = out[j, i] = m[ENTRY[name]]
    return out


def steiner(mass, com):
    return mass * (com @ com * np.eye(3) - np.outer(com, com))


def swapped(rng, m):
    turn = np.eye(3)[[[1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]][rng.integers(5)]]
    return turn @ m @ turn.T


def mirrored(rng, m):
    turn = np.diag(np.where(np.arange(3) == rng.integers(3), -1.0, 1.0))
    return turn @ m @ turn.T


def transposed(m):
    principal = ph.InertiaTensor(m)
    return principal.axes.T @ np.diag(principal.moments) @ principal.axes


def slipped(rng, m):
    i, j = list(ENTRY.values())[rng.integers(6)]
    out = m.copy()
    out[i, j] = out[j, i] = m[i, j] * (10, 0.1)[rng.integers(2)]
    return out


# name: (the cause to be named, what it does to mass, com, matrix)
KNOWN = {
    "products with the other sign": ("sign", lambda rng, m, c, i: (m, c, np.where(np.eye(3) > 0, i, -i))),
    "URDF's order read as MuJoCo's": ("order", lambda rng, m, c, i: (m, c, reordered(i, URDF, MUJOCO))),
    "MuJoCo's order read as URDF's": ("order", lambda rng, m, c, i: (m, c, reordered(i, MUJOCO, URDF))),
    "about the frame's origin": ("point", lambda rng, m, c, i: (m, c, i + steiner(m, c))),
    "parallel-axis term taken off twice": ("point", lambda rng, m, c, i: (m, c, i - steiner(m, c))),
    "mass in g": ("units", lambda rng, m, c, i: (m * 1e3, c, i)),
    "tensor in kg mm^2": ("units", lambda rng, m, c, i: (m, c, i * 1e6)),
    "tensor in kg cm^2": ("units", lambda rng, m, c, i: (m, c, i * 1e4)),
    "tensor in g mm^2, com in mm": ("units", lambda rng, m, c, i: (m, c * 1e3, i * 1e9)),
    "all in g and mm": ("units", lambda rng, m, c, i: (m * 1e3, c * 1e3, i * 1e9)),
    "com in mm": ("units", lambda rng, m, c, i: (m, c * 1e3, i)),
    "divided by 1e6 once too often": ("units", lambda rng, m, c, i: (m, c, i * 1e-6)),
    "axes taken for one another": ("axes", lambda rng, m, c, i: (m, c, swapped(rng, i))),
    "mirrored axes": ("axes", lambda rng, m, c, i: (m, c, mirrored(rng, i))),
    "principal axes transposed": ("axes", lambda rng, m, c, i: (m, c, transposed(i))),
    "a decimal point in one entry": ("decimal", lambda rng, m, c, i: (m, c, slipped(rng, i))),
}
