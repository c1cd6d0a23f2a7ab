"""What hosts of Python do: fork while threads work, make subinterpreters, import two copies of a package."""

import os
import pathlib
import shutil
import subprocess
import sys

import pytest

import polhode as ph

HERE = pathlib.Path(ph.__file__).parent
CORE = pathlib.Path(ph._core.__file__)


def python(script, *arguments, timeout=120, flags=()):
    return subprocess.run([sys.executable, *flags, "-c", script, *map(str, arguments)], capture_output=True, text=True,
                          timeout=timeout)


# ---- forks

FORK = """
import os, sys, threading, time
import numpy as np
import polhode as ph
S = ph.Scene.load("S3").replace(times=np.linspace(0, 30, 30))
{warm}
def work():
    for _ in range(3):
        {work}
threads = [threading.Thread(target=work) for _ in range(3)]
[thread.start() for thread in threads]
children = []
for k in range(50):
    pid = os.fork()
    if pid == 0:
        ph.solve_many(S, omega=np.ones((40, 3)), accuracy=1e-6, threads=2)
        ph.solve(S, accuracy=1e-6)
        ph.Rotation.random(3, rng=1)
        os._exit(0)
    children.append(pid)
    time.sleep(0.002)
[thread.join() for thread in threads]
end, left = time.monotonic() + 60, set(children)
while left and time.monotonic() < end:
    left = {{pid for pid in left if os.waitpid(pid, os.WNOHANG)[0] == 0}}
    time.sleep(0.01)
for pid in left:
    os.kill(pid, 9)
sys.exit(f"{{len(left)}} of {{len(children)}} children hang" if left else 0)
"""
FORKED = {
    "solve_many": "ph.solve_many(S, omega=np.ones((400, 3)), accuracy=1e-6, threads=2)",
    "modules that are imported late": "ph.Rotation.random(3, rng=1); ph.free_motion((1, 2, 2.5), np.ones((400, 1, 3)), "
                                      "(0, 0, 0, 1), np.arange(2000.))",
}


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.parametrize("name", FORKED)
def test_fifty_children_of_a_process_whose_threads_make_their_first_calls_end(name):
    found = python(FORK.format(warm="", work=FORKED[name]), flags=("-W", "ignore"))
    assert found.returncode == 0, found.stderr


def test_first_calls_import_nothing():
    """The locks of imports are what a forked child found closed: calls of arrays need none of them."""
    found = python("""
import sys
import numpy as np, polhode as ph
S = ph.Scene(inertia=(1, 2, 2.5), omega=(1, 2, 3), times=[0.0, 1.0])
before = set(sys.modules)
ph.solve(S, 1e-6), ph.solve(S, rtol=1e-6), ph.plan(S, 1e-6), ph.solve(S, 1e-6, sensitivity="omega")
ph.solve_many(S, omega=np.ones((4, 3)), accuracy=1e-6), ph.lyapunov(S, 0.1)
ph.free_motion((1, 2, 2.5), np.ones((4, 1, 3)), (0, 0, 0, 1), [1.0, 2.0])
ph.step((1, 2, 2.5), (1, 2, 3), (0, 0, 0, 1), 0.1), ph.Rotation.from_euler("ZXZ", (1, 2, 3)).apply((1, 2, 3))
ph.FreeMotion((1, 2, 2.5), (1, 2, 3)).sensitivity(1.0)
print(*sorted(set(sys.modules) - before))
""")
    assert found.returncode == 0, found.stderr
    assert found.stdout.split() == []


# ---- subinterpreters

SUB = """
import sys
try:
    import _xxsubinterpreters as interpreters   # up to Python 3.12
except ImportError:
    import _interpreters as interpreters
if sys.argv[1] == "main first":
    import polhode
one = interpreters.create()
try:
    found = interpreters.run_string(one, "import polhode")
    print(found)   # from Python 3.13 on what was raised is returned
except Exception as error:
    print(error)
interpreters.destroy(one)
if sys.argv[1] == "main last":
    import polhode
    print(polhode.FreeMotion((1, 2, 2.5), (1, 2, 3)).kind)
print("end")
"""


@pytest.mark.parametrize("order", ["alone", "main first", "main last"])
def test_a_subinterpreter_is_refused(order):
    found = python(SUB, order, timeout=60)
    assert found.returncode == 0 and found.stdout.endswith("end\n"), found.stderr
    assert "polhode cannot be imported in a subinterpreter" in found.stdout
    assert (order != "main last") or "about_" in found.stdout


# ---- two copies

COPIES = """
import sys
sys.path[:0] = [path for path in sys.argv[3:]]
for home in sys.argv[1:3]:
    for name in [name for name in sys.modules if name.split(".")[0] == "polhode"]:
        del sys.modules[name]
    sys.path.insert(0, home)
    try:
        import polhode
    except ImportError as error:
        print(error)
"""


def test_a_second_copy_is_named(tmp_path):
    for name in "ab":
        shutil.copytree(HERE, tmp_path / name / "polhode", ignore=shutil.ignore_patterns("_core", "__pycache__"))
        shutil.copy(CORE, tmp_path / name / "polhode")
    paths = [path for path in sys.path if path.endswith("site-packages")]
    found = python(COPIES, tmp_path / "a", tmp_path / "b", *paths, flags=("-S",))   # no editable install
    assert found.returncode == 0, found.stderr
    lines = found.stdout.splitlines()
    assert len(lines) == 1 and "imported twice" in lines[0]
    assert str(tmp_path / "a") in lines[0] and str(tmp_path / "b") in lines[0]
