"""Make the stored truth of the scenes: ``python tests/reference/make_references.py [S1 S5 ...]``.

Two programs in 113-bit arithmetic (g++ with libquadmath) run every scene: ``taylor.cpp`` (series of omega and the
quaternion) and ``collocation.cpp`` (Gauss-Legendre of order 24 on omega and the rotation matrix). What is stored is
the first, rounded to float64; what is reported is how far the two, and two orders of the first, disagree.

The float64 numbers of a scene file are taken as exact. Euler angles are turned into a quaternion, and degrees into
radians, with 40 digits: a program's own rounding of its start is part of its error.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Callable, Sequence
from pathlib import Path

import mpmath
import numpy as np
from mpmath import mp, mpf

HERE = Path(__file__).parent
SCENES = HERE.parents[1] / "scenes"
STORED = SCENES / "reference"
mp.dps = 40
ORDER, TOLERANCE, STAGES = 40, -35, 12

# Largest and first step of the collocation [s]: about half a radian, and the boundary layer of S7b resolved.
STEPS = {
    "S1": (0.125, 0), "S2": (0.1, 0), "S3": (0.2, 0), "S4": (0.1, 0), "S5": (0.1, 0), "S5c": (0.1, 0), "S6": (40.0, 0),
    "S7": (0.02, 0), "S7b": (0.0125, 2e-6), "S9": (0.1, 0), "S10": (0.1, 0), "S11": (0.1, 0), "N2": (0.1, 0),
    "Z1": (0.025, 0),
}  # fmt: skip
# A stiff scene is bounded by stability, which a high order hardly helps.
LOW_ORDER = {"S7b": (24, 30)}
COARSE = (0.05, 2e-6)  # its floor needs three digits, not thirty


def text(value: object) -> str:
    """A number for the programs: float64 exactly, anything finer with 40 digits."""
    return float(value).hex() if isinstance(value, (int, float)) else mpmath.nstr(value, 40)


def multiply(p, q):
    """Hamilton product, (x, y, z, w)."""
    (a, b, c, d), (x, y, z, w) = p, q
    return (d * x + a * w + b * z - c * y, d * y - a * z + b * w + c * x,
            d * z + a * y - b * x + c * w, d * w - a * x - b * y - c * z)  # fmt: skip


def start_attitude(start: dict) -> list:
    if "euler" not in start:
        return list(start.get("attitude", [0.0, 0.0, 0.0, 1.0]))
    q = (mpf(0), mpf(0), mpf(0), mpf(1))
    for letter, angle in zip(start["euler"]["sequence"], start["euler"]["angles"], strict=True):
        turn = [mpf(0)] * 3 + [mpmath.cos(mpf(angle) / 2)]
        turn["XYZ".index(letter)] = mpmath.sin(mpf(angle) / 2)
        q = multiply(q, turn)  # upper case: intrinsic
    return list(q)


def start_omega(start: dict) -> list:
    if "omega" in start:
        return list(start["omega"])
    return [mpf(w) * mpmath.pi / 180 for w in start["omega_deg"]]


def sample_times(scene: dict) -> np.ndarray:
    return np.linspace(0.0, scene["times"]["span"], scene["times"]["samples"])


def inputs(scene: dict) -> dict[str, list]:
    """The numbers of a scene, by the programs' keys."""
    found = {
        "moments": list(scene["body"]["moments"]),
        "omega": start_omega(scene["start"]),
        "attitude": start_attitude(scene["start"]),
    }
    for torque in scene.get("torques", []):
        if torque["kind"] == "gravity":
            found["gravity"] = [torque["weight"], *torque["arm"]]
        elif torque["kind"] == "gravity_gradient":
            found["gravity_gradient"] = [torque["mean_motion"], torque.get("phase", 0.0)]
        elif torque["kind"] == "constant" and torque["frame"] == "body":
            found["constant"] = list(torque["torque"])
        elif torque["kind"] == "damping":
            found["damping"] = list(np.ravel(torque.get("matrix") or np.diag(torque["diagonal"])))
        else:
            raise ValueError(f"no reference for this torque: {torque}")
    if "rotors" in scene:
        found["rotors"] = rotor_momentum(scene["rotors"])
    return found


