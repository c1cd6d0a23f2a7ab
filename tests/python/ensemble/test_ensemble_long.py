"""Ensembles at their full size: a billion states, and a million driven bodies on one worker and on two."""

import json
import subprocess
import sys

import ensembles
import numpy as np
import pytest

import polhode as ph

pytest.importorskip("zarr")
pytestmark = pytest.mark.long

PROGRAM = """
import json, resource, sys, time
import polhode as ph
start = time.perf_counter()
run = ph.ensemble(sys.argv[1], out=sys.argv[2], executor=int(sys.argv[3]))
own, children = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
print(json.dumps({"done": run.done, "wall": time.perf_counter() - start, "own": sum(own[:2]),
                  "children": sum(children[:2]), "largest": children.ru_maxrss / 1024}))
"""


def run(path, out, workers):
    """Run a recipe in a process of its own; return what it took and its log."""
    done = subprocess.run([sys.executable, "-c", PROGRAM, str(path), str(out), str(workers)], capture_output=True,
                          text=True, check=True)
    return json.loads(done.stdout), ensembles.events(out)


def test_a_billion_states_are_summed_up_in_little_memory(tmp_path):
    path = ensembles.write(tmp_path, ensembles.FREE.replace("[store]\nchunk = 4096\n", ""), count=2_000_000,
                           samples=500)
    path.write_text(path.read_text() + '[[summary]]\nof = "angle"\n')
    took, events = run(path, tmp_path / "out.zarr", 1)
    chunks = [event["cpu"] for event in events if event["event"] == "done"]
    assert took["done"] == 2_000_000 and took["largest"] < 300   # MB
    assert sum(chunks) < 1.3 * 20, f"{sum(chunks):.1f} s of CPU"
    summary = ph.load(tmp_path / "out.zarr").summary["angle"]
    assert (summary.count == 2_000_000).all() and (summary.histogram.sum(axis=1) == 2_000_000).all()


def test_a_million_driven_bodies_on_one_worker_and_two(tmp_path):
    text = ensembles.DRIVEN.replace('states = "float64"\nchunk = 32', "")
    path = ensembles.write(tmp_path, text, count=1_000_000, samples=101)
    stores = []
    for workers in (1, 2):
        took, events = run(path, tmp_path / f"{workers}.zarr", workers)
        chunks = [event["cpu"] for event in events if event["event"] == "done"]
        # What beside the chunks is the start of the processes, the last summaries, and the engine.
        spent = took["own"] + took["children"] - sum(chunks)
        assert took["done"] == 1_000_000 and spent < 0.05 * sum(chunks) + 3, f"{spent:.1f} of {sum(chunks):.1f} s"
        stores.append(ensembles.content(tmp_path / f"{workers}.zarr"))
    assert stores[0] == stores[1]
    assert np.isfinite(ph.load(tmp_path / "1.zarr").summary["angle"].mean).all()
