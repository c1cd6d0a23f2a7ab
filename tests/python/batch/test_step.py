"""The free step of many bodies, and the header by itself. The formulas are tested in tests/cpp/step."""

import hashlib
import pathlib
import re
import shutil
import subprocess

import levels
import numpy as np
import pytest

import polhode as ph

HEADERS = pathlib.Path(__file__).parents[3] / "cpp/include/polhode"
ENGINE = pathlib.Path(__file__).parents[3] / "examples/engine/engine.cpp"
COMPILERS = [name for name in ("g++", "clang++") if shutil.which(name)]


def bodies(n, dtype=np.float64, seed=15):
    rng = np.random.default_rng(seed)
    masses, omega, q = rng.uniform(0.1, 1, (n, 3)), rng.normal(size=(n, 3)), rng.normal(size=(n, 4))
    moments = masses.sum(1, keepdims=True) - masses
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    return moments.astype(dtype), (moments * omega).astype(dtype), q.astype(dtype), omega


def angle(p, q):
    near, far = np.linalg.norm(p - q, axis=-1), np.linalg.norm(p + q, axis=-1)
    return (4 * np.arcsin(np.minimum(near, far) / 2)).max()


@pytest.mark.parametrize(("dtype", "rounding"), [(np.float64, 1e-14), (np.float32, 4e-6)])
@pytest.mark.parametrize("n", [1, 7, 16, 33, 1000])
def test_free_bodies_move_as_their_closed_form(dtype, rounding, n):
    moments, L, q, omega = bodies(n, dtype)
    w, truth = ph.free_motion(moments, L.astype(float) / moments, q.astype(float) / np.linalg.norm(
        q.astype(float), axis=1, keepdims=True), 0.1)
    L_B, q_body = ph.step(moments, L, q, 0.1, frame="body")
    assert L_B.dtype == q_body.dtype == dtype
    assert angle(q_body, truth) < rounding and np.abs(L_B - moments * w).max() < rounding
    L_W = rotate(q, L).astype(dtype)
    same, q_space = ph.step(moments, L_W, q, 0.1)
    assert (same == L_W).all() and angle(q_space, truth) < rounding


def rotate(q, v):
    q, v = q.astype(float), v.astype(float)
    t = 2 * np.cross(q[:, :3], v)
    return v + q[:, 3:] * t + np.cross(q[:, :3], t)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_energy_and_momentum_of_100_000_steps(dtype):
    moments, L, q, omega = bodies(32, dtype)
    end, attitude = ph.step(moments, L, q, 0.1, frame="body", count=100_000)
    before, after = ((x.astype(float) ** 2 / moments).sum(1) for x in (L, end))
    assert np.abs(after / before - 1).max() < (5e-13 if dtype == np.float64 else 1e-3)
    start, space = rotate(q, L), rotate(attitude, end)
    lost = np.linalg.norm(space - start, axis=1) / np.linalg.norm(start, axis=1)
    assert lost.max() < (5e-13 if dtype == np.float64 else 1e-3)
    assert np.abs(np.linalg.norm(attitude.astype(float), axis=1) - 1).max() < (4e-16 if dtype == np.float64 else 3e-7)


def test_the_racket_flips_as_often_as_its_closed_form_has_it():
    moments = np.array((0.2, 0.4, 0.52))
    for e in (0.1, 0.01):
        omega = np.array((e, 5.0, e))
        truth = len(ph.FreeMotion(ph.InertiaTensor.from_moments(moments), omega).flip_times(0, 2000))
        L, q, flips, sign = moments * omega, np.array((0, 0, 0, 1.0)), 0, 1.0
        L, q = L[None], q[None]
        for _ in range(120_000):
            ph.step(moments, L, q, 1 / 60, frame="body", out=(L, q), threads=1)
            if L[0, 1] * sign < 0:
                flips, sign = flips + 1, -sign
        assert abs(flips - truth) <= 1 and truth > 300 * (e == 0.1)


