"""Steps of engines, judged: polhode's cheap methods, and a free body of MuJoCo where it is installed."""

import argparse

import numpy as np

import polhode as ph

MODEL = """<mujoco><option timestep="{}" integrator="{}" gravity="0 0 0"/><worldbody><body><freejoint/>
<inertial pos="0 0 0" mass="1" diaginertia="1 2 2.5"/></body></worldbody></mujoco>"""
MUJOCO = ("Euler", "implicit", "implicitfast", "RK4")


def scene_of(step, span):
    times = step * np.arange(round(span / step) + 1)
    return ph.Scene(inertia=(1, 2, 2.5), omega=(1, 0.5, 2), times=times)


def by_mujoco(name, scene, step):
    """Attitudes, with the scalar first, and rates of MuJoCo."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(MODEL.format(step, name))
    data = mujoco.MjData(model)
    data.qvel[3:] = scene.omega
    mujoco.mj_forward(model, data)
    attitude, omega = [data.qpos[3:].copy()], [data.qvel[3:].copy()]
    for _ in scene.times[1:]:
        mujoco.mj_step(model, data)
        attitude.append(data.qpos[3:].copy())
        omega.append(data.qvel[3:].copy())
    return attitude, omega


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=0.03)
    parser.add_argument("--span", type=float, default=6.0)
    given = parser.parse_args()
    scene = scene_of(given.step, given.span)
    for record in ph.methods():
        if not record["adaptive"]:
            try:
                run = ph.solve(scene, method=record["name"], step=given.step)
            except ph.InvalidInput:
                continue   # it is for other bodies
            found = ph.judge(scene.times, run.attitude, run.omega, scene=scene, tolerance=1e-9)
            print(f"polhode {record['name']}: {found.line()}", flush=True)
    try:
        import mujoco
    except ImportError:
        return
    for name in MUJOCO:
        attitude, omega = by_mujoco(name, scene, given.step)
        found = ph.judge(scene.times, attitude, omega, scene=scene, order="wxyz", tolerance=1e-9)
        print(f"MuJoCo {mujoco.__version__} {name}: {found.line()}", flush=True)


if __name__ == "__main__":
    main()
