"""Write eclipse.json: a body under the light of a sun on orbits with a shadow, in 24 digits, piece by piece.

Edges are those of tests/support/eclipse_truth.py, by classical anomalies. Each piece is integrated by extrapolated
midpoint steps. The plate faces the sun throughout, so that edges are the only jumps.
"""

import json
import pathlib
import sys

import mpmath as mp
from formula_motion_reference import cross, f, integrate, to_body

mp.mp.dps = 34
sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
import eclipse_truth

INERTIA = [[1.0, 0, 0], [0, 1.25, 0], [0, 0, 2.0]]
PLATE = {"area": 1.5, "normal": [0.0, 0.0, 1.0], "centre": [0.25, 0.5, 0.75], "specular": 0.25, "diffuse": 0.5}
SUN, PRESSURE, OMEGA, ATTITUDE = [0.25, -0.125, 1.0], 0.125, [0.0625, -0.125, 2.0], [0.0625, 0.0, 0.125, 1.0]


CASES = [
    ("four revolutions", (1.0, 0.0, 0.25), (0.0625, 0.25, -1.0625), 0.75, [3.0, 10.0, 25.0]),
    ("start inside", (0.125, 0.25, -1.5), (0.8125, 0.125, 0.125), 1.0, [2.0, 8.0]),
    ("backward", (1.0, 0.0, 0.25), (0.0625, 0.25, -1.0625), 0.75, [-4.0, -11.0]),
    ("flyby", (1.5, 0.0, 0.5), (-0.5, 0.125, -1.625), 0.5, [2.0, 6.0]),
]


J = [f(INERTIA[i][i]) for i in range(3)]
CENTRE = [f(x) for x in PLATE["centre"]]
LENGTH = mp.sqrt(sum(f(x) ** 2 for x in SUN))
TOWARDS = [f(x) / LENGTH for x in SUN]
PUSH, MIRROR, MATT = f(PRESSURE) * f(PLATE["area"]), f(PLATE["specular"]), f(PLATE["diffuse"]) / 3


def rate(lit):
    """Euler's equations with the torque as the page states it."""
    def derivative(t, y):
        w, q = y[:3], y[3:7]
        tau = [f(0)] * 3
        if lit:
            b = to_body(q, TOWARDS)
            c = b[2]
            assert c > 0
            across = 2 * (MIRROR * c + MATT)
            force = [-PUSH * c * (1 - MIRROR) * x for x in b]
            force[2] -= PUSH * c * across
            tau = cross(CENTRE, force)
        change = [(tau[0] + (J[1] - J[2]) * w[1] * w[2]) / J[0], (tau[1] + (J[2] - J[0]) * w[2] * w[0]) / J[1],
                  (tau[2] + (J[0] - J[1]) * w[0] * w[1]) / J[2]]
        spin = [q[3] * w[i] + c for i, c in enumerate(cross(q[:3], w))]
        return change + [x / 2 for x in spin] + [-(q[0] * w[0] + q[1] * w[1] + q[2] * w[2]) / 2]
    return derivative


def find_edges(conic, radius, first, last):
    """(time, enters) in the span, in the order of time."""
    rows = conic.edges(SUN, radius)
    if conic.e < 1:
        rows = [(t + k * conic.period, enters) for k in range(-60, 60) for t, enters in rows]
    return sorted((f(str(t)), enters) for t, enters in rows if first < t < last)


def follow(edges, times, backward):
    """The states at times, through the edges."""
    sign = -1 if backward else 1
    size = mp.sqrt(sum(f(x) ** 2 for x in ATTITUDE))
    y, at = [f(x) for x in OMEGA] + [f(x) / size for x in ATTITUDE], f(0)
    ahead = [edge for edge in edges if edge[0] * sign > 0]
    ahead = ahead[::-1] if backward else ahead
    # forward: lit until an edge is entered; backward: lit before it is entered, so dark until that edge
    lit = ahead[0][1] != backward
    stops = sorted([(t, None) for t in times] + ahead, key=lambda stop: sign * stop[0])
    rows = []
    for t, enters in stops:
        g, t = rate(lit), f(t)
        steps, last, apart = int(mp.ceil(abs(t - at) * 2)) + 1, None, f(1)
        while not apart < f(10) ** -24:
            now = integrate(g, y, at, t, steps, 14)
            apart = max(abs(a - b) for a, b in zip(last, now)) if last else f(1)
            steps, last = 2 * steps, now
        y, at = last, t
        if enters is None:
            rows.append([mp.nstr(x, 26) for x in y])
        else:
            lit = not lit
    return rows


def main():
    found = []
    for name, r0, v0, radius, times in CASES:
        conic = eclipse_truth.Conic(1.0, r0, v0)
        edges = find_edges(conic, radius, min(0.0, *times) - 40, max(0.0, *times) + 40)
        rows = follow(edges, times, times[0] < 0)
        inside = [[mp.nstr(t, 26), enters] for t, enters in edges if min(0, *times) < t < max(0, *times)]
        found.append({"name": name, "r0": r0, "v0": v0, "shadow": radius, "times": times, "edges": inside,
                      "states": rows})
        print(name, len(inside), "edges, e =", mp.nstr(f(str(conic.e)), 5), flush=True)
    common = {"inertia": INERTIA, "plate": PLATE, "sun": SUN, "pressure": PRESSURE, "omega": OMEGA,
              "attitude": ATTITUDE}
    text = json.dumps(common)[:-1] + ', "cases": [\n' + ",\n".join(json.dumps(case) for case in found) + "\n]}\n"
    pathlib.Path(__file__).with_name("eclipse.json").write_text(text)


if __name__ == "__main__":
    main()
