"""Motions of bodies that change, by mpmath at 30 digits, from the angular momentum in space.

Unknown are L in space and the attitude: L' = R tau, q' = q w / 2 with w = J(t)^-1 (R^T L - h(t)). So neither J' nor h'
is used. Matter that leaves is integrated by J(t) w' = J w x w + tau. Pieces begin anew at each jump.

    python tests/reference/changing_reference.py     writes changing.json
"""

import json
import pathlib

import mpmath as mp

mp.mp.dps = 34
BEFORE = [["2.0", "0.1", "-0.2"], ["0.1", "2.5", "0.05"], ["-0.2", "0.05", "1.7"]]
AFTER = [["3.1", "-0.1", "0.3"], ["-0.1", "2.9", "0.2"], ["0.3", "0.2", "3.4"]]
KICKED = [["1.2", "0.15", "0.1"], ["0.15", "1.9", "-0.1"], ["0.1", "-0.1", "1.5"]]
AT = [mp.mpf(1) / 2, mp.mpf(3) / 2, mp.mpf(5) / 2, mp.mpf(4)]
ZERO = [mp.mpf(0)] * 3


def numbers(values):
    return [mp.mpf(value) for value in values]


def tensor(rows):
    return mp.matrix([numbers(row) for row in rows]) if isinstance(rows[0], list) else mp.diag(numbers(rows))


def ramp(before, after, order, begin=1, end=3):
    """Value at a time within the ramp: s, s^2 (3 - 2 s) or s^3 (10 - 15 s + 6 s^2)."""
    a, b = tensor(before), tensor(after)

    def value(t):
        s = (t - begin) / (end - begin)
        s = {1: s, 3: s**2 * (3 - 2 * s), 5: s**3 * (10 - 15 * s + 6 * s**2)}[order]
        return a + (b - a) * s

    return [(0, begin, lambda t: a), (begin, end, value), (end, 4, lambda t: b)]


def momentum_of_parts(t):
    """Of parts that move: a polynomial of degree 2 until t = 2, then constant with a jump."""
    return [mp.mpf("0.3") * t, mp.mpf("0.2") - mp.mpf("0.1") * t**2, mp.mpf("-0.4") * t + mp.mpf("0.15") * t**2]


def with_parts(J):
    a = tensor(J)
    return [(0, 2, lambda t: a, momentum_of_parts), (2, 4, lambda t: a, lambda t: numbers(["0.1", "0.2", "-0.3"]))]


TABLE = [(mp.mpf(0), ["2.0", "2.5", "1.7"]), (mp.mpf(1), ["2.2", "2.4", "1.9"]), (mp.mpf(3), ["2.9", "2.6", "2.6"]),
         (mp.mpf(4), ["3.0", "3.0", "2.5"])]


def table():
    pieces = []
    for (t0, a), (t1, b) in zip(TABLE, TABLE[1:]):
        pieces.append((t0, t1, lambda t, t0=t0, t1=t1, a=tensor(a), b=tensor(b): a + (b - a) * (t - t0) / (t1 - t0)))
    return pieces


def thrust(t, w, q, J):
    return numbers(["0.1", "-0.2", "0.3"])


def weak(t, w, q, J):
    """A damping, a torque constant in space, and the gradient of gravity on a circular orbit with J(t)."""
    n = mp.mpf("0.8")
    u = to_body(q, [mp.cos(n * t), mp.sin(n * t), mp.mpf(0)])
    gradient = cross(u, multiply(J, u))
    space = to_body(q, numbers(["0.05", "0.0", "-0.1"]))
    return [3 * n**2 * gradient[i] + space[i] - mp.mpf("0.1") * w[i] for i in range(3)]


# Pieces are (begin, end, J(t), h(t)); a torque is torque(t, w, q, J). With `leaving` matter takes its momentum along.
CASES = {
    "linear": dict(pieces=ramp(BEFORE, AFTER, 1), w=["0.9", "-0.7", "1.3"]),
    "smooth": dict(pieces=ramp(BEFORE, AFTER, 5), w=["0.9", "-0.7", "1.3"]),
    "cubic on axes": dict(pieces=ramp(["2", "2.5", "1.7"], ["3", "3.2", "3.5"], 3), w=["0.2", "1.1", "0.1"]),
    "table": dict(pieces=table(), w=["0.4", "1.2", "-0.6"]),
    "kick": dict(pieces=[(0, 1, lambda t: tensor(BEFORE)), (1, 3, lambda t: tensor(KICKED)),
                         (3, 4, lambda t: tensor(AFTER))], w=["0.1", "2.2", "0.3"]),
    "moving parts": dict(pieces=with_parts(BEFORE), w=["0.5", "0.3", "-0.8"]),
    "cat": dict(pieces=with_parts(BEFORE), w=["0", "-0.08", "0"]),
    "leaving": dict(pieces=ramp(AFTER, KICKED, 1), w=["0.9", "-0.7", "1.3"], leaving=True),
    "rocket": dict(pieces=ramp(AFTER, KICKED, 1), w=["0.9", "-0.7", "1.3"], leaving=True, torque=thrust),
    "driven": dict(pieces=ramp(BEFORE, AFTER, 5), w=["0.3", "0.2", "-0.5"], torque=weak),
}


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def multiply(M, v):
    return [sum(M[i, k] * v[k] for k in range(3)) for i in range(3)]


