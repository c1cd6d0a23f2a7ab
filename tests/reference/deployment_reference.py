"""Make the stored truth of S14, whose body changes: ``python tests/reference/deployment_reference.py``.

The first route integrates the angular momentum in space and the attitude, the second J w' = J w x w - J' w and the
rotation matrix. Both extrapolate Gragg's midpoint rule in mpmath. Writes S14.npz, and S14's numbers in agreement.json
and floors.json.
"""

import json
import pathlib
import tomllib

import mpmath as mp
import numpy as np
from changing_reference import cross, matrix, to_body, turn

mp.mp.dps = 32
LEVELS = 11
SCENES = pathlib.Path(__file__).parents[2] / "scenes"
STORED = SCENES / "reference"
HALF_ULP = mp.mpf(2) ** -53


def load():
    scene = tomllib.loads((SCENES / "S14.toml").read_text(encoding="utf-8"))
    span, samples = scene["times"]["span"], scene["times"]["samples"]
    pieces = [[max(piece["from"], 0.0), min(piece["to"], span),
               [[mp.mpf(x) for x in term] for term in piece["inertia"]]] for piece in scene["body"]["pieces"]]
    return pieces, [mp.mpf(x) for x in scene["start"]["omega"]], np.linspace(0.0, span, samples)


def moments(terms, since):
    return [sum(term[i] * since**k for k, term in enumerate(terms)) for i in range(3)]


def slopes(terms, since):
    return [sum(k * term[i] * since ** (k - 1) for k, term in enumerate(terms) if k > 0) for i in range(3)]


def by_momentum(terms, begin):
    """L in space and the quaternion."""
    def f(t, y):
        J = moments(terms, t - begin)
        return [mp.mpf(0)] * 3 + turn(y[3:], [h / j for h, j in zip(to_body(y[3:], y[:3]), J)])

    return f


def by_rates(terms, begin):
    """w and the rotation matrix by rows."""
    def f(t, y):
        J, change, w = moments(terms, t - begin), slopes(terms, t - begin), y[:3]
        moved = cross([j * a for j, a in zip(J, w)], w)
        rows = [cross(y[3 + 3 * i:6 + 3 * i], w) for i in range(3)]   # R' = R [w]x
        return [(m - c * a) / j for m, c, a, j in zip(moved, change, w, J)] + [x for row in rows for x in row]

    return f


def advance(f, t, y, H, levels):
    table = []
    for k in range(levels):
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
    return table[-1][-1]


def solve(pieces, omega, times, levels=LEVELS, by=by_momentum):
    """Rows of w and R at the times; a piece begins at a sample."""
    identity = [mp.mpf(x) for x in (1, 0, 0, 0, 1, 0, 0, 0, 1)]
    y = [j * w for j, w in zip(pieces[0][2][0], omega)] + [mp.mpf(x) for x in (0, 0, 0, 1)]
    if by is by_rates:
        y = list(omega) + identity
    rows, quaternions, at = [], [], 0
    for i, t in enumerate(mp.mpf(float(t)) for t in times):
        if i > 0:
            begin, _, terms = pieces[at]
            start = mp.mpf(float(times[i - 1]))
            y = advance(by(terms, mp.mpf(begin)), start, y, t - start, levels)
        if at + 1 < len(pieces) and t >= pieces[at][1]:
            if by is by_rates:   # the angular momentum stays
                last = moments(pieces[at][2], t - mp.mpf(pieces[at][0]))
                y = [w * a / b for w, a, b in zip(y, last, pieces[at + 1][2][0])] + y[3:]
            at += 1
        begin, _, terms = pieces[at]
        if by is by_rates:
            rows.append(y)
            continue
        w = [h / j for h, j in zip(to_body(y[3:], y[:3]), moments(terms, t - mp.mpf(begin)))]
        rows.append(w + list(matrix(y[3:])))
        quaternions.append(y[3:])
    return rows, quaternions


def apart(a, b, scale):
    """The largest differences of w, relative, and of the attitude: |R - R'| is sqrt 2 times the angle."""
    rate = max(mp.norm([x - y for x, y in zip(p[:3], q[:3])]) for p, q in zip(a, b)) / scale
    angle = max(mp.norm([x - y for x, y in zip(p[3:], q[3:])]) for p, q in zip(a, b)) / mp.sqrt(2)
    return [float(rate), float(angle)]


def find_floors(pieces, omega, times, rows, scale):
    """Moves each input by a part of 1e-12, and shares half an ulp."""
    part, few = mp.mpf(10) ** -12, times[::20]
    base = rows[::20]
    total = np.zeros(2)
    for i in range(3):
        moved = [w * (1 + part) if k == i else w for k, w in enumerate(omega)]
        total += apart(solve(pieces, moved, few, 14)[0], base, scale)
    for p, (_, _, terms) in enumerate(pieces):
        for k, term in enumerate(terms):
            for i in range(3):
                if term[i] == 0:
                    continue
                changed = [[b, e, [list(row) for row in rest]] for b, e, rest in pieces]
                changed[p][2][k][i] *= 1 + part
                total += apart(solve(changed, omega, few, 14)[0], base, scale)
    total *= float(HALF_ULP / part)
    late = max(float(mp.norm(row[:3])) * float(t) for row, t in zip(rows, times)) * float(HALF_ULP)
    return {"omega": float(f"{total[0]:.2g}"), "attitude": float(f"{total[1] + late:.2g}")}


def main():
    pieces, omega, times = load()
    rows, quaternions = solve(pieces, omega, times)
    scale = max(mp.norm(row[:3]) for row in rows)
    report = {"orders": [2 * LEVELS, 2 * LEVELS - 4],
              "between_orders": apart(rows, solve(pieces, omega, times, LEVELS - 2)[0], scale),
              "against_collocation": apart(rows, solve(pieces, omega, times, by=by_rates)[0], scale)}
    print(report)
    floors = find_floors(pieces, omega, times, rows, scale)
    print(floors)
    signs, last = [], quaternions[0]
    for q in quaternions:
        last = q if sum(a * b for a, b in zip(q, last)) >= 0 else [-x for x in q]
        signs.append(last)
    np.savez_compressed(STORED / "S14.npz", t=times, omega=np.array([[float(x) for x in row[:3]] for row in rows]),
                        attitude=np.array([[float(x) for x in q] for q in signs]))
    for name, value in (("agreement", report), ("floors", floors)):
        file = STORED / f"{name}.json"
        known = json.loads(file.read_text(encoding="utf-8")) | {"S14": value}
        file.write_text(json.dumps(dict(sorted(known.items())), indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
