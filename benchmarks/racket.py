"""The racket: error against closeness to the separatrix, polhode's closed form and methods beside other solvers.

    python benchmarks/racket.py              # --add: only the solvers without stored results; --draw: the picture alone

The homework's block (0.20, 0.40, 0.52) is thrown at omega = (e, 5, e) rad/s and followed for 200 s, for e from 1 to
1e-15. Truth: the closed form of tests/reference with mpmath at 110 digits, at 41 times. Every solver runs at the
tightest setting that its makers document or accept, symplectic in steps of 0.02 s. polhode's taylor, radau and
symplectic run in the separatrix variables u, v. Its rk45 and the other programs run in Euler's plain rates. heyoka runs
in both. A peer that is not installed is named as missing. Writes benchmarks/results/racket.json and
docs/pictures/racket.svg and .png.
"""

import json
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).parents[1]
sys.path[:0] = [str(ROOT / "tests/support"), str(ROOT / "tests/reference")]
from free_motion_reference import closed_form  # noqa: E402
from measures import attitude_error, rates_error  # noqa: E402
from mpmath import mp  # noqa: E402

import polhode as ph  # noqa: E402
from polhode._plot import style  # noqa: E402

BLOCK = (0.20, 0.40, 0.52)
TIMES = np.linspace(0, 200, 41)
CLOSENESS = 10.0 ** -np.arange(16)
IDENTITY = (0.0, 0.0, 0.0, 1.0)


def derivative(t, y):
    a, b, c, x, y_, z, w = y
    i, j, k = BLOCK
    return [(j - k) / i * b * c, (k - i) / j * c * a, (i - j) / k * a * b, (w * a + y_ * c - z * b) / 2,
            (w * b + z * a - x * c) / 2, (w * c + x * b - y_ * a) / 2, -(x * a + y_ * b + z * c) / 2]


def by_polhode(omega):
    return ph.FreeMotion(BLOCK, omega).at(TIMES)


def by_method(**settings):
    def solve(omega):
        motion = ph.solve(ph.Scene(inertia=BLOCK, omega=omega, times=TIMES), **settings)
        return motion.omega, motion.attitude
    return solve


def by_scipy(omega):
    from scipy.integrate import solve_ivp

    y = solve_ivp(derivative, (0, 200), [*omega, *IDENTITY], "DOP853", TIMES, rtol=2.3e-14, atol=1e-18).y.T
    return y[:, :3], y[:, 3:]


def by_heyoka(omega, _cache=[]):  # noqa: B006 one compiled integrator serves all starts
    import heyoka as hy

    if not _cache:
        variables = hy.make_vars("a", "b", "c", "x", "y", "z", "w")
        _cache.append(hy.taylor_adaptive(list(zip(variables, derivative(0, variables), strict=True)),
                                         [*omega, *IDENTITY], tol=2.3e-16))
    solver = _cache[0]
    solver.time, solver.state[:] = 0.0, [*omega, *IDENTITY]
    y = solver.propagate_grid(TIMES)[-1]
    return y[:, :3], y[:, 3:]


def by_heyoka_in_u_v(omega, _cache=[]):  # noqa: B006 one compiled integrator serves all starts
    """heyoka on the variables of polhode's taylor, radau and symplectic: docs/ode.md, "Variables"."""
    import heyoka as hy

    i, j, k = BLOCK
    scale = np.sqrt(i * (j - i) / (k * (k - j)))
    rate, middle = np.sqrt((j - i) * (k - j) / (i * k)), (k - i) / (4 * j * scale)
    if not _cache:
        u, b, v, x, y_, z, w = variables = hy.make_vars("u", "b", "v", "x", "y", "z", "w")
        a, c = (v - u) / (2 * scale), (u + v) / 2
        turns = derivative(0, (a, b, c, x, y_, z, w))[3:]
        equations = [rate * b * u, middle * (v - u) * (v + u), -rate * b * v, *turns]
        _cache.append(hy.taylor_adaptive(list(zip(variables, equations, strict=True)),
                                         [0.0, 1.0, 0.0, *IDENTITY], tol=2.3e-16))
    solver, (a, b, c) = _cache[0], omega
    solver.time, solver.state[:] = 0.0, [c - scale * a, b, c + scale * a, *IDENTITY]
    y = solver.propagate_grid(TIMES)[-1]
    return np.stack([(y[:, 2] - y[:, 0]) / (2 * scale), y[:, 1], (y[:, 0] + y[:, 2]) / 2], axis=1), y[:, 3:]


def by_ellipj(omega):
    """The textbook's closed form of the rates with SciPy's Jacobi functions (Landau & Lifshitz 1976, section 37)."""
    from scipy.special import ellipj, ellipkinc

    i, j, k = BLOCK
    a, b, c = omega
    momentum, energy = (i * a) ** 2 + (j * b) ** 2 + (k * c) ** 2, i * a * a + j * b * b + k * c * c
    if not momentum > energy * j:
        return None
    m = (j - i) * (energy * k - momentum) / ((k - j) * (momentum - energy * i))
    rate = np.sqrt((k - j) * (momentum - energy * i) / (i * j * k))
    amplitude = np.arctan2(b / np.sqrt((energy * k - momentum) / (j * (k - j))),
                           a / np.sqrt((energy * k - momentum) / (i * (k - i))))
    sn, cn, dn, _ = ellipj(rate * TIMES + ellipkinc(amplitude, m), m)
    return np.stack([np.sqrt((energy * k - momentum) / (i * (k - i))) * cn,
                     np.sqrt((energy * k - momentum) / (j * (k - j))) * sn,
                     np.sqrt((momentum - energy * i) / (k * (k - i))) * dn], axis=1), None


