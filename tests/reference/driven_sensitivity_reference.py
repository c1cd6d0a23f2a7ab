"""Makes driven_sensitivity.json: derivatives of driven motions.

The derivatives are central differences of the motion itself, integrated by Taylor series of order 50 in fixed-point
numbers of 240 bits. The equations are those of the quaternion with the full inertia matrix. They share no formula with
the variational equations of the library. A second difference, ten times as wide, must give the same 17 digits.
Inputs are float64 numbers taken as exact. Small rotations are in space axes.

Run: python driven_sensitivity_reference.py [name ...]
"""

import copy
import json
import pathlib
import sys
from operator import mul

from mpmath import cos, eigsy, matrix, mp, mpf, nint, sin, sqrt

mp.prec = 320
FILE = pathlib.Path(__file__).with_name("driven_sensitivity.json")
BITS, ORDER, LOST = 240, 50, 150   # of the fixed point; of the series; of a step's last terms
ONE = 1 << BITS
STEP = mpf(10) ** -15

CASES = {
    "S5": {"inertia": [1.0, 2.0, 2.5], "omega": [0.3, 0.2, 3.0], "attitude": [0.24740395925452294, 0.0, 0.0,
                                                                              0.9689124217106447],
           "torques": [{"kind": "gravity", "weight": 2.0, "arm": [0.3, 0.2, 0.5]}],
           "times": [0.5, 4.0, 20.0],
           "groups": ["omega", "attitude", "inertia", "axes", "torques.0.weight", "torques.0.arm"]},
    "S6": {"inertia": [20.0, 40.0, 52.0], "omega": [0.002, 0.004, 0.006], "attitude": [0.0, 0.0, 0.0, 1.0],
           "torques": [{"kind": "gravity_gradient", "mean_motion": 1e-3, "phase": 0.0}],
           "times": [100.0, 1000.0, 3000.0],
           "groups": ["omega", "attitude", "inertia", "torques.0.mean_motion", "torques.0.phase"]},
    "S7": {"inertia": [1.0, 2.0, 2.5], "omega": [1.0, 2.0, 3.0], "attitude": [0.0, 0.0, 0.0, 1.0],
           "torques": [{"kind": "damping", "matrix": [[50.0, 0, 0], [0, 0.01, 0], [0, 0, 0.01]]}],
           "times": [0.1, 10.0, 100.0], "groups": ["omega", "attitude", "inertia", "torques.0.matrix"]},
    "S9": {"inertia": [0.20, 0.40, 0.52], "omega": [0.1, 0.2, 0.3], "attitude": [0.0, 0.0, 0.0, 1.0],
           "torques": [{"kind": "constant", "torque": [0.01, -0.02, 0.03], "frame": "body"}],
           "times": [1.0, 20.0, 100.0], "groups": ["omega", "attitude", "inertia", "torques.0.torque"]},
    "wheels": {"inertia": [[0.31, 0.02, -0.01], [0.02, 0.4, 0.03], [-0.01, 0.03, 0.52]], "omega": [1.0, 2.0, -1.5],
               "attitude": [0.5, -0.1, 0.7, 0.5],
               "torques": [{"kind": "gravity", "weight": 1.5, "arm": [0.1, -0.2, 0.3]},
                           {"kind": "angular_damping", "rate": 0.05}],
               "rotors": [{"axis": [0.6, 0.0, 0.8], "momentum": 0.3},
                          {"axis": [0.0, 1.0, 0.0], "inertia": 0.05, "speed": 20.0, "free": True}],
               "times": [-3.0, 2.0, 15.0],
               "groups": ["omega", "attitude", "inertia", "axes", "torques.0.weight", "torques.0.arm",
                          "torques.1.rate", "rotors.0.momentum", "rotors.1.inertia", "rotors.1.speed"]},
    "windows": {"inertia": [0.31, 0.4, 0.52], "omega": [0.4, 0.3, 0.9], "attitude": [0.0, 0.6, 0.0, 0.8],
                "torques": [{"kind": "constant", "torque": [0.2, -0.1, 0.05], "frame": "body",
                             "windows": [[1.0, 2.5], [6.0, 7.0]]},
                            {"kind": "constant", "torque": [0.02, 0.03, -0.04], "frame": "space"},
                            {"kind": "damping", "matrix": [[0.02, 0.01, 0], [0, 0.03, 0], [0, -0.01, 0.05]],
                             "windows": [[-2.0, 4.0]]}],
                "rotors": [{"axis": [0.0, 0.0, 1.0], "inertia": 0.02, "speed": 15.0, "during": [[-1.0, 5.0]]}],
                "times": [-4.0, -1.5, 1.5, 3.0, 4.5, 5.5, 10.0],
                "groups": ["omega", "attitude", "inertia", "torques.0.torque", "torques.0.windows",
                           "torques.1.torque", "torques.2.matrix", "torques.2.windows", "rotors.0.speed",
                           "rotors.0.inertia", "rotors.0.during"]},
    "all": {"inertia": [[1.5, 0.2, -0.1], [0.2, 2.0, 0.15], [-0.1, 0.15, 2.5]], "omega": [0.3, -0.7, 0.5],
            "attitude": [0.1, 0.7, -0.1, 0.7],
            "torques": [{"kind": "gravity", "weight": 0.8, "arm": [0.1, 0.3, -0.2]},
                        {"kind": "gravity_gradient", "mean_motion": 0.2, "phase": 0.3},
                        {"kind": "constant", "torque": [0.05, -0.02, 0.04], "frame": "space"},
                        {"kind": "damping", "matrix": [[0.03, 0.01, 0], [-0.01, 0.02, 0], [0, 0, 0.01]]}],
            "rotors": [{"axis": [0.0, 0.6, 0.8], "momentum": 0.4}],
            "times": [-2.0, 1.0, 12.0],
            "groups": ["omega", "attitude", "inertia", "axes", "torques.0.weight", "torques.0.arm",
                       "torques.1.mean_motion", "torques.1.phase", "torques.2.torque", "torques.3.matrix",
                       "rotors.0.momentum"]},
}


