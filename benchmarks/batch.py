"""Random bodies in one call: solve_many's taylor and rk45 in lanes beside heyoka's batch mode and the loop, each with
its true error.

    python benchmarks/batch.py [-n 4096] [-o results.json]
    python benchmarks/batch.py --driven        # rk45 in lanes beside solve() body by body, for every torque

Free bodies: all integrate omega and attitude to 100 s on one core and are asked for the end alone. heyoka's integrator
is written with each body's ratios as parameters and takes its recommended number of bodies at once; bodies sorted by
|omega| fill its batches better (--sorted). Its compilation is not counted, nor is our reading of the result. Seconds
are CPU time, the least of interleaved repeats. A body's error is the larger of the attitude's angle and omega's
relative error, against the closed form (ph.free_motion).

Driven bodies: a step's nanoseconds are those of a body, in lanes and by solve() (which gives the same bits, and has its
own set-up and call from Python in it); errors of the median body and of all against taylor at 1e-15.
"""

import argparse
import json
import pathlib
import time

import numpy as np

import polhode as ph

SETTINGS = (1e-3, 1e-6, 1e-9, 1e-10, 1e-12, 3e-13, 1e-13, 1e-14, 2.3e-16)
RK45_SETTINGS = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9, 1e-11)
LEVELS = (1e-3, 1e-6, 1e-9, 1e-12)
TORQUES = {
    "free": [],
    "gravity": [ph.torques.Gravity(2, (0.3, 0.2, 0.5))],
    "gradient": [ph.torques.GravityGradient(0.3)],
    "damping": [ph.torques.Damping((0.01, 0.02, 0.03))],
    "thruster": [ph.torques.Constant((0.01, 0.02, 0.03))],
    "in space": [ph.torques.Constant((0.01, 0.02, 0.03), frame="space")],
}
TORQUES["sum of five"] = sum(TORQUES.values(), [])


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


def run_polhode(common, bodies, method, rtol):
    moments, spins, turns = bodies
    begin = time.process_time()   # the work is done by a thread of its own
    many = ph.solve_many(common, inertia=moments, omega=spins, attitude=turns, method=method, rtol=rtol, threads=1)
    return time.process_time() - begin, many


def run_loop(scenes, rtol):
    begin = time.process_time()
    for scene in scenes:
        ph.solve(scene, method="rk45", rtol=rtol)
    return time.process_time() - begin


