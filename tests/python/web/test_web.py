"""The core as WebAssembly: the numbers by wasmtime, without a browser. `make web` builds what is tested here."""

import gzip
import importlib
import os
import pathlib
import struct

import numpy as np
import pytest

import polhode as ph

ROOT = pathlib.Path(__file__).parents[3]
WEB = ROOT / "build/web/site"
REQUIRED = os.environ.get("POLHODE_WEB") == "required"   # in `make web-check`: what is lacking is a failure, not a skip
wasmtime = importlib.import_module("wasmtime") if REQUIRED else pytest.importorskip("wasmtime", reason="needs wasmtime")
pytestmark = pytest.mark.skipif(not REQUIRED and not (WEB / "solve.wasm").exists(),
                                reason="needs the modules of `make web`")
START = (0.0, 0.0, 0.0, 1.0)


class Refused(Exception):
    """What the page shows."""


class Core:
    """The exports of a module, on NumPy's arrays."""

    def __init__(self, path):
        self.store = wasmtime.Store()
        module = wasmtime.Module.from_file(self.store.engine, str(path))
        linker = wasmtime.Linker(self.store.engine)
        linker.define_func("env", "raise", wasmtime.FuncType([wasmtime.ValType.i32()], []), self._refuse)
        for wanted in module.imports:   # stubs, as in the page
            if wanted.name == "environ_sizes_get":
                linker.define_func(wanted.module, wanted.name, wanted.type, self._empty)
            elif wanted.module != "env" and wanted.name != "proc_exit":
                linker.define_func(wanted.module, wanted.name, wanted.type, lambda *_: 0)
        linker.define_unknown_imports_as_traps(module)
        self.exports = linker.instantiate(self.store, module).exports(self.store)
        self.memory = self.exports["memory"]
        self.exports["_initialize"](self.store)

    def _empty(self, count, size):
        for at in (count, size):
            self.memory.write(self.store, bytes(4), at)
        return 0

    def _refuse(self, at):
        text = self.memory.read(self.store, at, at + 1000)
        raise Refused(bytes(text[:text.index(0)]).decode())

    def call(self, name, *arguments):
        return self.exports[name](self.store, *arguments)

    def put(self, at, numbers):
        self.memory.write(self.store, np.ascontiguousarray(numbers, float).tobytes(), at)

    def get(self, at, shape):
        raw = self.memory.read(self.store, at, at + 8 * int(np.prod(shape)))
        return np.frombuffer(bytes(raw)).reshape(shape)

    def throw(self, moments, omega, attitude, t):
        n = len(t)
        at = self.call("reserve", 10 + 8 * n)
        self.put(at, [*moments, *omega, *attitude]), self.put(at + 80, t)
        self.call("set_body", at)
        self.call("states", at + 80, n, at + 80 + 8 * n, at + 80 + 32 * n)
        return self.get(at + 80 + 8 * n, (n, 3)), self.get(at + 80 + 32 * n, (n, 4))

    def solve(self, start, t, method="", step=0.0, accuracy=1e-9, torque=""):
        n = len(t)
        for text, reserve in ((method, "reserve_text"), (torque, "reserve_formula")):
            self.memory.write(self.store, text.encode(), self.call(reserve, len(text.encode())))
        at = self.call("reserve", 18 + 8 * n)
        self.put(at, start), self.put(at + 144, t)
        self.call("solve_scene", at, at + 144, n, accuracy, step, at + 144 + 8 * n, at + 144 + 32 * n)
        return self.get(at + 144 + 8 * n, (n, 3)), self.get(at + 144 + 32 * n, (n, 4))


@pytest.fixture(scope="module")
def free():
    return Core(WEB / "free.wasm")


@pytest.fixture(scope="module")
def solve():
    return Core(WEB / "solve.wasm")


@pytest.fixture(scope="module")
def numbers():
    return Core(ROOT / "build/web/cmake/numbers.wasm")


@pytest.fixture(scope="module")
def baseline():
    """polhode on instructions that every x86 processor has: the bits of WebAssembly."""
    if ph.build_info()["simd"] != "baseline":
        assert not REQUIRED
        pytest.skip("needs POLHODE_SIMD=baseline")


