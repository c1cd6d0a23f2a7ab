"""The stored tables of tests/reference."""

import csv
import pathlib

import numpy as np

FOLDER = pathlib.Path(__file__).parents[1] / "reference"


def read(name):
    """The rows of a table, each a dict of texts."""
    with (FOLDER / name).open() as file:
        return list(csv.DictReader(file))


def numbers(row, *names):
    return np.array([float(row[name]) for name in names])
