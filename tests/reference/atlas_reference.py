"""Makes python/polhode/atlas/truth.npz: what is true in the atlas's families, from outside the library.

Free bodies by `free_motion_reference.closed_form` (mpmath, 110 digits), driven ones by `taylor.cpp` in 113-bit
arithmetic, stiff ones by `collocation.cpp`, the long spin-up by `taylor.cpp` in the 64-bit mantissas of long double.
Of polhode only the definitions of the problems are used, whose float64 numbers are taken as exact.
Run: python atlas_reference.py [part ...]; all of it takes a few minutes.
"""

import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from free_motion_reference import DIGITS, closed_form
from make_references import HERE, compile_programs, gauss, quaternion_of, run
from mpmath import asin, findroot, mp, sqrt

from polhode.atlas import scenes
from polhode.atlas.case import S1_MOMENTS, STORE, key
from polhode.torques import Constant, Damping, Gravity


def numbers(scene):
    found = {"moments": np.diag(scene.inertia.matrix).tolist(), "omega": scene.omega.tolist(),
             "attitude": scene.attitude.tolist()}
    for torque in scene.torques:
        if isinstance(torque, Gravity):
            found["gravity"] = [torque.weight, *torque.arm.tolist()]
        elif isinstance(torque, Constant):
            found["constant"] = torque.torque.tolist()
        elif isinstance(torque, Damping):
            found["damping"] = np.ravel(torque.matrix).tolist()
    if scene.rotors:
        found["rotors"] = scene.rotor_momentum.tolist()
    return found


def to_rows(answers):
    """Quaternions leave with unit length: the start's is unit only to rounding, and that is no attitude's affair."""
    rows = np.array([[float(x) for x in [*line[:3], *(c / sqrt(sum(q * q for q in line[3:])) for c in line[3:])]]
                     for line in answers])
    return rows


def free(scene):
    with mp.workdps(DIGITS):
        given = numbers(scene)
        answers = closed_form(given["moments"], given["omega"], given["attitude"], [float(t) for t in scene.times])
        return to_rows([[*w, *q] for w, q in answers])


def driven(programs, scene, program="taylor", order=40, tolerance=-33.0):
    return to_rows(run(programs / program, numbers(scene), [order, tolerance], scene.times.tolist()))


def first_flip(closeness):
    """The first zero of omega_y, and its slope there [s, rad/s^2]."""
    with mp.workdps(DIGITS):
        def rate(t):
            return closed_form(S1_MOMENTS, (closeness, 5.0, closeness), (0, 0, 0, 1), [t])[0][0][1]

        near = {1e-1: 2.7241, 1e-2: 3.6834, 1e-4: 5.6007, 1e-6: 7.5180, 1e-8: 9.4353, 1e-10: 11.3526, 1e-12: 13.2699}
        root = findroot(rate, (near[closeness] - 1e-4, near[closeness] + 1e-4), tol=1e-60)
        w = closed_form(S1_MOMENTS, (closeness, 5.0, closeness), (0, 0, 0, 1), [root])[0][0]
        I = [mp.mpf(v) for v in S1_MOMENTS]
        return [float(root), float((I[2] - I[0]) * w[2] * w[0] / I[1])]


def greatest_tilt(programs, scene, across=(3, 4)):
    """Of body z from the vertical, or of another axis from where it was: by the other two parts of the quaternion."""
    answers = run(programs / "taylor", numbers(scene), [40, -33.0], scene.times.tolist())
    return float(max(2 * asin(sqrt(sum(q[i] ** 2 for i in across) / sum(c * c for c in q[3:]))) for q in answers))


def compile_long_double(folder):
    """`taylor.cpp` once more, thirty times as fast."""
    text = "".join((HERE / name).read_text() for name in ("problem.hpp", "taylor.cpp"))
    for quad, double in ((r"#pragma once|#include .(quadmath|problem)\.h.*", ""), ("__float128", "long double"),
                         (r"\b(fabs|pow|cos|sin|sqrt)q\b", r"\1l"), ("strtoflt128", "strtold"),
                         ("quadmath_snprintf", "snprintf"), (r"%\.36Qe", "%.24Le"), (r"(\d)Q\b", r"\1L")):
        text = re.sub(quad, double, text)
    (folder / "fast.cpp").write_text("#include <cmath>\n" + text)
    subprocess.run(["g++", "-std=gnu++20", "-O2", "-o", str(folder / "fast"), str(folder / "fast.cpp")], check=True)


def parts(programs):
    """{part: {key: array}}, each made when it is asked for."""
    def stiff(case):
        rate = case.x   # I1 = 1
        lines = gauss(programs, (0.02, min(0.02, 0.1 / rate)), numbers(case.scene), case.scene.times.tolist())
        return to_rows([quaternion_of(line) for line in lines])

    def spin(case):
        """In 113 bits, then in 64; the longest in 64 alone."""
        fast = driven(programs, case.scene, "fast", 24, -21.0)
        if case.x > 2000:
            return fast
        slow = driven(programs, case.scene)
        print(f"spin-up to {case.x:g} s: long double is off by {np.abs(fast - slow).max():.1e}", flush=True)
        return slow

    def many(family, cases, solve):
        return {key(family, case): solve(case) for case in cases}

    return {
        "racket": lambda: {**many("racket", map(scenes.racket, scenes.RACKET), lambda c: free(c.scene)),
                           "racket/flips": np.array([first_flip(e) for e in scenes.RACKET])},
        "long": lambda: many("long", map(scenes.long, scenes.LONG), lambda c: free(c.scene)),
        "near": lambda: many("near", [scenes.near(kind, gap) for kind in ("sphere", "symmetric")
                                      for gap in scenes.NEAR],
                             lambda c: free(c.scene)),
        "gimbal": lambda: many("gimbal", [scenes.gimbal(kind, d) for kind in ("free", "top") for d in scenes.GIMBAL],
                               lambda c: driven(programs, c.scene)),
        "chaos": lambda: {"chaos": driven(programs, scenes.chaos())},
        "sleeping": lambda: {"sleeping": np.array([greatest_tilt(programs, scenes.sleeping(s).scene)
                                                   for s in scenes.SLEEPING])},
        "wheel": lambda: {"wheel": np.array([greatest_tilt(programs, scenes.wheel(s).scene, (3, 5))
                                             for s in scenes.WHEEL])},
        "damping": lambda: many("damping", map(scenes.damped, scenes.STIFF), stiff),
        "spin-up": lambda: many("spin-up", map(scenes.spin_up, scenes.SPIN_UP), spin),
    }


def main():
    with tempfile.TemporaryDirectory() as folder:
        compile_programs(Path(folder))
        compile_long_double(Path(folder))
        possible = parts(Path(folder))
        for name in sys.argv[1:] or list(possible):
            begin = time.time()
            made = possible[name]()
            known = dict(np.load(STORE)) if STORE.exists() else {}
            np.savez_compressed(STORE, **dict(sorted({**known, **made}.items())))
            print(f"{name}: {time.time() - begin:.0f} s", flush=True)


if __name__ == "__main__":
    main()
