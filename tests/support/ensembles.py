"""What tests of ensembles share: recipes, stores as bytes, and runs in processes that may be killed."""

import contextlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

FREE = """
name = "free"
count = 20000
seed = 8
draw = "by-body"
[body]
moments = [0.02, 0.03, 0.04]
moments_relative = { normal = [0.0, 0.05] }
[start]
omega = { normal = [[0.0, 0.0, 0.2], 0.05] }
attitude = { normal_deg = 3.0 }
[times]
span = 100.0
samples = 6
[store]
chunk = 4096
"""

DRIVEN = """
name = "driven"
count = 500
seed = 3
draw = "by-body"
[body]
moments = [1.0, 2.0, 2.5]
moments_relative = { normal = [0.0, 0.02] }
[start]
omega = { normal = [[0.3, 0.2, 3.0], 0.05] }
euler = { sequence = "ZXZ", angles = [0.0, 0.5, 0.0] }
attitude = { normal_deg = 3.0 }
[[torques]]
kind = "gravity"
weight = 2.0
arm = [0.3, 0.2, 0.5]
[times]
span = 10.0
samples = 11
[solve]
method = "taylor"
rtol = 1e-10
[[summary]]
of = "angle"
[[summary]]
of = "omega"
[store]
states = "float64"
chunk = 32
"""


def change(text, **changes):
    """A recipe with some of its lines `key = value` changed."""
    lines = [f"{line.split(' = ')[0]} = {changes.pop(line.split(' = ')[0])}" if line.split(" = ")[0] in changes
             else line for line in text.splitlines()]
    assert not changes, changes
    return "\n".join(lines) + "\n"


def write(folder, text, name="recipe.toml", **changes):
    """Write a recipe, with some of its lines changed."""
    path = pathlib.Path(folder) / name
    path.write_text(change(text, **changes))
    return path


def content(store):
    """The bytes of a store by the names of its files; its log lies beside it."""
    store = pathlib.Path(store)
    return {str(path.relative_to(store)): path.read_bytes() for path in sorted(store.rglob("*")) if path.is_file()}


def marks(store):
    """The marks of a store: their names, inodes and times of writing."""
    folder = pathlib.Path(store) / "record"
    try:
        return {entry.name: (entry.stat().st_ino, entry.stat().st_mtime_ns) for entry in os.scandir(folder)
                if entry.name.startswith("c.") and not entry.name.endswith(".partial")}
    except FileNotFoundError:
        return {}


def events(store):
    """The log of a store."""
    log = pathlib.Path(f"{store}.log")
    return [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []


def start(*arguments, env=None):
    """Start the command, in a group of its own. It minds Ctrl-C, which a job in the background of a shell does not."""
    return subprocess.Popen([sys.executable, "-m", "polhode", "ensemble", *map(str, arguments)], env=env,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
                            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))


def run(*arguments, env=None):
    """Run the command to its end; return status, stdout and stderr."""
    process = start(*arguments, env=env)
    out, err = process.communicate(timeout=300)
    return process.returncode, out, err


def wait_for(found, process=None, patience=60.0):
    """Wait until a function returns something true, or the process has ended."""
    end = time.monotonic() + patience
    while time.monotonic() < end:
        if value := found():
            return value
        if process is not None and process.poll() is not None:
            return found()
        time.sleep(0.002)
    raise AssertionError("nothing came")


def children(pid):
    """The processes that a process started, and theirs."""
    found = []
    for path in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = path.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == pid and fields[0] != "Z":
            child = int(path.parent.name)
            found += [child, *children(child)]
    return found


def kill(*pids):
    """Kill processes as the system does when memory runs out."""
    for pid in pids:
        try:
            os.kill(pid, signal.SIGKILL)
        except ProcessLookupError:
            pass


SCHEDULER = """
import time
from distributed import LocalCluster
if __name__ == "__main__":
    cluster = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0")
    print(cluster.scheduler_address, flush=True)
    time.sleep(1000)
"""


@contextlib.contextmanager
def scheduler(folder):
    """Start a Dask scheduler and two workers in a group of processes; give its address and the group's number."""
    script = pathlib.Path(folder) / "scheduler.py"
    script.write_text(SCHEDULER)
    process = subprocess.Popen([sys.executable, str(script)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                               text=True, start_new_session=True)
    try:
        yield process.stdout.readline().strip(), process.pid
    finally:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def tilt(times, omega, attitude):
    """A user's function: the angle of the body's z axis from space z, and NaN-free."""
    import numpy as np

    x, y = attitude[..., 0], attitude[..., 1]
    return np.hypot(x, y)


def die_for_first(times, omega, attitude):
    """A function that kills its process for the chunk that has body 0: its first attitude is in a file."""
    first = float(os.environ["POLHODE_TEST_FIRST"])
    if attitude[0, 0, 0] == first:
        os._exit(9)
    return omega[..., 0]


def fail_for_first(times, omega, attitude):
    """A function that fails for the chunk that has body 0."""
    if attitude[0, 0, 0] == float(os.environ["POLHODE_TEST_FIRST"]):
        raise ValueError("no such body")
    return omega[..., 0]
