"""Fit the forecasts of the methods' records: steps, errors and seconds on random scenes.

Run: python benchmarks/planner/fit.py
"""

import sys
import time

import numpy as np
from family import compute_error, compute_truth, draw

import polhode as ph

KINDS = ("free", "constant_body", "heavy_slow", "heavy_fast", "gradient", "damping_soft")
RTOL = 10.0 ** -np.arange(3, 15, dtype=float)


def main(count=60):
    rows = {m["name"]: [] for m in ph.methods() if m["adaptive"]}
    done = number = 0
    while done < count:
        one = draw(11, KINDS[number % len(KINDS)], number // len(KINDS))
        number += 1
        known = compute_truth(one.scene)
        if known is None:
            continue
        done += 1
        turns = ph.plan(one.scene).facts["turns"]
        for name, kept in rows.items():
            for rtol in RTOL:
                start = time.thread_time()
                motion = ph.solve(one.scene, method=name, rtol=rtol, max_steps=400_000)
                seconds = time.thread_time() - start
                if motion.status == "finished":
                    found = compute_error(motion, known)
                    kept.append((rtol, turns, found, motion.stats["steps"], seconds, KINDS.index(one.kind)))
    for name, kept in rows.items():
        rtol, turns, found, steps, seconds, kind = np.array(kept).T
        radians = 2 * np.pi * turns
        per_radian = steps / radians
        fit = np.polyfit(np.log(rtol[steps > 30]), np.log(per_radian[steps > 30]), 1)
        print(f"{name}: steps per radian {np.exp(fit[1]):.3f} rtol^{fit[0]:.4f}")
        small = (found < 0.1)
        floor = np.array([np.median((found / turns)[rtol == r]) for r in RTOL])
        print("  median error per turn by rtol", " ".join(f"{r:.0e}:{f:.1e}" for r, f in zip(RTOL, floor, strict=True)))
        for k, label in enumerate(KINDS):
            pick = small & (kind == k) & (rtol > 1e-11)
            if pick.any():
                scaled = found[pick] / (rtol[pick] * turns[pick] * (1 + turns[pick] / 30))
                print(f"  {label}: error / (rtol n (1 + n/30)): "
                      + ", ".join(f"q{q} {np.quantile(scaled, q / 100):.2g}" for q in (5, 25, 50, 75, 95)))
        for r in RTOL[::3]:
            print(f"  rtol {r:.0e}: {np.median((seconds / steps)[rtol == r]) * 1e9:.0f} ns a step, steps per radian "
                  f"q10 {np.quantile(per_radian[rtol == r], .1):.2f} q50 {np.median(per_radian[rtol == r]):.2f} q90 "
                  f"{np.quantile(per_radian[rtol == r], .9):.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 60)
