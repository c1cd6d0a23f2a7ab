"""Odd objects in every argument of the public callables: InvalidInput comes out, and nothing else."""

import decimal
import fractions
import pathlib
import warnings

import doors
import numpy as np
import pytest

import polhode as ph

T = ph.torques


class Liar:
    def __array__(self, *args, **kwargs):
        raise RuntimeError("no array")


class Quaternions:
    def as_quat(self):
        return np.array([0, 0, 0, 2.0])


def in_itself():
    items = []
    items.append(items)
    return items


SCENE = ph.Scene(inertia=(1, 2, 2.5), omega=(1, 2, 3), times=[0.0, 1.0])
ODD = {
    "None": None, "True": True, "bytes": b"1", "text": "1", "surrogate": "\ud800", "empty": "", "nan": float("nan"),
    "inf": float("inf"), "huge": 10**400, "-1": -1, "0": 0, "1.5": 1.5, "complex": 1j, "object": object(), "class": int,
    "Rotation class": ph.Rotation, "function": len, "module": np, "dict": {}, "set": {1, 2}, "list": [],
    "ragged": [[1], [1, 2]], "texts": ["a", "b"], "Nones": [None] * 3, "0-d": np.array(1.0),
    "datetime": np.datetime64("2020"), "timedelta": np.timedelta64(1, "s"),
    "datetimes": np.array(["2020", "2021", "2022"], "M8[D]"), "strings": np.array(["a", "b", "c"]),
    "objects": np.array([1, None, 2], object), "structured": np.zeros(3, [("a", "f8")]),
    "masked": np.ma.masked_array([1.0, 2, 3], [0, 1, 0]), "memoryview": memoryview(np.array([1.0, 2, 3])),
    "characters": memoryview(b"abc").cast("c"), "bytearray": bytearray(b"abc"), "range": range(3),
    "empty array": np.zeros(0), "no rows": np.zeros((0, 3)), "5-d": np.zeros((1, 1, 1, 1, 3)), "matrix": np.eye(3),
    "long double": np.ones(3, np.longdouble), "half": np.ones(3, np.float16), "liar": Liar(),
    "quaternions": Quaternions(), "Decimal": decimal.Decimal(1), "Fraction": fractions.Fraction(1, 3), "Scene": SCENE,
    "Rotation": ph.Rotation.identity(), "torque": T.Constant((1, 0, 0)), "no scene": ph.Scene.__new__(ph.Scene),
    "no tensor": ph.InertiaTensor.__new__(ph.InertiaTensor), "no torque": T.Constant.__new__(T.Constant),
    "ellipsis": ..., "big": np.full(3, 1e308), "strided": np.ones((3, 6))[:, ::2], "in itself": in_itself(),
    "path": pathlib.Path("nonexistent.toml"),
}
I, W, Q, TIMES = (1, 2, 2.5), (1, 2, 3), (0, 0, 0, 1), [0.0, 1.0]
FREE, SPUN = ph.FreeMotion(I, W), ph.Gyrostat(I, momentum=(1, 0, 0), omega=W)
TOP, SWING = ph.HeavyTop((1, 1, 0.5), 2.0, W), ph.Pendulum(I, 1.0, (0, 0, -1), (0.5, 0, 0))
DAMPED, TURNS = ph.DampedFree(I, 0.1, W), ph.Rotation.identity(3)
BATCH = dict(inertia=I, omega=W, attitude=Q, t=np.array(TIMES), out=None, want="omega", axis=None, frame="body",
             dtype="float64", threads=None, errors="raise")
