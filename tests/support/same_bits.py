"""Hashes of some hundred answers: the same on every machine, before and after every change that is to move no bit.

    python tests/support/same_bits.py            compare with tests/reference/same_bits.json, at every level of SIMD
    python tests/support/same_bits.py --write    store the hashes of this build

Inputs are exact: scene files, products of small numbers, and uniform draws of a counter-based generator. An answer that
depends on the maker of the processor or on the system's mathematical library is a defect.
"""

import argparse
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).parents[2]
STORE = ROOT / "tests/reference/same_bits.json"
LEVELS = {"baseline": "baseline", "avx2": "wide", "avx512": "wide"}   # AVX2 and AVX-512 have the same bits
FIXED_STEPS = {"S1": 0.01, "S2": 0.01, "S3": 0.01, "S4": 0.01, "S5": 0.01, "S5c": 0.01, "S6": 5.0, "S7": 0.01,
               "S7b": 1e-5, "S9": 0.01, "N2": 0.01, "Z1": 0.01}
SPANS = {"S7b": 0.05}   # of fixed steps; else the scene's own, at most 2000 steps


def draws(seed):
    return np.random.Generator(np.random.Philox(seed))


def ball(rng, n):
    """Vectors of the cube's directions, of exact arithmetic: no logarithm, sine or root."""
    return 2 * rng.random((n, 3)) - 1


def digest(*parts):
    total = hashlib.sha256()
    for part in parts:
        if part is None:
            total.update(b"none")
        elif isinstance(part, str):
            total.update(part.encode())
        else:
            array = np.ascontiguousarray(part, dtype=None if np.asarray(part).dtype.kind in "ib" else np.float64)
            total.update(repr(array.shape).encode() + array.tobytes())
    return total.hexdigest()[:16]


def bodies(n, seed):
    """Moments that a body can have, in no order, and starts."""
    rng = draws(seed)
    half = 0.1 + 0.9 * rng.random((n, 3))
    square = half * half
    moments = square.sum(axis=1, keepdims=True) - square
    x, y, z, w = 2 * rng.random((4, n)) - 1
    attitude = np.stack((x, y, z, w), axis=1) / np.sqrt(x * x + y * y + (z * z + w * w))[:, None]
    return moments, 6 * ball(rng, n), attitude, 2000 * rng.random(n) - 500


def full_tensors(n, seed):
    """Tensors off their principal axes: sums of point masses."""
    points = ball(draws(seed), 4 * n).reshape(n, 4, 3)
    spread = np.einsum("npi,npj->nij", points, points)
    return np.trace(spread, axis1=1, axis2=2)[:, None, None] * np.eye(3) - spread


REGIMES = {
    "rest": ((1, 2, 2.5), (0, 0, 0)),
    "spherical": ((2, 2, 2), (1, 2, 3)),
    "steady": ((1, 2, 2.5), (0, 3, 0)),
    "oblate": ((1, 1, 1.5), (1, 2, 3)),
    "prolate": ((1.5, 1.5, 1), (0.5, -2, 3)),
    "about least": ((1, 2, 2.5), (3, 0.5, 0.25)),
    "about greatest": ((1, 2, 2.5), (0.5, 0.25, 3)),
    "near separatrix": ((0.20, 0.40, 0.52), (1e-4, 5, 1e-4)),
    "nearer separatrix": ((0.20, 0.40, 0.52), (1e-9, 5, 1e-12)),
    "nearly symmetric": ((1, 1 + 2.0**-40, 1.5), (1, 2, 3)),
    "needle": ((1e-6, 1, 1.0000001), (1, 2, 3)),
}
TOPS = {
    "regular": ((1, 1, 0.5), 2.0, (0.1, 0.2, 6)),
    "cuspidal": ((1, 1, 0.5), 2.0, (0, 0, 6)),
    "slow": ((1, 1, 0.5), 2.0, (0.3, -0.2, 0.1)),
    "pendulum": ((1, 1, 0.5), 2.0, (0.3, 0, 0)),
    "fast": ((1, 1, 1.5), 2.0, (0.3, 0.5, 400)),
    "light": ((1, 1, 1.5), 1e-9, (0.3, 0.5, 4)),
}
TILTED = (0.5, -0.5, 0.5, 0.5)


