"""Every number of the paper is one that `benchmarks/paper.py` wrote, and it writes the same today."""

import importlib.util
import json
import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).parents[3]
PAPER = (ROOT / "paper/paper.md").read_text()
MADE = json.loads((ROOT / "benchmarks/results/paper.json").read_text())
GIVEN = {"110", "200", "1e-9", "20"}   # of the questions: digits of the truth, seconds, the angle asked for, C++20


def load():
    spec = importlib.util.spec_from_file_location("paper", ROOT / "benchmarks/paper.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_number_of_the_paper_has_its_source():
    body = PAPER.partition("# Summary")[2]
    marked = re.findall(r"<!-- (.+?) -->([-+.e\d]*\d)", body)
    assert dict(marked) == MADE and len(marked) == len(MADE)
    rest = re.sub(r"<!-- .+? -->[-+.e\d]*\d|\[@.*?\]", "", body)
    assert set(re.findall(r"\d[-.e\d]*\d|\d", rest)) <= GIVEN


def test_sources_are_in_the_bibliography():
    known = set(re.findall(r"@\w+\{(\w+),", (ROOT / "docs/references.bib").read_text()))
    assert set(re.findall(r"@(\w+)", PAPER.partition("# Summary")[2])) <= known


@pytest.mark.parametrize("part", ["racket", "stated", "exchange"])
def test_the_numbers_are_computed_again(part):
    found = getattr(load(), part)()
    for name, text in found.items():
        # Last bits differ between processors' lanes, not the figures.
        assert float(text) == pytest.approx(float(MADE[name]), rel=0.15), name
