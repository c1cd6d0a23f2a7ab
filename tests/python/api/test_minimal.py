"""A smoke test of every public name. It needs NumPy and pytest alone: run it on an installed wheel, from any folder."""

import importlib
import pathlib
import pickle
import re
import subprocess
import sys
import tempfile
import types

import numpy as np
import pytest
from smoke_bodies import (
    BLOCK,
    OMEGA,
    TIMES,
    scene,
    smoke_attitude_ephemeris,
    smoke_changing,
    smoke_controller,
    smoke_damper,
    smoke_measure,
    smoke_rotor,
)

import polhode as ph
from polhode import _wings


def smoke_rotation():
    turn = ph.Rotation.from_euler("ZXZ", (0.1, 0.2, 0.3))
    assert np.allclose((turn * turn.inv()).as_matrix(), np.eye(3))


def smoke_body_rates():
    rates = ph.body_rates("ZXZ", (0.1, 0.2, 0.3), (1.0, 2.0, 3.0))
    assert np.allclose(ph.euler_rates("ZXZ", (0.1, 0.2, 0.3), rates), (1.0, 2.0, 3.0))


def smoke_free_motion_object():
    motion = ph.FreeMotion(BLOCK, OMEGA)
    omega, attitude = motion.at(TIMES)
    assert omega.shape == (5, 3) and attitude.shape == (5, 4)
    assert np.allclose((omega**2 * BLOCK).sum(axis=1) / 2, motion.energy)
    assert pickle.loads(pickle.dumps(motion)) == motion


def smoke_gyrostat_object():
    motion = ph.Gyrostat(BLOCK, momentum=(0.3, -0.2, 0.5), omega=OMEGA)
    omega, attitude = motion.at(TIMES)
    assert omega.shape == (5, 3) and attitude.shape == (5, 4)
    assert np.allclose((omega**2 * BLOCK).sum(axis=1) / 2, motion.energy)
    assert pickle.loads(pickle.dumps(motion)) == motion


def smoke_gyrostat():
    omega, attitude = ph.gyrostat(BLOCK, (0.3, -0.2, 0.5), OMEGA, (0, 0, 0, 1), TIMES)
    assert np.allclose(omega, ph.Gyrostat(BLOCK, momentum=(0.3, -0.2, 0.5), omega=OMEGA).at(TIMES)[0], rtol=1e-13)


def smoke_heavy_tops():
    omega, attitude = ph.heavy_top((1, 1, 0.5), np.array([1.0, 2.0]), (0.1, 0.2, 6), (0, 0, 0, 1), 3.5)
    assert omega.shape == (2, 3) and np.allclose(np.linalg.norm(attitude, axis=1), 1)
    assert np.allclose(omega[1], ph.HeavyTop((1, 1, 0.5), 2.0, (0.1, 0.2, 6)).at(3.5)[0])


def smoke_step():
    L, attitude = ph.step(BLOCK, np.multiply(BLOCK, OMEGA), (0, 0, 0, 1), 0.1, frame="body")
    assert L.shape == (3,) and abs(np.linalg.norm(attitude) - 1) < 1e-15


def smoke_lyapunov():
    found = ph.lyapunov(scene(times=[20.0]))
    assert isinstance(found, ph.Lyapunov) and abs(found.exponent) < 0.5


def smoke_judge():
    omega, attitude = ph.FreeMotion(BLOCK, OMEGA).at(np.linspace(0, 5, 100))
    found = ph.judge(np.linspace(0, 5, 100), attitude, omega, inertia=BLOCK)
    assert isinstance(found, ph.Judgement) and found.fine


def smoke_free_sensitivity():
    s = ph.free_sensitivity(BLOCK, OMEGA, (0, 0, 0, 1), TIMES)
    assert s.d_omega.shape == (5, 3, 6) and np.allclose(s.d_omega[..., 3:] @ BLOCK, 0, atol=1e-13)