def fixed(x):
    return int(nint(x * ONE))


def conv(a, b, n):
    return sum(map(mul, a[: n + 1], b[n::-1])) >> BITS


def exact(x):
    """The same structure with mpf in the place of numbers."""
    if isinstance(x, dict):
        return {k: exact(v) for k, v in x.items()}
    if isinstance(x, list):
        return [exact(v) for v in x]
    return mpf(x) if isinstance(x, (int, float)) and not isinstance(x, bool) else x


def product(a, b):
    x, y, z, s = a
    i, j, k, r = b
    return [s * i + x * r + y * k - z * j, s * j + y * r + z * i - x * k, s * k + z * r + x * j - y * i,
            s * r - x * i - y * j - z * k]


def to_matrix(J):
    if isinstance(J[0], list):
        return matrix(J)
    return matrix([[J[i] if i == j else mpf(0) for j in range(3)] for i in range(3)])


def turn(axis, angle):
    q = [mpf(0), mpf(0), mpf(0), cos(angle / 2)]
    q[axis] = sin(angle / 2)
    return q


def rotation(q):
    return matrix([[product(product(q, [mpf(i == c) for i in range(3)] + [mpf(0)]),
                            [-q[0], -q[1], -q[2], q[3]])[r] for c in range(3)] for r in range(3)])


