"""rk45 beside SciPy's RK45 and Boost.Odeint's runge_kutta_dopri5 at equal error, in one run.

    python benchmarks/rk45.py [-o results.json]

Each peer's tolerances are swept; a time is the median of interleaved repeats of the thread's CPU time, all samples
included. "Equal error" reads each peer's time off its own line through its points (log time against log error).
Boost is compiled with the flags polhode's own wheel has (-O3, no -march), and once more with -march=native.
"""

import argparse
import ctypes
import json
import pathlib
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

ROOT = pathlib.Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests/support"))
from bodies import PARTS, scene  # noqa: E402
from measures import error, truth  # noqa: E402

import polhode as ph  # noqa: E402

SCENES = {"S1": (0, (0, 0, 0, 0)), "S4": (1, (2, 0, 0, 1)), "S5": (1, (2, 0.3, 0.2, 0.5)), "S6": (2, (1e-3, 0, 0, 0)),
          "S9": (4, (0.01, -0.02, 0.03, 0))}
SCIPY = {"S1": (1e-5, 1e-6), "S4": (1e-5, 1e-7), "S5": (1e-5, 1e-7, 1e-9), "S6": (1e-5, 1e-6), "S9": (1e-5, 1e-7)}
OURS = 10.0 ** -np.arange(3, 13)


def build_odeint(flags):
    """The shared library with Boost's solver, or None where there is no compiler or no Boost."""
    if shutil.which("g++") is None or not pathlib.Path("/usr/include/boost/numeric/odeint.hpp").exists():
        return None
    path = pathlib.Path(tempfile.mkdtemp()) / "odeint.so"
    source = ROOT / "benchmarks/peers/odeint.cpp"
    subprocess.run(["g++", "-O3", *flags, "-std=c++20", "-shared", "-fPIC", "-w", str(source), "-o", str(path)],
                   check=True)
    library = ctypes.CDLL(str(path))
    library.run_odeint.restype = ctypes.c_double
    return library


def array(values):
    values = np.ascontiguousarray(values, float)
    return values, values.ctypes.data_as(ctypes.c_void_p)


def run_odeint(library, name, rtol):
    kind, parameters = SCENES[name]
    parts = PARTS[name]
    times = parts["times"]
    out = np.empty((times.size, 7))
    keep = [array(v) for v in (parts["inertia"], parameters, [*parts["omega"], *parts.get("attitude", (0, 0, 0, 1))],
                               times)]
    seconds = library.run_odeint(kind, keep[0][1], keep[1][1], keep[2][1], keep[3][1], ctypes.c_long(times.size),
                                 ctypes.c_double(rtol), out.ctypes.data_as(ctypes.c_void_p))
    return seconds, out[:, :3], out[:, 3:]


def run_polhode(one, rtol):
    begin = time.thread_time()
    motion = ph.solve(one, rtol=rtol)
    return time.thread_time() - begin, motion.omega, motion.attitude


def derivative(name):
    """The right-hand side as a Python user writes it with NumPy."""
    kind, p = SCENES[name]
    inertia = np.array(PARTS[name]["inertia"], float)
    torque = np.array(p[:3], float)

    def matrix(q):
        x, y, z, w = q / np.sqrt(q @ q)
        return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])

    def f(t, state):
        omega, q = state[:3], state[3:]
        tau = np.zeros(3)
        if kind == 1:
            tau = np.cross(p[1:], -p[0] * matrix(q)[2])
        elif kind == 2:
            u = np.array([np.cos(p[0] * t), np.sin(p[0] * t), 0]) @ matrix(q)
            tau = 3 * p[0] ** 2 * np.cross(u, inertia * u)
        elif kind == 4:
            tau = torque
        rates = (tau - np.cross(omega, inertia * omega)) / inertia
        x, y, z, w = q
        a, b, c = 0.5 * omega
        return np.array([*rates, w * a + y * c - z * b, w * b + z * a - x * c, w * c + x * b - y * a,
                         -(x * a + y * b + z * c)])

    return f


def run_scipy(name, rtol):
    from scipy.integrate import solve_ivp

    parts = PARTS[name]
    start = np.array([*parts["omega"], *parts.get("attitude", (0, 0, 0, 1))], float)
    begin = time.thread_time()
    solution = solve_ivp(derivative(name), (0, parts["times"][-1]), start, method="RK45", t_eval=parts["times"],
                         rtol=rtol,
                         atol=rtol * 1e-3)
    seconds = time.thread_time() - begin
    q = solution.y[3:].T
    return seconds, solution.y[:3].T, q / np.linalg.norm(q, axis=1)[:, None]


def time_at(points, level):
    """Time at an error, on the line through the two points next to it (log-log)."""
    x = np.log([p["error"] for p in points])
    y = np.log([p["seconds"] for p in points])
    order = np.argsort(x)
    x, y = x[order], y[order]
    k = int(np.clip(np.searchsorted(x, np.log(level)) - 1, 0, len(x) - 2))
    return float(np.exp(y[k] + (y[k + 1] - y[k]) * (np.log(level) - x[k]) / (x[k + 1] - x[k])))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", help="write every point as JSON")
    parser.add_argument("--no-scipy", action="store_true")
    options = parser.parse_args()
    libraries = {"odeint": build_odeint([]), "odeint native": build_odeint(["-march=native"])}
    results = {"machine": platform.processor() or platform.machine(), "polhode": ph.build_info(), "scenes": {}}
    heads = "".join(f"{head:>12}{'ratio':>8}" for head in ("odeint", "native", "SciPy"))
    print(f"{'scene':6}{'error':>10}{'polhode':>12}{heads}")
    for name in SCENES:
        one, reference = scene(name), truth(name)
        runs = {"polhode": lambda rtol, one=one: run_polhode(one, rtol)}
        for label, library in libraries.items():
            if library is not None:
                runs[label] = lambda rtol, library=library, name=name: run_odeint(library, name, rtol)
        points = {label: [] for label in runs}
        for rtol in OURS:
            repeats = {label: [] for label in runs}
            total = 0.0
            for _ in range(15):   # interleaved, so that a busy moment hits all alike
                for label, run in runs.items():
                    seconds, omega, attitude = run(rtol)
                    repeats[label].append((seconds, omega, attitude))
                    total += seconds
                if total > 6:
                    break
            for label, all_runs in repeats.items():
                points[label].append({"rtol": rtol, "seconds": statistics.median(r[0] for r in all_runs),
                                      "error": error(all_runs[-1][1], all_runs[-1][2], reference)})
        if not options.no_scipy:
            points["scipy"] = []
            for rtol in SCIPY[name]:
                seconds, omega, attitude = run_scipy(name, rtol)
                points["scipy"].append({"rtol": rtol, "seconds": seconds, "error": error(omega, attitude, reference)})
        results["scenes"][name] = points
        levels = [p["error"] for p in points.get("scipy", [])] or [1e-3, 1e-6]
        for level in sorted({*levels, 1e-3, 1e-6, 1e-9}, reverse=True):
            ours = time_at(points["polhode"], level)
            row = f"{name:6}{level:10.1e}{ours * 1e6:9.0f} us"
            for label in ("odeint", "odeint native", "scipy"):
                known = label in points and (label != "scipy" or level in levels)
                theirs = time_at(points[label], level) if known else 0.0
                row += f"{theirs * 1e6:9.0f} us{theirs / ours:8.2f}" if known else f"{'-':>12}{'-':>8}"
            print(row, flush=True)
    if options.output:
        pathlib.Path(options.output).write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
