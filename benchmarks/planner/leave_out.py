"""Are torques left out only where they change nothing, and what does it save? Random weak torques on random bodies.

Run: python benchmarks/planner/leave_out.py [--count 400] [--seed 1] [--workers 1] [--json rows.json] [--last]

Each case is a decision of the planner at a random accuracy, for a torque whose effect is about the accuracy. Truth is a
certified run with the torque, at an accuracy a hundredth of that asked or 1e-13. A decision is false if a sample of the
motion without the torque is farther from the truth than its stated error, or than the accuracy. Seed 31 is kept for a
last judgement: it asks for --last.
"""

import argparse
import collections
import json
import math
import multiprocessing
import pathlib
import time

import numpy as np

import polhode as ph

LAST = 31
BODIES = ("box", "near symmetric", "near spherical", "thin", "near separatrix")
TORQUES = ("body", "space", "damping", "matrix", "gradient", "window", "formula")


def draw_body(rng, kind):
    if kind == "box":
        a = np.sort(rng.uniform(0.3, 1.0, 3))
        moments = np.array((a[1]**2 + a[2]**2, a[0]**2 + a[2]**2, a[0]**2 + a[1]**2))
    elif kind == "near symmetric":
        moments = np.array((1.0, 1 + 10**rng.uniform(-7, -1), rng.uniform(0.3, 1.9)))
    elif kind == "near spherical":
        moments = 1 + 10**rng.uniform(-8, -2) * rng.uniform(-1, 1, 3)
    elif kind == "thin":
        thin = 10**rng.uniform(-2.5, -1)
        moments = np.array((thin, 1.0, 1 + thin * rng.uniform(0, 0.9)))
    else:
        moments = np.array((1.0, rng.uniform(1.2, 1.8), 2.0))
    omega = rng.normal(size=3)
    if kind == "near separatrix":
        omega[1], omega[[0, 2]] = 1.0, 10**rng.uniform(-6, -0.5, 2)
    return moments * 10**rng.uniform(-3, 3), omega * 10**rng.uniform(-2, 1)


def swing(t, omega, attitude, p):
    return p.c * np.array([np.sin(p.n * t), np.cos(p.n * t), 0.5]) - p.c * omega * ph.formula.norm(omega) / p.w**2


def make_torque(rng, kind, size, moments, rate, span):
    v = rng.normal(size=3)
    v *= size / np.linalg.norm(v)
    t = ph.torques
    if kind == "body":
        return t.Constant(v)
    if kind == "space":
        return t.Constant(v, frame="space")
    if kind == "damping":
        return t.Damping(abs(v) / rate)
    if kind == "matrix":
        return t.Damping(np.outer(v, rng.normal(size=3)) / rate)
    if kind == "gradient":
        return t.GravityGradient(math.sqrt(size / (1.5 * (moments.max() - moments.min()))))
    if kind == "window":
        begin = rng.uniform(0, 0.8) * span
        return t.During(t.Constant(5 * v), [(begin, begin + 0.2 * span)])
    return t.Formula(function=swing, c=float(size), n=float(rate * rng.uniform(0.1, 3)), w=float(rate))


def draw(seed, number):
    """A scene, its accuracy and the kinds of its body and torque."""
    rng = np.random.default_rng((seed, number))
    body, torque = rng.choice(BODIES), rng.choice(TORQUES)
    moments, omega = draw_body(rng, body)
    rate = float(np.linalg.norm(omega))
    turns = 10**rng.uniform(0, 3)
    span = 2 * math.pi * turns / rate
    accuracy = 10**rng.uniform(-10, -3)
    # To first order an angle of b T^2 / 2 J, where nothing else amplifies it.
    size = accuracy * 10**rng.uniform(-3.5, 0.5) * 2 * moments.max() / span**2 * min(1.0, 0.5 * rate * span)
    return ph.Scene(inertia=moments, omega=omega, torques=[make_torque(rng, torque, size, moments, rate, span)],
                    times=np.linspace(0, span, 33)[1:]), accuracy, str(body), str(torque)


def compute_apart(a, b):
    """The distance of two motions, as the accuracy is defined."""
    rates = np.linalg.norm(a.omega - b.omega, axis=1).max() / max(a.omega_scale, b.omega_scale)
    p, q = a.attitude, b.attitude
    far = np.minimum(np.linalg.norm(p - q, axis=1), np.linalg.norm(p + q, axis=1)).max()
    return max(float(rates), 4 * math.asin(min(1.0, far / 2)))


