"""MuJoCo: a free body at fixed steps, by its default integrator and by its most accurate one."""

from __future__ import annotations

import time

import numpy as np

from ..._scene.scene import Scene
from ..candidate import Answer, Candidate, Failure, Run, Settings, steps, uniform
from .found import version

NAME, INSTALL = "MuJoCo", "pip install mujoco"
MODEL = """<mujoco><option gravity="0 0 0" integrator="{integrator}"><flag contact="disable"/></option>
<worldbody><body><freejoint/><inertial pos="0 0 0" mass="1" fullinertia="{inertia}"/></body></worldbody></mujoco>"""


def found() -> str:
    """The version, or ""."""
    return version("mujoco")


def _refuses(scene: Scene) -> str:
    if scene.torques or scene.rotors:
        return "only free bodies are written down for it here"
    if not scene.inertia.physical:
        return "it refuses inertias that break the triangle inequality"
    return "" if uniform(scene) else "its fixed steps want samples equally far apart"


def _start(scene: Scene, integrator: str) -> Run:
    import mujoco as mj  # type: ignore[import-not-found,import-untyped,unused-ignore]

    mj.set_mju_user_warning(lambda text: None)   # of unstable steps, which else go to a file where one stands
    m = scene.inertia.matrix
    numbers = " ".join(repr(float(v)) for v in (m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[0, 2], m[1, 2]))
    model = mj.MjModel.from_xml_string(MODEL.format(integrator=integrator, inertia=numbers))
    data = mj.MjData(model)
    n = scene.times.size
    gap = float(scene.times[-1] - scene.t0) / max(n - 1, 1)

    def run(step: float, limit: float | None) -> Answer:
        count = max(1, round(gap / step))
        model.opt.timestep = gap / count
        mj.mj_resetData(model, data)
        data.qpos[3:7] = scene.attitude[[3, 0, 1, 2]]   # its quaternions are (w, x, y, z)
        data.qvel[3:6] = scene.omega                    # of a free joint: in body axes
        omega, attitude = np.empty((n, 3)), np.empty((n, 4))
        end = None if limit is None else time.perf_counter() + limit
        for i in range(n):
            if i:
                mj.mj_step(model, data, count)
            omega[i], attitude[i] = data.qvel[3:6], data.qpos[3:7]
            if end is not None and time.perf_counter() > end:
                raise Failure(f"not done within {limit:.2g} s: reached sample {i} of {n}")
        return Answer(omega, attitude[:, [1, 2, 3, 0]], {"steps": count * (n - 1)})

    return run


def candidates() -> list[Candidate]:
    """Runge and Kutta's 4, its most accurate, and Euler, its default; between the samples all steps are in C."""
    def settings(scene: Scene) -> Settings:
        return steps(scene, 7, 4)

    def make(integrator: str) -> Candidate:
        return Candidate(f"MuJoCo {integrator}", "peer", f"mujoco.mj_step(nstep), integrator {integrator}", settings,
                         lambda scene: _start(scene, integrator), _refuses, "step")

    return [make("RK4"), make("Euler")]