def smoke_sensitivity():
    s = ph.FreeMotion(BLOCK, OMEGA).sensitivity(TIMES, ("omega", "attitude"))
    assert isinstance(s, ph.Sensitivity) and np.allclose(np.linalg.det(s.transition), 1)


def measured_rates():
    t = np.linspace(0, 5, 100)
    rng = np.random.default_rng(1)
    return ph.measured.Rates(t, ph.FreeMotion(BLOCK, OMEGA).at(t)[0] + 0.01 * rng.normal(size=(100, 3)), 0.01)


def smoke_fit():
    assert np.allclose(ph.fit(measured_rates(), fit=("omega", "inertia")).omega, OMEGA, atol=0.05)


def smoke_fit_result():
    found = ph.fit(measured_rates(), fit=("omega", "inertia"))
    assert isinstance(found, ph.FitResult) and found.predict([0.0, 9.0]).spread[1] > 0


def smoke_free_motion():
    omega, attitude = ph.free_motion(BLOCK, OMEGA, (0, 0, 0, 1), TIMES)
    assert np.allclose(omega, ph.FreeMotion(BLOCK, OMEGA).at(TIMES)[0], rtol=1e-13)


def smoke_pendulum():
    swing = ph.Pendulum(BLOCK, 2.0, (0, 0, -0.5), (1e-3, 0, 0))
    assert np.allclose(swing.at(2.0)[0][0], 1e-3 * np.cos(2.0 * swing.frequency), atol=1e-9)


def smoke_damped_free():
    motion = ph.DampedFree(BLOCK, 0.5, OMEGA)
    assert np.allclose(motion.at(2.0)[0], np.exp(-1.0) * motion.free.at(motion.slowed_time(2.0))[0])


def smoke_heavy_top():
    top = ph.HeavyTop((1, 1, 0.5), 2.0, (0, 0, 6), ph.Rotation.from_euler("ZXZ", (0, 0.5, 0)))
    assert np.allclose(top.at(TIMES)[0][:, 2], 6.0)


def smoke_inertia_tensor():
    tensor = ph.InertiaTensor(np.diag(BLOCK))
    assert tensor == ph.InertiaTensor.from_moments(BLOCK) and tensor.about_axis((0, 0, 2)) == 0.52


def smoke_mass_properties():
    block = ph.MassProperties(12.0, (0, 0, 0), ph.InertiaTensor.from_moments(BLOCK))
    assert np.allclose(block.about((0, 0, 0.1)).moments, (0.32, 0.52, 0.52))
    again = ph.MassProperties.from_tensor(12.0, (0, 0, 0), block.about((0, 0, 0.1)), about=(0, 0, 0.1))
    assert np.allclose(again.inertia.moments, BLOCK) and ph.inertia.equivalent_box(12.0, again.inertia)[0].shape == (3,)
    assert 0.24 < ph.inertia.from_pendulum((2, 0.01), 1, 0.5).moment < ph.inertia.from_bifilar(2, 1, 1, 1).moment < 0.25
    corners, faces = [(0, 0, 0), (1, 0, 0), (0, 2, 0), (0, 0, 3)], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    assert ph.MassProperties.from_mesh(corners, faces, density=2).mass == 2.0
    assert ph.shapes.volume("box", (1, 1, 1)) == 8


def smoke_principal_axes():
    assert isinstance(ph.InertiaTensor(np.diag(BLOCK)).principal(), ph.PrincipalAxes)


def smoke_scene():
    assert pickle.loads(pickle.dumps(scene())) == scene() and scene(t0=1.0) != scene()


def smoke_solve():
    motion = ph.solve(scene(), accuracy=1e-9)
    assert isinstance(motion, ph.Motion) and motion.success, motion.message
    assert np.allclose(motion.omega, ph.FreeMotion(BLOCK, OMEGA).at(TIMES)[0], atol=1e-8)


def smoke_plan():
    made = ph.plan(scene(), 1e-9)
    assert isinstance(made, ph.Plan) and made.method == "exact" and made.model in str(made)


