"""The C interface: by programs in C and Rust, and by ctypes. Its answers have the bits of the Python module."""

import ctypes
import os
import pathlib
import re
import shutil
import subprocess

import numpy as np
import pytest

import polhode as ph

ROOT = pathlib.Path(__file__).parents[3]
DEV_BUILD = ROOT / "build/dev"
HEADER = ROOT / "cpp/include/polhode/polhode.h"
INERTIA = ph.InertiaTensor(np.diag([0.2, 0.4, 0.52]))
OMEGA, ATTITUDE, MOMENTUM = (0.01, 5.0, 0.01), (0.5, -0.5, 0.5, 0.5), (0.03, -0.02, 0.05)
TIMES = np.array([0.0, 1.25, -1e6])
FORMS = {"free_motion": ph.FreeMotion(INERTIA, OMEGA, ATTITUDE),
         "gyrostat": ph.Gyrostat(INERTIA, momentum=MOMENTUM, omega=OMEGA, attitude=ATTITUDE),
         "heavy_top": ph.HeavyTop(ph.InertiaTensor(np.diag([0.4, 0.4, 0.25])), 1.5, OMEGA, ATTITUDE, rotor=0.25)}
OK, INVALID_INPUT, STOPPED = 0, 1, 3


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0 and not done.stderr, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def library():
    """The shared library of the build tree."""
    if not (DEV_BUILD / "CMakeCache.txt").exists():
        pytest.skip("no build tree to build the C interface in")
    subprocess.run(["cmake", "--build", DEV_BUILD, "--target", "polhode_c"], check=True, stdout=subprocess.DEVNULL)
    return DEV_BUILD / "cpp/libpolhode_c.so"


@pytest.fixture(scope="module")
def c(library):
    """The same for ctypes, whose functions return a status."""
    loaded = ctypes.CDLL(str(library))
    loaded.polhode_last_error.restype = loaded.polhode_version.restype = ctypes.c_char_p
    return loaded


def compile_c(library, source, program):
    run("cc", "-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", f"-I{ROOT / 'cpp/include'}", source,
        f"-L{library.parent}", f"-Wl,-rpath,{library.parent}", "-lpolhode_c", "-lm", "-lpthread", "-o", program)
    return run(program)


def numbers(*values):
    return (ctypes.c_double * len(values))(*values)


def sentence(c):
    return c.polhode_last_error().decode()


def test_only_functions_of_the_header_leave_the_library(library):
    rows = [line.split() for line in run("nm", "-D", "--defined-only", library).splitlines()]
    text = re.sub(r"/\*.*?\*/", "", HEADER.read_text(), flags=re.S)
    declared = set(re.findall(r"POLHODE_API [\w* ]+?\b(polhode_\w+)\(", text))
    assert {row[-1] for row in rows} == declared and len(declared) > 25
    assert all(row[1] == "T" for row in rows)


def test_the_library_has_the_version_of_its_header_and_needs_little(library, c):
    abi = int(re.search(r"define POLHODE_ABI_VERSION (\d+)", HEADER.read_text())[1])
    assert c.polhode_abi_version() == abi and c.polhode_version().decode() == ph.__version__
    dynamic = run("readelf", "-d", library)
    assert f"[libpolhode_c.so.{abi}]" in dynamic
    assert {"libpolhode", "libpython3"}.isdisjoint(re.findall(r"NEEDED.*\[(\w+)", dynamic))


def test_the_c_program_finds_bits_sizes_refusals_and_errors_of_threads(library, tmp_path):
    lines = compile_c(library, ROOT / "tests/c/interface.c", tmp_path / "interface").splitlines()
    expected = [ph.__version__]
    for name, form in FORMS.items():
        for part in form.at(TIMES):
            expected.append(" ".join([name, *(f"{bits:016x}" for bits in part.ravel().view("u8"))]))
    assert lines[:7] == expected
    newer, nan, inertia, motion = lines[7:]
    assert newer == "polhode_solve: options: a field is set that this version of polhode does not have"
    assert nan.startswith("polhode_free_motion_create: omega: must be finite, got (1, 2, nan)")
    assert inertia == "polhode_free_motion_create: inertia: must not be NULL"
    assert motion == "polhode_free_motion_at: motion: must not be NULL"