class Body:
    """What acts on one piece, in units of the largest moment and of a time `unit`."""

    def __init__(self, case, torques, rotors, unit):
        J = to_matrix(case["inertia"])
        h = [mpf(0)] * 3
        for rotor in case["rotors"]:
            if rotor.get("free") and "inertia" in rotor:
                for i in range(3):
                    for j in range(3):
                        J[i, j] -= rotor["inertia"] * rotor["axis"][i] * rotor["axis"][j]
        for rotor in rotors:
            for i in range(3):
                h[i] += momentum(rotor, case["omega"]) * rotor["axis"][i]
        self.J, self.h, self.unit, self.torques = J, matrix(h), unit, torques
        self.scale = mpf(2) ** 1
        inverse = J ** -1
        self.i_J = [[fixed(J[i, j] / self.scale) for j in range(3)] for i in range(3)]
        self.i_inverse = [[fixed(inverse[i, j] * self.scale) for j in range(3)] for i in range(3)]
        self.i_h = [fixed(x * unit / self.scale) for x in h]

    def expand(self, t, w, q):
        """Series of w unit and q in powers of time / unit."""
        W, Q = [[x] for x in w], [[x] for x in q]
        L, R = [[], [], []], [[[] for _ in range(3)] for _ in range(3)]
        factor = self.unit ** 2 / self.scale
        orbits = []
        for torque in self.torques:
            if torque["kind"] == "gravity_gradient":
                angle = torque["mean_motion"] * t + torque["phase"]
                orbits.append(([fixed(cos(angle))], [fixed(sin(angle))], [[], [], []], [[], [], []],
                               fixed(torque["mean_motion"] * self.unit)))
        needs_rows = any(x["kind"] in ("gravity", "gravity_gradient") or x.get("frame") == "space"
                         for x in self.torques)
        for n in range(ORDER):
            for i in range(3):
                L[i].append((sum(self.i_J[i][j] * W[j][n] for j in range(3)) >> BITS) + (self.i_h[i] if n == 0 else 0))
            N = [conv(L[(i + 1) % 3], W[(i + 2) % 3], n) - conv(L[(i + 2) % 3], W[(i + 1) % 3], n) for i in range(3)]
            if needs_rows:
                x, y, z, s = Q
                xx, yy, zz, ss = (conv(a, a, n) for a in (x, y, z, s))
                xy, xz, yz = conv(x, y, n), conv(x, z, n), conv(y, z, n)
                sx, sy, sz = conv(s, x, n), conv(s, y, n), conv(s, z, n)
                for row, values in zip(R, ((ss + xx - yy - zz, 2 * (xy - sz), 2 * (xz + sy)),
                                           (2 * (xy + sz), ss - xx + yy - zz, 2 * (yz - sx)),
                                           (2 * (xz - sy), 2 * (yz + sx), ss - xx - yy + zz))):
                    for i in range(3):
                        row[i].append(values[i])
            orbit = iter(orbits)
            for torque in self.torques:
                kind = torque["kind"]
                if kind == "constant" and torque["frame"] == "body" and n == 0:
                    N = [N[i] + fixed(torque["torque"][i] * factor) for i in range(3)]
                if kind == "constant" and torque["frame"] == "space":
                    f = [fixed(x * factor) for x in torque["torque"]]
                    N = [N[i] + (sum(f[r] * R[r][i][n] for r in range(3)) >> BITS) for i in range(3)]
                if kind == "gravity":
                    m = [fixed(torque["weight"] * x * factor) for x in torque["arm"]]
                    g = [R[2][i][n] for i in range(3)]
                    N = [N[i] - ((m[(i + 1) % 3] * g[(i + 2) % 3] - m[(i + 2) % 3] * g[(i + 1) % 3]) >> BITS)
                         for i in range(3)]
                if kind == "damping":
                    C = [[fixed(torque["matrix"][i][j] * self.unit / self.scale) for j in range(3)] for i in range(3)]
                    N = [N[i] - (sum(C[i][j] * W[j][n] for j in range(3)) >> BITS) for i in range(3)]
                if kind == "angular_damping":
                    c = fixed(torque["rate"] * self.unit)
                    N = [N[i] - ((c * (L[i][n] - (self.i_h[i] if n == 0 else 0))) >> BITS) for i in range(3)]
                if kind == "gravity_gradient":
                    co, si, u, Iu, rate = next(orbit)
                    if n > 0:
                        co.append(-((rate * si[n - 1]) >> BITS) // n), si.append(((rate * co[n - 1]) >> BITS) // n)
                    for i in range(3):
                        u[i].append(conv(co, R[0][i], n) + conv(si, R[1][i], n))
                    for i in range(3):
                        Iu[i].append(sum(self.i_J[i][j] * u[j][n] for j in range(3)) >> BITS)
                    k = fixed(3 * (torque["mean_motion"] * self.unit) ** 2)
                    N = [N[i] + ((k * (conv(u[(i + 1) % 3], Iu[(i + 2) % 3], n)
                                       - conv(u[(i + 2) % 3], Iu[(i + 1) % 3], n))) >> BITS) for i in range(3)]
            for i in range(3):
                W[i].append((sum(self.i_inverse[i][j] * N[j] for j in range(3)) >> BITS) // (n + 1))
            a, b, c, x, y, z, s = *W, *Q
            d = [conv(s, a, n) + conv(y, c, n) - conv(z, b, n), conv(s, b, n) + conv(z, a, n) - conv(x, c, n),
                 conv(s, c, n) + conv(x, b, n) - conv(y, a, n), -conv(x, a, n) - conv(y, b, n) - conv(z, c, n)]
            for i in range(4):
                Q[i].append(d[i] // (2 * (n + 1)))
        return W + Q


def momentum(rotor, omega):
    if "momentum" in rotor:
        return rotor["momentum"]
    speed = rotor["speed"]
    if rotor.get("free"):
        speed += sum(a * b for a, b in zip(rotor["axis"], omega))
    return rotor["inertia"] * speed


def evaluate(series, s):
    total = 0
    for c in reversed(series):
        total = ((total * s) >> BITS) + c
    return total


def acts(item, key, begin, end):
    return key not in item or any(a <= begin and end <= b for a, b in item[key])


def flow(case, sign):
    """States at the case's times on one side of t = 0, in their order from the start; by pieces."""
    times = sorted((t for t in case["times"] if t * sign > 0), key=lambda t: t * sign)
    ends = {t for x in case["torques"] for window in x.get("windows", []) for t in window}
    ends |= {t for x in case["rotors"] for window in x.get("during", []) for t in window}
    edges = sorted((t for t in ends if t * sign > 0 and t * sign < times[-1] * sign), key=lambda t: t * sign)
    w, q = matrix(case["omega"]), list(case["attitude"])
    size = sqrt(sum(x * x for x in q))
    q = [x / size for x in q]
    fast = max(abs(x) for x in case["omega"])
    found, t, old_h = {}, mpf(0), None
    start = [r for r in case["rotors"] if "during" not in r or any(a <= 0 < b for a, b in r["during"])]
    for end in [*edges, times[-1]]:
        low, high = min(t, end), max(t, end)
        torques = [x for x in case["torques"] if acts(x, "windows", low, high)]
        rotors = [x for x in case["rotors"] if acts(x, "during", low, high)]
        body = Body(case, torques, rotors, 1 / fast)
        if old_h is None:
            old_h = Body(case, [], start, 1 / fast).h
        w = w + body.J ** -1 * (old_h - body.h)
        old_h = body.h
        while t != end:
            # The unit of time follows the rates.
            unit = mpf(2) ** -int(mp.ceil(mp.log(max(max(abs(x) for x in w), fast), 2)))
            body = Body(case, torques, rotors, unit)
            series = body.expand(t, [fixed(x * unit) for x in w], [fixed(x) for x in q])
            room = min((BITS - LOST - max(abs(s[k]) for s in series).bit_length()) / k for k in (ORDER - 1, ORDER))
            h = mpf(2) ** mpf(int(room * 16) / 16) * unit
            left = abs(end - t)
            step = min(h, left)
            for T in times:
                near = abs(T - t) <= step and (abs(T - t) < left or T == times[-1])
                if T not in found and t * sign < T * sign and near:
                    s = fixed((T - t) / unit)
                    y = [mpf(evaluate(c, s)) / ONE for c in series]
                    found[T] = ([x / unit for x in y[:3]], y[3:])
            s = fixed(sign * step / unit)
            y = [mpf(evaluate(c, s)) / ONE for c in series]
            w, q = matrix([x / unit for x in y[:3]]), y[3:]
            t = end if step == left else t + sign * step
    return found


def states(case):
    found = {}
    for sign in (1, -1):
        if any(t * sign > 0 for t in case["times"]):
            found |= flow(case, sign)
    return [found[t] for t in case["times"]]


def columns(case):
    """Names, changes of the case by a size, and the size of each column."""
    def component(path, size):
        def change(new, d):
            holder = new
            for key in path[:-1]:
                holder = holder[key]
            holder[path[-1]] += d * size
        return change

    def inertia(i):
        def change(new, d):
            J = to_matrix(new["inertia"])
            if isinstance(new["inertia"][0], list):
                _, E = eigsy(J)
                a = E[:, i]
            else:
                a = matrix([mpf(k == i) for k in range(3)])
            J += a * a.T * d
            new["inertia"] = J.tolist()
        return change

    def axes(i):
        def change(new, d):
            E = rotation(turn(i, d))
            new["inertia"] = (E * to_matrix(new["inertia"]) * E.T).tolist()
        return change

    def attitude(i):
        def change(new, d):
            new["attitude"] = product(turn(i, d), new["attitude"])
        return change

    for group in case["groups"]:
        for i in range(3):
            if group == "omega":
                size = max(abs(x) for x in case["omega"])
                yield f"omega_{'xyz'[i]}", component(("omega", i), size), size
            if group in ("attitude", "inertia", "axes"):
                name = f"{group}_{'123'[i] if group == 'inertia' else 'xyz'[i]}"
                yield name, {"attitude": attitude, "inertia": inertia, "axes": axes}[group](i), mpf(1)
        if "." not in group:
            continue
        what, number, field = group.split(".")
        value = case[what][int(number)][field]
        path = (what, int(number), field)
        if field in ("windows", "during"):
            for i in range(len(value)):
                for k, end in enumerate(("begin", "end")):
                    yield f"{group}_{i}_{end}", component((*path, i, k), mpf(1)), mpf(1)
        elif field == "matrix":
            for i in range(3):
                for k in range(3):
                    yield f"{group}_{'xyz'[i]}{'xyz'[k]}", component((*path, i, k), mpf(1)), mpf(1)
        elif isinstance(value, list):
            for i in range(3):
                yield f"{group}_{'xyz'[i]}", component((*path, i), mpf(1)), mpf(1)
        else:
            size = abs(value) if value else mpf(1)
            yield group, component(path, size), size


def difference(case, change, size, d):
    both = []
    for sign in (1, -1):
        new = copy.deepcopy(case)
        change(new, sign * d)
        both.append(states(new))
    rows = []
    for (w1, q1), (w2, q2) in zip(*both):
        turned = product(q1, [-q2[0], -q2[1], -q2[2], q2[3]])
        sign = 1 if turned[3] > 0 else -1
        rows.append([(a - b) / (2 * d * size) for a, b in zip(w1, w2)] +
                    [2 * sign * c / (2 * d * size) for c in turned[:3]])
    return rows


def make(name):
    given = {**CASES[name], "rotors": CASES[name].get("rotors", [])}
    case = exact(given)
    table = {}
    for column, change, size in columns(case):
        fine = difference(case, change, size, STEP)
        wide = difference(case, change, size, 10 * STEP)
        for a, b in zip(fine, wide):
            largest = max(abs(x) for x in a)
            apart = max(abs(x - y) for x, y in zip(a, b))
            assert apart <= largest * mpf(10) ** -17, (name, column, apart / largest)
        table[column] = [[float(x) for x in row] for row in fine]
        print(name, column, flush=True)
    omega, attitude = zip(*states(case))
    return {**given, "true_omega": [[float(x) for x in w] for w in omega],
            "true_attitude": [[float(x) for x in q] for q in attitude], "columns": table}


if __name__ == "__main__":
    table = json.loads(FILE.read_text()) if FILE.exists() else {}
    for name in sys.argv[1:] or CASES:
        table[name] = make(name)
        FILE.write_text(json.dumps(table, indent=None, separators=(",", ":")).replace('"columns"', '\n"columns"')
                        .replace('},"', '},\n"') + "\n")