def test_impulses_gain_no_energy():
    moments, L, q, _ = bodies(64)
    rng = np.random.default_rng(3)
    energy = (L**2 / moments).sum(1)
    start = energy.copy()
    for _ in range(2000):
        ph.step(moments, L, q, 0.3, frame="body", out=(L, q))
        r, n = rng.normal(size=(2, 64, 3))
        J = np.cross(r, n)   # an elastic impulse along n at r, on a body whose centre is held
        L -= J * (2 * (J * L / moments).sum(1) / (J * J / moments).sum(1))[:, None]
    assert np.abs((L**2 / moments).sum(1) / start - 1).max() < 1e-12


def test_a_torque_from_a_potential_has_a_bounded_energy_and_order_two():
    moments, start_L, start_q, _ = bodies(32)
    start_L = 0.2 * start_L

    def torque(L, q):   # of the potential -z . R(q) z, in space
        z = rotate(q, np.tile((0.0, 0.0, 1.0), (len(q), 1)))
        return np.cross(z, (0.0, 0.0, 1.0))

    def energy(L, q):
        L_B = rotate(q * (-1, -1, -1, 1), L)
        z = rotate(q, np.tile((0.0, 0.0, 1.0), (len(q), 1)))
        return 0.5 * (L_B**2 / moments).sum(1) - z[:, 2]

    errors = []
    for h in (0.02, 0.01):
        L, q = ph.step(moments, start_L, start_q, h, torque=torque, count=round(20 / h))
        errors.append(np.abs(energy(L, q) - energy(start_L, start_q)).max())
    assert errors[0] < 5e-3 and 3 < errors[0] / errors[1] < 5.5
    apart_L, apart_q = start_L.copy(), start_q.copy()
    for _ in range(10):
        apart_L += 0.005 * torque(apart_L, apart_q)
        apart_L, apart_q = ph.step(moments, apart_L, apart_q, 0.01)
        apart_L += 0.005 * torque(apart_L, apart_q)
    L, q = ph.step(moments, start_L, start_q, 0.01, torque=torque, count=10)
    assert np.abs(L - apart_L).max() < 1e-14 and np.abs(q - apart_q).max() < 1e-14


@pytest.mark.parametrize("frame", ["space", "body"])
def test_a_full_tensor_moves_as_its_closed_form(frame):
    tensor = ph.InertiaTensor(np.array(((2.0, 0.3, 0.1), (0.3, 2.5, 0.2), (0.1, 0.2, 1.5))))
    omega = np.array((1.0, 2.0, 3.0))
    w, truth = ph.FreeMotion(tensor, omega).at(0.6)
    L = tensor.matrix @ omega
    for inertia in (tensor, [tensor, tensor]):
        end, q = ph.step(inertia, L, (0, 0, 0, 1.0), 0.2, frame=frame, count=3)
        expected = tensor.matrix @ w if frame == "body" else L
        assert np.abs(end - expected).max() < 1e-13 and angle(q, truth) < 1e-14
    kicked = ph.step(tensor, L, (0, 0, 0, 1.0), 0.2, frame=frame, torque=(0.1, 0.2, 0.3), count=4)
    parts = (L, np.array((0, 0, 0, 1.0)))
    for _ in range(4):
        parts = ph.step(tensor, *parts, 0.2, frame=frame, torque=lambda L, q: (0.1, 0.2, 0.3))
    assert np.abs(kicked[0] - parts[0]).max() < 1e-13 and np.abs(kicked[1] - parts[1]).max() < 1e-13


def test_threads_neighbours_places_and_counts_change_no_bit():
    for dtype in (np.float32, np.float64):
        moments, L, q, _ = bodies(200, dtype)
        tau = (0.1 * L).astype(dtype)
        whole = ph.step(moments, L, q, 0.2, torque=tau, threads=1)
        many = [np.tile(x, (300, 1)) for x in (moments, L, q, tau)]
        large = ph.step(*many[:3], 0.2, torque=many[3], threads=2)
        for a, b in zip(whole, large, strict=True):
            assert (np.tile(a, (300, 1)) == b).all()
        for i in (0, 63, 199):
            one = ph.step(moments[i], L[i], q[i], 0.2, torque=tau[i])
            assert (one[0] == whole[0][i]).all() and (one[1] == whole[1][i]).all()
        thrice = ph.step(moments, L, q, 0.2, count=3)
        apart = ph.step(moments, *ph.step(moments, *ph.step(moments, L, q, 0.2), 0.2), 0.2)
        assert (thrice[1] == apart[1]).all()


