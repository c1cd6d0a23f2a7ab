"""Torques on orbits beside heyoka, a million bodies, and Basilisk's orbit with a gravity gradient, in one run.

    python benchmarks/worlds.py [-o results.json] [--repeats 7] [--bodies 1000000] [--basilisk PYTHON]

Six scenes: gravity gradient on orbits of e = 0.1, 0.73 and 0.97, on a hyperbola, of two bodies, and a magnet whose
orbit crosses the pole of a dipole. heyoka has position and velocity as states beside the rates and the attitude, in
units in which the periapsis, the speed there and the first rate are 1, so that its one norm weighs all alike. Each side
runs at its cheapest setting whose true error is at most 1e-9, with 501 samples. Times are the thread's CPU time of a
call from Python: the median of interleaved repeats, without heyoka's compilation. The truth is heyoka in long double.

`--basilisk` names an interpreter that has Basilisk (`pip install bsk`): basilisk_orbit.py runs there.
"""

import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

import formula
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests/support"))
from measures import error  # noqa: E402

import polhode as ph  # noqa: E402

LEVEL, SAMPLES = 1e-9, 501
SETTINGS = 10.0 ** -np.arange(5, 15)
EARTH = 3.986004418e14
BOX = (20.0, 40.0, 52.0)


def orbit(e, periapsis=7e6, mu=EARTH, **more):
    return ph.Orbit.from_elements(mu, periapsis_distance=periapsis, e=e, inclination=0.9, node=0.3, periapsis=0.8,
                                  **more)


def scenes():
    """Name, orbits, rates, span [s], and the magnet of those that have one."""
    yield "e = 0.1", [orbit(0.1)], (2e-3, 4e-3, 6e-3), 5.8e4, None
    yield "e = 0.73", [orbit(0.73)], (1e-3, 2e-3, 3e-3), 8.7e4, None
    yield "e = 0.97", [orbit(0.97)], (1e-3, 2e-3, 3e-3), 2e5, None
    yield "hyperbola", [orbit(4.2, 3.8e7, anomaly=-1.6)], (2e-5, 1e-5, 6e-5), 6e5, None
    second = ph.Orbit(4.9e12, r0=(3e7, 1e7, 5e6), v0=(-200.0, 400.0, 100.0))
    yield "two bodies", [orbit(0.3), second], (2e-3, 4e-3, 6e-3), 3e4, None
    polar = ph.Orbit.from_elements(EARTH, a=7e6, inclination=np.pi / 2)
    yield "dipole", [polar], (2e-3, 4e-3, 6e-3), 5.8e4, (0.3, -0.2, 0.5)


def make_scene(orbits, omega, span, moment):
    torques = [ph.torques.GravityGradient(orbit=one) for one in orbits]
    if moment:
        torques.append(ph.torques.Dipole(moment, ph.MagneticField.dipole(orbits[0], 7.9e15, tilt=np.pi)))
    return ph.Scene(inertia=BOX, omega=omega, attitude=(0.1, -0.1, 0.7, 0.7), torques=torques,
                    times=np.linspace(0, span, SAMPLES))


