"""Instructions of twenty jobs: no change makes one dearer, or cheaper, without a new count (tests/counts)."""

import importlib.util
import json
import pathlib

import pytest

COUNTS = pathlib.Path(__file__).parents[2] / "counts/counts.py"


def load():
    spec = importlib.util.spec_from_file_location("counts", COUNTS)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_changes_beyond_the_bounds_are_named():
    counts = load()
    assert counts.changes({"a": 1000, "b": 1000}, {"a": 1029, "b": 971}) == []
    assert counts.changes({"a": 1000}, {"a": 1031}) == ["a: 1000 instructions became 1031, +3.1 %"]
    assert counts.changes({"a": 1000}, {"a": 969}) == ["a: 1000 instructions became 969, -3.1 %"]
    assert counts.changes({"a": 1000}, {"b": 1000}) == ["a: only stored", "b: only found"]


@pytest.mark.long
def test_no_job_takes_other_instructions_than_stored():
    counts = load()
    if why := counts.refusal():
        pytest.skip(why)
    stored = json.loads(counts.STORE.read_text())["counts"]
    assert len(stored) == 20
    assert counts.changes(stored, counts.count()) == []