def test_many_steps_of_a_call_are_those_of_many_calls():
    moments, L, q, _ = bodies(5)
    once = ph.step(moments, L, q, 0.01, torque=(0.1, 0.2, 0), count=2500)   # the core pauses every 1024 steps
    parts = L, q
    for _ in range(2500):
        parts = ph.step(moments, *parts, 0.01, torque=(0.1, 0.2, 0))
    assert np.abs(once[0] - parts[0]).max() < 1e-11 and angle(once[1], parts[1]) < 1e-9
    assert np.abs(once[0] - L - 25 * np.array((0.1, 0.2, 0))).max() < 1e-11


def test_in_place_and_apart_have_the_same_bits():
    moments, L, q, _ = bodies(100)
    expected = ph.step(moments, L, q, 0.2, torque=(0.1, 0, 0))
    for given in ((L.copy(), q.copy()), (np.asfortranarray(L), np.asfortranarray(q))):
        answer = ph.step(moments, *given, 0.2, torque=(0.1, 0, 0), out=given)
        assert answer[0] is given[0] and answer[1] is given[1]
        assert (given[0] == expected[0]).all() and (given[1] == expected[1]).all()
    moments_in = moments.copy()
    ph.step(moments_in, L, q, 0.2, torque=(0.1, 0, 0), out=(moments_in, q.copy()))   # the inertia is overwritten
    assert (moments_in == expected[0]).all()


def test_a_body_that_is_not_finite_leaves_the_others_alone():
    moments, L, q, _ = bodies(40)
    expected = ph.step(moments, L, q, 0.2)
    L[7, 1] = np.nan
    q[9, 2] = np.nan
    new_L, new_q = ph.step(moments, L, q, 0.2)
    others = [i for i in range(40) if i not in (7, 9)]
    assert np.isnan(new_q[[7, 9]]).all() and (new_q[others] == expected[1][others]).all()


@pytest.mark.parametrize(("changes", "words"), [
    ({"inertia": (1, 1, 0)}, "inertia: .*positive"), ({"inertia": (1, 1, -1)}, "inertia: .*positive"),
    ({"inertia": (1, 1, 2.1)}, "inertia: .*sum"), ({"inertia": (1, 1)}, r"inertia: .*\(\.\.\., 3\)"),
    ({"inertia": (1, np.nan, 1)}, "inertia: .*finite"), ({"h": np.inf}, "h: .*finite"), ({"h": "long"}, "h: "),
    ({"momentum": np.ones(3, int)}, "momentum: .*float32 or float64"),
    ({"momentum": np.ones(3, np.float16)}, "momentum: .*float32 or float64"),
    ({"momentum": np.ones(3, np.float32), "attitude": np.array((0, 0, 0, 1.0))}, "momentum: .*dtype of attitude"),
    ({"momentum": np.ones((4, 3)), "inertia": np.ones((5, 3))}, "momentum: must broadcast"),
    ({"attitude": (0, 0, 0, 2.0)}, "attitude.*unit"), ({"attitude": (0, 0, 1.0)}, r"attitude: .*\(\.\.\., 4\)"),
    ({"torque": (1.0, 2.0)}, "torque: "), ({"torque": lambda L, q: np.ones((9, 3))}, "torque: must return"),
    ({"frame": "world"}, "frame: "), ({"count": -1}, "count: "), ({"count": 1.5}, "count: "),
    ({"count": True}, "count: "), ({"threads": 0}, "threads: "), ({"out": np.ones(3)}, "out: "),
    ({"out": (np.ones(3), np.ones(4, np.float32))}, "out: .*attitude"), ({"momentum": "L"}, "momentum: .*real numbers"),
    ({"momentum": np.ma.masked_array(np.ones(3), (1, 0, 0))}, "momentum: .*masked"),
])
def test_bad_input_is_refused_at_the_door(changes, words):
    good = {"inertia": (1.0, 1.0, 1.5), "momentum": np.ones(3), "attitude": (0, 0, 0, 1.0), "h": 0.1}
    call = {**good, **changes}
    with pytest.raises(ph.InvalidInput, match=words):
        ph.step(**call)


