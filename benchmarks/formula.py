"""Torques as formulas, beside the torques of the list, heyoka and a Python callback, in one run.

    python benchmarks/formula.py [-o results.json] [--repeats 15]

Four scenes: S5 and S6, whose formulas are not recognised (`recognise=False`), a controller with tanh, and drag. Each
side runs at its cheapest setting whose true error meets the row, whatever the setting means to it. Times are the
thread's CPU time of a call from Python, all samples included: the median of interleaved repeats. heyoka's run is its
`propagate_grid` alone; its compilation is told apart, once without its caches and once from its cache in memory. The
making of a formula is told apart too. Errors are against stored truth. Without heyoka its columns are left out.
"""

import argparse
import json
import pathlib
import sys
import time

import numpy as np

ROOT = pathlib.Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests/support"))
from bodies import scene as stored_scene  # noqa: E402
from measures import error, truth  # noqa: E402

import polhode as ph  # noqa: E402
from polhode.torques import Custom, Formula  # noqa: E402

LEVELS = (1e-3, 1e-6, 1e-9, 1e-12)
SETTINGS = 10.0 ** -np.arange(1, 16.5, 0.5)
MOTIONS = json.loads((ROOT / "tests/reference/formula_motion.json").read_text())
S5_MOMENT, S6_RATE, S6_INERTIA = (0.6, 0.4, 1.0), 1e-3, (20.0, 40.0, 52.0)


