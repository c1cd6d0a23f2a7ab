"""Derivatives of free motions and fits to made measurements: speed with its error, and how often a fit finds the truth.

    python benchmarks/fit.py              # all bars, some minutes on one core
    python benchmarks/fit.py --trials 20  # fewer trials

Times are CPU time of this thread. Each fit starts from nothing, with a seed that the truth does not share.
"""

import argparse
import json
import os
import subprocess
import sys
import time

import fit_cases as cases
import numpy as np
from timing import best

import polhode as ph

BLOCK = (0.20, 0.40, 0.52)


def random_body(rng):
    half = rng.uniform(0.1, 1, 3) ** 2
    q = rng.normal(size=4)
    return half.sum() - half, rng.normal(size=3), q / np.linalg.norm(q)


def speed():
    """ns a state: one body at many times, and many bodies at one time each."""
    rng = np.random.default_rng(1)
    n = 65536  # so that the call itself is little
    t, start = rng.uniform(1, 1000, n), (0.0, 0.0, 0.0, 1.0)
    out = (np.empty((n, 3)), np.empty((n, 4)), np.empty((n, 3, 6)), np.empty((n, 3, 6)))
    cost = {}
    for name, omega in (("one body, any times", (1, 2, 3)), ("near the separatrix, any times", (1e-4, 5, 1e-4))):
        cost[name] = best(lambda w=omega: ph.free_sensitivity(BLOCK, w, start, t, out=out, threads=1)) / n
    cost["free_motion, one body, any times"] = best(
        lambda: ph.free_motion(BLOCK, (1, 2, 3), start, t, out=out[:2], threads=1)) / n
    many = 20_000
    bodies = [random_body(rng) for _ in range(many)]
    moments, omega, q = (np.array(part) for part in zip(*bodies, strict=True))
    t = rng.uniform(1, 1000, many)
    out = tuple(np.empty((many, *a.shape[1:])) for a in out)
    cost["many bodies, a time each"] = best(
        lambda: ph.free_sensitivity(moments, omega, q, t, out=out, threads=1), 7) / many
    cost["free_motion, the same bodies"] = best(
        lambda: ph.free_motion(moments, omega, q, t, out=out[:2], threads=1), 7) / many
    return {"level": ph.build_info()["simd"], "cost": cost}


def measure(motion, t, kind, sigma, rng):
    omega, q = motion.at(t)
    noise = sigma * rng.normal(size=(t.size, 3))
    if kind == "rates":
        return ph.measured.Rates(t, omega + noise, sigma)
    if kind == "attitudes":
        return ph.measured.Attitudes(t, ph.Rotation.from_quat(q) * ph.Rotation.from_rotvec(noise), sigma)
    return ph.measured.Axis(t, ph.Rotation.from_quat(q).as_matrix()[:, :, 2] + noise, sigma, (0, 0, 1))


def trial(kind, noise, seed):
    """(found, CPU seconds): found means that chi2 fits and every moment is within 6 standard errors, up to twins."""
    rng = np.random.default_rng([17, seed])
    inertia, omega, q = random_body(rng)
    motion = ph.FreeMotion(inertia, omega, q)
    fast = np.linalg.norm(omega)
    if kind == "rates":
        data = measure(motion, np.linspace(0, 4 * motion.period, 200), kind, noise * fast, rng)
        groups = ("omega", "inertia")
    else:
        turns, count = (20, 50) if kind == "attitudes" else (10, 80)
        data = measure(motion, np.sort(rng.uniform(0, turns * 2 * np.pi / fast, count)), kind, noise, rng)
        groups = ("omega", "attitude", "inertia")
    start = time.thread_time()
    found = ph.fit(data, fit=groups, seed=seed)
    spent = time.thread_time() - start
    P = 0.5 * inertia.sum() - inertia
    here = [found.parameters.index(name) for name in ("log_p1_p3", "log_p2_p3")]
    twins = [P] if kind != "axis" else [P, P[[1, 0, 2]]]
    sigma = np.maximum(found.stderr[here], 1e-9)
    near = min(np.abs((found.x[here] - np.log(p[:2] / p[2])) / sigma).max() for p in twins)
    return bool(found.success and near < 6), spent


