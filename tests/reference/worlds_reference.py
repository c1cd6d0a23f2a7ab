"""Make the stored truth of S13 and S15: ``python tests/reference/worlds_reference.py [S13 ...] [--floors]``.

``world_momentum.cpp`` and ``world_rates.cpp`` run each scene in 113 bits. They share the reader and the walk from
switch to switch, and neither their equations nor their methods nor their orbits. Writes the scene's npz, and its
numbers in agreement.json and floors.json. Needs g++ with libquadmath, and nothing of polhode.
"""

import argparse
import concurrent.futures
import json
import pathlib
import subprocess
import tempfile
import time
import tomllib

import mpmath
import numpy as np
from make_references import SCENES, STORED, disagreement, quaternion_of, sample_times, text
from mpmath import mp, mpf

HERE = pathlib.Path(__file__).parent
mp.dps = 40
STAGES = 12
# Longest steps of the two routes [s], and the tolerance of the first.
STEPS = {"S13": (600.0, 600.0, 1e-28), "S15": (0.25, 0.25, 1e-30)}
HALF_ULP = mpf(2) ** -53
MOVED = mpf(10) ** -8   # the part of an input by which it moves for the floors


def orbit_numbers(orbit):
    """mu, q, e, the angles, the mean anomaly at time 0, position and velocity there."""
    mu, e = mpf(orbit["mu"]), mpf(orbit.get("e", 0.0))
    q = mpf(orbit["periapsis_distance"]) if "periapsis_distance" in orbit else mpf(orbit["a"]) * (1 - e)
    angles = [mpf(orbit.get(name, 0.0)) for name in ("inclination", "node", "periapsis", "anomaly")]
    a = q / abs(1 - e)
    n = mpmath.sqrt(mu / a**3)
    half = mpmath.sqrt(abs(1 - e) / (1 + e)) * mpmath.tan(angles[3] / 2)
    if e < 1:
        E = 2 * mpmath.atan(half)
        mean = E - e * mpmath.sin(E) - n * mpf(orbit.get("t0", 0.0))
        E = mpmath.findroot(lambda x: x - e * mpmath.sin(x) - mean, mean)
        flat = [a * (mpmath.cos(E) - e), a * mpmath.sqrt(1 - e * e) * mpmath.sin(E)]
        slope = n / (1 - e * mpmath.cos(E))
        fast = [-a * mpmath.sin(E) * slope, a * mpmath.sqrt(1 - e * e) * mpmath.cos(E) * slope]
    else:
        F = 2 * mpmath.atanh(half)
        mean = e * mpmath.sinh(F) - F - n * mpf(orbit.get("t0", 0.0))
        F = mpmath.findroot(lambda x: e * mpmath.sinh(x) - x - mean, mpmath.asinh(mean / e))
        flat = [a * (e - mpmath.cosh(F)), a * mpmath.sqrt(e * e - 1) * mpmath.sinh(F)]
        slope = n / (e * mpmath.cosh(F) - 1)
        fast = [-a * mpmath.sinh(F) * slope, a * mpmath.sqrt(e * e - 1) * mpmath.cosh(F) * slope]

    def turned(x, y):
        i, node, w = angles[:3]
        x, y = x * mpmath.cos(w) - y * mpmath.sin(w), x * mpmath.sin(w) + y * mpmath.cos(w)
        y, z = y * mpmath.cos(i), y * mpmath.sin(i)
        return [x * mpmath.cos(node) - y * mpmath.sin(node), x * mpmath.sin(node) + y * mpmath.cos(node), z]

    return [mu, q, e, *angles[:3], mean, *turned(*flat), *turned(*fast)]


def plate_numbers(plates):
    rows = []
    for plate in plates:
        size = mpmath.norm([mpf(x) for x in plate["normal"]])
        rows += [plate["area"], *(mpf(x) / size for x in plate["normal"]), *plate["centre"],
                 plate.get("specular", 0.0), plate.get("diffuse", 0.0)]
    return [len(plates), *rows]


def inputs(scene):
    """The numbers of a scene by the programs' keys."""
    start = scene["start"]
    found = {"body": [*scene["body"]["moments"], *start["omega"], *start.get("attitude", [0.0, 0.0, 0.0, 1.0])]}
    if "orbits" in scene:
        found["orbit"] = orbit_numbers(scene["orbits"]["main"])
    for torque in scene.get("torques", []):
        kind = torque["kind"]
        if kind == "dipole":
            field = torque["field"]
            found[kind] = [*torque["moment"], *(field.get(k, 0.0) for k in ("strength", "tilt", "spin", "phase"))]
        elif kind == "drag":
            names = ("coefficient", "density", "height_radius", "scale_height", "spin")
            found[kind] = [*(torque.get(name, 0.0) for name in names), *plate_numbers(torque["plates"])]
        elif kind == "solar_pressure":
            size = mpmath.norm([mpf(x) for x in torque["sun"]])
            found[kind] = [*(mpf(x) / size for x in torque["sun"]), torque["pressure"], torque.get("shadow", 0.0),
                           *plate_numbers(torque["plates"])]
        elif kind != "gravity_gradient":
            raise ValueError(f"no reference for this torque: {torque}")
    for rotor in scene.get("rotors", []):
        size = mpmath.norm([mpf(x) for x in rotor["axis"]])
        ramp = rotor["torque"].removesuffix(" * t")
        found["rotor"] = [*(mpf(x) / size for x in rotor["axis"]), rotor["inertia"], rotor["viscous"],
                          rotor["coulomb"], float(ramp), rotor["max_torque"], rotor["max_speed"]]
    return found


