"""What the process around polhode may do: end while threads work, collect garbage, flush denormal numbers to zero."""

import gc
import os
import pathlib
import shutil
import subprocess
import sys
import weakref

import pytest

import polhode as ph

INCLUDE = pathlib.Path(__file__).parents[3] / "cpp" / "include"
COMPILERS = [name for name in ("g++", "clang++") if shutil.which(name)]
BLOCK, OMEGA = (1, 2, 2.5), (1, 2, 3)


def python(script, **more):
    return subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=120, **more)


# ---- the end of the process

WORK = {
    "solve_many, lanes": "ph.solve_many(S, omega=np.ones((40000, 3)), rtol=1e-8)",
    "solve_many, one by one": "ph.solve_many(S, omega=np.ones((40000, 3)), accuracy=1e-8)",
    "solve": "ph.solve(S.replace(torques=[ph.torques.Damping((1e-9, 1e-9, 1e-9))], times=[1e6]), rtol=1e-12, "
             "method='rk45')",
    "a torque of Python": "ph.solve_many(S.replace(torques=[ph.torques.Custom(lambda t, w, q: (0., 0., 0.))]), "
                          "omega=np.ones((40000, 3)), rtol=1e-8)",
    "an event of Python": "ph.solve(S.replace(times=[1e6]), rtol=1e-8, events=[lambda t, w, q: w[0] + 100])",
    "free_motion": "ph.free_motion((1, 2, 2.5), np.ones((4000, 1, 3)), (0, 0, 0, 1), np.random.rand(5000), "
                   "want='omega')",
    "FreeMotion.at": "ph.FreeMotion((1, 2, 2.5), (1, 2, 3)).at(np.random.rand(20_000_000))",
}


@pytest.mark.parametrize("name", WORK)
def test_no_abort_at_exit_while_a_daemon_thread_works(name):
    script = f"""
import threading, time
import numpy as np, polhode as ph
S = ph.Scene.load("S3").replace(times=np.linspace(0, 300, 30))
begun = threading.Event()
def work():
    begun.set()
    while True:
        {WORK[name]}
threading.Thread(target=work, daemon=True).start()
begun.wait()
time.sleep(0.2)
print("said by the main thread")
"""
    for _ in range(3):
        found = python(script)
        assert found.returncode == 0, found.stderr
        assert found.stdout == "said by the main thread\n" and found.stderr == ""


# ---- the collector of garbage


class Craft:
    """It is in a cycle with its own scene."""

    def __init__(self, make):
        self.kept = make(self.torque, self.potential)

    def torque(self, t, omega, attitude):
        return (0.0, 0.0, 0.0)

    def potential(self, t, attitude):
        return 0.0


def scene(*torques):
    return ph.Scene(inertia=BLOCK, omega=OMEGA, times=[1.0], torques=torques)


CYCLES = {
    "Custom": lambda torque, potential: ph.torques.Custom(torque),
    "its potential": lambda torque, potential: ph.torques.Custom(lambda t, w, q: w, potential=potential),
    "During": lambda torque, potential: ph.torques.During(ph.torques.Custom(torque), (0, 1)),
    "Scene": lambda torque, potential: scene(ph.torques.Custom(torque)),
    "Scene with During": lambda torque, potential: scene(ph.torques.During(ph.torques.Custom(torque), (0, 0.5))),
    "two of one": lambda torque, potential: [scene(custom := ph.torques.Custom(torque)), scene(custom), custom],
    "Scene, replaced": lambda torque, potential: scene(ph.torques.Custom(torque)).replace(times=[2.0]),
    "Plan": lambda torque, potential: ph.plan(scene(ph.torques.Custom(torque))),
    "Motion": lambda torque, potential: ph.solve(scene(ph.torques.Custom(torque)), 1e-6, dense=True),
    "Motion in pieces": lambda torque, potential: ph.solve(
        scene(ph.torques.During(ph.torques.Custom(torque), (0, 0.5))), 1e-6, dense=True),
    "Event": lambda torque, potential: ph.Event(torque),
}


@pytest.mark.parametrize("name", CYCLES)
def test_a_cycle_is_collected(name):
    gc.collect()
    craft = weakref.ref(Craft(CYCLES[name]))
    gc.collect()
    assert craft() is None


@pytest.mark.parametrize("name", ["Custom", "Scene", "Scene with During", "two of one", "Motion"])
def test_what_is_used_is_not_collected(name):
    craft = Craft(CYCLES[name])
    kept = craft.kept
    alive = weakref.ref(craft)
    del craft
    for _ in range(3):
        gc.collect()
    assert alive() is not None
    scenes = [kept] if isinstance(kept, ph.Scene) else [kept.scene] if isinstance(kept, ph.Motion) else [
        one for one in (kept if isinstance(kept, list) else [scene(kept)]) if isinstance(one, ph.Scene)]
    for one in scenes:
        assert ph.solve(one, 1e-6).success and alive() is not None