SELF, OTHER = [[0, 1, 2]], [[0, 1, 2], [1, 0, 2]]     # which axes of a body may be exchanged
BARS = {
    "50 attitudes, 60 to 300 turns": (cases.attitudes, (50, (60, 300)), SELF),
    "20 attitudes, 60 to 300 turns": (cases.attitudes, (20, (60, 300)), SELF),
    "50 attitudes, 1000 to 3000 turns": (cases.attitudes, (50, (1000, 3000)), SELF),
    "one axis, 80 samples, 60 to 300 turns": (cases.axis, (80, (60, 300)), OTHER),
    "one axis, 80 samples, 10 to 20 turns": (cases.axis, (80, (10, 20)), OTHER),
    "one direction, 80 samples, 60 to 300 turns": (cases.direction, (80, (60, 300)), SELF),
    "light of an ellipsoid, 300 samples, 8 to 15 turns": (cases.light, (300, (8, 15)), SELF),
    "rates, 60 samples on an even grid, 20 to 40 periods": (cases.rates, (60, (20, 40), True), SELF),
    "rates, 60 samples at random, 20 to 40 periods": (cases.rates, (60, (20, 40), False), SELF),
}


def bar(name, number, seed):
    """(found, wrong, CPU seconds): found means a success with the body among its candidates.

    Wrong is a success whose only candidate is another body. The body of a light curve is the minimum that a fit reaches
    from the truth, for 5 % of noise leave the moments uncertain.
    """
    make, arguments, twins = BARS[name]
    data, inertia, omega, q = make(np.random.default_rng([seed, number]), *arguments)
    groups = ("omega", "inertia") if make is cases.rates else ("omega", "attitude", "inertia")
    start = time.thread_time()
    found = ph.fit(data, fit=groups)
    spent = time.thread_time() - start
    if make is cases.light:
        best = cases.minimum_of(data, inertia, omega, q)
        inertia, omega = best.inertia, best.omega
    near = min(cases.distance(one, inertia, omega, twins) for one in found.candidates)
    good = bool(found.success and near < cases.NEAR)
    return good, bool(found.success and not good and len(found.candidates) == 1), spent


def bars(trials, seed, names=tuple(BARS)):
    wrong = count = 0
    for name in names:
        results = [bar(name, number, seed) for number in range(trials)]
        good, bad, spent = (list(part) for part in zip(*results, strict=True))
        wrong, count = wrong + sum(bad), count + trials
        print(f"{name}: {sum(good)} of {trials} found, {np.median(spent):.2f} s in the median, "
              f"{max(spent):.1f} s at most; lost: {[k for k in range(trials) if not good[k]]}", flush=True)
    print(f"wrong with success and no other candidate: {wrong} of {count}")


def rivals(trials, seed, name="20 attitudes, 60 to 300 turns"):
    """Found by SciPy's least_squares from random bodies in the time of polhode's fit, with the same residuals."""
    from scipy.optimize import least_squares

    make, arguments, twins = BARS[name]
    won = 0
    for number in range(trials):
        rng = np.random.default_rng([seed, number])
        data, inertia, omega, _ = make(rng, *arguments)
        start = time.thread_time()
        best = ph.fit(data)
        spent = time.thread_time() - start
        start, lowest = time.thread_time(), None
        while time.thread_time() - start < spent:
            half, rate, q = rng.uniform(0.1, 1, 3) ** 2, rng.normal(size=3), rng.normal(size=4)
            scene = ph.Scene(inertia=tuple(half.sum() - half), omega=tuple(2 * rate / np.linalg.norm(rate)), attitude=q,
                             times=data.t)
            problem = cases.problem_of(data, scene)
            here = least_squares(problem.fun, np.zeros(8), problem.jac, method="lm", max_nfev=100)
            lowest = here.cost if lowest is None else min(lowest, here.cost)
        won += lowest is not None and 2 * lowest <= 1.5 * best.chi2
    print(f"{name}: least_squares from random starts, at equal time: {won} of {trials} found")


