"""Writes slopes.json: derivatives of loops by central differences of by_hand.run in 40 digits. Takes minutes."""

import copy
import json
import pathlib
import sys

import mpmath as mp
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import by_hand
import loops

STEP = mp.mpf(10) ** -13   # of 40 digits, 26 are left


def run(loop, by, step):
    """Samples of a loop whose number `by` is changed by a step."""
    loop = copy.copy(loop)
    loop["controllers"] = [dict(one) for one in loop["controllers"]]
    omega = [mp.mpf(float(x)) for x in loop["omega"]]
    q = [mp.mpf(float(x)) for x in np.array(loop["attitude"]) / np.linalg.norm(loop["attitude"])]
    size = mp.sqrt(mp.fsum(x * x for x in q))
    q = [x / size for x in q]
    group, _, axis = by.rpartition("_")
    body, more = loops.make_body(loop)
    if group == "omega":
        omega["xyz".index(axis)] += step
        if more and not more["held"]:   # a free wheel has its speed relative to the body
            more["h"]["xyz".index(axis)] += mp.mpf(loop["wheels"]["inertia"]) * step
    elif group == "attitude":   # a small rotation in space axes, on the left
        i = "xyz".index(axis)
        p = [mp.mpf(0)] * 3
        p[i] = mp.sin(step / 2)
        c, w = by_hand.cross(p, q[:3]), mp.cos(step / 2)
        q = [w * q[k] + q[3] * p[k] + c[k] for k in range(3)] + [w * q[3] - p[i] * q[i]]
    elif group == "inertia":
        body.J[int(axis) - 1, int(axis) - 1] += step
        body.inverse = body.J**-1
    else:
        _, number, name = by.split(".")
        one = loop["controllers"][int(number)]
        name, _, part = name.partition("_")
        table = "parameters" if name in one["parameters"] else "states"
        one[table] = dict(one[table])
        value = one[table][name]
        if part:
            value = [mp.mpf(float(x)) for x in value]
            value["xyz".index(part)] += step
        else:
            value = mp.mpf(value) + step
        one[table][name] = value
    return np.array(by_hand.run(body, omega, q, list(loops.times(loop)), loop["controllers"], **more), object)


def slopes(loop, by):
    """(d omega, small rotation in space axes) at each time."""
    more, less = run(loop, by, STEP), run(loop, by, -STEP)
    middle = (more + less) / 2
    d = (more - less) / (2 * STEP)
    found = []
    for row, change in zip(middle, d, strict=True):
        q, dq = row[3:], change[3:]   # theta = 2 dq q*
        c = by_hand.cross(dq[:3], q[:3])
        theta = [2 * (q[3] * dq[k] - dq[3] * q[k] - c[k]) for k in range(3)]
        found.append([mp.nstr(x, 22) for x in (*change[:3], *theta)])
    return found


def main(names):
    mp.mp.dps = 40
    path = pathlib.Path(__file__).with_name("slopes.json")
    found = json.loads(path.read_text()) if path.exists() else {}
    for name, loop in loops.SLOPES.items():
        if names and name not in names:
            continue
        found[name] = {by: slopes(loop, by) for by in loop["by"]}
        path.write_text(json.dumps(found, indent=0))
        print(name, flush=True)


main(sys.argv[1:])
