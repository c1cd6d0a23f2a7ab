"""taylor beside heyoka's Taylor integrator, each at its cheapest setting whose true error meets the row, in one run.

    python benchmarks/taylor.py [-o results.json] [SCENE ...]

Times are the thread's CPU time, the least of interleaved repeats, all samples included; heyoka's compilation is not
counted and printed. The true error is against the stored truth of the scenes (docs/reference_scenes.md).
"""

import argparse
import json
import pathlib
import sys
import time

import numpy as np

ROOT = pathlib.Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests/support"))
from bodies import PARTS, scene  # noqa: E402
from measures import error, truth  # noqa: E402

import polhode as ph  # noqa: E402

LEVELS = (1e-3, 1e-6, 1e-9, 1e-12)
SETTINGS = 10.0 ** -np.arange(1, 16.25, 0.25)


def make_heyoka(name):
    """heyoka's integrator as a user writes it, by tolerance, and the seconds of compiling one."""
    import heyoka as hy

    w1, w2, w3, x, y, z, w = hy.make_vars("w1", "w2", "w3", "x", "y", "z", "w")
    parts = PARTS[name]
    a, b, c = (float(v) for v in parts["inertia"])
    tau = [0.0, 0.0, 0.0]
    for torque in parts.get("torques", ()):
        kind = type(torque).__name__
        if kind == "Gravity":
            g = (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))
            m = [torque.weight * v for v in torque.arm]
            tau = [-(m[1] * g[2] - m[2] * g[1]), -(m[2] * g[0] - m[0] * g[2]), -(m[0] * g[1] - m[1] * g[0])]
        elif kind == "GravityGradient":
            n = torque.mean_motion
            ct, st = hy.cos(n * hy.time), hy.sin(n * hy.time)
            u = (ct * (1 - 2 * (y * y + z * z)) + st * 2 * (x * y + w * z),
                 ct * 2 * (x * y - w * z) + st * (1 - 2 * (x * x + z * z)),
                 ct * 2 * (x * z + w * y) + st * 2 * (y * z - w * x))
            tau = [3 * n * n * (c - b) * u[1] * u[2], 3 * n * n * (a - c) * u[2] * u[0],
                   3 * n * n * (b - a) * u[0] * u[1]]
        elif kind == "Constant":
            tau = list(torque.torque)
        elif kind == "Damping":
            d = np.diag(torque.matrix)
            tau = [-d[0] * w1, -d[1] * w2, -d[2] * w3]
    system = [(w1, ((b - c) * w2 * w3 + tau[0]) / a), (w2, ((c - a) * w3 * w1 + tau[1]) / b),
              (w3, ((a - b) * w1 * w2 + tau[2]) / c),
              (x, 0.5 * (w * w1 + y * w3 - z * w2)), (y, 0.5 * (w * w2 + z * w1 - x * w3)),
              (z, 0.5 * (w * w3 + x * w2 - y * w1)), (w, -0.5 * (x * w1 + y * w2 + z * w3))]
    start = [*(float(v) for v in parts["omega"]), *(float(v) for v in parts.get("attitude", (0, 0, 0, 1)))]

    def make(tolerance):
        begin = time.perf_counter()
        integrator = hy.taylor_adaptive(system, start, tol=float(tolerance))
        return integrator, time.perf_counter() - begin

    def run(integrator):
        integrator.time = 0.0
        integrator.state[:] = start
        begin = time.thread_time()
        result = integrator.propagate_grid(np.asarray(parts["times"], float))
        seconds = time.thread_time() - begin
        states = result[-1]
        q = states[:, 3:]
        return seconds, states[:, :3], q / np.linalg.norm(q, axis=1)[:, None]

    return make, run


def run_polhode(one, rtol):
    begin = time.thread_time()
    motion = ph.solve(one, method="taylor", rtol=rtol)
    seconds = time.thread_time() - begin
    return seconds, motion.omega, motion.attitude, motion.stats["seconds"]


def cheapest(points, level, key="seconds"):
    fit = [p[key] for p in points if p["error"] <= level]
    return min(fit) if fit else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=[])
    parser.add_argument("-o", "--output", help="write every point as JSON")
    options = parser.parse_args()
    try:
        import heyoka  # noqa: F401
        peer = True
    except ImportError:
        print("heyoka is not installed: pip install heyoka")
        peer = False
    results = {"polhode": ph.build_info(), "scenes": {}}
    print(f"{'scene':6}{'error':>8}{'taylor, Python call':>22}{'in C++':>12}{'heyoka':>12}{'ratio':>8}   (compiled in "
          "s)")
    for name in options.scenes or PARTS:
        one, reference = scene(name), truth(name)
        points = {"taylor": [], "heyoka": []}
        compiled = 0.0
        make, run = make_heyoka(name) if peer else (None, None)
        for tolerance in SETTINGS:
            integrator = None
            if peer:
                integrator, spent = make(max(tolerance, 2.3e-16))
                compiled = max(compiled, spent)
            ours, theirs = [], []
            begin = time.perf_counter()
            while len(ours) < 15 and (len(ours) < 3 or time.perf_counter() - begin < 0.3):
                ours.append(run_polhode(one, tolerance))
                if integrator is not None:
                    theirs.append(run(integrator))
            points["taylor"].append({"rtol": float(tolerance), "seconds": min(r[0] for r in ours),
                                     "inside": min(r[3] for r in ours),
                                     "error": error(ours[-1][1], ours[-1][2], reference)})
            if theirs:
                points["heyoka"].append({"rtol": float(tolerance), "seconds": min(r[0] for r in theirs),
                                         "error": error(theirs[-1][1], theirs[-1][2], reference)})
        results["scenes"][name] = points
        for level in LEVELS:
            a, c, b = cheapest(points["taylor"], level), cheapest(points["taylor"], level,
                                                                  "inside"), cheapest(points["heyoka"], level)
            texts = [f"{v * 1e6:.0f} us" if v else "never" for v in (a, c, b)]
            ratio = f"{b / c:.2f}" if b and c else "-"
            print(f"{name:6}{level:8.0e}{texts[0]:>22}{texts[1]:>12}{texts[2]:>12}{ratio:>8}   ({compiled:.2f})",
                  flush=True)
    if options.output:
        pathlib.Path(options.output).write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