def measure(run, least=3):
    answer, took = None, []
    for _ in range(least):
        begin = time.thread_time()
        answer = run()
        took.append(time.thread_time() - begin)
    return answer, min(took)


def judge(case):
    scene, accuracy, body, torque = draw(*case)
    plan, with_decision = measure(lambda: ph.plan(scene, accuracy))
    kept, without = measure(lambda: ph.plan(scene, accuracy, leave_out=False))
    effect = ph.effect(scene)
    rate = float(np.linalg.norm(scene.omega))
    bound = max(effect.omega / rate, effect.attitude)
    first = max(effect.first_order[0] / rate, effect.first_order[1])
    row = {"case": case, "body": body, "torque": torque, "accuracy": accuracy, "bound": bound, "first": first,
           "turns": rate * float(scene.times[-1]) / (2 * math.pi), "left_out": bool(plan.left_out),
           "reason": effect.reason, "decision": with_decision - without}
    truth = ph.solve(scene, max(1e-13, accuracy / 100), leave_out=False)
    free = ph.solve(ph.Scene(inertia=scene.inertia, omega=scene.omega, times=scene.times), 1e-12)
    row["effect"], row["truth_error"] = compute_apart(free, truth), truth.error
    row["false_bound"] = row["effect"] > bound + truth.error + free.error
    row["false"] = False
    if plan.left_out:
        motion, row["seconds"] = measure(lambda: ph.solve(scene, plan=plan))
        _, row["seconds_with"] = measure(lambda: ph.solve(scene, plan=kept))
        apart = compute_apart(motion, truth) - truth.error
        row["false"] = not (apart <= motion.error <= accuracy)
    return row


def summarise(rows):
    def median(values):
        values = [value for value in values if math.isfinite(value)]
        return float(np.median(values)) if values else math.nan

    gone = [row for row in rows if row["left_out"]]
    bounded = [row for row in rows if not row["reason"]]
    small = [row for row in rows if 10 * row["bound"] <= row["accuracy"]]
    tiny = [row for row in rows if 100 * row["effect"] <= row["accuracy"]]
    tight = [row["bound"] / row["effect"] for row in bounded if row["effect"] > 10 * row["truth_error"]]
    def ratio(rows):
        return median([row["seconds_with"] / row["seconds"] for row in rows])

    return {
        "decisions": len(rows), "left out": len(gone), "false decisions": sum(row["false"] for row in rows),
        "false bounds": sum(row["false_bound"] for row in rows),
        "bounded": len(bounded),
        "left out where 10 bounds are within the accuracy": sum(row["left_out"] for row in small) / max(1, len(small)),
        "left out where 100 true effects are within the accuracy":
            sum(row["left_out"] for row in tiny) / max(1, len(tiny)),
        "bound over first order, median": median([row["bound"] / row["first"] for row in bounded if row["first"] > 0]),
        "bound over true effect, median": median(tight),
        "run with the torque over run without, median": ratio(gone),
        "the same below 10 revolutions": ratio([row for row in gone if row["turns"] < 10]),
        "the same from 10 to 100": ratio([row for row in gone if 10 <= row["turns"] < 100]),
        "the same above 100": ratio([row for row in gone if row["turns"] >= 100]),
        "decision of those left out [ms], median": median([1e3 * row["decision"] for row in gone]),
        "decision of all [ms], median": median([1e3 * row["decision"] for row in rows]),
        "decision of all [ms], 99 in 100": float(np.quantile([1e3 * row["decision"] for row in rows], 0.99)),
        "refusals": dict(collections.Counter(row["reason"] for row in rows if row["reason"]).most_common()),
        "refusals by body": dict(collections.Counter(row["body"] for row in rows if row["reason"]).most_common()),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--last", action="store_true", help=f"allow seed {LAST}")
    options = parser.parse_args()
    if options.seed == LAST and not options.last:
        parser.error(f"seed {LAST} is kept for a last judgement: --last")
    cases = [(options.seed, number) for number in range(options.count)]
    if options.workers > 1:
        with multiprocessing.get_context("spawn").Pool(options.workers) as pool:
            rows = pool.map(judge, cases, chunksize=8)
    else:
        rows = [judge(case) for case in cases]
    found = summarise(rows)
    for name, value in found.items():
        print(f"{name}: {value if not isinstance(value, float) else f'{value:.3g}'}")
    for row in rows:
        if row["false"] or row["false_bound"]:
            print("FALSE", row)
    if options.json:
        options.json.write_text(json.dumps({"summary": found, "rows": rows}))


if __name__ == "__main__":
    main()