def make_heyoka(orbits, omega, span, moment, real):
    """How an integrator is made for a tolerance, and how it runs."""
    import heyoka as hy

    names = [f"{part}{k}{axis}" for k in range(len(orbits)) for part in "rv" for axis in "xyz"]
    *w, x, y, z, s = hy.make_vars("w1", "w2", "w3", "x", "y", "z", "w")
    moved = hy.make_vars(*names)
    q, I = (x, y, z, s), [real(part) for part in BOX]
    unit = real(1) / real(np.linalg.norm(omega))                     # of time [s]
    tau, rows, start = [real(0)] * 3, [], []
    for k, one in enumerate(orbits):
        r, v = (np.asarray(part, real) for part in one.at(0.0))
        far = real(one.periapsis_distance)
        fast = np.sqrt(real(one.mu) * (1 + real(one.e)) / far)       # the speed there
        mu, turn = real(one.mu) / (far * fast**2), fast * unit / far
        own_r, own_v = moved[6 * k:6 * k + 3], moved[6 * k + 3:6 * k + 6]
        d2 = own_r[0] * own_r[0] + own_r[1] * own_r[1] + own_r[2] * own_r[2]
        pull = d2**real(-1.5)
        rows += [(a, turn * b) for a, b in zip(own_r, own_v)]
        rows += [(b, -turn * mu * a * pull) for a, b in zip(own_r, own_v)]
        start += [*(r / far), *(v / fast)]
        u = formula.to_body(q, own_r)
        strength = 3 * real(one.mu) * unit**2 / far**3 * d2**real(-2.5)
        pulled = formula.cross(u, [moment_ * part for moment_, part in zip(I, u)])
        tau = [old + strength * part for old, part in zip(tau, pulled)]
        if moment and k == 0:   # m = -z: B = k / r^3 (3 (m.u) u - m)
            field = real(7.9e15) * unit**2 / far**3
            B = [field * (-3 * own_r[2] * a * d2**real(-2.5) - (-pull if i == 2 else 0)) for i, a in enumerate(own_r)]
            turned = formula.cross([real(m) for m in moment], formula.to_body(q, B))
            tau = [old + part for old, part in zip(tau, turned)]
    turned = [s * w[0] + y * w[2] - z * w[1], s * w[1] + z * w[0] - x * w[2], s * w[2] + x * w[1] - y * w[0],
              -(x * w[0] + y * w[1] + z * w[2])]
    rates = [((I[(i + 1) % 3] - I[(i + 2) % 3]) * w[(i + 1) % 3] * w[(i + 2) % 3] + tau[i]) / I[i] for i in range(3)]
    system = [*zip([*w, *q], [*rates, *(real(0.5) * part for part in turned)]), *rows]
    start = np.array([*(real(part) * unit for part in omega), 0.1, -0.1, 0.7, 0.7, *start], real)
    start[3:7] /= np.sqrt(np.sum(start[3:7] ** 2))
    times = np.linspace(0, span, SAMPLES).astype(real) / unit

    def make(tolerance):
        return hy.taylor_adaptive(system, start, tol=real(tolerance), fp_type=real)

    def run(integrator):
        integrator.time = real(0)
        integrator.state[:] = start
        rows = integrator.propagate_grid(times)[-1]
        return rows[:, :3] / unit, rows[:, 3:7] / np.linalg.norm(rows[:, 3:7].astype(float), axis=1)[:, None]

    return make, run


def measure(name, orbits, omega, span, moment, repeats):
    scene = make_scene(orbits, omega, span, moment)
    fine, run_fine = make_heyoka(orbits, omega, span, moment, np.longdouble)
    exact = [part.astype(float) for part in run_fine(fine(1e-18))]
    truth = {"omega": exact[0], "attitude": exact[1]}
    make, run = make_heyoka(orbits, omega, span, moment, float)
    points = {"polhode": [], "heyoka": []}
    for setting in SETTINGS:
        integrator = make(max(setting, 2.3e-16))
        calls = {"polhode": lambda s=setting: ph.solve(scene, method="taylor", rtol=s),
                 "heyoka": lambda: run(integrator)}
        times, results = {side: [] for side in calls}, {}
        for _ in range(repeats):
            for side, call in calls.items():
                seconds, results[side] = formula.timed(call)
                times[side].append(seconds * 1e6)
        for side, result in results.items():
            states = result if isinstance(result, tuple) else (result.omega, result.attitude)
            points[side].append({"setting": float(setting), "median": float(np.median(times[side])),
                                 "error": error(*states, truth, scene.omega)})
    best = {side: formula.find_cheapest(rows, LEVEL) for side, rows in points.items()}
    return {"scene": name, "points": points, "best": best}


def show(found):
    parts = [f"{side} {point['median']:.0f} us (error {point['error']:.0e})" if point else f"{side} never"
             for side, point in found["best"].items()]
    both = all(found["best"].values())
    ratio = found["best"]["polhode"]["median"] / found["best"]["heyoka"]["median"] if both else None
    print(f"{found['scene']:12}{', '.join(parts)}" + (f": {ratio:.2f}" if both else ""), flush=True)
    return ratio


