"""An ensemble on the address of a Dask scheduler, and what else Dask does in that process."""

import os
import subprocess
import sys

import ensembles
import pytest

pytest.importorskip("distributed")
OTHER_WORK = """
import os, signal, sys
import dask, polhode as ph
recipe, address, group = sys.argv[1], sys.argv[2], int(sys.argv[3])
at_home = []

def work():
    at_home.append(dask.delayed(os.getpid, pure=False)().compute() == os.getpid())

def progress(done, total):
    if not at_home:
        work()
        os.killpg(group, signal.SIGKILL)
    work()
    return True

run = ph.ensemble(recipe, executor=address, progress=progress)
work()
print(all(at_home) and len(at_home) >= 3, "the scheduler is gone" in run.failed.values())
"""


def test_other_work_of_dask_never_waits_for_the_scheduler_of_an_ensemble(tmp_path):
    """By Dask's threads in this process: beside the ensemble, after its scheduler was killed, and after its end."""
    stateless = ensembles.write(tmp_path, ensembles.DRIVEN.replace('states = "float64"\n', ""))
    quick = {**os.environ, "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "2s"}
    with ensembles.scheduler(tmp_path) as (address, group):
        found = subprocess.run([sys.executable, "-c", OTHER_WORK, stateless, address, str(group)], env=quick,
                               capture_output=True, text=True, timeout=60)
    assert found.stdout == "True True\n", found.stderr