def test_a_torque_lives_as_long_as_the_scene_alone():
    made = [scene(ph.torques.During(ph.torques.Custom(lambda t, w, q: (k, 0.0, 0.0)), (0, 1))) for k in range(50)]
    gc.collect()
    assert [ph.solve(one, rtol=1e-6).omega[0, 0] for one in made[:1]] and len({s.torques for s in made}) == 50
    custom = ph.torques.Custom(lambda t, w, q: (0.0, 0.0, 0.0))
    assert scene(custom).torques[0] is custom and sys.getrefcount(custom) < 10


# ---- the processor's and the compiler's arithmetic

SOURCE = """
#include "polhode/{header}"
int main() {{ return 0; }}
"""


def compile_cpp(compiler, source, folder, *flags):
    (folder / "a.cpp").write_text(source)
    eigen = next((f"-I{path}" for path in ("/usr/include/eigen3", *sys.path) if os.path.isdir(f"{path}/Eigen")), "-I.")
    return subprocess.run([compiler, "-std=c++20", f"-I{INCLUDE}", eigen, "-fsyntax-only", *flags, "a.cpp"],
                          cwd=folder, capture_output=True, text=True, timeout=120)


@pytest.mark.skipif(not COMPILERS, reason="needs g++ or clang++")
@pytest.mark.parametrize("header", ["polhode.hpp", "math/detail/double_double.hpp", "core/error.hpp", "core/quat.hpp"])
def test_headers_refuse_fast_math_with_a_way_out(header, tmp_path):
    source = SOURCE.format(header=header)
    for compiler in COMPILERS:
        for flag in ("-ffast-math", "-Ofast"):
            found = compile_cpp(compiler, source, tmp_path, flag, "-Wfatal-errors")
            assert found.returncode != 0 and "POLHODE_ALLOW_FAST_MATH" in found.stderr, compiler


@pytest.mark.skipif(not COMPILERS, reason="needs g++ or clang++")
def test_headers_compile_under_fast_math_with_the_macro(tmp_path):
    source = SOURCE.format(header="math/detail/double_double.hpp")
    for flags in (("-ffast-math", "-DPOLHODE_ALLOW_FAST_MATH"), ("-O3", "-march=native")):
        found = compile_cpp(COMPILERS[0], source, tmp_path, *flags)
        assert found.returncode == 0, found.stderr


FLUSHED = """
import ctypes, sys
import numpy as np, polhode as ph
tiny = float.fromhex("0x1p-1030")
body = ph.InertiaTensor.from_moments((tiny, tiny, tiny)).moments[0] == tiny
ctypes.CDLL(sys.argv[1])
assert tiny * 1.0 == 0.0, "the library does not flush"
doors = {
    "moments": lambda: ph.InertiaTensor.from_moments((tiny, tiny, tiny)),
    "scene.omega": lambda: ph.Scene(inertia=(1, 2, 2.5), omega=(tiny, 0, 0), times=[1.0]),
    "Constant.torque": lambda: ph.torques.Constant((tiny, 0, 0)),
    "omega": lambda: ph.FreeMotion((1, 2, 2.5), (tiny, 0, 0)),
    "t": lambda: ph.free_motion((1, 2, 2.5), (1, 2, 3), (0, 0, 0, 1), np.array([1.0, tiny])),
    "m": lambda: ph.elliptic.K(tiny),
}
for name, door in doors.items():
    try:
        door()
    except ph.InvalidInput as error:
        assert str(error).startswith(name + ":") and "-ffast-math" in str(error), error
    else:
        sys.exit(f"{name} was taken")
motion = ph.solve(ph.Scene(inertia=(1, 2, 2.5), omega=(1, 2, 3), times=[0.0, 1.0]), accuracy=1e-9)
assert motion.success   # all other numbers are as ever
"""


@pytest.mark.skipif(shutil.which("gcc") is None or os.uname().machine != "x86_64", reason="needs gcc on x86")
def test_denormal_numbers_are_refused_where_the_processor_drops_them(tmp_path):
    (tmp_path / "a.c").write_text("int nothing(void) { return 0; }\n")
    built = subprocess.run(["gcc", "-shared", "-fPIC", "-ffast-math", "a.c", "-o", "fast.so"], cwd=tmp_path,
                           capture_output=True, text=True)
    assert built.returncode == 0, built.stderr
    found = subprocess.run([sys.executable, "-c", FLUSHED, str(tmp_path / "fast.so")], capture_output=True, text=True)
    if "does not flush" in found.stderr:
        pytest.skip("this gcc sets no flush-to-zero in shared libraries")
    assert found.returncode == 0, found.stderr
    assert ph.InertiaTensor.from_moments((1e-310,) * 3).moments[0] == 1e-310   # kept here
