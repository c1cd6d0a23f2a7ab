"""Thin evidence, judged: what the data cannot show must not be named. Twelve kinds, with seeds as arguments."""

import argparse
import json
import pathlib
import sys

import numpy as np

import polhode as ph

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/support"))

import spoiled


def free(moments, omega, count=120, turns=2.0):
    """Times, rates and attitudes of a free body over so many turns."""
    t = np.linspace(0, turns * 2 * np.pi / np.linalg.norm(omega), count)
    return t, *ph.FreeMotion(moments, omega, physical=False).at(t)


def shaken(t, omega, attitude, noise, rng):
    case = spoiled.noisy(spoiled.Case(t, attitude, omega, {}), noise, rng)
    return case.omega, case.attitude


def cases(rng):
    """Give the name, the arguments of `polhode.judge`, the answers that the data allow, and a word of `untold`.

    An answer is the main cause, "" for none. With `cannot tell` the named cause must be among the rivals.
    """
    moments = np.array([1.0, rng.uniform(1.4, 1.8), rng.uniform(2.0, 2.3)])
    start = rng.uniform(0.5, 1.5, 3) * rng.choice([-1, 1], 3)
    other = moments * [1, 1.04, 1]
    t, w, q = free(moments, start)
    yield "rates alone, one axis flipped", (t, None, w * [1, 1, -1], moments), {"gyroscopic sign", "axis flipped"}, ""
    yield "attitudes alone, another inertia", (t, q, None, other), {"inertia"}, "attitudes alone"
    yield "attitudes alone, reversed", (t, q * [-1, -1, -1, 1], None, moments), {"conjugate"}, ""
    few = slice(0, 7)
    yield "seven samples", (t[few], np.roll(q[few], 1, axis=1), w[few], moments), {"scalar order"}, "too few"
    s, v, p = free(moments, start, 40, 0.15)
    yield "a seventh of a turn, another inertia", (s, p, v, other), {""}, "too few"
    s, v, p = free(np.full(3, 1.0), start)
    yield "a sphere, another inertia", (s, p, v, np.full(3, 2.0)), {""}, ""
    s, v, p = free(moments, np.eye(3)[rng.choice([0, 2])] * 1.3)
    yield "a steady turn, another inertia", (s, p, v, other), {""}, ""
    round_ = np.array([1, 1, rng.uniform(0.5, 1.6)])
    s, v, p = free(round_, start)
    late = ph.FreeMotion(round_, start, physical=False).at(s + 0.5 * s[1])[0]
    yield "a symmetric body, rates late", (s, p, late, round_), {"lag", "misaligned"}, ""
    yield "a free body, all rates 0.3 % large", (t, q, 1.003 * w, moments), {"clock", "units of rates"}, ""
    yield "inertia not given", (t, q, w, None), {""}, "inertia was fitted"
    v, p = shaken(t, w + [1e-5, 0, 0], q, 1e-2, rng)
    yield "a bias far below the noise", (t, p, v, moments), {""}, ""
    scene = ph.Scene(inertia=moments, omega=start, times=t, torques=[ph.torques.AngularDamping(0.005 / t[-1])])
    motion = ph.solve(scene, 1e-12)
    v, p = shaken(t, motion.omega, motion.attitude, 1e-3, rng)
    yield "half a percent of damping in noise", (t, p, v, moments), {"damping", "torque"}, ""


def judged(name, given, allowed, word):
    t, attitude, omega, inertia = given
    found = ph.judge(t, attitude, omega, inertia=inertia, tolerance=1e-10)
    main = [f for f in found.findings if f.level != "remark"]
    said = main[0].cause if main else ""
    right = said in allowed or said == "cannot tell" and bool(allowed & set(main[0].rivals))
    if len(allowed) > 1 and right and said != "cannot tell":  # a cause that others equal names them
        right = bool(set(main[0].rivals) & allowed - {said})
    right &= all(f.level == "remark" or f is main[0] for f in found.findings)
    right &= any(word in text for text in found.untold) if word else True
    return {"case": name, "said": said, "rivals": list(main[0].rivals) if main else [], "right": bool(right)}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--each", type=int, default=2)
    parser.add_argument("--json", type=pathlib.Path)
    given = parser.parse_args()
    records = []
    for k in range(given.each):
        records += [judged(*case) for case in cases(np.random.default_rng([given.seed, k]))]
    print("| evidence | what is said | right |\n|---|---|---|")
    for name in dict.fromkeys(r["case"] for r in records):
        mine = [r for r in records if r["case"] == name]
        words = ", ".join(dict.fromkeys(r["said"] or "nothing" for r in mine))
        print(f"| {name} | {words} | {sum(r['right'] for r in mine)} of {len(mine)} |")
    print(f"\n{sum(r['right'] for r in records)} of {len(records)} right")
    if given.json:
        given.json.write_text(json.dumps(records, indent=1))


if __name__ == "__main__":
    main()