def smoke_effect():
    weak = scene(torques=[ph.torques.Constant((1e-15, 0, 0))])
    found = ph.effect(weak)
    assert found.kind == "bounded" and 0 < found.omega < 1e-9 and ph.plan(weak, 1e-9).left_out[0].torque == 0


def smoke_event():
    spin = ph.Event(lambda t, omega, attitude: omega[0], terminal=True)
    assert ph.solve(scene(times=[0.0, 5.0]), events=[spin]).status == "event"


def smoke_generalised_forces():
    assert np.allclose(ph.generalised_forces((0, 0, 2.0), (0.1, 0.2, 0.3))[2], 2.0)


def smoke_methods():
    assert "rk45" in {method["name"] for method in ph.methods()}


def smoke_errors():
    assert issubclass(ph.InvalidInput, ValueError) and issubclass(ph.IntegrationFailure, RuntimeError)
    with pytest.raises(ph.InvalidInput, match="omega"):
        ph.FreeMotion(BLOCK, (1.0, float("nan"), 0.0))


def smoke_build_info():
    info = ph.build_info()
    print(info)
    assert {"version", "compiler", "flags", "eigen", "simd"} <= set(info) and info["version"] == ph.__version__


def smoke_cmake_prefix():
    try:
        prefix = pathlib.Path(ph.cmake_prefix())
    except ph.InvalidInput as error:   # a wheel of the module alone
        assert "pip install polhode-cpp" in str(error)
        return
    assert all((prefix / "include/polhode" / name).exists() for name in ("polhode.hpp", "step.hpp", "polhode_step.h"))
    assert (prefix / "lib/cmake/polhode/polhodeConfig.cmake").exists()


def smoke_solve_many():
    many = ph.solve_many(scene(torques=[ph.torques.Damping((0.1, 0.1, 0.1))]), omega=[(1, 2, 3), (3, 2, 1)], rtol=1e-9)
    assert isinstance(many, ph.Motions) and many.omega.shape == (2, 5, 3) and many.success.all()


RECIPE = """
count = 100
seed = 1
draw = "by-body"
body = { moments = [0.2, 0.4, 0.52] }
start = { omega = { normal = [[1.0, 2.0, 3.0], 0.1] } }
times = { span = 1.0, samples = 5 }
"""


def smoke_ensemble():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "recipe.toml"
        path.write_text(RECIPE)
        run = ph.ensemble(path, executor=0)
    assert isinstance(run, ph.Ensemble) and run.done == 100
    assert np.allclose(run.summary["omega"].mean[0], np.linalg.norm(run.bodies(range(100)).omega, axis=1).mean())


def smoke_load():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "motion.npz"
        motion = ph.solve(scene(), rtol=1e-8)
        motion.save(path)
        again = ph.load(path)
    assert np.array_equal(again.omega, motion.omega) and again.scene == motion.scene
    assert np.array_equal(ph.solve(again.scene, **again.options).omega, motion.omega)


def smoke_orbit():
    orbit = ph.Orbit(1.0, (1, 0, 0), (0, 1, 0))
    assert orbit.kind == "circular" and np.allclose(orbit.at(np.pi / 2)[0], (0, 1, 0))


def smoke_magnetic_field():
    field = ph.MagneticField.dipole(ph.Orbit(1.0, (1, 0, 0), (0, 1, 0)), 2.0)
    assert np.allclose(field.at(0.0), (0, 0, -2)) and np.allclose(field.at(0.0, (0, 0, 1)), (0, 0, 4))
    assert np.allclose(ph.torques.Dipole((1, 0, 0), field).value(0.0, (0, 0, 0), (0, 0, 0, 1)), (0, 2, 0))


def smoke_plate():
    light = ph.torques.SolarPressure(ph.Plate(1.0, (0, 0, 1), (1, 0, 0)), (0, 0, 1), 1.0)
    assert np.allclose(light.value(0.0, (0, 0, 0), (0, 0, 0, 1)), (0, 1, 0))


