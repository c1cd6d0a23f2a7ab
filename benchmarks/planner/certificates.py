"""Four ways to bound the error of a stepped motion, side by side on scenes of five kinds.

Run: python benchmarks/planner/certificates.py [scenes] [--seed 3]

carried: what solve() does with taylor, a linearised error that goes along with the run. pair: two runs, the coarser one
with moved inputs. loose twin: one run, and one at a hundred times its tolerance, whose difference over 33 counts.
margin: one run at a fifth of the forecast tolerance, for the scenes in which nothing is fed back from the attitude and
nothing checked. All of them take taylor, begin at the same tolerance and are made again, tighter, while they claim more
than is asked.
"""

import argparse

import numpy as np
from family import Known, compute_error, compute_truth, draw
from regret import find_best, measure_cpu

import polhode as ph

LEAST = 1e-16
KINDS = ("heavy_slow", "heavy_fast", "gradient", "constant_body", "damping_soft")


def run(scene, rtol):
    return ph.solve(scene, method="taylor", rtol=max(rtol, LEAST), max_steps=2_000_000)


def moved(scene):
    """The scene with every input changed by two units in the last place, up or down."""
    rng = np.random.Generator(np.random.PCG64(2026))

    def move(x):
        x = np.asarray(x, dtype=float)
        end = np.where(rng.uniform(size=x.shape) < 0.5, np.inf, -np.inf)
        return np.where(x == 0, x, np.nextafter(np.nextafter(x, end), end))

    torques = []
    for one in scene.torques:
        match one:
            case ph.torques.Constant():
                torques.append(ph.torques.Constant(move(one.torque)))
            case ph.torques.Gravity():
                torques.append(ph.torques.Gravity(float(move(one.weight)), move(one.arm)))
            case ph.torques.GravityGradient():
                torques.append(ph.torques.GravityGradient(float(move(one.mean_motion))))
            case ph.torques.Damping():
                torques.append(ph.torques.Damping(move(one.matrix)))
    return ph.Scene(inertia=move(np.diag(scene.inertia.matrix)), omega=move(scene.omega), attitude=move(scene.attitude),
                    torques=torques, times=scene.times, want=scene.want)


def apart(a, b):
    scale = max(np.linalg.norm(b.omega, axis=1).max(), np.linalg.norm(b.scene.omega))
    return compute_error(a, Known(b.omega, b.attitude, scale, 0))


def pair(scene, accuracy, rtol, ratio=5, scale=1.5):
    """Return the run that is given back and what is claimed of it."""
    best = None
    other = moved(scene)
    for attempt in range(6):
        fine, coarse = run(scene, rtol / ratio), run(other if ratio == 5 else scene, rtol)
        claim = scale * apart(fine, coarse)
        if best is None or claim < best[1]:
            best = fine, claim
        if claim <= accuracy or rtol <= ratio * LEAST or (attempt > 1 and claim > best[1]):
            return best
        rtol = max(rtol / np.clip(2 * claim / accuracy, 3, 1e4), ratio * LEAST)
    return best


def carried(scene, accuracy, rtol):
    motion = ph.solve(scene, accuracy, method="taylor", max_steps=2_000_000)
    return motion, motion.error


SCHEMES = {"carried": carried, "pair": pair,
           "loose twin": lambda scene, accuracy, rtol: pair(scene, accuracy, rtol * 20, 100, 0.03),
           "margin": lambda scene, accuracy, rtol: (run(scene, rtol / 5), 0.5 * accuracy)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scenes", nargs="?", type=int, default=200)
    parser.add_argument("--seed", type=int, default=3)
    options = parser.parse_args()
    rows, number = {name: [] for name in SCHEMES}, -1
    while len(rows["carried"]) < options.scenes:
        number += 1
        one = draw(options.seed, KINDS[number % len(KINDS)], number // len(KINDS))
        accuracy = max(one.accuracies[number % len(one.accuracies)], 1e-11)
        known = compute_truth(one.scene)
        if known is None:
            continue
        best = find_best(one.scene, known, accuracy, ["taylor", "rk45"])
        plan = ph.plan(one.scene, accuracy, method="taylor")
        for name, scheme in SCHEMES.items():
            act = lambda: scheme(one.scene, accuracy, 5 * plan_rtol(plan))  # noqa: E731,B023
            motion, claim = act()
            found = compute_error(motion, known)
            rows[name].append((accuracy, found, claim, measure_cpu(act) / best[0] if best else np.nan))
    for name, kept in rows.items():
        accuracy, found, claim, regret = np.array(kept).T
        claims = claim <= accuracy
        false = claims & (found > accuracy)
        ratio = (claim / found)[claims & (found > 0)]
        worst = f", the worst by {(found / accuracy)[false].max():.2g}" if false.any() else ""
        print(f"{name:10}: claims {claims.sum()} of {len(kept)}, false {false.sum()}{worst}; refused though within "
              f"{(~claims & (found <= accuracy)).sum()}; "
              f"claimed over true 1 ... 100 in {100 * np.mean((ratio >= 1) & (ratio <= 100)):.1f} %, median "
              f"{np.median(ratio):.2g}; "
              f"regret median {np.nanmedian(regret[claims]):.2f}, q95 {np.nanquantile(regret[claims], .95):.2f}")


def plan_rtol(plan):
    return next(one.rtol for one in plan.candidates if one.name == "taylor")


if __name__ == "__main__":
    main()