def rotor_momentum(rotors: list[dict]) -> list:
    """The sum of the momenta relative to the body, of rotors held at constant speed on body axes."""
    total = [0.0, 0.0, 0.0]
    for rotor in rotors:
        if sorted(rotor["axis"]) != [0.0, 0.0, 1.0] or set(rotor) != {"axis", "momentum"}:
            raise ValueError(f"no reference for this rotor: {rotor}")
        total[rotor["axis"].index(1.0)] += rotor["momentum"]
    return total


def compile_programs(folder: Path) -> None:
    for name in ("taylor", "collocation"):
        command = ["g++", "-std=gnu++20", "-O2", "-Wall", "-Wextra", "-o", str(folder / name)]
        subprocess.run([*command, str(HERE / f"{name}.cpp"), "-lquadmath"], check=True)


def run(program: Path, numbers: dict[str, list], options: list, times: Sequence) -> list[list[mpf]]:
    lines = [f"{key} {' '.join(text(x) for x in values)}" for key, values in numbers.items()]
    lines += [f"options {len(options)} " + " ".join(text(x) for x in options)]
    lines += [f"times {len(times)} " + " ".join(text(t) for t in times)]
    done = subprocess.run([program], input="\n".join(lines), capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{program.name}: {done.stderr}")
    return [[mpf(x) for x in line.split()] for line in done.stdout.splitlines()]


def taylor(programs: Path, numbers: dict, times: Sequence, order: int = ORDER) -> list[list[mpf]]:
    return run(programs / "taylor", numbers, [order, float(TOLERANCE)], times)


def gauss(programs: Path, steps: tuple, numbers: dict, times: Sequence) -> list[list[mpf]]:
    legendre = mpmath.taylor(lambda x: mpmath.legendre(STAGES, x), 0, STAGES)[::-1]
    nodes = sorted((1 + x) / 2 for x in mpmath.polyroots(legendre, maxsteps=200, extraprec=200))
    with mp.workdps(80):  # A = V' V^-1 with powers of the nodes
        powers = mpmath.matrix(STAGES, STAGES)
        integrals = mpmath.matrix(STAGES, STAGES)
        for i, c in enumerate(nodes):
            for k in range(STAGES):
                powers[i, k], integrals[i, k] = c**k, c ** (k + 1) / (k + 1)
        a = integrals * powers**-1
    return run(programs / "collocation", numbers, [STAGES, *steps, *nodes, *a], times)


def quaternion_of(line: list[mpf]) -> list[mpf]:
    """(w, R row by row) to (w, q): the largest of the four squares first (Shepperd 1978)."""
    r = [line[3 + 3 * i : 6 + 3 * i] for i in range(3)]
    trace = r[0][0] + r[1][1] + r[2][2]
    squares = [1 + 2 * r[i][i] - trace for i in range(3)] + [1 + trace]
    k = squares.index(max(squares))
    if k == 3:
        q = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1], squares[3]]
    else:
        i, j = (k + 1) % 3, (k + 2) % 3
        q = [mpf(0)] * 3 + [r[j][i] - r[i][j]]
        q[k], q[i], q[j] = squares[k], r[k][i] + r[i][k], r[k][j] + r[j][k]
    size = mpmath.sqrt(sum(x * x for x in q))
    return [*line[:3], *(x / size for x in q)]


def disagreement(one: list[list[mpf]], two: list[list[mpf]]) -> tuple[float, float]:
    """The error measure of the scenes: |dw| / max|w| and the angle between the attitudes [rad], worst sample."""
    top = max(mpmath.norm(line[:3]) for line in one)
    rates = max(mpmath.norm([a - b for a, b in zip(p[:3], q[:3], strict=True)]) for p, q in zip(one, two, strict=True))
    turns = mpf(0)
    for p, q in zip(one, two, strict=True):
        x, y, z, w = multiply((-p[3], -p[4], -p[5], p[6]), q[3:])
        turns = max(turns, 2 * mpmath.atan2(mpmath.norm([x, y, z]), abs(w)))
    return float(rates / top), float(turns)