SMOKE = {
    "Plate": smoke_plate,
    "MagneticField": smoke_magnetic_field,
    "Event": smoke_event,
    "DampedFree": smoke_damped_free,
    "FitResult": smoke_fit_result,
    "FreeMotion": smoke_free_motion_object,
    "Gyrostat": smoke_gyrostat_object,
    "HeavyTop": smoke_heavy_top,
    "Pendulum": smoke_pendulum,
    "InertiaTensor": smoke_inertia_tensor,
    "IntegrationFailure": smoke_errors,
    "InvalidInput": smoke_errors,
    "MassProperties": smoke_mass_properties,
    "Motion": smoke_solve,
    "Orbit": smoke_orbit,
    "Motions": smoke_solve_many,
    "Plan": smoke_plan,
    "PrincipalAxes": smoke_principal_axes,
    "Rotation": smoke_rotation,
    "Changing": smoke_changing,
    "Controller": smoke_controller,
    "Measure": smoke_measure,
    "Damper": smoke_damper,
    "Rotor": smoke_rotor,
    "Scene": smoke_scene,
    "Sensitivity": smoke_sensitivity,
    "__version__": smoke_build_info,
    "body_rates": smoke_body_rates,
    "build_info": smoke_build_info,
    "cmake_prefix": smoke_cmake_prefix,
    "euler_rates": smoke_body_rates,
    "fit": smoke_fit,
    "free_motion": smoke_free_motion,
    "step": smoke_step,
    "lyapunov": smoke_lyapunov,
    "Lyapunov": smoke_lyapunov,
    "free_sensitivity": smoke_free_sensitivity,
    "effect": smoke_effect,
    "generalised_forces": smoke_generalised_forces,
    "gyrostat": smoke_gyrostat,
    "heavy_top": smoke_heavy_tops,
    "load": smoke_load,
    "methods": smoke_methods,
    "plan": smoke_plan,
    "solve": smoke_solve,
    "solve_many": smoke_solve_many,
} | {name: smoke_ensemble for name in ("Ensemble", "ensemble") if _wings.is_there("ensemble")} | {
    name: smoke_judge for name in ("Judgement", "judge") if _wings.is_there("judge")} | {
    name: smoke_attitude_ephemeris for name in ("AttitudeEphemeris",) if _wings.is_there("exchange")}


@pytest.mark.parametrize("name", [n for n in ph.__all__ if not isinstance(getattr(ph, n), types.ModuleType)])
def test_every_public_name(name):
    SMOKE[name]()   # a KeyError: a new name wants its smoke test here


@pytest.mark.parametrize("module", ["elliptic", "formula", "inertia", "shapes", "torques"])
def test_every_public_module_has_what_it_lists(module):
    names = importlib.import_module(f"polhode.{module}").__all__
    assert names and all(getattr(getattr(ph, module), name).__doc__ for name in names)


def test_shapes_torques_and_elliptic_functions():
    assert np.allclose(ph.shapes.box(12.0, (0.3, 0.2, 0.1)).inertia.moments, BLOCK)
    assert np.allclose(ph.elliptic.K(0.5), 1.8540746773013719)   # Abramowitz and Stegun, table 17.1
    fired = ph.torques.During(ph.torques.Constant((0, 0, 0.52)), [(0.25, 0.75)])
    assert np.allclose(ph.solve(scene(torques=[fired], omega=(0, 0, 0)), 1e-9).omega[:, 2], (0, 0, 0.25, 0.5, 0.5))
    braked = ph.torques.Formula(lambda t, omega, attitude, p: -p.c * omega / ph.formula.norm(omega), c=0.1)
    assert np.allclose(ph.torques.Constant((0, 0, 1)).as_formula().value(0, (0, 0, 2), (0, 0, 0, 1)), (0, 0, 1))
    assert np.allclose(braked.value(0, (0, 0, 2), (0, 0, 0, 1)), (0, 0, -0.1))
    assert np.allclose(scene(torques=[braked]).torque(0, (0, 0, 2), (0, 0, 0, 1)), (0, 0, -0.1))
    pushed = ph.solve(scene(torques=[ph.torques.Constant((0, 0, 0.52)), ph.torques.Damping((0, 0, 0))],
                            omega=(0, 0, 0)))
    assert np.allclose(pushed.omega[:, 2], TIMES)


