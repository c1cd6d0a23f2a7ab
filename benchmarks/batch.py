"""Random free bodies in one call, solve_many's taylor beside heyoka's batch mode, each with its true error.

    python benchmarks/batch.py [-n 4096] [-o results.json]

Both integrate omega and attitude to 100 s on one core and are asked for the end alone. heyoka's integrator is written with
each body's ratios as parameters and takes its recommended number of bodies at once; bodies sorted by |omega| fill its batches
better (--sorted). Its compilation is not counted, nor is our reading of the result. Seconds are CPU time, the least of interleaved
repeats. A body's error is the larger of the attitude's angle and omega's relative error, against the closed form (ph.free_motion).
"""

import argparse
import json
import pathlib
import time

import numpy as np

import polhode as ph

SETTINGS = (1e-9, 1e-10, 1e-12, 3e-13, 1e-13, 1e-14, 2.3e-16)
LEVELS = (1e-9, 1e-12)


def make_bodies(n, seed=1):
    rng = np.random.default_rng(seed)
    half = rng.uniform(0.1, 1, (n, 3)) ** 2
    moments = half.sum(axis=1, keepdims=True) - half
    turns = rng.normal(size=(n, 4))
    return moments, rng.normal(size=(n, 3)), turns / np.linalg.norm(turns, axis=1)[:, None]


def errors(omega, attitude, truth):
    rates = np.linalg.norm(omega - truth[0], axis=1) / np.linalg.norm(truth[0], axis=1)
    distance = np.minimum(np.linalg.norm(attitude - truth[1], axis=1), np.linalg.norm(attitude + truth[1], axis=1))
    return np.maximum(rates, 4 * np.arcsin(np.minimum(1, distance / 2)))


def make_heyoka(tolerance):
    """The integrator of one batch, and the seconds of its compilation."""
    import heyoka as hy

    begin = time.perf_counter()
    w1, w2, w3, x, y, z, w = hy.make_vars("w1", "w2", "w3", "x", "y", "z", "w")
    system = [(w1, hy.par[0] * w2 * w3), (w2, hy.par[1] * w3 * w1), (w3, hy.par[2] * w1 * w2),
              (x, 0.5 * (w * w1 + y * w3 - z * w2)), (y, 0.5 * (w * w2 + z * w1 - x * w3)),
              (z, 0.5 * (w * w3 + x * w2 - y * w1)), (w, -0.5 * (x * w1 + y * w2 + z * w3))]
    width = hy.recommended_simd_size()
    solver = hy.taylor_adaptive_batch(system, np.ones((7, width)), tol=tolerance, pars=np.ones((3, width)))
    return solver, width, time.perf_counter() - begin


def run_heyoka(solver, width, ratios, start, span):
    n = ratios.shape[1]
    final = np.empty((7, n))
    begin = time.thread_time()
    for first in range(0, n, width):
        now = slice(first, first + width)
        solver.set_time(0.0)
        solver.state[:], solver.pars[:] = start[:, now], ratios[:, now]
        solver.propagate_until(span)
        final[:, now] = solver.state
    return time.thread_time() - begin, final


def run_polhode(common, bodies, rtol):
    moments, spins, turns = bodies
    begin = time.process_time()   # the work is done by a thread of its own
    many = ph.solve_many(common, inertia=moments, omega=spins, attitude=turns, method="taylor", rtol=rtol, threads=1)
    return time.process_time() - begin, many


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-n", type=int, default=4096, help="bodies")
    parser.add_argument("--span", type=float, default=100.0, help="seconds of motion")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--sorted", action="store_true", help="bodies by |omega|, which fills the peer's batches better")
    parser.add_argument("-o", "--output", help="write every point as JSON")
    options = parser.parse_args()
    bodies = make_bodies(options.n)
    if options.sorted:
        order = np.argsort(np.linalg.norm(bodies[1], axis=1))
        bodies = tuple(part[order] for part in bodies)
    moments, spins, turns = bodies
    truth = ph.free_motion(moments, spins, turns, options.span)
    common = ph.Scene(inertia=(1, 1.5, 2), omega=(0, 0, 1), times=(options.span,))
    a, b, c = moments.T
    ratios, start = np.array([(b - c) / a, (c - a) / b, (a - b) / c]), np.concatenate([spins, turns], axis=1).T.copy()
    try:
        import heyoka  # noqa: F401
        peer = True
    except ImportError:
        print("heyoka is not installed: pip install heyoka")
        peer = False

    points, compiled, width = {"polhode": [], "heyoka": []}, 0.0, 0
    print(f"{options.n} free bodies, {options.span:g} s; simd {ph.build_info()['simd']}; us per body, error of the median body, of 99 % and of all")
    for rtol in SETTINGS:
        if peer:
            solver, width, spent = make_heyoka(rtol)
            compiled += spent
        ours, theirs = [], []
        for _ in range(options.repeats):
            ours.append(run_polhode(common, bodies, rtol))
            if peer:
                theirs.append(run_heyoka(solver, width, ratios, start, options.span))
        many = ours[-1][1]
        results = {"polhode": (ours, many.omega[:, 0], many.attitude[:, 0])}
        if peer:
            final = theirs[-1][1]
            results["heyoka"] = (theirs, final[:3].T, (final[3:] / np.linalg.norm(final[3:], axis=0)).T)
        for name, (runs, omega, attitude) in results.items():
            found = errors(omega, attitude, truth)
            point = {"rtol": rtol, "microseconds": min(r[0] for r in runs) / options.n * 1e6,
                     **{f"error_{p}": float(np.percentile(found, p)) for p in (50, 99, 100)}}
            if name == "polhode":
                point["steps"] = float(many.steps.mean())
            points[name].append(point)
            print(f"{name:8} rtol {rtol:7.1e}: {point['microseconds']:8.2f} us   {point['error_50']:.1e} {point['error_99']:.1e} {point['error_100']:.1e}",
                  flush=True)
    print(f"heyoka: batches of {width}, compiled in {compiled:.2f} s" if peer else "")
    for level in LEVELS:
        for share in (50, 99, 100):
            cheapest = {}
            for name, found in points.items():
                fit = [p["microseconds"] for p in found if p[f"error_{share}"] <= level]
                cheapest[name] = min(fit) if fit else None
            texts = [f"{name} {v:.1f} us" if v else f"{name} never" for name, v in cheapest.items()]
            ratio = f", ratio {cheapest['heyoka'] / cheapest['polhode']:.2f}" if all(cheapest.values()) else ""
            print(f"error {level:g} for {share} % of the bodies: {', '.join(texts)}{ratio}")
    if options.output:
        pathlib.Path(options.output).write_text(json.dumps({"polhode": ph.build_info(), "points": points}, indent=1))


if __name__ == "__main__":
    main()
