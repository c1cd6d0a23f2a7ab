"""Judge proofs of formulas with states and switches: ``python tests/reference/state_proof_reference.py [--write]``.

Each law is drawn as a tree with switches (abs, sign, min, max, clip, where) and states of its own. It is written twice:
as text for the package, and as C++ for ``__float128``, where extrapolated midpoint steps integrate it from one zero of
a guard to the next. Some scenes have a driven rotor or a damper, whose equations are written out. Samples lie within a
unit of each crossing. Two tolerances with other steps must agree to 24 digits. ``--write`` stores the first scenes;
``--scenes`` and ``--seed`` draw others.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from formula_proof_reference import Law

FILE = Path(__file__).parent / "state_proof.json"
PROGRAM = Path(__file__).parent / "state_proof.cpp"
STORED = 10
SWITCHES = ("abs", "sign", "min", "max", "clip", "where")


class StateLaw(Law):
    """A torque, and the rates of a wheel's momentum h and of a number z."""

    def __init__(self, rng: np.random.Generator, switches: float) -> None:
        self.switches = switches
        super().__init__(rng)
        rates = []
        for name, code in (("h.x", "h[0]"), ("h.y", "h[1]"), ("h.z", "h[2]"), ("z", "h[3]")):
            text, tree = self.tree(2)
            size, decay = self.number(0.1, 0.6), self.number(0.05, 0.5)
            rates.append((f"{size[0]} * sin({text}) - {decay[0]} * {name}",
                          f"{size[1]} * sin({tree}) - {decay[1]} * {code}"))
        self.rates = [code for _, code in rates]
        self.rate_texts = ["[" + ", ".join(text for text, _ in rates[:3]) + "]", rates[3][0]]

    def leaf(self) -> tuple[str, str]:
        if self.rng.random() < 0.35:
            kind = self.rng.integers(4)
            return ("z", "h[3]") if kind == 3 else (f"h.{'xyz'[kind]}", f"h[{kind}]")
        return super().leaf()

    def tree(self, depth: int) -> tuple[str, str]:
        if depth == 0 or self.rng.random() >= self.switches:
            return super().tree(depth)
        a, x = self.tree(depth - 1)
        k, c = self.number(0.05, 0.5)
        kind = self.rng.choice(SWITCHES)
        if kind in ("abs", "sign"):
            return f"{kind}({a} - {k})", f"s.{kind}({x} - {c})"
        if kind == "clip":
            return f"clip({a}, -{k}, {k})", f"s.clip({x}, -{c}, {c})"
        b, y = self.tree(depth - 1)
        if kind == "where":
            return f"where({a} > {k}, {b}, {k})", f"s.pick({x} - {c}, {y}, {c})"
        return f"{kind}({a}, {k} * {b})", f"s.{kind}({x}, {c} * {y})"


def draw(seed: int, index: int) -> dict:
    """Return a scene as plain numbers, and its law as C++."""
    rng = np.random.default_rng([seed, index, 30])
    inertia = np.diag(np.array([1.0, 1.6, 2.1]) * rng.uniform(0.9, 1.1, 3))
    if rng.random() < 0.5:
        turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
        inertia = turn @ inertia @ turn.T
        inertia = (inertia + inertia.T) / 2
    law = StateLaw(rng, float(rng.choice([0.0, 0.25, 0.4])))
    t0 = float(rng.choice([0.0, 0.0, -1.25, 100.0]))
    span = float(rng.uniform(2.0, 6.0))
    attitude = rng.standard_normal(4)
    rotor = damper = None
    if rng.random() < 0.4:
        axis = [[0.0, 0.0, 1.0], [1.0, -2.0, 2.0]][rng.integers(2)]
        rotor = {"axis": axis, "inertia": 0.0625 * float(rng.uniform(1, 2)), "speed": float(rng.uniform(-3, 3)),
                 "viscous": float(rng.uniform(0.01, 0.1)), "torque": float(rng.uniform(-0.1, 0.1))}
    if rng.random() < 0.4:
        damper = {"inertia": float(rng.uniform(0.1, 0.3)), "viscous": float(rng.uniform(0.05, 0.3)),
                  "rates": rng.uniform(-1, 1, 3).tolist()}
    times = t0 + np.concatenate([rng.uniform(-0.4 * span, span, 14), [0.0, span, -0.4 * span]])
    return {"inertia": inertia.tolist(), "omega": rng.uniform(-1, 1, 3).tolist(),
            "attitude": (attitude / np.linalg.norm(attitude)).tolist(), "t0": t0,
            "times": [float(t) for t in times], "text": law.text, "rates": law.rate_texts, "numbers": law.numbers,
            "states": rng.uniform(-0.4, 0.4, 4).tolist(), "rotor": rotor, "damper": damper,
            "code": law.code, "rate_code": law.rates}


