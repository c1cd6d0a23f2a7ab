"""The closed forms beside heyoka and SciPy's DOP853 on S1 to S4, each with its error, in one run.

    python benchmarks/exact_peers.py [-o results.json]

polhode: the call from Python with the set-up included. heyoka: its best error (tolerance 2.3e-16), compilation not
counted but printed. SciPy: DOP853 at rtol 2.3e-14 with a right-hand side in plain floats, its best. Times are medians
of interleaved repeats of the thread's CPU time, all samples included; SciPy runs once. Orekit's TorqueFree (S1 to S3)
runs in a JVM of its own where java and the package orekit-jpype are there (its jars alone are used): the least of 500
runs by the clock.
"""

import argparse
import importlib.util
import json
import pathlib
import shutil
import statistics
import subprocess
import sys
import time

import numpy as np

ROOT = pathlib.Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests/support"))
from bodies import PARTS, TILTED  # noqa: E402
from measures import error, truth  # noqa: E402

import polhode as ph  # noqa: E402


def by_polhode(name, times):
    parts = PARTS[name]
    if name == "S4":
        return ph.HeavyTop(parts["inertia"], 2.0, parts["omega"], TILTED).at(times)
    return ph.FreeMotion(parts["inertia"], parts["omega"]).at(times)


def derivative(name, y):
    i, j, k = PARTS[name]["inertia"]
    a, b, c, x, y_, z, w = y
    weight = 2.0 if name == "S4" else 0.0
    return [((j - k) * b * c + weight * 2 * (y_ * z + w * x)) / i,
            ((k - i) * c * a - weight * 2 * (x * z - w * y_)) / j,
            (i - j) / k * a * b, (w * a + y_ * c - z * b) / 2, (w * b + z * a - x * c) / 2,
            (w * c + x * b - y_ * a) / 2,
            -(x * a + y_ * b + z * c) / 2]


def start(name):
    return [*map(float, PARTS[name]["omega"]), *PARTS[name].get("attitude", (0.0, 0.0, 0.0, 1.0))]


def make_heyoka(name):
    import heyoka as hy

    variables = hy.make_vars("a", "b", "c", "x", "y", "z", "w")
    begin = time.perf_counter()
    solver = hy.taylor_adaptive(list(zip(variables, derivative(name, variables), strict=True)), start(name),
                                tol=2.3e-16)
    print(f"{name}: heyoka compiled in {time.perf_counter() - begin:.2f} s", flush=True)

    def run(times):
        solver.time, solver.state[:] = 0.0, start(name)
        y = solver.propagate_grid(times)[-1]
        return y[:, :3], y[:, 3:] / np.linalg.norm(y[:, 3:], axis=1)[:, None]

    return run


def by_scipy(name, times):
    from scipy.integrate import solve_ivp

    y = solve_ivp(lambda t, y: derivative(name, y), (0, times[-1]), start(name), "DOP853", times, rtol=2.3e-14,
                  atol=1e-16).y.T
    return y[:, :3], y[:, 3:] / np.linalg.norm(y[:, 3:], axis=1)[:, None]


def by_orekit(name, times):
    """Seconds of one run and its answer, or None."""
    package = importlib.util.find_spec("orekit_jpype")
    if package is None or shutil.which("java") is None or name == "S4":
        return None
    jars = pathlib.Path(package.origin).parent / "jars/*"
    numbers = [*PARTS[name]["inertia"], *PARTS[name]["omega"], times[-1], times.size]
    source = pathlib.Path(__file__).parent / "peers/OrekitTorqueFree.java"
    run = subprocess.run(["java", "-cp", str(jars), str(source), *map(str, numbers)], capture_output=True, text=True)
    if run.returncode:
        return print(f"{name}: Orekit failed: {run.stderr.strip().splitlines()[-1]}")
    nanoseconds, *rows = run.stdout.splitlines()
    y = np.array([row.split() for row in rows], dtype=float)
    return float(nanoseconds) * 1e-9, (y[:, :3], y[:, 3:])


def clock(run, times, least=2e-3):
    """Seconds of one run, the mean of as many in a row as take `least` seconds: nobody starts with another's cache."""
    answer, count = run(times), 0
    begin = now = time.thread_time()
    while count == 0 or now - begin < least:
        answer, count = run(times), count + 1
        now = time.thread_time()
    return (now - begin) / count, answer


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output")
    options = parser.parse_args()
    results = {"simd": ph.build_info()["simd"], "scenes": {}}
    for name in ("S1", "S2", "S3", "S4"):
        reference = truth(name)
        times = reference["t"]
        runs = {"polhode": lambda t, name=name: by_polhode(name, t)}
        try:
            runs["heyoka"] = make_heyoka(name)
        except ImportError:
            print("heyoka: missing")
        seconds = {label: [] for label in runs}
        answers = {}
        for _ in range(25):
            for label, run in runs.items():
                took, answers[label] = clock(run, times)
                seconds[label].append(took)
        begin = time.thread_time()
        answers["SciPy DOP853"] = by_scipy(name, times)
        seconds["SciPy DOP853"] = [time.thread_time() - begin]
        if found := by_orekit(name, times):
            seconds["Orekit TorqueFree"], answers["Orekit TorqueFree"] = [found[0]], found[1]
        ours = statistics.median(seconds["polhode"])
        results["scenes"][name] = {}
        for label, answer in answers.items():
            middle = statistics.median(seconds[label])
            point = {"seconds": middle, "per_state": middle / times.size, "error": error(*answer, reference),
                     "ratio": middle / ours}
            results["scenes"][name][label] = point
            print(f"{name}  {label:18}{middle * 1e6:12.1f} us  {point['per_state'] * 1e9:10.1f} ns a state  error "
                  f"{point['error']:.1e}"
                  f"  x{point['ratio']:.0f}", flush=True)
    if options.output:
        pathlib.Path(options.output).write_text(json.dumps(results, indent=1) + "\n")


if __name__ == "__main__":
    main()