RECIPE = """name = "gradient"
count = {count}
seed = 8
draw = "by-body"
[body]
moments = [20.0, 40.0, 52.0]
moments_relative = {{ normal = [0.0, 0.02] }}
[start]
omega = {{ normal = [[0.002, 0.004, 0.006], 0.0005] }}
[[torques]]
kind = "gravity_gradient"
mean_motion = 1.1e-3
[times]
span = 5600.0
samples = 11
[solve]
method = "taylor"
rtol = 1e-9
[[summary]]
of = "omega"
"""


def run_many(count, folder):
    path = pathlib.Path(folder) / "gradient.toml"
    path.write_text(RECIPE.format(count=count))
    before, cpu = time.time(), time.process_time()
    done = ph.ensemble(str(path), executor=0)
    found = {"bodies": count, "seconds": time.time() - before, "cpu": time.process_time() - cpu,
             "memory": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024, "failed": done.counts["failed"]}
    rows = done.states(range(8))
    worst = max(np.abs(rows.omega[i] - ph.solve(done.scene(i), accuracy=1e-12).omega).max() for i in range(8))
    print(f"{count} bodies through one orbit: {found['seconds']:.0f} s, {found['cpu']:.0f} s of CPU, "
          f"{found['memory'] / 1e6:.0f} MB, {found['failed']} failed; eight bodies off by {worst:.0e} rad/s",
          flush=True)
    return found


def run_basilisk(python):
    script = pathlib.Path(__file__).with_name("basilisk_orbit.py")
    done = subprocess.run([python, str(script)], capture_output=True, text=True, check=False)
    if done.returncode:
        print(f"Basilisk did not run: {done.stderr.strip().splitlines()[-1]}")
        return None
    theirs = json.loads(done.stdout.strip().splitlines()[-1])
    scene = ph.Scene(inertia=(500, 800, 350), omega=(0, 0, 0), times=theirs["times"],
                     attitude=ph.Rotation.from_mrp((0.1, 0.2, -0.3)),
                     torques=[ph.torques.GravityGradient(orbit=ph.Orbit(theirs["mu"], theirs["r"], theirs["v"]))])
    exact = ph.solve(scene, accuracy=1e-13)
    truth = {"omega": exact.omega, "attitude": exact.attitude}

    def point(setting):
        found = [formula.timed(lambda: ph.solve(scene, method="taylor", rtol=setting)) for _ in range(5)]
        motion = found[0][1]
        return {"setting": setting, "median": float(np.median([one[0] for one in found])),
                "error": error(motion.omega, motion.attitude, truth, exact.omega[-1])}

    points, rows = [point(setting) for setting in SETTINGS], []
    for run in theirs["runs"]:
        turns = ph.Rotation.from_mrp(run["sigma"])
        off = error(np.array(run["omega"]), turns.as_quat(), truth, exact.omega[-1])
        own = formula.find_cheapest(points, max(off, 1e-12))
        rows.append({key: run[key] for key in ("step", "integrator", "seconds")} | {"error": off, "own": own})
        print(f"Basilisk {theirs['version']} {run['integrator']} step {run['step']} s: {run['seconds']:.3f} s, error "
              f"{off:.0e}; polhode {own['median']:.1e} s, error {own['error']:.0e}: "
              f"{run['seconds'] / own['median']:.0f} times")
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", help="write every number as JSON")
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--bodies", type=int, default=1_000_000)
    parser.add_argument("--basilisk", help="an interpreter that has Basilisk")
    options = parser.parse_args()
    import heyoka

    print(f"polhode {ph.build_info()['version']}, heyoka {heyoka.__version__}: cheapest setting within {LEVEL:g}")
    found, ratios = [], []
    for one in scenes():
        found.append(measure(*one, options.repeats))
        ratios += [ratio for ratio in [show(found[-1])] if ratio is not None]
    print(f"median ratio {np.median(ratios):.2f} of {len(ratios)} scenes")
    with tempfile.TemporaryDirectory() as folder:
        many = run_many(options.bodies, folder) if options.bodies else None
    theirs = run_basilisk(options.basilisk) if options.basilisk else None
    if options.output:
        content = {"scenes": found, "many": many, "basilisk": theirs}
        pathlib.Path(options.output).write_text(json.dumps(content, indent=1))


if __name__ == "__main__":
    main()