def test_a_refusal_changes_nothing():
    moments, L, q, _ = bodies(1000)
    moments[900, 2] = -1.0
    before = L.copy(), q.copy()
    with pytest.raises(ph.InvalidInput, match=r"inertia\[900\]"):
        ph.step(moments, L, q, 0.1, torque=(1, 0, 0), out=(L, q))
    assert (L == before[0]).all() and (q == before[1]).all()
    assert [x.shape for x in ph.step(np.ones((0, 3)), np.ones((0, 3)), np.ones((0, 4)), 0.1)] == [(0, 3), (0, 4)]


def hash_of_steps():
    found = hashlib.sha256()
    for dtype in (np.float32, np.float64):
        for frame in ("space", "body"):
            moments, L, q, _ = bodies(501, dtype)
            for x in ph.step(moments, L, q, 0.7, torque=(0.1, 0.2, 0.3), frame=frame, count=50):
                found.update(x.tobytes())
    return found.hexdigest()


def test_avx2_and_avx512_have_the_same_bits():
    found = levels.outputs("import test_step; print(test_step.hash_of_steps(), end='')")
    assert found["avx2"] == found["avx512"] and len(found["avx2"]) == 64


# ---- the header by itself

STRICT = ["-std=c++17", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]


def compile_text(compiler, text, folder, *flags):
    source, program = folder / "main.cpp", folder / "main"
    source.write_text(text)
    subprocess.run([compiler, *flags, str(source), "-o", str(program)], check=True, capture_output=True, text=True)
    return program


def test_the_header_is_short_and_leans_on_nothing():
    text = (HEADERS / "step.hpp").read_text()
    assert text.count("\n") < 300
    assert re.findall(r"#include (\S+)", text) == ["<cmath>"]
    assert set(re.findall(r"std::(\w+)", text)) == {"sqrt"}


@pytest.mark.parametrize("compiler", COMPILERS)
def test_the_headers_compile_alone_for_cpp17_and_c(compiler, tmp_path):
    for name in ("step.hpp", "polhode_step.h"):
        shutil.copy(HEADERS / name, tmp_path / name)
    for flags in ([], ["-ffast-math"]):
        subprocess.run([compiler, *STRICT, *flags, "-fsyntax-only", "-x", "c++", str(tmp_path / "step.hpp")] + (
            ["-Wno-pragma-once-outside-header"] if compiler == "clang++" else ["-Wno-error"]), check=True)
    (tmp_path / "main.c").write_text("""
#include <stdio.h>
#include "polhode_step.h"
int main(void) {
  double moments[3] = {0.2, 0.4, 0.5}, L[3] = {0.2, 0.8, 1.5}, q[4] = {0, 0, 0, 1}, tensor[6] = {2, 2.5, 1.5, 0, 0, 0};
  float start[4] = {0, 0, 0, 1}, l[3] = {0.2f, 0.8f, 1.5f}, m[3] = {0.2f, 0.4f, 0.5f}, axes[4];
  const polhode_inertia_d body = polhode_make_inertia_d(moments);
  const polhode_inertia_f small = polhode_make_inertia_f(m);
  polhode_drift_body_d(&body, 0.1, L, q);
  polhode_drift_space_f(&small, 0.1f, l, start);
  polhode_make_principal_d(tensor, q);
  (void)axes;
  printf("%.17g %.17g %.9g %.9g", L[0], L[2], (double)start[0], (double)start[3]);
  return 0;
}
""")
    (tmp_path / "impl.cpp").write_text('#define POLHODE_STEP_IMPLEMENTATION\n#include "polhode_step.h"\n')
    c = {"g++": "gcc", "clang++": "clang"}[compiler]
    strict = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    subprocess.run([c, *strict, "-c", "main.c", "-o", "main.o"], check=True, cwd=tmp_path)
    subprocess.run([compiler, *STRICT, "-O1", "impl.cpp", "main.o", "-o", "main"], check=True, cwd=tmp_path)
    done = subprocess.run([tmp_path / "main"], check=True, capture_output=True, text=True)
    L, q = ph.step((0.2, 0.4, 0.5), (0.2, 0.8, 1.5), (0, 0, 0, 1), 0.1, frame="body")
    numbers = [float(x) for x in done.stdout.split()]
    assert np.abs(np.array(numbers[:2]) - L[[0, 2]]).max() < 1e-15
    _, q = ph.step((0.2, 0.4, 0.5), (0.2, 0.8, 1.5), (0, 0, 0, 1), 0.1)
    assert np.abs(np.array(numbers[2:]) - q[[0, 3]]).max() < 3e-7