def test_no_call_loses_memory_or_reads_beyond_its_own(library, tmp_path):
    if not shutil.which("valgrind"):
        pytest.skip("needs valgrind")
    known = os.environ | {"POLHODE_SIMD": "avx2"}   # of valgrind
    for source in ("tests/c/interface.c", "examples/c/tumble.c"):
        compile_c(library, ROOT / source, tmp_path / "program")
        done = subprocess.run(["valgrind", "-q", "--leak-check=full", "--error-exitcode=9", tmp_path / "program"],
                              capture_output=True, text=True, env=known)
        assert done.returncode == 0, done.stderr


def test_the_c_example_prints_what_python_finds(library, tmp_path):
    lines = compile_c(library, ROOT / "examples/c/tumble.c", tmp_path / "tumble").splitlines()
    free = ph.FreeMotion((0.2, 0.4, 0.52), OMEGA)
    flips = "".join(f" {t:.6f}" for t in free.flip_times(0, 15))
    assert lines[0] == f"{free.kind}, period {free.period:.6f} s, flips at{flips}"
    assert lines[1] == "after 1e6 s:" + "".join(f" {x:.9f}" for x in free.at(1e6)[1])
    found, by_hand = re.search(r"bounded: omega_z (\S+) rad/s at 4 s, by hand (\S+)", lines[2]).groups()
    assert float(found) == pytest.approx(float(by_hand), rel=1e-8) and float(by_hand) == pytest.approx(3 / np.e)


def test_the_rust_example_prints_what_python_finds(library, tmp_path):
    if not shutil.which("rustc"):
        pytest.skip("needs rustc")
    run("rustc", "-O", ROOT / "examples/rust/tumble.rs", "-L", library.parent, "-C",
        f"link-arg=-Wl,-rpath,{library.parent}", "-o", tmp_path / "tumble")
    lines = run(tmp_path / "tumble").splitlines()
    free = ph.FreeMotion((0.2, 0.4, 0.52), OMEGA)
    assert lines[:2] == [f"flip at {t:.6f} s" for t in free.flip_times(0, 15)]
    assert lines[2] == f"bits after 1e6 s: {free.at(1e6)[1][:1].view('u8')[0]:016x}"
    assert lines[3].startswith("refused: polhode_free_motion_create: inertia: must be within the triangle inequality")


class Facts(ctypes.Structure):
    _fields_ = [("size", ctypes.c_size_t), ("count", ctypes.c_size_t), ("success", ctypes.c_int),
                ("error", ctypes.c_double), ("reached", ctypes.c_double), ("steps", ctypes.c_longlong),
                *((name, ctypes.c_char_p) for name in ("error_kind", "model", "method", "message"))]


class Options(ctypes.Structure):
    STOP = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
    _fields_ = [("size", ctypes.c_size_t), ("accuracy", ctypes.c_double), ("method", ctypes.c_char_p),
                ("rtol", ctypes.c_double), ("atol", ctypes.c_double), ("step", ctypes.c_double),
                ("max_steps", ctypes.c_longlong), ("expected_only", ctypes.c_int), ("proof", ctypes.c_int),
                ("stop", STOP), ("data", ctypes.c_void_p)]

    def __init__(self, **fields):
        super().__init__(size=ctypes.sizeof(type(self)), **fields)


TORQUE = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_double, *[ctypes.POINTER(ctypes.c_double)] * 3, ctypes.c_void_p)
SAMPLES = np.linspace(0.0, 2.0, 5)


@pytest.fixture
def scene(c):
    """A scene without torques, at five times, and a function that solves it."""
    handle = ctypes.c_void_p()
    body = numbers(*np.diag([1.0, 2.0, 2.5]).ravel())
    assert c.polhode_scene_create(body, numbers(0.3, 0.2, 3.0), None, ctypes.byref(handle)) == OK
    assert c.polhode_scene_set_times(handle, numbers(*SAMPLES), ctypes.c_size_t(5)) == OK
    yield handle
    c.polhode_scene_destroy(handle)