def find_numbers(scene: dict) -> list[float]:
    """Return what the program reads of a scene, in its order."""
    rotor = scene["rotor"] or {"axis": [0.0, 0.0, 1.0], "inertia": 0.0, "viscous": 0.0, "torque": 0.0, "speed": 0.0}
    damper = scene["damper"] or {"inertia": 0.0, "viscous": 0.0, "rates": [0.0] * 3}
    return [*np.ravel(scene["inertia"]), *scene["omega"], *scene["attitude"], scene["t0"], len(scene["states"]),
            *scene["states"], *rotor["axis"], *(rotor[name] for name in ("inertia", "viscous", "torque", "speed")),
            damper["inertia"], damper["viscous"], *damper["rates"], len(scene["times"]), *scene["times"]]


def run(program: Path, number: int, scene: dict, tolerance: float,
        longest: float) -> tuple[list[float], np.ndarray] | None:
    """Return the times of the crossings and the rows (n, 11 + 4, 2), or None where they are not known."""
    text = " ".join([str(number), repr(tolerance), repr(longest), *(float(x).hex() for x in find_numbers(scene))])
    done = subprocess.run([program], input=text, text=True, capture_output=True, check=False)
    if done.returncode == 2:
        return None
    count, *words = done.stdout.split()
    numbers = [float.fromhex(x) for x in words]
    return numbers[:int(count)], np.array(numbers[int(count):]).reshape(len(scene["times"]), -1, 2)


def compute(scenes: list[dict]) -> None:
    """Add to each scene samples at its crossings, their number, and the truth, which is None where it is not known."""
    laws = []
    for i, scene in enumerate(scenes):
        body = " ".join([*(f"tau[{k}] = {line};" for k, line in enumerate(scene["code"])),
                         *(f"rates[{k}] = {line};" for k, line in enumerate(scene["rate_code"]))])
        laws.append(f"static void law{i}(Q t, const Q* w, const Q* q, const Q* h, Switches& s, Q* tau, Q* rates) "
                    f"{{ (void)t; (void)q; (void)s; {body} }}")
    table = "static const Law laws[] = {" + ", ".join(f"law{i}" for i in range(len(scenes))) + "};"
    with tempfile.TemporaryDirectory() as folder:
        source, program = Path(folder) / "truth.cpp", Path(folder) / "truth"
        source.write_text(PROGRAM.read_text().replace("// LAWS", "\n".join([*laws, table])))
        subprocess.run(["g++", "-std=gnu++20", "-O1", "-o", program, source, "-lquadmath"], check=True)
        for i, scene in enumerate(scenes):
            scene["truth"] = None
            first = run(program, i, scene, 1e-28, 0.05)
            if first is None:
                continue
            scene["crossings"] = len(first[0])
            for t in first[0][:8]:
                scene["times"] += [t, float(np.nextafter(t, -np.inf)), float(np.nextafter(t, np.inf))]
            runs = [run(program, i, scene, *how) for how in ((1e-28, 0.05), (1e-27, 0.033))]
            if runs[0] is None or runs[1] is None or len(runs[0][0]) != len(runs[1][0]):
                continue
            one, other = runs[0][1], runs[1][1]
            if np.abs((one[..., 0] - other[..., 0]) + (one[..., 1] - other[..., 1])).max() < 1e-24:
                scene["truth"] = one.tolist()


def main() -> int:
    """Draw, compute, judge or store."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--scenes", type=int, default=STORED)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    given = parser.parse_args()
    scenes = [draw(given.seed, given.first + i) for i in range(given.scenes)]
    compute(scenes)
    known = [scene for scene in scenes if scene["truth"] is not None]
    if given.write:
        for scene in known:
            del scene["code"], scene["rate_code"]
        FILE.write_text(json.dumps(known, separators=(",", ":")) + "\n")
        return 0
    sys.path.insert(0, str(Path(__file__).parents[1] / "support"))
    from proofs import count_states_outside, make_state_scene

    import polhode as ph

    numbers = outside = crossings = ended = 0
    for i, scene in enumerate(known):
        crossings += scene["crossings"]
        for accuracy in (1e-6, 1e-11):
            motion = ph.solve(make_state_scene(scene), accuracy, certify="proof")
            wrong, judged = count_states_outside(motion, scene)
            numbers, outside = numbers + judged, outside + wrong
            ended += motion.error_kind != "proved"
            if motion.error_kind != "proved" or wrong:
                print(i, accuracy, motion.error_kind, motion.error, wrong, scene["crossings"], motion.message)
    print(f"{len(known)} of {len(scenes)} scenes, {crossings} crossings, {numbers} numbers, {outside} outside, "
          f"{ended} not proved")
    return outside


if __name__ == "__main__":
    sys.exit(main() > 0)
