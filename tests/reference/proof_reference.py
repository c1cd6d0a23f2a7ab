"""Make the truth for proofs: ``python tests/reference/proof_reference.py``, some minutes.

Bounds of a proof hold the motion of exactly the float64 numbers of a scene, so the truth here starts from float64
numbers too: those stored beside it. ``taylor.cpp`` computes it in 113-bit arithmetic; each value is stored as the sum
of two float64 numbers.
"""

from __future__ import annotations

import tempfile
import tomllib
from pathlib import Path

import mpmath
import numpy as np
from make_references import HERE, SCENES, compile_programs, inputs, sample_times, taylor
from mpmath import mpf

NAMES = ("S2", "S3", "S4", "S5", "S5c", "S6", "S7", "S9", "N2")
SAMPLES = 41


def split(values: list[list[mpf]]) -> np.ndarray:
    """Return each number as two float64 numbers, shape (n, 7, 2)."""
    return np.array([[(float(x), float(x - mpf(float(x)))) for x in line] for line in values])


def main() -> None:
    """Make and store."""
    stored = {}
    with tempfile.TemporaryDirectory() as folder:
        compile_programs(Path(folder))
        for name in NAMES:
            scene = tomllib.loads((SCENES / f"{name}.toml").read_text())
            numbers, times = inputs(scene), sample_times(scene)
            times = times[:: max(1, (len(times) - 1) // (SAMPLES - 1))]
            omega, attitude = ([float(x) for x in numbers[key]] for key in ("omega", "attitude"))
            size = mpmath.sqrt(sum(mpf(x) ** 2 for x in attitude))
            numbers.update(omega=omega, attitude=[mpf(x) / size for x in attitude])
            truth = split(taylor(Path(folder), numbers, times))
            stored.update({f"{name}_omega0": omega, f"{name}_attitude0": attitude, f"{name}_t": times,
                           f"{name}_truth": truth})
            print(name, len(times))
    np.savez_compressed(HERE / "proof.npz", **stored)


if __name__ == "__main__":
    main()
