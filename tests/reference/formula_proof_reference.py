"""Judge proofs of drawn formulas by 113-bit numbers: ``python tests/reference/formula_proof_reference.py [--write]``.

Each law is drawn as a tree and written twice: as text for the package, and as C++ for ``__float128``, where
extrapolated midpoint steps integrate it. So neither the package's parser nor its series take part. Some scenes have
gravity, a rotor, or windows for the formula, with samples one unit beside each edge. Two tolerances must agree to
25 digits, and the finer one counts. ``--write`` stores the first scenes; ``--scenes`` and ``--seed`` draw others.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

FILE = Path(__file__).parent / "formula_proof.json"
PROGRAM = Path(__file__).parent / "formula_proof.cpp"
STORED = 8


class Law:
    """A smooth torque, bounded, as text and as C++; every number is a parameter."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        self.numbers: list[float] = []
        parts = []
        for i in range(3):
            text, code = self.tree(3)
            size, drag = self.number(0.1, 0.6), self.number(0.05, 0.3)
            wrap = rng.choice(["tanh", "sin", "cos", "atan2"])
            one = self.number(0.5, 1.5)
            arguments = (f"{text}, {one[0]}", f"{code}, {one[1]}") if wrap == "atan2" else (text, code)
            axis = "xyz"[i]
            parts.append((f"{size[0]} * {wrap}({arguments[0]}) - {drag[0]} * omega.{axis}",
                          f"{size[1]} * {wrap}({arguments[1]}) - {drag[1]} * w[{i}]"))
        self.text = "[" + ", ".join(text for text, _ in parts) + "]"
        self.code = [code for _, code in parts]

    def number(self, low: float, high: float) -> tuple[str, str]:
        self.numbers.append(float(self.rng.uniform(low, high)))
        name = f"k{len(self.numbers) - 1}"
        return name, f"Q({self.numbers[-1].hex()})"

    def leaf(self) -> tuple[str, str]:
        kind = self.rng.integers(9)
        if kind < 3:
            return f"omega.{'xyz'[kind]}", f"w[{kind}]"
        if kind < 7:
            return f"attitude.{'xyzw'[kind - 3]}", f"q[{kind - 3}]"
        if kind == 7:
            return "t", "t"
        return self.number(-1, 1)

    def tree(self, depth: int) -> tuple[str, str]:
        if depth == 0:
            return self.leaf()
        a, x = self.tree(depth - 1)
        kind = self.rng.choice(["sum", "difference", "product", "quotient", "sqrt", "exp", "log", "sin", "cos", "tanh",
                                "atan2", "power", "cube", "seen"])
        if kind in ("sum", "difference", "product", "quotient", "atan2"):
            b, y = self.tree(depth - 1)
            k, c = self.number(0.3, 1.5)
            text, code = {"sum": (f"({k} * {a} + {b})", f"({c} * {x} + {y})"),
                          "difference": (f"({a} - {k} * {b})", f"({x} - {c} * {y})"),
                          "product": (f"({a} * {b})", f"({x} * {y})"),
                          "quotient": (f"({a} / ({k} + {b} * {b}))", f"({x} / ({c} + {y} * {y}))"),
                          "atan2": (f"atan2({a}, {k} + {b} * {b})", f"atan2({x}, {c} + {y} * {y})")}[kind]
            return text, code
        k, c = self.number(0.3, 1.5)
        if kind == "exp":
            return f"exp(-({k} * sin({a})))", f"exp(-({c} * sin({x})))"
        if kind in ("sqrt", "log"):
            return f"{kind}({k} + {a} * {a})", f"{kind}({c} + {x} * {x})"
        if kind == "power":
            exponent = float(self.rng.uniform(-2, 2))
            return f"({k} + {a} * {a}) ^ {exponent!r}", f"power({c} + {x} * {x}, Q({exponent.hex()}))"
        if kind == "cube":
            return f"({k} * sin({a})) ^ 3", f"cube({c} * sin({x}))"
        if kind == "seen":
            return f"({k} * to_body([0, {a}, 1]).y)", f"({c} * seen(q, {x}))"
        return f"{kind}({a})", f"{kind}({x})"


