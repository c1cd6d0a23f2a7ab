"""The carried error judged on scenes drawn anew: heavy, driven and orbiting bodies, truth from the long double series.

    python benchmarks/planner/carried.py [--seed 77] [--count 600]

Prints how many bounds are false, the worst ratio of error to bound, how often the error is beyond what was asked, and
the quantiles of bound over error. Errors of omega are relative to the largest rate of the start and the samples.
"""

import argparse
import time

import numpy as np

import polhode as ph
from polhode import _core


def direction(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def draw(rng):
    """A box of some scale, one to fifty revolutions, 1 to 60 samples at random times."""
    half = rng.uniform(0.1, 1, 3)
    moments = (np.sum(half**2) - half**2) / 3 * 10 ** rng.uniform(-1, 1)
    rate = 10 ** rng.uniform(-1, 1)
    omega = rate * direction(rng)
    attitude = rng.normal(size=4)
    size = np.linalg.norm(moments * omega) * rate
    weight = size * 10 ** rng.uniform(-2, 1) * direction(rng)
    thrust = size * 10 ** rng.uniform(-3, -0.5) * direction(rng)
    torques = [[ph.torques.Gravity(1.0, weight)], [ph.torques.Constant(thrust, frame="space")],
               [ph.torques.GravityGradient(rate * 10 ** rng.uniform(-2, -0.3))],
               [ph.torques.Gravity(1.0, weight), ph.torques.Constant(thrust)]][rng.integers(4)]
    span = 2 * np.pi * 10 ** rng.uniform(0, 1.7) / rate
    times = np.sort(rng.uniform(0, span, int(rng.choice([1, 2, 5, 20, 60]))))
    return ph.Scene(inertia=moments, omega=omega, attitude=attitude / np.linalg.norm(attitude), torques=torques,
                    times=times)


def measure(scene, motion):
    omega, attitude, _ = _core.reference(scene, 24, 1e-20, 400_000)
    rates = np.linalg.norm(motion.omega - omega, axis=1).max() / motion.omega_scale
    apart = np.minimum(np.linalg.norm(motion.attitude - attitude, axis=1),
                       np.linalg.norm(motion.attitude + attitude, axis=1))
    return max(rates, (4 * np.arcsin(apart / 2)).max())


def judge(seed, count):
    """Return bound over error and accuracy over error of each claim, the refusals, and the seconds of solve."""
    rng = np.random.default_rng(seed)
    bounds, asked, refused, seconds = [], [], 0, 0.0
    while len(bounds) < count:
        scene, accuracy = draw(rng), 10 ** rng.uniform(-10, -3)
        begin = time.process_time()
        motion = ph.solve(scene, accuracy, method="taylor")
        seconds += time.process_time() - begin
        if motion.error_kind != "bounded":
            refused += 1
            continue
        error = max(measure(scene, motion), 1e-300)
        bounds.append(motion.error / error)
        asked.append(accuracy / error)
    return np.array(bounds), np.array(asked), refused, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=77)
    parser.add_argument("--count", type=int, default=600)
    chosen = parser.parse_args()
    bounds, asked, refused, seconds = judge(chosen.seed, chosen.count)
    low, middle, high = np.percentile(bounds, [2.5, 50, 97.5])
    print(f"{chosen.count} claims, {refused} refused, {seconds:.2f} s of solve: {np.sum(bounds < 1)} bounds false, the "
          f"worst by {1 / bounds.min():.2f}; {np.sum(asked < 1)} errors beyond what was asked; bound over error: "
          f"2.5 % {low:.1f}, median {middle:.1f}, 97.5 % {high:.1f}")


if __name__ == "__main__":
    main()
