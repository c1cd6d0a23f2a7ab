"""Free bodies of engines, judged: polhode's cheap steps, MuJoCo, Drake, Bullet and JSBSim where they are installed.

    pip install mujoco drake pybullet jsbsim
    python benchmarks/judge_engines.py --step 0.03 --only MuJoCo
"""

import argparse
import dataclasses
import pathlib
import tempfile

import numpy as np

import polhode as ph

MOMENTS, OMEGA = (1.0, 2.0, 2.5), (1.0, 0.5, 2.0)


@dataclasses.dataclass
class Run:
    """Samples as an engine gives them, with the words that `polhode.judge` needs to read them."""

    engine: str
    setting: str
    t: np.ndarray
    attitude: np.ndarray
    omega: np.ndarray
    words: dict = dataclasses.field(default_factory=dict)


def times(step, span):
    return step * np.arange(round(span / step) + 1)


def polhode(step, span):
    """The methods of `solve` that step by a given length."""
    scene = ph.Scene(inertia=MOMENTS, omega=OMEGA, times=times(step, span))
    for record in ph.methods():
        if not record["adaptive"]:
            try:
                run = ph.solve(scene, method=record["name"], step=step)
            except ph.InvalidInput:
                continue  # it is for other bodies
            yield Run(f"polhode {ph.__version__}", record["name"], scene.times, run.attitude, run.omega)


MJCF = """<mujoco><option timestep="{}" integrator="{}" gravity="0 0 0"/><worldbody><body><freejoint/>
<inertial pos="0 0 0" mass="1" diaginertia="1 2 2.5"/></body></worldbody></mujoco>"""


def mujoco(step, span):
    """A free joint: its velocity has the rates in body axes, its position the quaternion with the scalar first."""
    import mujoco as engine

    for name in ("Euler", "implicit", "implicitfast", "RK4"):
        model = engine.MjModel.from_xml_string(MJCF.format(step, name))
        data = engine.MjData(model)
        data.qvel[3:] = OMEGA
        engine.mj_forward(model, data)
        t = times(step, span)
        rows = [(data.qpos[3:].copy(), data.qvel[3:].copy())]
        for _ in t[1:]:
            engine.mj_step(model, data)
            rows.append((data.qpos[3:].copy(), data.qvel[3:].copy()))
        attitude, omega = map(np.array, zip(*rows))
        yield Run(f"MuJoCo {engine.__version__}", name, t, attitude, omega, {"order": "wxyz"})


DRAKE = ("discrete", "explicit_euler", "semi_explicit_euler", "implicit_euler", "velocity_implicit_euler",
         "runge_kutta2", "runge_kutta3", "bogacki_shampine3", "radau1", "radau3", "runge_kutta5")  # fmt: skip


def drake(step, span):
    """A floating body. Continuous plants have a fixed step here: their error control is switched off."""
    import importlib.metadata

    from pydrake.multibody.math import SpatialVelocity
    from pydrake.multibody.plant import MultibodyPlant
    from pydrake.multibody.tree import SpatialInertia, UnitInertia
    from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig

    for name in DRAKE:
        plant = MultibodyPlant(step if name == "discrete" else 0.0)
        body = plant.AddRigidBody("body", SpatialInertia(1.0, np.zeros(3), UnitInertia(*MOMENTS)))
        plant.mutable_gravity_field().set_gravity_vector(np.zeros(3))
        plant.Finalize()
        simulator = Simulator(plant)
        if name != "discrete":
            config = SimulatorConfig(integration_scheme=name, max_step_size=step, use_error_control=False)
            ApplySimulatorConfig(config, simulator)
        context = simulator.get_mutable_context()
        plant.SetFreeBodySpatialVelocity(context=context, body=body,
                                         V_JpJc=SpatialVelocity(np.array(OMEGA), np.zeros(3)))  # fmt: skip
        simulator.Initialize()
        t, rows = times(step, span), []
        for at in t:
            if at > 0:
                simulator.AdvanceTo(at)
            q = plant.EvalBodyPoseInWorld(context, body).rotation().ToQuaternion()
            rate = plant.EvalBodySpatialVelocityInWorld(context, body).rotational()
            rows.append(([q.x(), q.y(), q.z(), q.w()], rate.copy()))
        attitude, omega = map(np.array, zip(*rows))
        yield Run(f"Drake {importlib.metadata.version('drake')}", name, t, attitude, omega, {"frame": "space"})


def bullet(step, span):
    """A base without links, as it is made by default, and as a rigid body of maximal coordinates."""
    import importlib.metadata

    import pybullet as engine

    engine.connect(engine.DIRECT)
    for name, maximal in (("default", False), ("useMaximalCoordinates", True)):
        engine.resetSimulation()
        engine.setGravity(0, 0, 0)
        engine.setTimeStep(step)
        shape = engine.createCollisionShape(engine.GEOM_BOX, halfExtents=[0.1] * 3)
        body = engine.createMultiBody(1.0, shape, useMaximalCoordinates=maximal)
        engine.changeDynamics(body, -1, localInertiaDiagonal=MOMENTS, linearDamping=0, angularDamping=0)
        engine.resetBaseVelocity(body, [0, 0, 0], OMEGA)
        t, rows = times(step, span), []
        for at in t:
            if at > 0:
                engine.stepSimulation()
            rows.append((engine.getBasePositionAndOrientation(body)[1], engine.getBaseVelocity(body)[1]))
        attitude, omega = map(np.array, zip(*rows))
        version = importlib.metadata.version("pybullet")
        yield Run(f"PyBullet {version}", name, t, attitude, omega, {"frame": "space"})
    engine.disconnect()


