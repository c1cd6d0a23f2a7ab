"""Truth of derivatives under torques that are formulas: central differences of the 26 digits of formula_motion.

The laws are written here by hand on mpmath numbers, with the parameters that they are differentiated by. A difference
of 2e-9 leaves an error of 1e-17. Writes formula_columns.json beside this file.
"""

import json
import multiprocessing
from pathlib import Path

import formula_motion_reference as motion
import mpmath as mp
from formula_motion_reference import BLOCK, FULL, START, cross, f, to_body, vector

TIMES = [-1.5, 3.0]
H = mp.mpf("1e-9")


def pd(t, w, q, I, p):
    return [-p["kp"] * q[i] * q[3] - p["kd"][i] * w[i] for i in range(3)]


def spring(t, w, q, I, p):
    """Towards a direction of space, as strong as the angle between them."""
    aim, axis = to_body(q, vector(0, 1, 0)), vector(0, 0, 1)
    across = cross(axis, aim)
    sine = mp.sqrt(sum(x * x for x in across))
    angle = mp.atan2(sine, aim[2])
    return [p["k"] * angle / sine * x - p["c"] * v for x, v in zip(across, w)]


def mixture(t, w, q, I, p):
    size = p["a"] + w[0] ** 2 + w[1] ** 2
    return [f(0.2) * mp.exp(-p["b"] * t) * mp.sin(w[2]) - f(0.1) * w[0],
            f(0.1) * mp.log(size) * q[0] - f(0.05) * w[1] ** 3,
            f(0.3) * size ** f(-1.3) * mp.cos(f(0.7) * t)]


def gradient(t, w, q, I, p):
    """Of a plate fixed by its own numbers: the inertia of the body does not change the law."""
    u = to_body(q, [mp.cos(p["n"] * t + f(0.3)), mp.sin(p["n"] * t + f(0.3)), f(0)])
    return [3 * p["n"] ** 2 * x for x in cross(u, [f(1.0) * u[0], f(1.5) * u[1], f(2.25) * u[2]])]


def integral(t, w, q, I, p, s):
    """A PID law: the integrator starts at rest, at 0."""
    tau = [-p["kp"] * q[i] * q[3] - f(0.9) * w[i] - p["ki"] * s[i] for i in range(3)]
    return tau, [x * q[3] for x in q[:3]]


LAWS = {"pd": (pd, {"kp": f(0.7), "kd": vector(0.5, 0.5, 0.4)}), "spring": (spring, {"k": f(0.6), "c": f(0.05)}),
        "mixture": (mixture, {"a": f(1.5), "b": f(0.1)}), "gradient": (gradient, {"n": f(0.4)}),
        "integral": (integral, {"kp": f(0.7), "ki": f(0.1)})}
CASES = [("pd", BLOCK), ("pd", FULL), ("spring", FULL), ("mixture", BLOCK), ("gradient", FULL), ("integral", BLOCK)]


def run(law, inertia, omega, attitude, parameters, states):
    """Rows of w and q at the times."""
    function, inverse = LAWS[law][0], mp.inverse(inertia)
    I = [[inertia[i, j] for j in range(3)] for i in range(3)]

    def given(t, w, q, I, *s):
        return function(t, w, q, I, parameters, *s)

    if states:
        motion.STATES[given] = states
    g = motion.rate(given, I, inverse)
    rows, at, y = [], f(0), omega + attitude + states
    for t in TIMES:
        if t * at < 0:
            at, y = f(0), omega + attitude + states
        steps, last, apart = int(mp.ceil(abs(f(t) - at) / f(0.5))), None, f(1)
        while not apart < f(10) ** -26:
            now = motion.integrate(g, y, at, f(t), steps)
            apart = max(abs(a - b) for a, b in zip(last, now)) if last else f(1)
            steps, last = 2 * steps, now
        rows.append(last)
    return rows


def product(p, q):
    v = cross(p[:3], q[:3])
    return [p[3] * q[i] + q[3] * p[i] + v[i] for i in range(3)] + [p[3] * q[3] - sum(a * b for a, b in zip(p, q[:3]))]


def rotation(k, angle):
    return [mp.sin(angle / 2) if i == k else f(0) for i in range(3)] + [mp.cos(angle / 2)]


def moved(law, inertia, column, by):
    """The rows of a motion whose column is changed."""
    omega, attitude = [f(x) for x in START["omega"]], [f(x) for x in START["attitude"]]
    size = mp.sqrt(sum(x * x for x in attitude))
    attitude = [x / size for x in attitude]
    tensor = mp.matrix([[f(x) for x in row] for row in inertia])
    parameters = {name: list(value) if isinstance(value, list) else value for name, value in LAWS[law][1].items()}
    states = vector(0, 0, 0) if law == "integral" else []
    what, _, which = column.rpartition("_")
    if what == "omega":
        omega["xyz".index(which)] += by
    elif what == "attitude":   # space axes
        attitude = product(rotation("xyz".index(which), by), attitude)
    elif what in ("inertia", "axes"):
        k = "123".index(which) if what == "inertia" else "xyz".index(which)
        if inertia is BLOCK:
            axis = mp.matrix([int(i == k) for i in range(3)])
        else:
            axis = mp.eigsy(tensor)[1][:, k]   # ascending
        if what == "inertia":
            tensor = tensor + by * axis * axis.T
        else:
            x = [f(int(i == k)) for i in range(3)]
            E = mp.expm(by * mp.matrix([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]]))
            tensor = E * tensor * E.T
    elif what == "states.s":
        states["xyz".index(which)] += by
    elif column in parameters:
        parameters[column] += by
    else:
        parameters[what]["xyz".index(which)] += by
    return run(law, tensor, omega, attitude, parameters, states)


def differences(job):
    """d omega, the small rotation in space and the changes of states at each time."""
    law, inertia, column = job
    mp.mp.dps = 40
    plus, minus = moved(law, inertia, column, H), moved(law, inertia, column, -H)
    rows = []
    for a, b in zip(plus, minus):
        turn = product(a[3:7], [-x for x in b[3:6]] + [b[6]])
        rows.append([(x - y) / (2 * H) for x, y in zip(a[:3], b[:3])] + [x / turn[3] / H for x in turn[:3]] +
                    [(x - y) / (2 * H) for x, y in zip(a[7:], b[7:])])
    return [[mp.nstr(x, 17) for x in row] for row in rows]


def columns_of(law):
    names = [f"{group}_{c}" for group in ("omega", "attitude") for c in "xyz"] + [f"inertia_{c}" for c in "123"]
    for name, value in LAWS[law][1].items():
        names += [f"{name}_{c}" for c in "xyz"] if isinstance(value, list) else [name]
    names += [f"states.s_{c}" for c in "xyz"] if law == "integral" else []
    return names + [f"axes_{c}" for c in "xyz"]


if __name__ == "__main__":
    jobs = [(law, inertia, column) for law, inertia in CASES for column in columns_of(law)]
    with multiprocessing.Pool() as pool:
        found = iter(pool.map(differences, jobs, chunksize=1))
    cases = [{"law": law, "inertia": inertia, "columns": {column: next(found) for column in columns_of(law)}}
             for law, inertia in CASES]
    text = {"source": Path(__file__).name, "start": START, "times": TIMES, "cases": cases}
    Path(__file__).with_name("formula_columns.json").write_text(json.dumps(text, indent=1) + "\n")
