"""The numbers of `paper/paper.md`: `python benchmarks/paper.py` writes them to `benchmarks/results/paper.json`.

Each is text as the paper has it. Those of the racket come from `benchmarks/racket.py`, the rest is computed here.
"""

import json
import math
import pathlib
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests/support"))
import measures

import polhode as ph

OUT = ROOT / "benchmarks/results/paper.json"
ACCURACIES = (1e-6, 1e-9, 1e-12)


def scientific(number, up=True):
    """Two digits, rounded away from what would flatter."""
    power = math.floor(math.log10(number))
    digits = (math.ceil if up else math.floor)(number / 10.0 ** (power - 1)) / 10
    return f"{digits * 10.0**power:.1e}"


def racket():
    """How far each program is off within 200 s, at the worst of sixteen throws."""
    errors = json.loads((ROOT / "benchmarks/results/racket.json").read_text())["errors"]
    worst = {name: max(x for x in row if x is not None) for name, row in errors.items()}
    return {"racket throws": str(len(errors["polhode, closed form"])),
            "racket closed form": scientific(worst["polhode, closed form"]),
            "racket taylor": scientific(worst["polhode, taylor"]),
            "racket heyoka": scientific(worst["heyoka, Taylor in u, v"], up=False)}


def stated():
    """The error of each scene with stored truth, over the error that is stated with it."""
    names = sorted(path.stem for path in (ROOT / "scenes/reference").glob("S*.npz"))
    ratios, runs = [], 0
    for name in names:
        scene = ph.Scene.load(ROOT / f"scenes/{name}.toml")
        truth = measures.truth(name)
        for accuracy in ACCURACIES:
            motion = ph.solve(scene, accuracy=accuracy)
            if not motion.success or motion.error_kind != "bounded":
                continue
            runs += 1
            ratios.append(measures.error(motion.omega, motion.attitude, truth, scene.omega) / motion.error)
    return {"scenes": str(len(names)), "stated runs": str(runs),
            "stated false": str(sum(ratio > 1 for ratio in ratios)), "stated largest": f"{max(ratios):.2f}"}


def exchange():
    """A racket as an attitude ephemeris: knots at 1e-9 rad, and how many turns about fixed axes would need."""
    motion = ph.solve(ph.Scene(inertia=(1, 2, 3), omega=(1e-3, 1, 1e-3), times=[0, 200]))
    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "x.aem"
        motion.save(path, accuracy=1e-9, epoch="2026-03-01T06:00:00")
        found = ph.load(path)
    t = np.linspace(0, 200, 20_001)
    exact = ph.FreeMotion((1, 2, 3), omega=(1e-3, 1, 1e-3)).at(t)[1]
    angle = measures.attitude_error(found(t), exact)
    assert angle <= found.error <= 1e-9
    return {"knots": str(len(found.t)), "knots error": scientific(angle)}


if __name__ == "__main__":
    made = racket() | stated() | exchange()
    OUT.write_text(json.dumps(made, indent=1) + "\n")
    print(OUT.read_text())