CORNERS, SIDES = [[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
MOTION, T30 = ph.solve(SCENE, 1e-6, dense=True, sensitivity="omega"), np.linspace(0, 10, 30)
FORMULA = T.Formula(text="k * h * omega", k=1.0, states={"h": {"start": 1.0, "rate": "-h"}})
ORBIT = ph.Orbit(1.0, (1, 0, 0), (0, 1, 0))
RATES = ph.measured.Rates(T30, FREE.at(T30)[0], 0.01)

# A callable, and arguments that it takes; one of them at a time becomes odd. Up to a comma the name is the public one.
DOORS = {
    "free_motion": (ph.free_motion, BATCH),
    "free_motion, grid": (ph.free_motion, {**BATCH, "omega": np.ones((4, 1, 3))}),
    "gyrostat": (ph.gyrostat, {**BATCH, "momentum": (1, 0, 0)}),
    "heavy_top": (ph.heavy_top, {**BATCH, "inertia": (1, 1, 0.5), "weight_arm": 2.0}),
    "free_sensitivity": (ph.free_sensitivity, dict(inertia=I, omega=W, attitude=Q, t=TIMES, wrt="omega", side="space",
                                                   out=None, threads=None)),
    "step": (ph.step, dict(inertia=I, momentum=W, attitude=Q, h=0.1, frame="space", count=1, out=None, threads=None)),
    "Scene": (ph.Scene, dict(inertia=I, omega=W, attitude=Q, torques=(), times=TIMES, want="omega", t0=0.0, name="",
                             rotors=())),
    "Scene.replace": (SCENE.replace, dict(inertia=I, omega=W, attitude=Q, times=TIMES, name="")),
    "Scene.load": (ph.Scene.load, dict(source="S1")),
    "Scene.save": (SCENE.save, dict(path="-")), "Scene.show_url": (SCENE.show_url, dict(page="playground.html")),
    "solve": (ph.solve, dict(scene=SCENE, accuracy=None, plan=None, method=None, certify=True, rtol=None, atol=None,
                             step=None, max_steps=1000, dense=False, formulation="euler", sensitivity=None,
                             side="space")),
    "solve, events": (lambda events: ph.solve(SCENE, events=events if not callable(events) else ()), dict(events=())),
    "solve, tolerances": (ph.solve, dict(scene=SCENE, rtol=1e-6, atol=1e-9, method="rk45")),
    "solve_many": (ph.solve_many, dict(scenes=SCENE, inertia=I, omega=np.ones((2, 3)), attitude=Q, accuracy=1e-6,
                                       method=None, rtol=None, atol=None, step=None, max_steps=1000, threads=None,
                                       sensitivity="omega", side="space",
                                       errors="raise")),
    "Orbit": (ph.Orbit, dict(mu=1.0, r0=(1, 0, 0), v0=(0, 1, 0), t0=0.0)),
    "Orbit.at": (ph.Orbit(1.0, (1, 0, 0), (0, 1, 0)).at, dict(t=TIMES)),
    "Orbit.eclipses": (ph.Orbit(1.0, (1, 0, 0), (0, 1, 0)).eclipses, dict(sun=W, shadow=0.5, begin=0.0, end=1.0)),
    "Orbit.from_elements": (ph.Orbit.from_elements, dict(mu=1.0, periapsis_distance=1.0, a=None, e=0.1, inclination=0.1,
                                                         node=0.0, periapsis=0.0, anomaly=0.1, t0=0.0, j2=0.0,
                                                         radius=1.0)),
    "Orbit.table": (ph.Orbit.table, dict(t=TIMES, r=np.eye(3)[:2], v=np.eye(3)[:2], mu=None)),
    "plan": (ph.plan, dict(scene=SCENE, accuracy=1e-6, method=None, certify=True, formulation="euler",
                           leave_out=True)),
    "effect": (ph.effect, dict(scene=SCENE, torque=0)),
    "lyapunov": (ph.lyapunov, dict(scene=SCENE, span=1e-3, accuracy=1e-6)),
    "fit": (ph.fit, dict(data=RATES, scene=SCENE, fit="omega", start="search", loss="linear", f_scale=1.0, seed=0)),
    "MagneticField.dipole": (ph.MagneticField.dipole, dict(orbit=ORBIT, strength=1.0, tilt=0.1, spin=0.1, phase=0.0)),
    "MagneticField.gauss": (ph.MagneticField.gauss, dict(orbit=ORBIT, radius=1.0, g=[[0], [1, 2]], h=[[0], [0, 1]],
                                                         spin=0.1, phase=0.0)),
    "MagneticField.at": (ph.MagneticField.dipole(ORBIT, 1.0).at, dict(t=1.0, r=(1, 0, 0))),
    "Plate": (ph.Plate, dict(area=1.0, normal=W, centre=W, specular=0.1, diffuse=0.2)),
    "torques.Drag": (ph.torques.Drag, dict(plates=[ph.Plate(1.0, W, W)], orbit=ORBIT, coefficient=2.0, density=1.0,
                                           height_radius=1.0, scale_height=1.0, spin=0.0)),
    "torques.SolarPressure": (ph.torques.SolarPressure, dict(plates=ph.Plate(1.0, W, W), sun=W, pressure=1.0)),
    "torques.Dipole": (ph.torques.Dipole, dict(moment=W, field=ph.MagneticField.dipole(ORBIT, 1.0))),
    "judge": (ph.judge, dict(t=T30, attitude=FREE.at(T30)[1], omega=FREE.at(T30)[0], inertia=I, order="xyzw",
                             frame="body", euler=None, degrees=False, tolerance=1e-6, sigma=None)),
    "Judgement.fails": (ph.judge(T30, omega=FREE.at(T30)[0], inertia=I).fails, dict(level="warning")),
    "Rotor": (ph.Rotor, dict(axis=(0, 0, 1), momentum=1.0, inertia=None, speed=None, free=False, during=None,
                             torque=0.0, viscous=0.0, coulomb=0.0, max_torque=None, max_speed=None, let=None,
                             parameters=None)),
    "Changing": (ph.Changing, dict(pieces=[(0, 1, [(1, 2, 2.5)])], before=None, after=None, physical=True)),
    "Changing.at": (ph.Changing([(0, 1, [(1, 2, 2.5)])]).at, dict(t=0.5)),
    "Changing.ramp": (ph.Changing.ramp, dict(before=(1, 2, 2.5), after=(1, 2, 2.7), times=(0, 1), order=5,
                                             physical=True)),
    "Changing.table": (ph.Changing.table, dict(t=(0, 1), values=[(1, 2, 2.5), (1, 2, 2.7)], physical=True)),
    "Controller": (ph.Controller, dict(period=1.0, function=None, output="torque", states={"z": 0.0}, delay=0.0,
                                       parameters={"k": 1.0}, width=None, start=0.0, limit=None, field=None,
                                       measure=None, trace=True, command="k * omega", update={"z": "z"}, let=None,
                                       initial=None, rotors=None)),
    "Controller.replace": (ph.Controller(1.0, command="omega").replace, dict(period=2.0, delay=0.1)),
    "Measure": (ph.Measure, dict(omega_noise=0.0, attitude_noise=0.0, field_noise=0.0, omega_quantum=0.0, seed=1)),
    "Damper": (ph.Damper, dict(inertia=0.1, viscous=0.1, rates=(0, 0, 0))),
    "FreeMotion": (ph.FreeMotion, dict(inertia=I, omega=W, attitude=Q)),
    "Gyrostat": (ph.Gyrostat, dict(inertia=I, momentum=(1, 0, 0), omega=W, attitude=Q, rotors=None)),
    "HeavyTop": (ph.HeavyTop, dict(inertia=(1, 1, 0.5), weight_arm=2.0, omega=W, attitude=Q)),
    "Pendulum": (ph.Pendulum, dict(inertia=I, weight=1.0, arm=(0, 0, -1), omega=(0.5, 0, 0), attitude=Q)),
    "DampedFree": (ph.DampedFree, dict(inertia=I, damping=0.1, omega=W, attitude=Q)),
    "FreeMotion.at": (FREE.at, dict(t=TIMES)), "FreeMotion.euler_angles": (FREE.euler_angles, dict(t=TIMES)),
    "FreeMotion.polhode": (FREE.polhode, dict(t=TIMES)), "FreeMotion.herpolhode": (FREE.herpolhode, dict(t=TIMES)),
    "FreeMotion.sensitivity": (FREE.sensitivity, dict(t=TIMES, wrt="omega", side="space")),
    "FreeMotion.flip_times": (FREE.flip_times, dict(begin=0.0, end=1.0)),
    "Gyrostat.at": (SPUN.at, dict(t=TIMES)), "Gyrostat.euler_angles": (SPUN.euler_angles, dict(t=TIMES)),
    "Gyrostat.polhode": (SPUN.polhode, dict(t=TIMES)), "HeavyTop.at": (TOP.at, dict(t=TIMES)),
    "Pendulum.at": (SWING.at, dict(t=TIMES)), "DampedFree.at": (DAMPED.at, dict(t=TIMES)),
    "DampedFree.slowed_time": (DAMPED.slowed_time, dict(t=1.0)),
    "Motion.__call__": (lambda t: MOTION(t), dict(t=TIMES)),
    "Sensitivity.column": (MOTION.sensitivity.column, dict(name="omega_x")),
    "Event": (ph.Event, dict(function=len, direction=0, terminal=False)),
    "Rotation": (ph.Rotation, dict(quat=Q, scalar_first=False)),
    "Rotation.from_quat": (ph.Rotation.from_quat, dict(quat=Q, scalar_first=False)),
    "Rotation.from_matrix": (ph.Rotation.from_matrix, dict(matrix=np.eye(3))),
    "Rotation.from_rotvec": (ph.Rotation.from_rotvec, dict(rotvec=W, degrees=False)),
    "Rotation.from_euler": (ph.Rotation.from_euler, dict(seq="ZXZ", angles=W, degrees=False)),
    "Rotation.from_mrp": (ph.Rotation.from_mrp, dict(mrp=W)),
    "Rotation.align_vectors": (ph.Rotation.align_vectors, dict(a=np.eye(3), b=np.eye(3), weights=None)),
    "Rotation.identity": (ph.Rotation.identity, dict(num=None, shape=None)),
    "Rotation.random": (ph.Rotation.random, dict(num=None, rng=1, shape=None)),
    "Rotation.concatenate": (ph.Rotation.concatenate, dict(rotations=[TURNS, TURNS])),
    "Rotation.as_quat": (TURNS.as_quat, dict(canonical=False, scalar_first=False)),
    "Rotation.as_rotvec": (TURNS.as_rotvec, dict(degrees=False)),
    "Rotation.as_euler": (TURNS.as_euler, dict(seq="ZXZ", degrees=False)),
    "Rotation.gimbal_lock": (TURNS.gimbal_lock, dict(seq="ZXZ")),
    "Rotation.apply": (TURNS.apply, dict(vectors=W, inverse=False)),
    "Rotation, power": (lambda n: TURNS ** n, dict(n=2.0)),
    "Rotation.mean": (TURNS.mean, dict(weights=None)), "Rotation.spread": (TURNS.spread, dict(weights=None)),
    "Rotation.approx_equal": (TURNS.approx_equal, dict(other=TURNS, atol=None, degrees=False)),
    "body_rates": (ph.body_rates, dict(sequence="ZXZ", angles=W, angle_rates=W)),
    "euler_rates": (ph.euler_rates, dict(sequence="ZXZ", angles=W, omega=W)),
    "generalised_forces": (ph.generalised_forces, dict(torque=W, angles=W)),
    "InertiaTensor": (ph.InertiaTensor, dict(matrix=np.eye(3))),
    "InertiaTensor.from_moments": (ph.InertiaTensor.from_moments, dict(moments=I)),
    "MassProperties.from_mesh": (ph.MassProperties.from_mesh, dict(vertices=CORNERS, faces=SIDES, mass=1.0)),
    "mesh.report": (ph.mesh.report, dict(vertices=CORNERS, faces=SIDES)),
    "mesh.read": (ph.mesh.read, dict(path="x.stl")),
    "inertia.principal_axes": (ph.inertia.principal_axes, dict(matrices=np.eye(3))),
    "inertia.from_pendulum": (ph.inertia.from_pendulum, dict(period=(1.2, 0.01), mass=2.2, distance=0.17, gravity=9.8,
                                                             amplitude=0.1)),
    "inertia.from_bifilar": (ph.inertia.from_bifilar, dict(period=(1.2, 0.01), mass=2.2, length=1.0, spacing=0.3,
                                                           gravity=9.8, amplitude=0.1)),
    "inertia.diagnose": (lambda body: ph.inertia.diagnose(body), dict(body=np.eye(3))),
    "elliptic.K": (ph.elliptic.K, dict(m=0.5)), "elliptic.nome": (ph.elliptic.nome, dict(m=0.5)),
    "elliptic.jacobi": (ph.elliptic.jacobi, dict(u=0.5, m=0.5)),
    "measured.Rates": (ph.measured.Rates, dict(t=T30, y=FREE.at(T30)[0], sigma=0.01)),
    "measured.Acceleration": (ph.measured.Acceleration, dict(t=T30, y=FREE.at(T30)[0], sigma=0.01, arm=(1, 2, 3))),
    "measured.Brightness": (ph.measured.Brightness, dict(
        t=T30, y=np.ones(T30.size), sigma=0.01, body=(1, 2, 3), sun=(0, 0, 1), observer=(0, 1, 0), law="lambert",
        night=np.zeros(T30.size), scale=True, offset=False)),
    "torques.During": (T.During, dict(torque=T.Constant(W), windows=[(0, 1)])),
    "torques.Constant": (T.Constant, dict(torque=W, frame="body")),
    "torques.Gravity": (T.Gravity, dict(weight=1.0, arm=W)), "torques.Custom": (T.Custom, dict(function=len)),
    "torques.Formula": (T.Formula, dict(text="k * omega", let={"u": "k * t"}, recognise=True, k=1.0)),
    "torques.Formula, states": (T.Formula, dict(text="h * omega", states={"h": {"start": 1.0, "rate": "-h"}})),
    "torques.Formula, potential": (T.Formula, dict(potential="attitude.x")),
    "torques.Formula.rates": (FORMULA.rates, dict(t=0.0, omega=W, attitude=Q, states={"h": 1.0})),
    "torques.Formula.with_parameters": (FORMULA.with_parameters, dict(k=1.0)),
    "torques.Formula.with_starts": (FORMULA.with_starts, dict(h=1.0)),
    "torques.Formula.energy": (FORMULA.energy, dict(t=0.0, attitude=Q)),
    "torques.Formula, function": (T.Formula, dict(function=lambda t, omega, attitude, p: omega)),
    "formula.to_body": (ph.formula.to_body, dict(attitude=Q, v=W)),
    "formula.to_space": (ph.formula.to_space, dict(attitude=Q, v=W)),
    "formula.friction": (ph.formula.friction, dict(load=0.1, rate=W)),
    "formula.norm": (ph.formula.norm, dict(v=W, smooth=0.0)),
    "formula.where": (ph.formula.where, dict(condition=True, a=W, b=W)),
    "formula.clip": (ph.formula.clip, dict(a=W, low=0.0, high=1.0)),
    "Scene, torque": (SCENE.torque, dict(t=0.0, omega=W, attitude=Q)),
    "torques.Gravity.as_formula": (T.Gravity(1.0, W).as_formula, dict(inertia=None)),
    "torques.Constant.as_formula": (T.Constant(W).as_formula, dict(inertia=None)),
    "torques.Damping.as_formula": (T.Damping(W).as_formula, dict(inertia=None)),
    "torques.Formula.as_formula": (FORMULA.as_formula, dict(inertia=None)),
    "torques.Gravity.value": (T.Gravity(1.0, W).value, dict(t=0.0, omega=W, attitude=Q, inertia=None)),
    "torques.Damping": (T.Damping, dict(matrix=np.eye(3))), "load": (ph.load, dict(path="x.npz")),
}
# What takes nothing but self, a file, or the user's own data is left out; the rest must stand above.
OUT = ("AttitudeEphemeris", "Judgement", "line", "to_dict",
       "Ensemble", "FitResult", "Lyapunov", "Motion", "Motions", "Plan", "Sensitivity", "PrincipalAxes",
       "MassProperties",
       "InertiaTensor", "IntegrationFailure", "InvalidInput", "animate", "plot", "inv", "magnitude", "as_matrix",
       "as_mrp", "atlas", "charts", "recipe", "report", "schema", "shapes", "ensemble", "methods", "build_info",
       "cmake_prefix", "measured", "inertia", "records", "AngularDamping", "GravityGradient", "OrbitGradient",
       "MagneticField", "value")


def test_every_public_callable_is_tried_or_left_out():
    tried = {name.partition(",")[0] for name in DOORS}
    assert tried <= set(doors.public())
    assert not [name for name in doors.public() if name not in tried and not set(name.split(".")) & set(OUT)]


@pytest.mark.parametrize("name", DOORS)
def test_odd_objects_are_taken_or_refused(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)   # one of them is a path, to which a scene is saved
    call, arguments = DOORS[name]
    wrong = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for key in arguments:
            for odd, value in {**ODD, "generator": (x for x in (1, 2, 3))}.items():
                try:
                    call(**{**arguments, key: value})
                except ph.InvalidInput as error:
                    if "pybind" in str(error).lower():
                        wrong.append(f"{key}={odd}: {error}")
                except MemoryError:
                    pass
                except Exception as error:
                    wrong.append(f"{key}={odd}: {type(error).__name__}: {str(error)[:80]}")
    assert not wrong, "\n".join(wrong)