def matrix(q):
    x, y, z, w = q
    return mp.matrix([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                      [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                      [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def to_body(q, v):
    return multiply(matrix(q).T, v)


def turn(q, w):
    x, y, z, s = q
    return [(s * w[0] + y * w[2] - z * w[1]) / 2, (s * w[1] + z * w[0] - x * w[2]) / 2,
            (s * w[2] + x * w[1] - y * w[0]) / 2, -(x * w[0] + y * w[1] + z * w[2]) / 2]


def parts(piece):
    return (*piece[:3], piece[3] if len(piece) > 3 else lambda t: ZERO)


def make(case, piece):
    """The function of the state in a piece, and the rates w of a state there."""
    _, _, J, h = parts(piece)
    torque, leaving = case.get("torque"), case.get("leaving")

    def rates(t, y):
        if leaving:
            return y[:3]
        return list(mp.lu_solve(J(t), mp.matrix([a - b for a, b in zip(to_body(y[3:], y[:3]), h(t))])))

    def f(t, y):
        w, q, inertia = rates(t, y), y[3:], J(t)
        tau = torque(t, w, q, inertia) if torque else ZERO
        if leaving:
            moment = [a + b for a, b in zip(cross(multiply(inertia, w), w), tau)]
            return list(mp.lu_solve(inertia, mp.matrix(moment))) + turn(q, w)
        return multiply(matrix(q), tau) + turn(q, w)

    return f, rates


def advance(f, t, y, H):
    """One step of Gragg's midpoint rule with 14 extrapolations: the error is of order 28 in the step."""
    rows = []
    for k in range(14):
        m = 2 * (k + 1)
        h = H / m
        before, now = y, [a + h * b for a, b in zip(y, f(t, y))]
        for i in range(1, m):
            before, now = now, [a + 2 * h * b for a, b in zip(before, f(t + i * h, now))]
        row = [[(a + b + h * c) / 2 for a, b, c in zip(before, now, f(t + H, now))]]
        for j in range(1, k + 1):
            ratio = mp.mpf(k + 1) ** 2 / mp.mpf(k + 1 - j) ** 2 - 1
            row.append([a + (a - b) / ratio for a, b in zip(row[j - 1], rows[k - 1][j - 1])])
        rows.append(row)
    return rows[-1][-1]


def solve(case, steps, at=AT):
    """Rows (w, q) at the times; a row at a jump has the rates after it."""
    w, q = numbers(case["w"]), numbers("0001")
    _, _, J, h = parts(case["pieces"][0])
    y = w if case.get("leaving") else [a + b for a, b in zip(multiply(J(mp.mpf(0)), w), h(mp.mpf(0)))]
    y, rows = [*y, *q], []
    for i, piece in enumerate(case["pieces"]):
        f, rates = make(case, piece)
        begin, end = mp.mpf(piece[0]), mp.mpf(piece[1])
        last = i == len(case["pieces"]) - 1
        t = begin
        for stop in [s for s in at if begin < s < end or (last and s == end)] + ([] if last else [end]):
            count = max(1, int(mp.ceil((stop - t) * steps)))
            H = (stop - t) / count
            for _ in range(count):
                y, t = advance(f, t, y, H), t + H
            t = stop
            if stop in at and (stop != end or last):
                rows.append(list(rates(t, y)) + y[3:])
        if not last and end in at:
            _, later = make(case, case["pieces"][i + 1])
            rows.append(list(later(end, y)) + y[3:])
    return rows


def main():
    out = {}
    for name, case in CASES.items():
        rows, coarse = solve(case, 5), solve(case, 4)
        gap = max(abs(a - b) for one, other in zip(rows, coarse) for a, b in zip(one, other))
        assert gap < mp.mpf(10) ** -23, (name, gap)
        out[name] = {"t": [float(t) for t in AT], "y": [[mp.nstr(value, 22) for value in row] for row in rows]}
    target = pathlib.Path(__file__).with_name("changing.json")
    target.write_text(json.dumps(out, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