def legendre(stages):
    polynomial = mpmath.taylor(lambda x: mpmath.legendre(stages, x), 0, stages)[::-1]
    nodes = sorted((1 + x) / 2 for x in mpmath.polyroots(polynomial, maxsteps=200, extraprec=200))
    with mp.workdps(80):   # A = V' V^-1 with powers of the nodes
        powers, integrals = mpmath.matrix(stages, stages), mpmath.matrix(stages, stages)
        for i, c in enumerate(nodes):
            for k in range(stages):
                powers[i, k], integrals[i, k] = c**k, c ** (k + 1) / (k + 1)
        return [*nodes, *(integrals * powers**-1)]


def run(program, numbers, options, times):
    lines = [f"{key} {' '.join(text(x) for x in values)}" for key, values in numbers.items()]
    lines += [f"options {len(options)} " + " ".join(text(x) for x in options),
              f"times {len(times)} " + " ".join(text(t) for t in times)]
    done = subprocess.run([program], input="\n".join(lines), capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{program}: {done.stderr}")
    print(f"    {pathlib.Path(program).name}: {done.stderr.strip()}", flush=True)
    return [[mpf(x) for x in line.split()] for line in done.stdout.splitlines()]


def compile_programs(folder):
    for name, flags in (("world_momentum", []), ("world_rates", []), ("world_momentum", ["-DFLOORS"])):
        command = ["g++", "-std=gnu++20", "-O2", "-Wall", "-Wextra", *flags, str(HERE / f"{name}.cpp"), "-lquadmath"]
        subprocess.run([*command, "-o", f"{folder}/{name}{'_short' if flags else ''}"], check=True)


def moved_scenes(scene):
    """The scene with one number after another moved by the part MOVED, and all those of the plates at once."""
    def walk(part, path):
        for key, value in part.items() if isinstance(part, dict) else enumerate(part):
            if isinstance(value, (dict, list)):
                yield from walk(value, (*path, key))
            elif isinstance(value, float) and value != 0.0:
                yield (*path, key)

    known = {key: scene[key] for key in ("body", "start", "orbits", "torques", "rotors") if key in scene}
    paths = list(walk(known, ()))
    plates = [path for path in paths if "plates" in path and "normal" not in path]   # normals are axes, exactly
    for moved in [[path] for path in paths if "plates" not in path] + ([plates] if plates else []):
        changed = json.loads(json.dumps(scene))
        for path in moved:
            part = changed
            for key in path[:-1]:
                part = part[key]
            part[path[-1]] = mpf(part[path[-1]]) * (1 + MOVED)
        yield moved[0], changed


def find_floors(folder, name, scene, times):
    """Moves each input, and shares half an ulp; in float64, at every tenth sample."""
    longest = STEPS[name][0]
    few = times[::10]

    def solve(some, when):
        rows = run(f"{folder}/world_momentum_short", inputs(some), [longest, mpf(10) ** -12], when)
        return [row[:3] + [x / mpmath.norm(row[3:7]) for x in row[3:7]] for row in rows]

    base = solve(scene, few)
    total = np.array(disagreement(base, solve(scene, [float(t) * (1 + float(MOVED)) for t in few])))
    for path, changed in moved_scenes(scene):
        apart = np.array(disagreement(base, solve(changed, few)))
        print("   ", path, apart, flush=True)
        total += apart
    total *= float(HALF_ULP / MOVED)
    return {"omega": float(f"{total[0]:.2g}"), "attitude": float(f"{total[1]:.2g}")}


def make(folder, name, floors):
    scene = tomllib.loads((SCENES / f"{name}.toml").read_text(encoding="utf-8"))
    numbers, times = inputs(scene), sample_times(scene)
    first, second, tolerance = STEPS[name]
    begin = time.time()
    tableau = [second, STAGES, *legendre(STAGES)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        jobs = [pool.submit(run, f"{folder}/{program}", numbers, options, times)
                for program, options in (("world_momentum", [first, tolerance]), ("world_rates", tableau),
                                         ("world_momentum", [first / 1.5, tolerance]))]
        rows, other, fine = (job.result() for job in jobs)
    other = [quaternion_of(row[:12]) for row in other]
    short = [row[:7] for row in rows]
    report = {"between_orders": disagreement(short, [row[:7] for row in fine]),
              "against_collocation": disagreement(short, other)}
    print(f"{name}: {json.dumps(report)}  {time.time() - begin:.0f} s", flush=True)
    signs, last = [], short[0][3:]
    for row in short:
        last = row[3:] if sum(a * b for a, b in zip(row[3:], last)) >= 0 else [-x for x in row[3:]]
        signs.append(last)
    more = {"rotor_speed": np.array([[float(row[7])] for row in rows])} if len(rows[0]) > 7 else {}
    np.savez_compressed(STORED / f"{name}.npz", t=times, omega=np.array([[float(x) for x in row[:3]] for row in rows]),
                        attitude=np.array([[float(x) for x in q] for q in signs]), **more)
    store("agreement", name, report)
    if floors:
        store("floors", name, find_floors(folder, name, scene, times))


def store(file, name, value):
    path = STORED / f"{file}.json"
    known = json.loads(path.read_text(encoding="utf-8")) | {name: value}
    path.write_text(json.dumps(dict(sorted(known.items())), indent=2) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("names", nargs="*", default=sorted(STEPS))
    parser.add_argument("--floors", action="store_true", help="how far half an ulp of the inputs moves the answer")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        compile_programs(folder)
        for name in asked.names:
            make(folder, name, asked.floors)


if __name__ == "__main__":
    main()
