"""Motions of a body with motors, friction and a slug, by mpmath at 30 digits, from the equations of its parts.

Unknown are the rates w of the body, the speeds W of the rotors relative to it and the rates of the slug relative to it:
    Js (W' + a.w') = e,   J w' + sum Js W' a + Jd sigma' = -w x (J w + sum Js W a + Jd sigma),
    Jd (sigma' + w' + w x sigma) = -c sigma.
The angular momentum of the whole is differentiated, so no carrier and no momentum of a part is used.
Hughes 1986, Spacecraft Attitude Dynamics, sec. 3.4 and 3.7.

    python tests/reference/driven_rotors_reference.py     writes driven_rotors.json
"""

import json
import pathlib

import mpmath as mp

mp.mp.dps = 36
FULL = [["2.0", "0.1", "-0.2"], ["0.1", "2.5", "0.05"], ["-0.2", "0.05", "1.7"]]
SKEW = [mp.mpf(1) / 3, mp.mpf(2) / 3, mp.mpf(2) / 3]
UNITS = [[mp.mpf(i == k) for i in range(3)] for k in range(3)]
AT = [mp.mpf(1) / 2, mp.mpf(1), mp.mpf(2)]

# Rotors are (axis, inertia, speed, viscous, torque(t, w, q, W)); a slug is (inertia, viscous, rates).
CASES = {
    "three motors": dict(J=FULL, w=["0.3", "-0.2", "0.5"], rotors=[
        (UNITS[0], "0.05", "3.0", "0.01", lambda t, w, q, W: mp.mpf("0.04")),
        (UNITS[1], "0.04", "-2.0", "0.0", lambda t, w, q, W: mp.mpf("-0.02")),
        (UNITS[2], "0.06", "5.0", "0.02", lambda t, w, q, W: mp.mpf("0.0"))]),
    "by rates": dict(J=FULL, w=["0.5", "0.4", "-0.3"], rotors=[
        (SKEW, "0.2", "4.0", "0.01", lambda t, w, q, W: mp.mpf("0.2") * w[0] - mp.mpf("0.01") * W)]),
    "of time": dict(J=FULL, w=["0.1", "1.2", "0.2"], rotors=[
        (SKEW, "0.3", "-4.0", "0.0", lambda t, w, q, W: mp.mpf("0.1") * mp.sin(3 * t) + mp.mpf("0.05") * q[0])]),
    "slug": dict(J=FULL, w=["0.9", "-0.4", "1.1"], rotors=[], slug=("0.3", "0.15", ["0.2", "0.1", "-0.5"])),
    "slug and wheel": dict(J=FULL, w=["0.2", "1.4", "0.3"], rotors=[
        (UNITS[2], "0.1", "8.0", "0.05", lambda t, w, q, W: mp.mpf("0.03"))],
        slug=("0.2", "0.3", ["0.0", "0.0", "0.0"])),
}


def numbers(values):
    return [mp.mpf(value) for value in values]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def rates(case):
    """The derivative of (w, W..., sigma, q): accelerations by one linear system of all parts."""
    J = mp.matrix([numbers(row) for row in case["J"]])
    rotors = [(axis, mp.mpf(own), mp.mpf(viscous), torque) for axis, own, _, viscous, torque in case["rotors"]]
    slug = case.get("slug")
    n = len(rotors)

    def f(t, y):
        w, W, sigma, q = y[:3], y[3:3 + n], y[3 + n:6 + n], y[6 + n:]
        size = 3 + n + 3
        M, b = mp.eye(size), mp.matrix(size, 1)
        Jd, c = (mp.mpf(slug[0]), mp.mpf(slug[1])) if slug else (mp.mpf(0), mp.mpf(0))
        H = [dot(J[i, :], w) + Jd * sigma[i] for i in range(3)]
        for (axis, own, _, _), speed in zip(rotors, W):
            H = [H[i] + own * speed * axis[i] for i in range(3)]
        turned = cross(w, H)
        for i in range(3):   # H' = -w x H for the whole
            for k in range(3):
                M[i, k] = J[i, k]
            for r, (axis, own, _, _) in enumerate(rotors):
                M[i, 3 + r] = own * axis[i]
            M[i, 3 + n + i] = Jd
            b[i] = -turned[i]
        for r, (axis, own, viscous, torque) in enumerate(rotors):   # Js (W' + a.w') = e
            for k in range(3):
                M[3 + r, k] = own * axis[k]
            M[3 + r, 3 + r] = own
            b[3 + r] = torque(t, w, q, W[r]) - viscous * W[r]
        if slug:   # Jd (sigma' + w' + w x sigma) = -c sigma
            moved = cross(w, sigma)
            for i in range(3):
                M[3 + n + i, i] = Jd
                M[3 + n + i, 3 + n + i] = Jd
                b[3 + n + i] = -c * sigma[i] - Jd * moved[i]
        x = mp.lu_solve(M, b)
        x1, x2, x3, x0 = q
        half = mp.mpf(1) / 2
        q_rate = [half * (x0 * w[0] + x2 * w[2] - x3 * w[1]), half * (x0 * w[1] + x3 * w[0] - x1 * w[2]),
                  half * (x0 * w[2] + x1 * w[1] - x2 * w[0]), -half * (x1 * w[0] + x2 * w[1] + x3 * w[2])]
        return [x[i] for i in range(size)] + q_rate

    return f


def solve(case, steps):
    """Gragg's midpoint steps with 16 extrapolations: the error is of order 32 in the step."""
    f = rates(case)
    sigma = case["slug"][2] if case.get("slug") else ["0"] * 3
    y = numbers(case["w"]) + numbers([rotor[2] for rotor in case["rotors"]]) + numbers(sigma) + numbers("0001")
    rows, t = [], mp.mpf(0)
    for end in AT:
        H = (end - t) / steps
        for _ in range(steps):
            table = []
            for k in range(16):
                m = 2 * (k + 1)
                h = H / m
                before, now = y, [a + h * b for a, b in zip(y, f(t, y))]
                for i in range(1, m):
                    before, now = now, [a + 2 * h * b for a, b in zip(before, f(t + i * h, now))]
                row = [[(a + b + h * c) / 2 for a, b, c in zip(before, now, f(t + H, now))]]
                for j in range(1, k + 1):
                    ratio = mp.mpf(k + 1) ** 2 / mp.mpf(k + 1 - j) ** 2 - 1
                    row.append([a + (a - b) / ratio for a, b in zip(row[j - 1], table[k - 1][j - 1])])
                table.append(row)
            y, t = table[-1][-1], t + H
        rows.append(y)
    return rows


def main():
    out = {}
    for name, case in CASES.items():
        rows, coarse = solve(case, 4), solve(case, 3)
        gap = max(abs(a - b) for one, other in zip(rows, coarse) for a, b in zip(one, other))
        assert gap < mp.mpf(10) ** -24, (name, gap)
        out[name] = {"t": [float(t) for t in AT], "y": [[mp.nstr(value, 22) for value in row] for row in rows]}
    target = pathlib.Path(__file__).with_name("driven_rotors.json")
    target.write_text(json.dumps(out, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