def random_bodies(n):
    rng = np.random.default_rng(20)
    half = rng.uniform(0.05, 1, (n, 3)) ** 2
    half[: n // 10, 1] = half[: n // 10, 0]   # symmetric bodies
    omega = rng.normal(size=(n, 3))
    omega[n // 10: n // 5, ::2] *= 1e-6       # next to the separatrix, or to a steady rotation
    attitude = rng.normal(size=(n, 4))
    return half.sum(axis=1, keepdims=True) - half, omega, attitude / np.linalg.norm(attitude, axis=1, keepdims=True)


def test_free_motion_has_the_bits_of_the_baseline(free, baseline):
    t = np.concatenate([np.linspace(0, 20, 30), 10.0 ** np.arange(10)])
    for body in zip(*random_bodies(2000), strict=True):
        motion = ph.FreeMotion(*body)
        for got, wanted in zip(free.throw(body[0], motion.omega,
                                          motion.attitude, t), motion.at(t), strict=True):
            assert got.tobytes() == wanted.tobytes()


def rest(weight=0.0, arm=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), momentum=0.0):
    return [weight, *arm, *axis, momentum]


SCENES = {
    "free": ((0.2, 0.4, 0.52), (1.0, 2.0, 3.0), START, rest()),
    "racket": ((0.2, 0.4, 0.52), (1e-4, 5.0, 1e-4), START, rest()),
    "heavy": ((1.0, 2.0, 2.5), (0.3, 0.2, 3.0), (0.2, 0.0, 0.0, np.sqrt(0.96)), rest(2.0, (0.3, 0.2, 0.5))),
    "top": ((1.0, 1.0, 0.5), (0.1, 0.2, 5.0), (0.6, 0.0, 0.0, 0.8), rest(1.0, (0.0, 0.0, 1.3))),
    "pivot": ((14.0, 14.2, 9.0), (0.0, 0.0, 14.0), (0.6, 0.0, 0.0, 0.8), rest(10.0, (0.0, 0.0, 0.12))),
    "wheel": ((0.2, 0.4, 0.52), (1.0, 2.0, 3.0), START, rest(momentum=0.5)),
    "heavy wheel": ((1.0, 2.0, 2.5), (0.3, 0.2, 3.0), START, rest(2.0, (0.3, 0.2, 0.5), (1.0, 2.0, 2.0), 0.5)),
}
EXACT = [("", 0.0), ("taylor", 0.0), ("semi_euler", 1 / 60), ("rk4", 1 / 60), ("jolt", 1 / 60)]
CLOSE = [("rk45", 0.0), ("dop853", 0.0), ("catto", 1 / 60)]


def run_both(solve, name, method, step):
    moments, omega, attitude, more = SCENES[name]
    t = np.linspace(0, 10, 101)
    scene = ph.Scene(inertia=moments, omega=omega, attitude=attitude, times=t,
                     torques=[ph.torques.Gravity(more[0], more[1:4])] if more[0] else [],
                     rotors=[ph.Rotor(more[4:7], momentum=more[7])] if more[7] else [])
    motion = ph.solve(scene, method=method or None, **({"step": step} if step else {"accuracy": 1e-9}))
    return solve.solve([*moments, *omega, *scene.attitude, *more], t, method, step), motion


@pytest.mark.parametrize("method, step", EXACT, ids=[name or "plan" for name, _ in EXACT])
@pytest.mark.parametrize("name", SCENES)
def test_solve_has_the_bits_of_the_baseline(solve, baseline, name, method, step):
    got, motion = run_both(solve, name, method, step)
    assert got[0].tobytes() == motion.omega.tobytes() and got[1].tobytes() == motion.attitude.tobytes()


@pytest.mark.parametrize("method, step", CLOSE, ids=[name for name, _ in CLOSE])
@pytest.mark.parametrize("name", SCENES)
def test_solve_where_sums_of_three_are_grouped_otherwise(solve, name, method, step):
    """Eigen adds three numbers in another order where it has no vectors: a tolerance or a step moves by one unit."""
    got, motion = run_both(solve, name, method, step)
    assert np.abs(got[0] - motion.omega).max() <= 1e-11 * np.abs(motion.omega).max()
    assert np.abs(got[1] - motion.attitude).max() <= 1e-11


TORQUES = ["-0.1 * omega", "[0.1 * sin(t), 0, 0]", "-0.002 * omega * norm(omega)",
           "-attitude.xyz * attitude.w - 0.2 * omega", "0.1 * where(sin(t) > 0, omega, -omega)",
           "to_body([0, 0, 0.1 * t])"]


@pytest.mark.parametrize("torque", TORQUES)
def test_a_torque_that_is_typed_acts_as_in_python(solve, torque):
    """Sums of products may stand in another order: the compiler chooses which factor of C++ is evaluated first."""
    moments, omega, attitude, more = SCENES["heavy"]
    t = np.linspace(0, 10, 101)
    scene = ph.Scene(inertia=moments, omega=omega, attitude=attitude, times=t,
                     torques=[ph.torques.Gravity(more[0], more[1:4]), ph.torques.Formula(text=torque)])
    motion = ph.solve(scene, accuracy=1e-9)
    got = solve.solve([*moments, *omega, *scene.attitude, *more], t, torque=torque)
    assert np.abs(got[0] - motion.omega).max() <= 1e-12 * np.abs(motion.omega).max()
    assert np.abs(got[1] - motion.attitude).max() <= 1e-12
    without = solve.solve([*moments, *omega, *scene.attitude, *more], t)[0]
    assert np.abs(without - got[0]).max() > 1e-3   # the torque acts, and the next scene has none


@pytest.mark.parametrize("torque", ["-0.1 * omgea", "omega *", "1.0", "import os", "(" * 500, "\u00b5 * omega"])
def test_a_torque_that_is_no_formula_is_refused_as_in_python(solve, torque):
    with pytest.raises(Refused) as told:
        solve.solve([0.2, 0.4, 0.52, 1, 2, 3, *START, *rest()], [1.0], torque=torque)
    with pytest.raises(ph.InvalidInput) as same:
        ph.torques.Formula(text=torque)
    assert str(told.value).splitlines()[0] == str(same.value).splitlines()[0]
    assert np.isfinite(solve.solve([0.2, 0.4, 0.52, 1, 2, 3, *START, *rest()], [1.0])[0]).all()


def test_close_to_every_instruction_set(free):
    """Fused operations move last digits: what the page shows is what Python shows."""
    t = np.linspace(0, 50, 200)
    for body in zip(*random_bodies(100), strict=True):
        for got, wanted in zip(free.throw(*body, t), ph.FreeMotion(*body).at(t), strict=True):
            assert np.abs(got - wanted).max() <= 1e-13 * np.abs(wanted).max()


def test_a_refusal_has_the_sentence_and_the_module_lives_on(free, solve):
    with pytest.raises(Refused, match=r"^inertia: must") as told:
        free.throw((1.0, 2.0, 4.0), (1.0, 2.0, 3.0), START, [0.0])
    with pytest.raises(ph.InvalidInput) as same:
        ph.FreeMotion((1.0, 2.0, 4.0), (1.0, 2.0, 3.0), START)
    assert str(told.value).splitlines()[0] == str(same.value)
    with pytest.raises(Refused, match="leapfrog"):
        solve.solve([0.2, 0.4, 0.52, 1, 2, 3, *START, *rest()], [1.0], "leapfrog", 0.01)
    assert np.isfinite(free.throw((1.0, 2.0, 2.5), (1.0, 2.0, 3.0), START, [5.0])[0]).all()


def test_a_refusal_writes_numbers_as_python_does(free):
    """The module has a way of its own from doubles to text: the fewest digits that read back."""
    bits = np.random.default_rng(5).integers(0, 2**63, 300, dtype=np.uint64)
    drawn = [value for value in bits.view(float) if np.isfinite(value)]
    for moment in (2.5, 2.0**60, 123456789012345680000.0, 1e22, 1e300, 5e-324, 0.1, 1e-5, 100.0, 1e5, *drawn):
        moments = (1.0, moment, 1.0) if moment > 2.1 else (moment, 1.0, 4.0)
        with pytest.raises(Refused) as told:
            free.throw(moments, (1.0, 2.0, 3.0), START, [0.0])
        with pytest.raises(ph.InvalidInput) as same:
            ph.FreeMotion(moments, (1.0, 2.0, 3.0), START)
        assert str(told.value).splitlines()[0] == str(same.value)


def read(numbers, text):
    """What std::from_chars makes of a text: the characters that it takes, or minus the error, and the value."""
    numbers.memory.write(numbers.store, text.encode(), numbers.call("reserve_text", len(text)))
    return numbers.call("read"), numbers.call("last")


def test_numbers_are_written_with_the_fewest_digits_and_read_back(numbers):
    bits = np.random.default_rng(6).integers(0, 2**63, 5000, dtype=np.uint64)
    near_one = np.ldexp(np.round(np.random.default_rng(7).uniform(size=2000), 6), 20)
    known = (0.0, 1.0, 2.0**53, 2.0**53 + 2, 1e21, 1e23, 5e-324, 1.7976931348623157e308)
    for value in (*bits.view(float), *near_one, *known):
        if not np.isfinite(value):
            continue
        length = numbers.call("write", float(value))
        at = numbers.call("written")
        text = bytes(numbers.memory.read(numbers.store, at, at + length)).decode()
        assert float(text) == value
        digits = repr(float(value)).split("e")[0].replace(".", "").strip("0")
        if "e" in text:
            assert len(text.split("e")[0].replace(".", "")) <= max(len(digits), 1), (text, value)
        assert read(numbers, text) == (length, value)


OUT_OF_RANGE, INVALID = -68, -28   # ERANGE and EINVAL of WASI


@pytest.mark.parametrize("text, length, value", [
    ("1.5*x", 3, 1.5), ("2e", 1, 2.0), ("2e+", 1, 2.0), ("2e-3)", 4, 2e-3), (".5", 2, 0.5), ("7.", 2, 7.0),
    ("0x1F", 1, 0.0), ("3E5", 3, 3e5), ("0e999", 5, 0.0), ("1.2.3", 3, 1.2), ("9007199254740993", 16, 2.0**53),
    ("9007199254740993.0000000000000000000000001", 42, 2.0**53 + 2), ("1e-320", 6, 1e-320), ("0" * 400 + "1", 401, 1.0),
    ("1e400", OUT_OF_RANGE, None), ("1e-400", OUT_OF_RANGE, None), ("x", INVALID, None), (".", INVALID, None)])
def test_numbers_are_read_as_the_grammar_of_formulas_says(numbers, text, length, value):
    taken, got = read(numbers, text)
    assert taken == length
    assert value is None or got == value


def test_period_flips_and_momentum(free):
    free.throw((0.2, 0.4, 0.52), (1e-4, 5.0, 1e-4), START, [0.0])
    motion = ph.FreeMotion((0.2, 0.4, 0.52), (1e-4, 5.0, 1e-4), START)
    at = free.call("reserve", 64)
    count = free.call("flips", 0.0, 50.0, at, 8)
    assert count == len(motion.flip_times(0, 50)) > 3
    assert np.allclose(free.get(at, (count,)), motion.flip_times(0, 50), rtol=1e-13)
    assert free.call("period") == pytest.approx(motion.period, rel=1e-14)
    free.call("angular_momentum", at)
    assert np.allclose(free.get(at, (3,)), motion.angular_momentum, rtol=1e-14)


@pytest.mark.parametrize("name, most", [("free.wasm", 150 * 1024), ("solve.wasm", 600 * 1024)])
def test_modules_are_small(name, most):
    data = (WEB / name).read_bytes()
    assert data[:4] == b"\0asm" and struct.unpack("<I", data[4:8]) == (1,)
    assert len(gzip.compress(data, 9)) <= most