def solve(c, scene, **options):
    """The facts, omega and attitude, or the status of a refusal."""
    handle = ctypes.c_void_p()
    asked = Options(**options)
    if status := c.polhode_solve(scene, ctypes.byref(asked), ctypes.byref(handle)):
        assert not handle
        return status
    facts = Facts(size=ctypes.sizeof(Facts))
    w, q = np.empty((5, 3)), np.empty((5, 4))
    assert c.polhode_motion_get_facts(handle, ctypes.byref(facts)) == OK
    assert c.polhode_motion_get_samples(handle, ctypes.c_size_t(facts.count), None, ctypes.c_void_p(w.ctypes.data),
                                        ctypes.c_void_p(q.ctypes.data)) == OK
    room = c.polhode_motion_get_samples(handle, ctypes.c_size_t(facts.count - 1), None, None, None)
    assert room == INVALID_INPUT and "room: must be" in sentence(c)
    copy = {name: getattr(facts, name) for name, _ in Facts._fields_}
    c.polhode_motion_destroy(handle)
    return copy, w, q


ARM, TURN, MATRIX = (0.3, 0.2, 0.5), 0.7, np.array([[0.1, 0.02, 0], [0.02, 0.2, 0], [0, 0, 0.3]])
TORQUES = {
    "constant": ("constant", (numbers(0.1, 0.2, 0.3), 0), ph.torques.Constant((0.1, 0.2, 0.3))),
    "constant in space": ("constant", (numbers(0.1, 0.2, 0.3), 1), ph.torques.Constant((0.1, 0.2, 0.3), frame="space")),
    "gravity": ("gravity", (ctypes.c_double(2.0), numbers(*ARM)), ph.torques.Gravity(2.0, ARM)),
    "gravity_gradient": ("gravity_gradient", (ctypes.c_double(TURN), ctypes.c_double(0.25)),
                         ph.torques.GravityGradient(TURN, 0.25)),
    "damping": ("damping", (numbers(*MATRIX.ravel()),), ph.torques.Damping(MATRIX)),
    "formula": ("formula", (b"cross([0, 0, k], to_body([0, 0, 1])) - d * omega", (ctypes.c_char_p * 2)(b"k", b"d"),
                            numbers(0.6, 0.5), ctypes.c_size_t(2)),
                ph.torques.Formula(text="cross([0, 0, k], to_body([0, 0, 1])) - d * omega", k=0.6, d=0.5)),
}


@pytest.mark.parametrize("windows", [(), ((0.25, 0.75), (1.0, 1.5))], ids=["always", "windows"])
@pytest.mark.parametrize("name", TORQUES)
def test_a_scene_has_the_bits_of_python(c, scene, name, windows):
    function, arguments, twin = TORQUES[name]
    assert getattr(c, f"polhode_scene_add_{function}")(scene, *arguments) == OK, sentence(c)
    for begin, end in windows:
        assert c.polhode_scene_add_window(scene, ctypes.c_double(begin), ctypes.c_double(end)) == OK
    assert c.polhode_scene_add_rotor(scene, numbers(0, 0, 1), ctypes.c_double(0.2)) == OK
    # A plan weighs the costs that Python has measured: a method that is named needs none.
    facts, w, q = solve(c, scene, method=b"dop853", rtol=1e-9)
    torque = ph.torques.During(twin, windows) if windows else twin
    same = ph.solve(ph.Scene(inertia=(1, 2, 2.5), omega=(0.3, 0.2, 3), times=SAMPLES, torques=[torque],
                             rotors=[ph.Rotor((0, 0, 1), momentum=0.2)]), method="dop853", rtol=1e-9)
    assert np.array_equal(w, same.omega) and np.array_equal(q, same.attitude)
    assert facts["success"] == 1 and facts["method"] == b"dop853" and facts["steps"] == same.stats["steps"]
    assert facts["count"] == 5 and facts["reached"] == 2.0 and facts["model"].decode() == same.plan.model