def compare_driven(common, bodies, repeats, in_loop=256):
    print(f"rk45, {len(bodies[0])} bodies in lanes beside {in_loop} by solve(), {common.times[-1]:g} s; simd "
          f"{ph.build_info()['simd']}")
    for name, torques in TORQUES.items():
        for want in (("omega", "attitude"), ("omega",)) if name in ("free", "damping") else (("omega", "attitude"),):
            scene = common.replace(torques=torques, want=want)
            alone = [scene.replace(inertia=m, omega=w, attitude=q)
                     for m, w, q in zip(*(part[:in_loop] for part in bodies), strict=True)]
            _, truth = run_polhode(scene, bodies, "taylor", 1e-15)
            for rtol in (1e-4, 1e-8):
                runs, loops = [], []
                for _ in range(repeats):
                    runs.append(run_polhode(scene, bodies, "rk45", rtol))
                    loops.append(run_loop(alone, rtol))
                many = runs[-1][1]
                lane, loop = min(r[0] for r in runs) / len(bodies[0]), min(loops) / in_loop
                if "attitude" in want:
                    found = errors(many.omega[:, 0], many.attitude[:, 0], (truth.omega[:, 0], truth.attitude[:, 0]))
                else:
                    off = np.linalg.norm(many.omega - truth.omega, axis=-1)[:, 0]
                    found = off / np.linalg.norm(truth.omega, axis=-1)[:, 0]
                print(f"{name:12} {' '.join(want):15} rtol {rtol:g}: {many.steps.mean():6.0f} steps, lanes "
                      f"{lane * 1e6:8.2f} us a body, "
                      f"{lane / many.steps.mean() * 1e9:6.1f} ns a step; loop {loop * 1e6:8.2f} us, "
                      f"{loop / many.steps[:in_loop].mean() * 1e9:6.1f} ns; "
                      f"ratio {loop / lane * many.steps.mean() / many.steps[:in_loop].mean():.2f}; errors "
                      f"{np.median(found):.1e} {found.max():.1e}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-n", type=int, default=4096, help="bodies")
    parser.add_argument("--span", type=float, help="seconds of motion: 100, driven 20, where chaos has not yet begun")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--driven", action="store_true", help="rk45 in lanes beside solve(), for every torque")
    parser.add_argument("--sorted", action="store_true",
                        help="bodies by |omega|, which fills the peer's batches better")
    parser.add_argument("-o", "--output", help="write every point as JSON")
    options = parser.parse_args()
    options.span = options.span or (20.0 if options.driven else 100.0)
    bodies = make_bodies(options.n)
    if options.sorted:
        order = np.argsort(np.linalg.norm(bodies[1], axis=1))
        bodies = tuple(part[order] for part in bodies)
    moments, spins, turns = bodies
    truth = ph.free_motion(moments, spins, turns, options.span)
    common = ph.Scene(inertia=(1, 1.5, 2), omega=(0, 0, 1), times=(options.span,))
    if options.driven:
        return compare_driven(common, bodies, options.repeats)
    a, b, c = moments.T
    ratios, start = np.array([(b - c) / a, (c - a) / b, (a - b) / c]), np.concatenate([spins, turns], axis=1).T.copy()
    try:
        import heyoka  # noqa: F401
        peer = True
    except ImportError:
        print("heyoka is not installed: pip install heyoka")
        peer = False

    points, compiled, width = {"taylor": [], "rk45": [], "heyoka": []}, 0.0, 0
    print(f"{options.n} free bodies, {options.span:g} s; simd {ph.build_info()['simd']}; us per body, error of the "
          "median body, of 99 % and of all")
    for rtol in sorted({*SETTINGS, *RK45_SETTINGS}, reverse=True):
        methods = [m for m, settings in (("taylor", SETTINGS), ("rk45", RK45_SETTINGS)) if rtol in settings]
        beside = peer and rtol in SETTINGS
        if beside:
            solver, width, spent = make_heyoka(rtol)
            compiled += spent
        ours, theirs = {method: [] for method in methods}, []
        for _ in range(options.repeats):
            for method in methods:
                ours[method].append(run_polhode(common, bodies, method, rtol))
            if beside:
                theirs.append(run_heyoka(solver, width, ratios, start, options.span))
        results = {m: (runs, runs[-1][1].omega[:, 0], runs[-1][1].attitude[:, 0]) for m, runs in ours.items()}
        if beside:
            final = theirs[-1][1]
            results["heyoka"] = (theirs, final[:3].T, (final[3:] / np.linalg.norm(final[3:], axis=0)).T)
        for name, (runs, omega, attitude) in results.items():
            found = errors(omega, attitude, truth)
            point = {"rtol": rtol, "microseconds": min(r[0] for r in runs) / options.n * 1e6,
                     **{f"error_{p}": float(np.percentile(found, p)) for p in (50, 99, 100)}}
            if name in ours:
                point["steps"] = float(runs[-1][1].steps.mean())
            points[name].append(point)
            print(f"{name:8} rtol {rtol:7.1e}: {point['microseconds']:8.2f} us   {point['error_50']:.1e} "
                  f"{point['error_99']:.1e} {point['error_100']:.1e}",
                  flush=True)
    print(f"heyoka: batches of {width}, compiled in {compiled:.2f} s" if peer else "")
    for level in LEVELS:
        for share in (50, 99, 100):
            cheapest = {}
            for name, found in points.items():
                fit = [p["microseconds"] for p in found if p[f"error_{share}"] <= level]
                cheapest[name] = min(fit) if fit else None
            texts = [f"{name} {v:.1f} us" if v else f"{name} never" for name, v in cheapest.items()]
            best = min(cheapest[m] or np.inf for m in ("taylor", "rk45"))
            ratio = f", ratio {cheapest['heyoka'] / best:.2f}" if cheapest["heyoka"] and best < np.inf else ""
            print(f"error {level:g} for {share} % of the bodies: {', '.join(texts)}{ratio}")
    if options.output:
        pathlib.Path(options.output).write_text(json.dumps({"polhode": ph.build_info(), "points": points}, indent=1))


if __name__ == "__main__":
    main()