def test_the_scenes_and_their_references_are_installed():
    folder = pathlib.Path(ph._core.__file__).parent / "scenes"
    assert (folder / "S1.toml").exists() and (folder / "reference/S1.npz").exists()
    assert not list(folder.rglob("*.py"))


def test_scene_files_are_read():
    assert ph.Scene.load("S1").times.size == 1001


LATE = ("recipe", "schema", *(("atlas", "charts", "report") if _wings.is_there("charts") else ()))


@pytest.mark.parametrize("name", LATE)
def test_a_late_module_is_there_when_it_is_asked_for(name):
    program = f"import sys, polhode as ph; assert 'polhode.{name}' not in sys.modules; print(ph.{name}.__name__)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.stdout == f"polhode.{name}\n", done.stderr
    assert name in dir(ph) and name not in ph.__all__


def test_all_names_what_is_meant_to_be_public():
    modules = {"elliptic", "formula", "inertia", "measured", "mesh", "shapes", "torques"}
    assert set(ph.__all__) == modules | set(SMOKE) and set(ph.__all__) <= set(dir(ph))
    with pytest.raises(AttributeError, match="module 'polhode' has no attribute 'nonsense'"):
        ph.nonsense
    with pytest.raises(AttributeError):
        ph.planning


def described(cls):
    """The names in the section Attributes of a class's docstring."""
    section = re.search(r"^ *Attributes\n *-+\n(.*?)(?=^ *\w+\n *---|\Z)", cls.__doc__, flags=re.M | re.S)
    indent = re.match(r" *", section[1])[0] if section else ""
    lines = re.findall(rf"^{indent}(\w[\w, ]*?)(?= :|$)", section[1], flags=re.M) if section else []
    return {name.strip() for line in lines for name in line.split(",")}


def instances():
    motion = ph.solve(scene(), accuracy=1e-9)
    tensor = ph.InertiaTensor(np.diag(BLOCK))
    return {
        "Motion": motion, "pickled Motion": pickle.loads(pickle.dumps(motion)), "Plan": motion.plan, "Scene": scene(),
        "Candidate": motion.plan.candidates[0], "Rotation": motion.rotation, "InertiaTensor": tensor,
        "Motions": ph.solve_many([scene()]), "MassProperties": ph.shapes.box(1, (1, 2, 3)),
        "PrincipalAxes": tensor.principal(), "FreeMotion": ph.FreeMotion(BLOCK, OMEGA),
        "DampedFree": ph.DampedFree(BLOCK, 0.5, OMEGA),
        "HeavyTop": ph.HeavyTop((1, 1, 0.5), 2.0, OMEGA),
        "Pendulum": ph.Pendulum(BLOCK, 2.0, (0, 0, -0.5), (1, 0, 0)),
        "Event": ph.Event(lambda t, omega, attitude: omega[0]),
        "Diagnosis": ph.inertia.diagnose(np.diag(BLOCK)), "Damping": ph.torques.Damping((1, 2, 3)),
    }


def test_completion_lists_every_attribute():
    for name, thing in instances().items():
        listed = set(dir(thing))
        assert described(type(thing)) <= listed, name
        for attribute in listed:
            if not attribute.startswith("_") and attribute != "at":
                getattr(thing, attribute)   # what is listed is there
    motion = ph.solve(scene(), accuracy=1e-9)   # nothing was asked of it yet
    assert {"t", "omega", "attitude", "error", "error_kind", "plan", "stats", "status", "events", "asked", "drift",
            "message", "success", "energy", "angular_momentum", "rotation", "plot", "scene"} <= set(dir(motion))
    assert {"accuracy", "candidates", "facts", "method", "model", "pieces", "wishes"} <= set(dir(motion.plan))