def test_an_accuracy_is_kept_and_its_error_is_told(c, scene):
    assert c.polhode_scene_add_gravity(scene, ctypes.c_double(2.0), numbers(*ARM)) == OK
    facts, w, _ = solve(c, scene, accuracy=1e-9)
    same = ph.solve(ph.Scene(inertia=(1, 2, 2.5), omega=(0.3, 0.2, 3), times=SAMPLES,
                             torques=[ph.torques.Gravity(2.0, ARM)]), accuracy=1e-12)
    assert np.abs(w - same.omega).max() <= 1e-9 * np.linalg.norm(same.omega, axis=1).max()
    assert facts["error_kind"] == b"bounded" and 0 < facts["error"] <= 1e-9
    assert solve(c, scene, accuracy=1e-9, rtol=1e-9) == INVALID_INPUT and "polhode_solve: " in sentence(c)


def test_functions_of_the_caller_give_torques_and_stop(c, scene):
    def brake(t, omega, attitude, torque, data):
        torque[0], torque[1], torque[2] = (-0.5 * omega[i] for i in range(3))
        return 7 if t > 1.0 and stops else 0

    stops, held = False, TORQUE(brake)
    assert c.polhode_scene_add_custom(scene, held, None) == OK
    facts, w, _ = solve(c, scene, accuracy=1e-8)
    same = ph.solve(ph.Scene(inertia=(1, 2, 2.5), omega=(0.3, 0.2, 3), times=SAMPLES,
                             torques=[ph.torques.Damping((0.5, 0.5, 0.5))]), accuracy=1e-12)
    assert facts["success"] == 1 and np.abs(w - same.omega).max() <= 1e-8 * 3.1
    stops = True
    assert solve(c, scene, accuracy=1e-8) == STOPPED
    assert re.search(r"the torque function returned 7 at t = 1\.\d+ s", sentence(c))
    stops, asked = False, Options.STOP(lambda data: 1)
    long = numbers(*np.linspace(0, 20000.0, 5))
    assert c.polhode_scene_set_times(scene, long, ctypes.c_size_t(5)) == OK
    assert solve(c, scene, method=b"rk4", step=1e-3, stop=asked) == STOPPED
    assert sentence(c) == "polhode_solve: the function stop ended the solution"


def test_what_no_scene_can_have_is_refused(c, scene):
    assert c.polhode_scene_add_window(scene, ctypes.c_double(0), ctypes.c_double(1)) == INVALID_INPUT
    assert sentence(c) == "polhode_scene_add_window: scene: has no torque yet"
    assert c.polhode_scene_add_formula(scene, b"-kd * omega", None, None, ctypes.c_size_t(0)) == INVALID_INPUT
    assert "kd" in sentence(c)
    assert c.polhode_scene_add_formula(scene, b"-kd * omega", None, None, ctypes.c_size_t(1)) == INVALID_INPUT
    assert c.polhode_scene_add_constant(scene, numbers(1, 2, float("inf")), 0) == INVALID_INPUT
    assert c.polhode_scene_add_gravity(scene, ctypes.c_double(1), numbers(*ARM)) == OK
    assert c.polhode_scene_add_window(scene, ctypes.c_double(1), ctypes.c_double(1)) == INVALID_INPUT
    assert c.polhode_scene_add_window(scene, ctypes.c_double(0), ctypes.c_double(1)) == OK
    assert c.polhode_scene_add_window(scene, ctypes.c_double(0.5), ctypes.c_double(2)) == INVALID_INPUT
    assert c.polhode_scene_set_times(scene, None, ctypes.c_size_t(0)) == OK
    assert solve(c, scene) == INVALID_INPUT and "times" in sentence(c)
    assert c.polhode_scene_set_times(scene, numbers(1.0), ctypes.c_size_t(1)) == OK
    assert solve(c, scene, method=b"magic") == INVALID_INPUT and "magic" in sentence(c)
