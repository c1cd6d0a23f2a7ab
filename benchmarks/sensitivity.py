"""Derivatives of driven bodies: what seven columns cost beside the plain run and beside heyoka, and their errors.

    python benchmarks/sensitivity.py            # the table of docs/results/fit.md
    python benchmarks/sensitivity.py S5 --rounds 5

Every round runs the plain solution, the columns with it, and heyoka's `var_ode_sys` (order 1, seven variables) in turn,
each in CPU time of this thread; the smallest of the rounds counts. heyoka makes one run and states no error. polhode
makes the plain run, two runs of the columns, and states an error. With certify=False it makes one run of each. Errors
are those of the columns of omega(0), relative to their size, against tests/reference/driven_sensitivity.json.
"""

import argparse
import json
import pathlib
import time

import numpy as np

import polhode as ph
from polhode.charts.equations import derivatives

SCENES = {"S5": ("omega", "attitude", "gravity.weight"), "S6": ("omega", "attitude", "gravity_gradient.mean_motion"),
          "S7": ("omega", "attitude", "damping.matrix"), "S9": ("omega", "attitude", "constant.torque")}
ACCURACIES = (1e-9, 1e-12)
CASES = json.loads((pathlib.Path(__file__).parents[1] / "tests" / "reference" / "driven_sensitivity.json").read_text())


def clock(work):
    start = time.thread_time_ns()
    found = work()
    return time.thread_time_ns() - start, found


def make_heyoka(scene, tolerance, real):
    """A function that gives states and their derivatives at the start and at the scene's times; None without heyoka."""
    try:
        import heyoka as hy
    except ImportError:
        return None
    names = hy.make_vars("a", "b", "c", "x", "y", "z", "s")
    found = derivatives(scene, hy.time, names, hy.cos, hy.sin)
    system = [(name, value if isinstance(value, hy.expression) else hy.expression(float(value)))
              for name, value in zip(names, found)]
    start = np.concatenate([scene.omega, scene.attitude]).astype(real)
    variational = hy.var_ode_sys(system, hy.var_args.vars, order=1)
    solver = hy.taylor_adaptive(variational, start, time=real(scene.t0), tol=real(tolerance), fp_type=real)
    whole = solver.state.copy()
    grid = np.unique(np.concatenate([[scene.t0], scene.times])).astype(real)

    def run():
        solver.time, solver.state[:] = real(scene.t0), whole
        return solver.propagate_grid(grid)[-1]

    return run


def to_columns(rows):
    """d omega and the small rotation in space axes by omega(0), (n, 6, 3), from heyoka's rows."""
    q = rows[:, 3:7]
    D = rows[:, 7:].reshape(-1, 7, 7)
    back = np.stack([-q[:, 0], -q[:, 1], -q[:, 2], q[:, 3]], axis=1)
    turns = []
    for k in range(3):
        a, b = D[:, 3:, k], back   # 2 dq conj(q)
        v = a[:, 3:] * b[:, :3] + b[:, 3:] * a[:, :3] + np.cross(a[:, :3], b[:, :3])
        turns.append(2 * v)
    return np.concatenate([D[:, :3, :3], np.stack(turns, axis=2)], axis=1)


def measure_error(found, truth, scale):
    def size(columns):
        return np.maximum(np.linalg.norm(columns[:, :3], axis=1) / scale, np.linalg.norm(columns[:, 3:], axis=1))
    return float((size(found - truth) / size(truth)).max())


def measure(name, rounds):
    scene, groups, case = ph.Scene.load(name), SCENES[name], CASES.get(name)
    for accuracy in ACCURACIES:
        theirs = make_heyoka(scene, accuracy, float)
        best = np.full(4, np.inf)
        for _ in range(rounds):
            plain, _ = clock(lambda: ph.solve(scene, accuracy))
            own, motion = clock(lambda: ph.solve(scene, accuracy, sensitivity=groups))
            one, _ = clock(lambda: ph.solve(scene, accuracy, certify=False, sensitivity=groups))
            other = clock(theirs)[0] if theirs else np.inf
            best = np.minimum(best, [plain, own, other, one])
        errors = ["-", "-", "-"]
        if case is not None:
            at = scene.replace(times=case["times"])
            s = ph.solve(at, accuracy, sensitivity="omega").sensitivity
            truth = np.moveaxis(np.array([case["columns"][f"omega_{c}"] for c in "xyz"]), 0, 2)
            scale = np.linalg.norm(s.omega, axis=1).max()
            columns = np.concatenate([s.d_omega, s.d_attitude], axis=1)
            errors = [f"{measure_error(columns, truth, scale):.0e}", f"{s.error.max():.0e}", "-"]
            if theirs:
                rows = make_heyoka(at, accuracy, float)()
                errors[2] = f"{measure_error(to_columns(rows)[-len(truth):], truth, scale):.0e}"
        count = len(motion.sensitivity.columns)
        print(f"| {name} | {accuracy:.0e} | {count} | {best[0] / 1e6:.2f} | {best[1] / 1e6:.2f} | "
              f"{best[1] / best[0]:.1f} | {errors[0]} | {errors[1]} | {best[3] / 1e6:.2f} | "
              f"{best[2] / 1e6:.2f} | {errors[2]} | {best[2] / best[1]:.1f} | {best[2] / best[3]:.1f} |", flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=list(SCENES))
    parser.add_argument("--rounds", type=int, default=7)
    given = parser.parse_args()
    for scene_name in given.scenes:
        measure(scene_name, given.rounds)