def coverage(trials):
    """The share of 95 % intervals that hold the truth, least and most over the parameters."""
    inertia, omega = np.array([0.3, 0.5, 0.62]), np.array([1.0, -2.0, 0.7])
    q = np.array([0.5, -0.1, 0.7, 0.5])
    span = 3 * 2 * np.pi / np.linalg.norm(omega)
    t = np.linspace(0, span, 60)
    P = 0.5 * inertia.sum() - inertia
    truth = np.concatenate([omega, np.log(P[:2] / P[2])])
    scene = ph.Scene(inertia=tuple(inertia), omega=tuple(omega), attitude=q, times=t)
    rows = {}
    for kind, sigma, groups in (("rates", 0.006, ("omega", "inertia")), ("rates", 0.06, ("omega", "inertia")),
                                ("attitudes", 0.003, ("omega", "inertia", "attitude")),
                                ("attitudes", 0.03, ("omega", "inertia", "attitude")),
                                ("attitudes", 0.15, ("omega", "inertia", "attitude"))):
        rng = np.random.default_rng([5, len(rows)])
        hits = []
        for _ in range(trials):
            found = ph.fit(measure(ph.FreeMotion(inertia, omega, q), t, kind, sigma, rng), scene, fit=groups,
                           start="scene")
            inside = np.abs(found.x[:5] - truth) <= 1.96 * found.stderr[:5]
            if "attitude" in groups:
                off = (found.attitude * ph.Rotation.from_quat(q).inv()).as_rotvec()
                inside = np.concatenate([inside, np.abs(off) <= 1.96 * found.stderr[5:8]])
            hits.append(inside)
        share = 100 * np.mean(hits, axis=0)
        rows[f"{kind}, noise {sigma:g}"] = (share.min(), share.max())
    return rows


def local_fit():
    rng = np.random.default_rng(3)
    inertia, omega = np.array([0.3, 0.5, 0.6]), np.array([1.0, 2.0, 0.5])
    t = np.linspace(0, 10, 400)
    data = ph.measured.Rates(t, ph.FreeMotion(inertia, omega).at(t)[0] + 0.01 * rng.normal(size=(400, 3)), 0.01)
    scene = ph.Scene(inertia=tuple(inertia * (1, 1.03, 0.98)), omega=tuple(omega + 0.02), times=t)
    return best(lambda: ph.fit(data, scene, fit=("omega", "inertia"), start="scene"), 60) / 1e6


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=100)
    parser.add_argument("--speed", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--bars", action="store_true", help="only the bars of sparse data and light curves")
    parser.add_argument("--seed", type=int, default=91, help="of the bars")
    options = parser.parse_args()
    if options.bars:
        bars(options.trials, options.seed)
        return rivals(min(options.trials, 20), options.seed)
    if options.speed:
        return print(json.dumps(speed()))
    print(f"load {os.getloadavg()[0]:.1f}; ns a state with all 36 derivatives")
    for level in ("avx512", "avx2"):
        run = subprocess.run([sys.executable, __file__, "--speed"], capture_output=True, text=True,
                             env={**os.environ, "POLHODE_SIMD": level})
        if run.returncode:
            continue
        found = json.loads(run.stdout)
        for name, cost in found["cost"].items():
            print(f"  {found['level']:8} {name:36} {cost:8.1f}")
    print(f"one local fit of 400 gyro samples: {local_fit():.2f} ms")
    for kind, noise in (("rates", 0.01), ("rates", 0.03), ("rates", 0.1), ("attitudes", 0.01), ("axis", 0.01)):
        results = [trial(kind, noise, seed) for seed in range(options.trials)]
        spent = [s for _, s in results]
        print(f"{kind}, noise {noise:g}: {sum(good for good, _ in results)} of {len(results)} found, "
              f"{np.median(spent):.3f} s in the median, {max(spent):.2f} s at most; "
              f"lost: {[seed for seed, (good, _) in enumerate(results) if not good]}", flush=True)
    bars(options.trials, options.seed)
    rivals(min(options.trials, 20), options.seed)
    for name, (least, most) in coverage(2 * options.trials).items():
        print(f"coverage of 95 % intervals, {name}: {least:.1f} to {most:.1f} %")


if __name__ == "__main__":
    main()