AIRCRAFT = """<?xml version="1.0"?><fdm_config name="brick" version="2.0" release="BETA">
<fileheader><author/><filecreationdate/><version/><description/></fileheader>
<metrics><wingarea unit="M2">1</wingarea><wingspan unit="M">1</wingspan><chord unit="M">1</chord>
<location name="AERORP" unit="M"><x>0</x><y>0</y><z>0</z></location></metrics>
<mass_balance><ixx unit="KG*M2">1</ixx><iyy unit="KG*M2">2</iyy><izz unit="KG*M2">2.5</izz>
<emptywt unit="KG">1</emptywt><location name="CG" unit="M"><x>0</x><y>0</y><z>0</z></location></mass_balance>
<ground_reactions/><propulsion/><flight_control name="none"/><aerodynamics/></fdm_config>"""
PLANET = """<?xml version="1.0"?><planet name="at rest"><equatorial_radius unit="FT">20925646</equatorial_radius>
<polar_radius unit="FT">20855486</polar_radius><rotation_rate unit="RAD/SEC">0</rotation_rate>
<GM unit="M3/SEC2">1e-6</GM><J2>0</J2></planet>"""
JSBSIM = {1: "Euler", 2: "trapezoidal", 3: "AB2", 4: "AB3", 5: "AB4", 6: "Buss 1", 7: "Buss 2", 8: "local linear",
          9: "AB5"}  # fmt: skip


def jsbsim(step, span):
    """A brick above a planet at rest, with each integrator of the attitude and the default one of the rates."""
    import jsbsim as engine

    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for part in ("aircraft/brick", "engine", "systems"):
            (root / part).mkdir(parents=True)
        (root / "aircraft/brick/brick.xml").write_text(AIRCRAFT)
        (root / "planet.xml").write_text(PLANET)
        for number, name in (None, "default"), *JSBSIM.items():
            model = engine.FGFDMExec(str(root))
            model.set_debug_level(0)
            model.load_planet(str(root / "planet.xml"), False)
            model.load_model("brick")
            model.set_dt(step)
            for key, value in {"h-sl-ft": 30000.0, "phi-rad": 0.0, "theta-rad": 0.0, "psi-true-rad": 0.0,
                               "p-rad_sec": OMEGA[0], "q-rad_sec": OMEGA[1], "r-rad_sec": OMEGA[2]}.items():
                model[f"ic/{key}"] = value
            if number is not None:
                model["simulation/integrator/position/rotational"] = number
            model.run_ic()
            rows = []
            for k in range(len(times(step, span))):
                if k:
                    model.run()
                rows.append(([model[f"attitude/{x}-rad"] for x in ("psi", "theta", "phi")],
                             [model[f"velocities/{x}i-rad_sec"] for x in "pqr"]))
            attitude, omega = map(np.array, zip(*rows))
            yield Run(f"JSBSim {engine.__version__}", name, times(step, span), attitude, omega, {"euler": "ZYX"})


ENGINES = {"polhode": polhode, "MuJoCo": mujoco, "Drake": drake, "PyBullet": bullet, "JSBSim": jsbsim}


def judged(run):
    """The verdict about a run, whose start is a claim too."""
    scene = ph.Scene(inertia=MOMENTS, omega=OMEGA, times=run.t)
    return ph.judge(run.t, run.attitude, run.omega, scene=scene, tolerance=1e-9, **run.words)


def said(found, step):
    """The main finding in a few words."""
    if found.fine:
        return "fine"
    main = found.findings[0]
    if main.order:
        length = "one step" if abs(main.step / step - 1) < 1e-6 else f"{main.step / step:.4g} steps"
        return f"{main.cause}, order {main.order}, {length}, like {main.method}"
    if main.rivals:
        return f"{main.cause}: {' or '.join(main.rivals)}" if main.cause == "cannot tell" else main.cause
    return main.cause


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=0.03)
    parser.add_argument("--span", type=float, default=6.0)
    parser.add_argument("--only", default="", help="an engine, such as MuJoCo")
    given = parser.parse_args()
    print("| engine | setting | what the judge says | deviates [rad] | left [rad] |\n|---|---|---|---|---|")
    for name, runs in ENGINES.items():
        if given.only not in ("", name):
            continue
        try:
            for run in runs(given.step, given.span):
                found = judged(run)
                size, rest = found.deviation.attitude_rms, found.noise.attitude_rms
                words = f"| {run.engine} | {run.setting} | {said(found, given.step)}"
                print(f"{words} | {size:.1e} | {rest:.1e} |", flush=True)
        except ImportError:
            print(f"| {name} | is not installed ||||")


if __name__ == "__main__":
    main()
