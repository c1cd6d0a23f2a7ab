"""Orekit's closed form of free motion, where a Java development kit is there besides the package."""

from __future__ import annotations

import functools
import pathlib
import shutil
import subprocess
import tempfile
from typing import Any

import numpy as np

from ..._scene.scene import Scene
from ..candidate import Answer, Candidate, Failure, Run, closed, fixed
from .found import version

NAME, INSTALL = "Orekit", "pip install orekit-jpype, apt install openjdk-17-jdk-headless"


def found() -> str:
    """The version, or "" without the package or a Java compiler."""
    return version("orekit-jpype", "orekit_jpype") if shutil.which("javac") else ""


@functools.cache
def _class() -> Any:
    """Compile the loop over the times, start the virtual machine, and warm it up."""
    import jpype  # type: ignore[import-not-found,import-untyped,unused-ignore]
    import orekit_jpype  # type: ignore[import-not-found,import-untyped,unused-ignore]

    jars = str(pathlib.Path(orekit_jpype.__file__).parent / "jars" / "*")
    folder = tempfile.mkdtemp(prefix="polhode-")
    try:
        source = pathlib.Path(__file__).parent / "TorqueFreeRun.java"
        done = subprocess.run(["javac", "-cp", jars, "-d", folder, str(source)], capture_output=True, text=True,
                              check=False)
        if done.returncode:
            raise Failure(f"does not compile: {(done.stderr.splitlines() or ['?'])[0]}")
        jpype.startJVM("-Xshare:auto", classpath=[jars, folder])
        found = jpype.JClass("TorqueFreeRun")
    finally:
        shutil.rmtree(folder, ignore_errors=True)   # the class is loaded
    times = np.linspace(0.0, 100.0, 200)
    for _ in range(100):
        found.run(np.array([1.0, 2.0, 2.5]), np.array([1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]), times)
    return found


def _refuses(scene: Scene) -> str:
    if scene.torques or scene.rotors:
        return "its closed form is of free bodies"
    matrix = scene.inertia.matrix
    return "" if (matrix == np.diag(np.diag(matrix))).all() else "only principal axes are written down for it here"


def _start(scene: Scene) -> Run:
    java = _class()
    moments = np.diag(scene.inertia.matrix).copy()
    start, times = np.concatenate([scene.omega, scene.attitude]), scene.times - scene.t0

    def run(value: float, limit: float | None) -> Answer:
        y = np.array(java.run(moments, start, times)).reshape(-1, 7)
        return Answer(y[:, :3].copy(), y[:, 3:].copy(), {})

    return run


def candidates() -> list[Candidate]:
    """Its TorqueFree, construction and all times in one call, the virtual machine warm."""
    return [Candidate("Orekit TorqueFree", "peer", "org.orekit.attitudes.TorqueFree", fixed("closed form"), _start,
                      _refuses, "", closed)]
