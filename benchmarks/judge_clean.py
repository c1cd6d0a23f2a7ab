"""Right motions, judged: every scene and closed form of polhode, with noise, few digits and uneven times. A finding
above a remark is a false alarm. Seeds are arguments."""

import argparse
import json
import pathlib
import sys
import time

import numpy as np

import polhode as ph

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/support"))

import spoiled

DRESSES = ("as computed", "noise 1e-9", "noise 1e-6", "noise 1e-3", "noise 1e-2", "float32", "nine digits",
           "uneven times", "sign flips", "dop853 at 1e-13")  # fmt: skip
# The judge takes no body that changes, and no motors.
SCENES = tuple(sorted(path.stem for path in (ROOT / "scenes").glob("*.toml") if path.stem not in ("S14", "S15")))
FORMS = ("free", "symmetric", "sphere", "steady", "Lagrange", "pendulum", "damped", "gyrostat")
MOST = 120  # samples of one run
TOLERANCE = 1e-10


def drawn(form, rng):
    """A scene that a closed form solves."""
    moments, omega = np.sort(rng.uniform(1, 1.9, 3)), rng.normal(size=3) * rng.uniform(0.3, 3)
    words = {"attitude": ph.Rotation.random(rng=rng).as_quat()}
    if form == "symmetric":
        moments[1] = moments[0]
    elif form == "sphere":
        moments[:] = moments[0]
    elif form == "steady":
        omega = np.eye(3)[rng.integers(3)] * rng.uniform(0.3, 3)
    elif form == "Lagrange":
        moments[1] = moments[0]
        words["torques"] = [ph.torques.Gravity(weight=rng.uniform(0.3, 2), arm=[0, 0, rng.uniform(0.1, 0.5)])]
    elif form == "pendulum":
        omega = np.array([0, 0, rng.uniform(0.3, 3)])
        words["torques"] = [ph.torques.Gravity(weight=rng.uniform(0.3, 2), arm=[rng.uniform(0.1, 0.5), 0, 0])]
        words["attitude"] = ph.Rotation.from_rotvec([np.pi / 2, 0, 0]).as_quat()
    elif form == "damped":
        words["torques"] = [ph.torques.AngularDamping(rng.uniform(0.01, 0.2))]
    elif form == "gyrostat":
        words["rotors"] = [ph.Rotor(axis=[0, 0, 1], momentum=rng.uniform(0.2, 2))]
    rate = float(np.linalg.norm(omega)) + 0.3
    span = rng.uniform(0.5, 4) * 2 * np.pi / rate
    return ph.Scene(inertia=moments, omega=omega, times=np.linspace(0, span, int(rng.integers(40, MOST))), **words)


def thinned(scene, rng):
    """A scene of polhode with another start near its own, and at most MOST of its samples from any place on."""
    times = np.asarray(scene.times)
    count = min(len(times), int(rng.integers(40, MOST // 2 if scene.torques else MOST)))
    first = int(rng.integers(0, min(len(times) - count, 200) + 1))
    return scene.replace(omega=scene.omega * rng.uniform(0.9, 1.1, 3), times=times[first : first + count])


def dressed(dress, scene, rng):
    """Samples of a scene in one of the harmless dresses."""
    if dress == "uneven times":
        times = np.asarray(scene.times, float).copy()
        times[1:-1] += 0.3 * np.minimum(np.diff(times)[:-1], np.diff(times)[1:]) * rng.uniform(-1, 1, len(times) - 2)
        scene = scene.replace(times=times)
    if dress.startswith("dop853"):
        motion, exact = ph.solve(scene, method="dop853", rtol=1e-13, atol=1e-15), ph.solve(scene, 1e-12)
        if np.max(np.abs(motion.omega - exact.omega)) > 1e-11 * np.max(np.abs(exact.omega)):
            raise ph.InvalidInput("dop853 is not right here")
    else:
        motion = ph.solve(scene, 1e-12)
    if motion.error is not None and motion.error > TOLERANCE:
        raise ph.InvalidInput("its own error exceeds the tolerance")
    omega, attitude = motion.omega, motion.attitude
    if dress.startswith("noise"):
        case = spoiled.noisy(spoiled.Case(motion.t, attitude, omega, {}), float(dress[6:]), rng)
        omega, attitude = case.omega, case.attitude
    elif dress == "float32":
        omega, attitude = omega.astype(np.float32), attitude.astype(np.float32)
    elif dress == "nine digits":
        omega, attitude = omega.round(9), attitude.round(9)
    elif dress == "sign flips":
        attitude = attitude * rng.choice([-1, 1], len(attitude))[:, None]
    return scene, motion.t, attitude, omega


def runs(seed, count, only="", part=0, parts=1):
    """Give one record for each run; a dress and a motion take turns."""
    names = [name for name in (*SCENES, *FORMS) if not only or name in only.split(",")]
    for k in range(part, count, parts):
        rng = np.random.default_rng([seed, k])
        name, dress = names[k % len(names)], DRESSES[(k // len(names)) % len(DRESSES)]
        try:
            file = str(ROOT / f"scenes/{name}.toml")
            scene = drawn(name, rng) if name in FORMS else thinned(ph.Scene.load(file), rng)
            scene, t, attitude, omega = dressed(dress, scene, rng)
        except (ph.InvalidInput, ph.IntegrationFailure) as error:
            yield {"k": k, "name": name, "dress": dress, "skipped": str(error)[:100]}
            continue
        free = not scene.torques and not scene.rotors
        words = {"inertia": scene.inertia} if free and k % 2 else {"scene": scene}
        began = time.process_time()
        found = ph.judge(t, attitude, omega, tolerance=TOLERANCE, **words)
        main = [f for f in found.findings if f.level != "remark"]
        yield {"k": k, "name": name, "dress": dress, "fine": found.fine, "seconds": time.process_time() - began,
               "said": str(main[0])[:140] if main else "", "turns": found.turns}  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=2200)
    parser.add_argument("--only", default="", help="motions, such as free,steady")
    parser.add_argument("--part", default="0/1", help="a part of the runs, such as 1/3")
    parser.add_argument("--json", type=pathlib.Path, help="a file that gets a line for each run")
    given = parser.parse_args()
    records = []
    part, parts = map(int, given.part.split("/"))
    for record in runs(given.seed, given.count, given.only, part, parts):
        records.append(record)
        if given.json:
            with given.json.open("a") as file:
                file.write(json.dumps(record) + "\n")
        if not record.get("fine"):
            print(record, file=sys.stderr, flush=True)
    judged = [r for r in records if "fine" in r]
    print("| dress | runs | false alarms |\n|---|---|---|")
    for dress in DRESSES:
        mine = [r for r in judged if r["dress"] == dress]
        print(f"| {dress} | {len(mine)} | {sum(not r['fine'] for r in mine)} |")
    print(f"\n{sum(not r['fine'] for r in judged)} of {len(judged)}; {len(records) - len(judged)} were not computed")


if __name__ == "__main__":
    main()