def closed_forms(ph):
    rng = draws(1)
    anytime, grid = 4000 * rng.random(301) - 1000, 0.125 * np.arange(-40, 400)
    for name, (inertia, omega) in REGIMES.items():
        motion = ph.FreeMotion(inertia, omega, TILTED)
        yield f"free {name}, any times", lambda m=motion: m.at(anytime)
        yield f"free {name}, grid", lambda m=motion: m.at(grid)
        yield f"free {name}, one time", lambda m=motion: m.at(12.5)
    for name, (inertia, weight_arm, omega) in TOPS.items():
        top = ph.HeavyTop(inertia, weight_arm, omega, TILTED)
        yield f"top {name}, any times", lambda m=top: m.at(anytime / 40)
        yield f"top {name}, grid", lambda m=top: m.at(grid)
    moments, omega, attitude, t = bodies(1003, 2)
    yield "free bodies, one state each", lambda: ph.free_motion(moments, omega, attitude, t)
    yield "free bodies, few, grid", lambda: ph.free_motion(
        moments[:37, None], omega[:37, None], attitude[:37, None], grid)
    tensors = full_tensors(57, 3)
    for i in range(3):
        yield f"free bodies, one full tensor {i}", lambda i=i: ph.free_motion(
            ph.InertiaTensor(tensors[i]), omega[:9, None], attitude[:9, None], t[:9])
    tops = np.sort(moments[:301], axis=1)[:, [2, 2, 0]]   # prolate
    yield "tops, one state each", lambda: ph.heavy_top(tops, 2.0, omega[:301], attitude[:301], t[:301] / 50)
    yield "tops, grid", lambda: ph.heavy_top(tops[:11, None], 2.0, omega[:11, None], attitude[:11, None], grid)


def drawn_scenes(ph):
    """Scenes of every torque, with windows, several torques and times before the start."""
    T = ph.torques
    gravity = T.Gravity(2, (0.3, 0.2, 0.5))
    lists = {
        "gravity": [gravity],
        "constant": [T.Constant((0.1, -0.2, 0.05))],
        "constant in space": [T.Constant((0.1, -0.2, 0.05), frame="space")],
        "damping": [T.Damping((0.01, 0.05, 0.02))],
        "damping, full": [T.Damping(((3, 0.5, 0), (0.5, 20, 1), (0, 1, 400)))],
        "gradient": [T.GravityGradient(mean_motion=0.3)],
        "several": [gravity, T.Damping((0.01, 0.05, 0.02)), T.Constant((0, 0.02, 0.1), frame="space")],
        "thrust in windows": [T.During(T.Constant((0.1, -0.2, 0.05)), [(1, 2), (3.5, 4)])],
        "gravity in a window": [T.During(gravity, [(1, 2)]), T.During(T.Damping((0.1, 0.1, 0.3)), [(0.5, 3)])],
        "free": [],
    }
    times = (0.0, 1.0, 0.25, -2.0, 3.0, -0.5, 7.5, 3.0)
    for name, torques in lists.items():
        common = {"torques": torques, "times": times, "name": name}
        yield name, ph.Scene(inertia=(1, 2, 2.5), omega=(0.3, 0.2, 3), attitude=TILTED, **common)
        full = ((2, 0.25, -0.125), (0.25, 3, 0.5), (-0.125, 0.5, 4))
        yield f"{name}, full tensor", ph.Scene(inertia=full, omega=(1, 2, 3), t0=0.5, **common)


def motion_parts(motion):
    stats = {key: value for key, value in motion.stats.items() if key != "seconds"}
    return (motion.t, motion.omega, motion.attitude, motion.error, motion.message, motion.error_kind, motion.status,
            json.dumps(stats, sort_keys=True))


def motions(ph):
    def load(name):
        return ph.Scene.load(ROOT / "scenes" / f"{name}.toml")

    def run(scene, **options):
        def answer():
            try:
                return motion_parts(ph.solve(scene, **options))
            except ph.InvalidInput as refusal:
                return (str(refusal),)
        return answer

    for name, step in FIXED_STEPS.items():
        scene = load(name)
        for method in ph.methods():
            if method["adaptive"]:
                for rtol in (1e-4, 1e-9):
                    yield f"{name} by {method['name']}, rtol {rtol:g}", run(scene, method=method["name"], rtol=rtol,
                                                                           max_steps=3000)
            else:
                span = SPANS.get(name, 500 * step)
                short = scene.replace(times=scene.t0 + span * np.arange(6) / 5)
                yield f"{name} by {method['name']}, step {step:g}", run(short, method=method["name"], step=step)
        for accuracy in (1e-3, 1e-8, 1e-11):
            yield f"{name}, accuracy {accuracy:g}", run(scene, accuracy=accuracy)
    for name, scene in drawn_scenes(ph):
        for accuracy in (1e-4, 1e-9):
            yield f"{name}, accuracy {accuracy:g}", run(scene, accuracy=accuracy)
        yield f"{name}, expected", run(scene, accuracy=1e-6, certify=False)
        for method in ("rk45", "taylor", "radau", "symplectic"):
            yield f"{name} by {method}", run(scene, method=method, rtol=1e-9)
        yield f"{name}, Lagrange's angles", run(scene, rtol=1e-8, formulation="lagrangian")


