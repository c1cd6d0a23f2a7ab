"""Boost.Odeint, compiled on the spot where there are a compiler and its headers, with -O3 -march=native."""

from __future__ import annotations

import ctypes
import functools
import os
import pathlib
import re
import shutil
import subprocess
import tempfile

import numpy as np

from ..._scene.scene import Scene
from ..._solve.motion import Floats
from ..candidate import Answer, Candidate, Failure, Run, euler, separatrix, tolerances
from ..equations import STATE, Separatrix, refuses, source

NAME, INSTALL = "Boost.Odeint", "apt install g++ libboost-dev"
FLAGS = ("-O3", "-march=native", "-std=c++20", "-shared", "-fPIC", "-w")
METHODS = {"dopri5": 0, "fehlberg78": 1}


def _compiler() -> str:
    return shutil.which(os.environ.get("CXX") or "g++") or ""


def found() -> str:
    """The version of Boost's headers, or "" without them or a compiler."""
    for folder in ("/usr/include", "/usr/local/include", "/opt/homebrew/include"):
        header = pathlib.Path(folder, "boost/version.hpp")
        if _compiler() and header.is_file() and header.parent.joinpath("numeric/odeint.hpp").is_file():
            written = re.search(r'BOOST_LIB_VERSION "(\w+)"', header.read_text(encoding="utf-8"))
            return written[1].replace("_", ".") if written else "unknown"
    return ""


def _compile(text: str, name: str) -> ctypes.CDLL:
    folder = pathlib.Path(tempfile.mkdtemp(prefix="polhode-"))
    try:
        (folder / f"{name}.cpp").write_text(text, encoding="utf-8")
        done = subprocess.run([_compiler(), *FLAGS, f"{name}.cpp", "-o", f"{name}.so"], cwd=folder, capture_output=True,
                              text=True, check=False)
        if done.returncode:
            raise Failure(f"does not compile: {(done.stderr.splitlines() or ['?'])[0]}")
        return ctypes.CDLL(str(folder / f"{name}.so"))
    finally:
        shutil.rmtree(folder, ignore_errors=True)   # what is loaded stays


@functools.cache
def _driver() -> ctypes.CDLL:
    library = _compile(pathlib.Path(__file__).with_suffix(".cpp").read_text(encoding="utf-8"), "odeint")
    library.solve.restype = ctypes.c_long
    return library


def _right_hand_side(scene: Scene, in_u_v: bool) -> ctypes.CDLL:
    lines, names = source(scene, Separatrix(scene) if in_u_v else None)
    body = [f"  const double {name} = u[{i}];" for i, name in enumerate(STATE)]
    body += [f"  const double {name} = {text};" for name, text in lines]
    body += [f"  f[{i}] = {name};" for i, name in enumerate(names)]
    head = '#include <cmath>\nusing std::cos, std::sin;\nextern "C" void f(double t, const double* u, double* f) {\n'
    return _compile(head + "\n".join(body) + "\n}\n", "scene")


@functools.lru_cache(maxsize=4)   # both methods share it
def _compiled(scene: Scene, in_u_v: bool) -> ctypes.CDLL:
    return _right_hand_side(scene, in_u_v)


def _start(scene: Scene, method: str, in_u_v: bool = False) -> Run:
    driver, function = _driver(), _compiled(scene, in_u_v).f
    form = Separatrix(scene) if in_u_v else None
    start, n = form.start(scene) if form else np.concatenate([scene.omega, scene.attitude]), scene.times.size
    from_start = scene.times[0] == scene.t0
    times = np.array(scene.times) if from_start else np.concatenate([[scene.t0], scene.times])
    size = float(np.linalg.norm(scene.omega)) or 1.0

    def pointer(array: Floats) -> ctypes.c_void_p:
        return ctypes.c_void_p(array.ctypes.data)

    def run(rtol: float, limit: float | None) -> Answer:
        out = np.empty((times.size, 7))
        # Its tolerances are one number for all components: the smaller scale, as one does who knows them.
        calls = driver.solve(function, METHODS[method], pointer(start), pointer(times), ctypes.c_long(times.size),
                             ctypes.c_double(rtol * min(size, 1.0)), ctypes.c_double(rtol),
                             ctypes.c_double(limit or 0.0),
                             pointer(out))
        if calls < 0:
            raise Failure(f"not done within {limit:.2g} "
                          "s" if calls == -1 else "Odeint gave up: no step is small enough")
        return Answer(form.rates(out[-n:]) if form else out[-n:, :3], out[-n:, 3:], {"derivatives": int(calls)})

    return run


def candidates() -> list[Candidate]:
    """Dormand and Prince's pair with its dense output, and Fehlberg's 7(8), stepping onto samples, in u, v too."""
    def make(method: str, in_u_v: bool = False) -> Candidate:
        return Candidate(f"Odeint {method}{' u v' * in_u_v}", "peer",
                         f"boost::numeric::odeint::runge_kutta_{method}, g++ {' '.join(FLAGS[:2])}",
                         tolerances(3, 14), lambda scene: _start(scene, method, in_u_v),
                         Separatrix.refuses if in_u_v else refuses, variables=separatrix if in_u_v else euler,
                         right_hand_side="compiled by g++, called through a pointer")

    return [*(make(method) for method in METHODS), make("fehlberg78", True)]