def to_body(q, v):
    """R^T v by components, for numbers of any kind."""
    x, y, z, w = q
    rows = ((1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
            (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
            (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)))
    return [sum(entry * part for entry, part in zip(row, v, strict=True) if not isinstance(part, float) or part)
            for row in rows]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


# Each law is written once, by components: m has the functions, and `see` is R^T v.
def heavy(m, see, t, w, q):
    return [-part for part in cross(S5_MOMENT, see(q, (0.0, 0.0, 1.0)))]


def gradient(m, see, t, w, q):
    u = see(q, (m.cos(S6_RATE * t), m.sin(S6_RATE * t), 0.0))
    return [3 * S6_RATE**2 * part for part in cross(u, [I * part for I, part in zip(S6_INERTIA, u, strict=True)])]


def saturated(m, see, t, w, q):
    return [0.3 * m.tanh((-0.7 * q[i] * q[3] - 0.5 * w[i]) / 0.3) for i in range(3)]


def drag(m, see, t, w, q):
    speed = m.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
    return [-0.08 * speed * w[i] for i in range(3)]


def make_formula(law):
    def function(t, omega, attitude, p):
        return np.stack(law(np, ph.formula.to_body, t, omega, attitude))

    return Formula(function, recognise=False)


def make_case(name, law):
    """The scene without its torques, its truth, and the torque of the list that the law is."""
    if name in ("S5", "S6"):
        one = stored_scene(name)
        return one.replace(torques=[]), truth(name), list(one.torques)
    found = next(case for case in MOTIONS["cases"] if case["law"] == name and case["inertia"][0][1] == 0)
    q = np.array(MOTIONS["start"]["attitude"])
    rows = np.array(found["rows"], float)
    forward = np.array(MOTIONS["times"]) > 0
    one = ph.Scene(inertia=np.diag(found["inertia"]), omega=MOTIONS["start"]["omega"], attitude=q / np.linalg.norm(q),
                   times=np.array(MOTIONS["times"])[forward])
    return one, {"omega": rows[forward, :3], "attitude": rows[forward, 3:]}, None


def make_heyoka(one, law):
    """heyoka's adaptive integrator of a law: how it is made for a tolerance, and how it runs."""
    import heyoka as hy

    *w, x, y, z, s = hy.make_vars("w1", "w2", "w3", "x", "y", "z", "w")
    q = (x, y, z, s)
    I = [float(I) for I in np.diag(one.inertia.matrix)]
    tau = law(hy, to_body, hy.time, w, q)
    turn = [s * w[0] + y * w[2] - z * w[1], s * w[1] + z * w[0] - x * w[2], s * w[2] + x * w[1] - y * w[0],
            -(x * w[0] + y * w[1] + z * w[2])]
    rates = [((I[(i + 1) % 3] - I[(i + 2) % 3]) * w[(i + 1) % 3] * w[(i + 2) % 3] + tau[i]) / I[i] for i in range(3)]
    system = list(zip([*w, *q], [*rates, *(0.5 * part for part in turn)], strict=True))
    start = [*map(float, one.omega), *map(float, one.attitude)]
    times = np.concatenate([[0.0], one.times]) if one.times[0] > 0 else np.array(one.times)
    skip = len(times) - len(one.times)

    def make(tolerance):
        return hy.taylor_adaptive(system, start, tol=max(float(tolerance), 2.3e-16))

    def run(integrator):
        integrator.time = 0.0
        integrator.state[:] = start
        return integrator.propagate_grid(times)[-1][skip:]

    return make, run


def forget_code():
    """heyoka compiles the next integrator: its cache in memory is cleared, and that on the disk is off."""
    import heyoka as hy

    hy.llvm_state.set_diskcache_enabled(False)
    hy.llvm_state.clear_memcache()


def timed(call):
    begin = time.thread_time()
    result = call()
    return time.thread_time() - begin, result


def split(result):
    if not isinstance(result, np.ndarray):
        return result.omega, result.attitude
    return result[:, :3], result[:, 3:] / np.linalg.norm(result[:, 3:], axis=1)[:, None]


def find_cheapest(points, level):
    good = [point for point in points if point["error"] <= level]
    return min(good, key=lambda point: point["median"]) if good else None


def measure(name, law, repeats, peer):
    """Every setting of every side: medians and quartiles [us], and true errors. Then what each side makes once."""
    bare, reference, known = make_case(name, law)
    runs = {"formula": make_solve(bare, [make_formula(law)])}
    if known is not None:
        runs["built-in"] = make_solve(bare, known)
    once = {"formula made": find_median(lambda: make_formula(law), repeats)}
    if peer:
        make, run = make_heyoka(bare, law)
    points = {}
    for setting in SETTINGS:
        calls = {side: (lambda solve=solve, setting=setting: solve(setting)) for side, solve in runs.items()}
        if peer:
            integrator = make(setting)
            calls["heyoka"] = lambda integrator=integrator: run(integrator)
        times, results = {side: [] for side in calls}, {}
        for _ in range(repeats):
            for side, call in calls.items():
                seconds, results[side] = timed(call)
                times[side].append(seconds * 1e6)
        for side, result in results.items():
            low, median, high = map(float, np.percentile(times[side], (25, 50, 75)))
            points.setdefault(side, []).append({"setting": float(setting), "low": low, "median": median, "high": high,
                                                "error": error(*split(result), reference, bare.omega)})
    if peer:
        forget_code()
        once["heyoka compiled"] = timed(lambda: make(1e-9))[0] * 1e6
        once["heyoka cached"] = find_median(lambda: make(1e-9), repeats)
    return {"scene": name, "points": points, "once": once}


def make_solve(bare, torques):
    one = bare.replace(torques=torques)
    return lambda setting: ph.solve(one, method="taylor", rtol=setting)


def find_median(call, repeats):
    return float(np.median([timed(call)[0] for _ in range(repeats)])) * 1e6


def show(found):
    """Lines of a scene: at each level each side's time, its setting and its true error."""
    for level in LEVELS:
        best = {side: find_cheapest(points, level) for side, points in found["points"].items()}
        parts = [f"{side} {point['median']:.0f} us ({point['setting']:.0e}, {point['error']:.0e})" if point
                 else f"{side} never" for side, point in best.items()]
        ratios = [f"{best['formula']['median'] / point['median']:.2f} of {side}" for side, point in best.items()
                  if point and side != "formula" and best["formula"]]
        yield f"{found['scene']:10}{level:6.0e}  {', '.join(parts)}; {', '.join(ratios)}"
    yield f"{found['scene']:10}once    {', '.join(f'{what} {us:.0f} us' for what, us in found['once'].items())}"


def measure_callback(repeats):
    """S5 by dop853 with a lean Python function."""
    bare, reference, _ = make_case("S5", heavy)
    a, b, c = S5_MOMENT

    def lean(t, omega, attitude):
        x, y, z, w = attitude
        u, v, s = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
        return (c * v - b * s, a * s - c * u, b * u - a * v)

    one = bare.replace(torques=[Custom(lean)])
    points = []
    for setting in SETTINGS[:25:2]:
        times = []
        for _ in range(repeats):
            seconds, motion = timed(lambda setting=setting: ph.solve(one, method="dop853", rtol=setting))
            times.append(seconds * 1e6)
        points.append({"setting": float(setting), "median": float(np.median(times)),
                       "error": error(motion.omega, motion.attitude, reference, bare.omega)})
    return points


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", help="write every number as JSON")
    parser.add_argument("--repeats", type=int, default=15)
    options = parser.parse_args()
    peer = None
    try:
        import heyoka
        peer = heyoka.__version__
        forget_code()
    except ImportError:
        print("heyoka is not installed: pip install heyoka")
    info = ph.build_info()
    print(f"polhode {info['version']}, simd {info['simd']}, heyoka {peer or 'not installed'}")
    print("CPU time of the cheapest setting that meets the error (setting, true error); ratios of the formula's time")
    scenes = []
    for law, name in ((heavy, "S5"), (gradient, "S6"), (saturated, "saturated"), (drag, "drag")):
        scenes.append(measure(name, law, options.repeats, bool(peer)))
        print(*show(scenes[-1]), sep="\n", flush=True)
    callback = measure_callback(max(3, options.repeats // 3))
    for level in LEVELS:
        slow, quick = find_cheapest(callback, level), find_cheapest(scenes[0]["points"]["formula"], level)
        if slow and quick:
            print(f"S5 {level:.0e}: dop853 with a Python callback {slow['median']:.0f} us ({slow['error']:.0e}), "
                  f"{slow['median'] / quick['median']:.0f} times the formula's")
    if options.output:
        pathlib.Path(options.output).write_text(
            json.dumps({"polhode": info, "heyoka": peer, "scenes": scenes, "callback": callback}, indent=1))


if __name__ == "__main__":
    main()