def plans(ph):
    def parts(plan):
        found = plan.as_dict()
        found.pop("costs")
        return (json.dumps(found, sort_keys=True),)

    scenes = [ph.Scene.load(ROOT / "scenes" / f"{name}.toml") for name in FIXED_STEPS]
    scenes += [scene for _, scene in drawn_scenes(ph)]
    for i, scene in enumerate(scenes):
        for accuracy in (1e-3, 1e-8, 1e-12):
            yield f"plan {i} of {scene.name}, {accuracy:g}", lambda s=scene, a=accuracy: parts(ph.plan(s, accuracy=a))


def many(ph):
    T = ph.torques
    moments, omega, attitude, _ = bodies(37, 5)
    starts = {"inertia": moments, "omega": omega, "attitude": attitude}
    lists = {"free": [], "gravity": [T.Gravity(2, (0.3, 0.2, 0.5))], "gradient": [T.GravityGradient(mean_motion=0.3)],
             "all": [T.GravityGradient(mean_motion=0.3), T.Gravity(1, (0, 0.1, 0.3)), T.Damping((0.01, 0.05, 0.02)),
                     T.Constant((0, 0.02, 0.1), frame="space"), T.Constant((0.1, -0.2, 0.05))]}
    for name, torques in lists.items():
        scene = ph.Scene(inertia=(1, 1.5, 2), omega=(0, 0, 1), torques=torques, times=(0.0, 7.5, 1.0, -2.0, 3.0))
        for options in ({"method": "taylor", "rtol": 1e-12}, {"method": "rk45", "rtol": 1e-7}, {"accuracy": 1e-8}):
            def answer(scene=scene, options=options):
                found = ph.solve_many(scene, **starts, **options)
                return found.omega, found.attitude, found.steps, found.t_reached
            yield f"many, {name}, {options}", answer


def others(ph):
    moments, omega, attitude, t = bodies(201, 7)
    tensors = full_tensors(101, 8)
    turns = ph.Rotation.from_quat(attitude)
    yield "principal axes", lambda: ph.inertia.principal_axes(tensors)
    yield "rotation vectors", lambda: (turns.as_rotvec(), ph.Rotation.from_rotvec(omega).as_quat())
    yield "matrices", lambda: (turns.as_matrix(), ph.Rotation.from_matrix(turns.as_matrix()).as_quat())
    for sequence in ("ZXZ", "zyx", "XYZ", "zyz"):
        yield f"Euler angles {sequence}", lambda s=sequence: (
            turns.as_euler(s), ph.Rotation.from_euler(s, omega).as_quat())
    m = draws(9).random(101)
    yield "elliptic", lambda: (ph.elliptic.K(m), ph.elliptic.nome(m), *ph.elliptic.jacobi(10 * m - 5, m[::-1]))
    box = ph.shapes.box(2.0, (0.3, 0.2, 0.7))
    yield "shape box", lambda: (box.mass, box.inertia.matrix)
    for name in ("S1", "S5", "Z1"):
        scene = ph.Scene.load(ROOT / "scenes" / f"{name}.toml").replace(times=(0.0, 1.5, 3.0))
        yield f"reference {name}", lambda s=scene: ph._core.reference(s, 24, 1e-20, 100000)


def compute(ph):
    found = {}
    for kind in (closed_forms, motions, plans, many, others):
        for name, answer in kind(ph):
            assert name not in found, name
            parts = answer()
            found[name] = digest(*(parts if isinstance(parts, tuple) else (parts,)))
    return found


def compute_at(level):
    """The hashes at one level of SIMD, in a process of its own; None where the machine does not have it."""
    with tempfile.TemporaryDirectory() as cache:   # no cost factors of somebody's calibration
        environment = {**os.environ, "POLHODE_SIMD": level, "POLHODE_CACHE": cache}
        done = subprocess.run([sys.executable, __file__, "--compute"], env=environment, stdout=subprocess.PIPE,
                              text=True, check=True)
    found = json.loads(done.stdout)
    return found["hashes"] if found["level"] == level else None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="store the hashes of this build")
    parser.add_argument("--compute", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--level", choices=LEVELS, action="append", help="only this one; else all that the machine has")
    chosen = parser.parse_args()
    if chosen.compute:
        import polhode as ph
        print(json.dumps({"level": ph.build_info()["simd"], "hashes": compute(ph)}))
        return 0
    stored = json.loads(STORE.read_text()) if STORE.exists() and not chosen.write else {}
    failed = 0
    for level in chosen.level or LEVELS:
        found = compute_at(level)
        if found is None:
            print(f"{level}: not on this machine")
            continue
        kept = stored.setdefault(LEVELS[level], found) if chosen.write else stored.get(LEVELS[level], {})
        moved = sorted(name for name in kept.keys() | found.keys() if kept.get(name) != found.get(name))
        failed += len(moved)
        print(f"{level}: {len(found) - len(moved)} of {len(found)} answers have the stored bits")
        for name in moved:
            print(f"  {name}: {'is new' if name not in kept else 'is gone' if name not in found else 'has moved'}")
    if chosen.write:
        STORE.write_text(json.dumps(stored, indent=0, sort_keys=True) + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