def draw(seed: int, index: int) -> dict:
    """Return a scene as plain numbers, and its law as C++."""
    rng = np.random.default_rng([seed, index])
    moments = np.array([1.0, 1.6, 2.1]) * rng.uniform(0.9, 1.1, 3)
    inertia = np.diag(moments)
    if rng.random() < 0.5:
        turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
        inertia = turn @ inertia @ turn.T
        inertia = (inertia + inertia.T) / 2
    law = Law(rng)
    t0 = float(rng.choice([0.0, 0.0, -1.25, 100.0, 1e6]))
    span = float(rng.uniform(3.0, 9.0))
    times = t0 + np.concatenate([rng.uniform(-0.5 * span, span, 30), [0.0, span, -0.5 * span]])
    windows = []
    if rng.random() < 0.5:
        edges = sorted(float(t) for t in t0 + span * rng.uniform(-0.4, 0.9, 4))
        windows = [[edges[0], edges[1]], [edges[2], edges[3]]]
        times = np.concatenate([times, *([e, np.nextafter(e, -np.inf), np.nextafter(e, np.inf)] for e in edges)])
    attitude = rng.standard_normal(4)
    attitude /= np.linalg.norm(attitude)
    return {"inertia": inertia.tolist(), "omega": rng.uniform(-1, 1, 3).tolist(), "attitude": attitude.tolist(),
            "t0": t0, "times": [float(t) for t in rng.permutation(times)], "text": law.text, "numbers": law.numbers,
            "windows": windows, "gravity": rng.uniform(-0.4, 0.4, 3).tolist() if rng.random() < 0.4 else [],
            "rotor": float(rng.uniform(-0.5, 0.5)) if rng.random() < 0.4 else 0.0, "code": law.code}


def compute(scenes: list[dict]) -> list[np.ndarray | None]:
    """Return the truth of each scene, shape (n, 7, 2): each number is a sum of two. None where it is not known."""
    laws = []
    for i, scene in enumerate(scenes):
        body = " ".join(f"tau[{k}] = {line};" for k, line in enumerate(scene["code"]))
        laws.append(f"static void law{i}(Q t, const Q* w, const Q* q, Q* tau) {{ (void)t; (void)q; {body} }}")
    table = "static const Law laws[] = {" + ", ".join(f"law{i}" for i in range(len(scenes))) + "};"
    with tempfile.TemporaryDirectory() as folder:
        source, program = Path(folder) / "truth.cpp", Path(folder) / "truth"
        source.write_text(PROGRAM.read_text().replace("// LAWS", "\n".join([*laws, table])))
        subprocess.run(["g++", "-std=gnu++20", "-O1", "-o", program, source, "-lquadmath"], check=True)
        found = []
        for i, scene in enumerate(scenes):
            order = sorted(scene["times"])
            numbers = [*np.ravel(scene["inertia"]), *scene["omega"], *scene["attitude"], scene["t0"],
                       *(scene["gravity"] or [0.0] * 3), scene["rotor"], len(scene["windows"]),
                       *np.ravel(scene["windows"]), len(order), *order]
            runs = []
            for tolerance in (1e-30, 1e-29):
                text = " ".join([str(i), repr(tolerance), *(float(x).hex() for x in numbers)])
                done = subprocess.run([program], input=text, text=True, capture_output=True, check=False)
                if done.returncode == 2:   # 113 bits do not suffice, so far from t = 0
                    break
                runs.append(np.array([float.fromhex(x) for x in done.stdout.split()]).reshape(len(order), 7, 2))
            if len(runs) < 2:
                found.append(None)
                continue
            apart = np.abs((runs[0][..., 0] - runs[1][..., 0]) + (runs[0][..., 1] - runs[1][..., 1])).max()
            assert apart < 1e-25, (i, apart)
            place = {t: row for t, row in zip(order, runs[0], strict=True)}
            found.append(np.array([place[t] for t in scene["times"]]))
    return found


def main() -> int:
    """Draw, compute, judge or store."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--scenes", type=int, default=STORED)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    given = parser.parse_args()
    scenes = [draw(given.seed, given.first + i) for i in range(given.scenes)]
    truth = compute(scenes)
    scenes = [dict(scene, truth=values.tolist()) for scene, values in zip(scenes, truth, strict=True)
              if values is not None]
    for scene in scenes:
        del scene["code"]
    if given.write:
        FILE.write_text(json.dumps(scenes, separators=(",", ":")) + "\n")
        return 0
    sys.path.insert(0, str(Path(__file__).parents[1] / "support"))
    from proofs import find_outside, make_formula_scene

    import polhode as ph

    numbers = wrong = 0
    for i, scene in enumerate(scenes):
        for accuracy in (1e-6, 1e-11):
            motion = ph.solve(make_formula_scene(scene), accuracy, certify="proof")
            outside = find_outside(motion, np.array(scene["truth"]))
            numbers, wrong = numbers + 7 * len(scene["times"]), wrong + outside
            if motion.error_kind != "proved" or outside:
                print(given.first + i, accuracy, motion.error_kind, motion.error, outside, motion.message)
    print(f"{numbers} numbers, {wrong} outside")
    return wrong


if __name__ == "__main__":
    sys.exit(main() > 0)