def measure_floor(solver: Callable, numbers: dict, times: np.ndarray) -> tuple[float, float]:
    """How far the answer moves when each input moves by a relative 2^-53, shares added (worst signs).

    The inputs are the moments, the start, the torque's numbers and the sample times.
    """
    scale = mpf(2) ** 13  # inputs moved by 2^-40, small enough to be linear
    shares = np.zeros(2)
    truth = solver(numbers, times)
    grown = 1 + scale * mpf(2) ** -53
    runs = [(numbers, [mpf(float(t)) * grown for t in times])]
    for key, values in numbers.items():
        for i, value in enumerate(values):
            if value != 0:
                runs.append(({**numbers, key: [*values[:i], mpf(value) * grown, *values[i + 1 :]]}, times))
    for changed_numbers, changed_times in runs:
        changed = solver(changed_numbers, changed_times)
        for line in changed:
            size = mpmath.norm(line[3:])
            line[3:] = [x / size for x in line[3:]]
        shares += np.array(disagreement(truth, changed)) / float(scale)
    return float(shares[0]), float(shares[1])


def make(name: str, programs: Path, floors: bool) -> dict:
    scene = tomllib.loads((SCENES / f"{name}.toml").read_text())
    numbers, times = inputs(scene), sample_times(scene)
    low, high = LOW_ORDER.get(name, (ORDER - 10, ORDER))
    begin = time.time()
    truth = taylor(programs, numbers, times, high)
    second = disagreement(truth, taylor(programs, numbers, times, low))

    def solve_by_gauss(some: dict, when: Sequence, steps: tuple = STEPS[name]) -> list:
        return [quaternion_of(line) for line in gauss(programs, steps, some, when)]

    other = disagreement(truth, solve_by_gauss(numbers, times))
    arrays = np.array([[float(x) for x in line] for line in truth])
    STORED.mkdir(exist_ok=True)
    np.savez_compressed(STORED / f"{name}.npz", t=times, omega=arrays[:, :3], attitude=arrays[:, 3:])
    report = {"orders": [high, low], "between_orders": second, "against_collocation": other}
    if floors:
        if name in LOW_ORDER:
            report["floor"] = measure_floor(lambda n, t: solve_by_gauss(n, t, COARSE), numbers, times)
        else:
            report["floor"] = measure_floor(lambda n, t: taylor(programs, n, t), numbers, times)
    print(f"{name}: {json.dumps(report)}  {time.time() - begin:.0f} s", flush=True)
    return report


def write_table(known: dict) -> None:
    """The rows of the table in the README beside the stored files."""
    readme = STORED / "README.md"
    before, _, after = readme.read_text().partition("|---|---|---|\n")
    after = after[after.index("\n\n") :] if after else ""
    rows = []
    for name, report in sorted(known.items()):
        pairs = (report["between_orders"], report["against_collocation"])
        rows.append(" | ".join([f"| {name}", *(f"{w:.0e}, {a:.0e}" for w, a in pairs)]) + " |")
    readme.write_text(before + "|---|---|---|\n" + "\n".join(rows) + after)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("names", nargs="*", default=sorted(STEPS))
    parser.add_argument("--floors", action="store_true", help="measure the float64 floors too (slow)")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        compile_programs(Path(folder))
        made = {name: make(name, Path(folder), asked.floors) for name in asked.names}
    file = STORED / "agreement.json"
    known = json.loads(file.read_text()) if file.exists() else {}
    for name, report in made.items():
        known[name] = {**known.get(name, {}), **report}
    file.write_text(json.dumps(dict(sorted(known.items())), indent=2) + "\n")
    write_table(known)
    return 0


if __name__ == "__main__":
    sys.exit(main())