MUTATIONS = {"c_3": ("c3 = set(-1.0 / 7)", "c3 = set(1.0 / 7)"), "e": ("e = K3 + LLdd", "e = K3 - LLdd"),
             "A": ("(W + W - e) * We", "(W + W + e) * We"), "g": ("g1 = a[2] - a[1]", "g1 = a[1] - a[2]"),
             "m_3": ("m3 = set(-1.0 / 3)", "m3 = set(1.0 / 3)"), "P": ("P12 = X12 * P;", "P12 = -X12 * P;")}

PROGRAM = """
#include <cstdio>
#include <cstdlib>
#include "step.hpp"
int main(int, char** v) {
  using namespace polhode::step;
  const auto body = make_inertia(0.2, 0.4, 0.5);
  Vec<double> L{0.06, 0.2, 0.4};
  Quat<double> q{0, 0, 0, 1};
  for (int i = 0; i < 10; ++i) drift_body(body, std::atof(v[1]), L, q);
  std::printf("%.17g %.17g %.17g %.17g", q.x, q.y, q.z, q.w);
}
"""


def error_of(header, folder, *flags):
    (folder / "step.hpp").write_text(header)
    program = compile_text(COMPILERS[0], PROGRAM, folder, "-std=c++17", "-O1", f"-I{folder}", *flags)
    done = subprocess.run([program, "0.5"], check=True, capture_output=True, text=True)
    moments = np.array((0.2, 0.4, 0.5))
    _, truth = ph.FreeMotion(ph.InertiaTensor.from_moments(moments), np.array((0.06, 0.2, 0.4)) / moments).at(5.0)
    return angle(np.array([float(x) for x in done.stdout.split()]), truth)


@pytest.mark.skipif(not COMPILERS, reason="needs a compiler")
@pytest.mark.parametrize("mutation", [None, "fast-math", *MUTATIONS])
def test_a_changed_sign_is_seen_and_fast_math_is_harmless(mutation, tmp_path):
    header = (HEADERS / "step.hpp").read_text()
    if mutation in MUTATIONS:
        assert MUTATIONS[mutation][0] in header
        assert error_of(header.replace(*MUTATIONS[mutation]), tmp_path) > 1e-11
    else:
        flags = ["-ffast-math", "-O3"] if mutation else []
        assert error_of(header, tmp_path, *flags) < 1e-13


@pytest.mark.skipif(not COMPILERS, reason="needs a compiler")
def test_the_engine_of_the_examples_keeps_its_energy(tmp_path):
    program = compile_text(COMPILERS[0], ENGINE.read_text(), tmp_path, *STRICT[:3], "-Werror", "-O2", f"-I{HEADERS}")
    done = subprocess.run([program, "60"], check=True, capture_output=True, text=True)
    numbers = [float(x) for x in done.stdout.splitlines()[-1].split()]
    assert numbers[0] == 60 and numbers[2] < 1e-4 and numbers[4] > 1e-2 and numbers[6] > 1e-2