SOLVERS = {"polhode, closed form": by_polhode, "polhode, taylor": by_method(method="taylor", rtol=1e-16),
           "polhode, symplectic": by_method(method="symplectic", step=0.02),
           "polhode, radau": by_method(method="radau", rtol=1e-15),
           "polhode, rk45": by_method(method="rk45", rtol=1e-14), "SciPy DOP853": by_scipy, "heyoka, Taylor": by_heyoka,
           "heyoka, Taylor in u, v": by_heyoka_in_u_v, "textbook form, SciPy's ellipj": by_ellipj}


def measure(stored):
    """Measure the solvers that `stored` has no errors of."""
    results = {"closeness": list(CLOSENESS), "errors": {name: [] for name in SOLVERS}, "missing": []}
    for e in CLOSENESS:
        omega = (e, 5.0, e)
        with mp.workdps(110):
            exact = closed_form(BLOCK, omega, IDENTITY, TIMES)
            rates = np.array([[float(v) for v in w] for w, _ in exact])
            attitude = np.array([[float(v) for v in q] for _, q in exact])
        for name, solver in SOLVERS.items():
            if name in stored:
                continue
            try:
                answer = solver(omega)
            except ImportError as missing:
                if str(missing) not in results["missing"]:
                    results["missing"].append(str(missing))
                continue
            if answer is None:
                results["errors"][name].append(None)
                continue
            w, q = answer
            with np.errstate(all="ignore"):
                worst = rates_error(w, rates)
                if q is not None:
                    worst = max(worst, attitude_error(q / np.linalg.norm(q, axis=1)[:, None], attitude))
            results["errors"][name].append(float(worst) if np.isfinite(worst) else None)
        last = {name: errors[-1] if errors else None
                for name, errors in results["errors"].items() if name not in stored}
        print(f"{e:8.0e}", *(f"{name}: {'-' if error is None else f'{error:.1e}'}" for name, error in last.items()),
              sep="  ", flush=True)
    results["errors"] |= stored
    return results


COLOURS = {"polhode, closed form": style.colour("FreeMotion"), "polhode, taylor": style.colour("taylor"),
           "polhode, symplectic": style.colour("symplectic"), "polhode, radau": style.colour("radau"),
           "polhode, rk45": style.colour("rk45"),
           "SciPy DOP853": style.colour("SciPy DOP853"), "heyoka, Taylor": "#8c6bb1",
           "heyoka, Taylor in u, v": "#c51b8a", "textbook form, SciPy's ellipj": "#a6761d"}


def draw(results):
    folder = ROOT / "docs/pictures"
    with style.used() as plt:
        figure, axes = plt.subplots(figsize=(8.6, 5.0))
        figure.subplots_adjust(left=0.09, right=0.97, top=0.80, bottom=0.11)
        for name, errors in results["errors"].items():
            points = [(e, min(v, 3.2)) for e, v in zip(results["closeness"], errors, strict=False) if v is not None]
            if not points:
                continue
            ours = name == "polhode, closed form"
            axes.plot(*zip(*points, strict=True), color=COLOURS[name], marker="D" if ours else "o",
                      markersize=6 if ours else 4,
                      linewidth=2.4 if ours else 1.6, label=name, zorder=5 if ours else 3, markeredgecolor="white",
                      markeredgewidth=0.6)
        axes.set(xscale="log", yscale="log", xlim=(2, 5e-16), ylim=(2e-17, 30),
                 xlabel="closeness e to the separatrix: thrown at (e, 5, e) rad/s",
                 ylabel="error after up to 200 s")
        axes.axhline(np.pi, color=style.FLOOR, linewidth=0.8)
        axes.text(1.4, 4.5, "upside down", color=style.QUIET, fontsize=8.5)
        axes.legend(frameon=False, loc="upper right", bbox_to_anchor=(1.0, 0.88), fontsize=9)
        style.heading(figure, "The racket: the closed form and the separatrix variables u, v keep it",
                      "Block (0.20, 0.40, 0.52) kg m², error of rates and attitude against 110 digits; tightest "
                      "tolerances.\ntaylor, radau, symplectic (steps of 0.02 s) and one curve of heyoka run in u, v; "
                      "the other curves in Euler's plain rates.",
                      0.09)
        paths = style.save(figure, folder, "racket")
        plt.close(figure)
    return paths


if __name__ == "__main__":
    stored = ROOT / "benchmarks/results/racket.json"
    if "--draw" not in sys.argv:
        known = json.loads(stored.read_text())["errors"] if "--add" in sys.argv else {}
        stored.write_text(json.dumps(measure(known), indent=1) + "\n")
    print(*draw(json.loads(stored.read_text())), sep="\n")
