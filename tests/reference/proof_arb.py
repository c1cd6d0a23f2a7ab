"""Judge proofs by an evaluator of another kind: ``python tests/reference/proof_arb.py [--write]`` (needs python-flint).

Twenty scenes of many kinds are drawn and computed in 100 digits with FLINT's arb numbers: Taylor series of the rates
and the quaternion, with the rotation matrix formed from the quaternion and the orbit's angle from its sine and cosine.
The proofs' own equations have neither. Two orders must agree to 40 digits. Each number is stored as a sum of two.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
from flint import arb, arb_series, ctx

FILE = Path(__file__).parent / "proof_scenes.json"
ctx.dps, ctx.cap = 100, 100
TOLERANCE = 1e-70


def draw(seed: int = 20) -> list[dict]:
    """Return the scenes as plain numbers."""
    rng = np.random.default_rng(seed)

    def tensor(full: bool) -> list:
        moments = np.diag([1.0, 1.6, 2.1] * (0.9 + 0.2 * rng.random(3)))
        if full:
            turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
            moments = turn @ moments @ turn.T
            moments = 0.5 * (moments + moments.T)
        return moments.tolist()

    def vector(size: float) -> list:
        return (size * rng.standard_normal(3)).tolist()

    def gravity() -> dict:
        return {"kind": "gravity", "weight": 2.0 + rng.random(), "arm": vector(0.3)}

    def gradient(rate: float = 0.4) -> dict:
        return {"kind": "gradient", "mean_motion": rate * (1 + rng.random()), "phase": float(rng.random())}

    def constant(frame: str) -> dict:
        return {"kind": "constant", "torque": vector(0.3), "frame": frame}

    def damping(size: float, full: bool = True) -> dict:
        matrix = rng.random((3, 3)) if full else np.diag(rng.random(3))
        return {"kind": "damping", "matrix": (size * matrix).tolist()}

    def during(torque: dict, *windows: tuple) -> dict:
        return {**torque, "windows": [list(window) for window in windows]}

    kinds: list[tuple[bool, list]] = [
        (False, []), (True, []), (False, [gravity()]), (True, [gravity()]), (False, [gradient()]),
        (True, [gradient(), gradient(-0.2)]), (False, [constant("body")]), (True, [constant("space")]),
        (True, [constant("space"), constant("space"), constant("space")]), (False, [damping(0.3, full=False)]),
        (True, [damping(0.5)]), (True, [damping(-0.1)]), (True, [gravity(), damping(0.2), constant("body")]),
        (True, [gravity(), gradient(), constant("space"), damping(0.1)]),
        (False, [during(constant("body"), (0.5, 1.25))]),
        (True, [during(gravity(), (-1.0, 0.75)), during(damping(0.3), (0.5, 2.0), (2.5, 9.0)), constant("space")]),
        (False, [gradient()]), (True, [gravity(), during(constant("body"), (-1.5, -0.5), (0.5, 2.0))]),
        (False, [damping(20.0, full=False)]), (True, [gradient(), during(gradient(0.7), (1.0, 2.0))])]
    scenes = []
    for index, (full, torques) in enumerate(kinds):
        attitude = rng.standard_normal(4)
        t0 = 1e6 + 0.3 if index == 16 else 0.0
        times = t0 + np.sort(np.concatenate(([0.0], 5.0 * rng.random(6))))
        if index in (3, 5, 17):
            times = np.concatenate((times, t0 - 3.0 * rng.random(4)))
        attitude /= np.linalg.norm(attitude)
        scenes.append({"inertia": tensor(full), "omega": vector(1.5), "attitude": attitude.tolist(), "torques": torques,
                       "t0": t0, "times": times.tolist()})
    scenes[2]["omega"] = [0.0, 0.0, 0.0]
    scenes[0].update(inertia=np.diag([0.2, 0.4, 0.52]).tolist(), omega=[1e-4, 5.0, 1e-4])
    return scenes


def product(a: list, b: list, n: int) -> arb:
    """Return coefficient n of a product of two series."""
    total = arb(0)
    for i in range(n + 1):
        total += a[i] * b[n - i]
    return total


class Expansion:
    """Taylor series of omega and q about one time, with the given torques."""

    def __init__(self, body: dict, torques: list, t: arb, state: list, order: int) -> None:
        self.order, self.torques = order, torques
        self.I, self.inverse = body["I"], body["inverse"]
        self.w = [[x] for x in state[:3]]
        self.q = [[x] for x in state[3:]]
        self.R = [[[] for _ in range(3)] for _ in range(3)]
        self.L: list[list] = [[], [], []]
        self.u: dict = {}
        self.Iu: dict = {}
        self.orbit = {}
        for k, torque in enumerate(torques):
            if torque["kind"] == "gradient":
                rate = arb(torque["mean_motion"])
                angle = arb_series([rate * t + arb(torque["phase"]), rate], order + 1)
                self.orbit[k] = [[series[n] for n in range(order + 1)] for series in (angle.cos(), angle.sin())]
                self.u[k], self.Iu[k] = [[], [], []], [[], [], []]
        for n in range(order):
            self.extend(n)

    def extend(self, n: int) -> None:
        x, y, z, s = self.q
        squares = {(i, j): product(self.q[i], self.q[j], n) for i in range(4) for j in range(i, 4)}

        def p(i: int, j: int) -> arb:
            return squares[min(i, j), max(i, j)]

        rows = [[p(0, 0) - p(1, 1) - p(2, 2) + p(3, 3), 2 * (p(0, 1) - p(2, 3)), 2 * (p(0, 2) + p(1, 3))],
                [2 * (p(0, 1) + p(2, 3)), p(1, 1) - p(0, 0) - p(2, 2) + p(3, 3), 2 * (p(1, 2) - p(0, 3))],
                [2 * (p(0, 2) - p(1, 3)), 2 * (p(1, 2) + p(0, 3)), p(2, 2) - p(0, 0) - p(1, 1) + p(3, 3)]]
        for i in range(3):
            for j in range(3):
                self.R[i][j].append(rows[i][j])
        for i in range(3):
            self.L[i].append(sum((self.I[i][j] * self.w[j][n] for j in range(3)), arb(0)))
        tau = [arb(0)] * 3
        for k, torque in enumerate(self.torques):
            tau = [a + b for a, b in zip(tau, self.torque(k, torque, n), strict=True)]
        cross = [product(self.L[j], self.w[k], n) - product(self.L[k], self.w[j], n)
                 for j, k in ((1, 2), (2, 0), (0, 1))]
        rate = [sum((self.inverse[i][j] * (cross[j] + tau[j]) for j in range(3)), arb(0)) for i in range(3)]
        w = self.w
        turn = [product(s, w[0], n) + product(y, w[2], n) - product(z, w[1], n),
                product(s, w[1], n) + product(z, w[0], n) - product(x, w[2], n),
                product(s, w[2], n) + product(x, w[1], n) - product(y, w[0], n),
                -product(x, w[0], n) - product(y, w[1], n) - product(z, w[2], n)]
        for i in range(3):
            w[i].append(rate[i] / (n + 1))
        for i in range(4):
            self.q[i].append(turn[i] / (2 * (n + 1)))

    def torque(self, k: int, torque: dict, n: int) -> list:
        """Return coefficient n of one torque in body axes."""
        kind = torque["kind"]
        if kind == "gravity":
            arm, force = [arb(v) for v in torque["arm"]], [-arb(torque["weight"]) * self.R[2][j][n] for j in range(3)]
            return [arm[(i + 1) % 3] * force[(i + 2) % 3] - arm[(i + 2) % 3] * force[(i + 1) % 3] for i in range(3)]
        if kind == "damping":
            return [-sum((arb(torque["matrix"][i][j]) * self.w[j][n] for j in range(3)), arb(0)) for i in range(3)]
        if kind == "constant":
            tau = [arb(v) for v in torque["torque"]]
            if torque["frame"] == "body":
                return tau if n == 0 else [arb(0)] * 3
            return [sum((self.R[i][j][n] * tau[i] for i in range(3)), arb(0)) for j in range(3)]
        cosine, sine = self.orbit[k]
        u, Iu = self.u[k], self.Iu[k]
        for j in range(3):
            u[j].append(product(self.R[0][j], cosine, n) + product(self.R[1][j], sine, n))
        for j in range(3):
            Iu[j].append(sum((self.I[j][m] * u[m][n] for m in range(3)), arb(0)))
        strength = 3 * arb(torque["mean_motion"]) ** 2
        return [strength * (product(u[(i + 1) % 3], Iu[(i + 2) % 3], n) - product(u[(i + 2) % 3], Iu[(i + 1) % 3], n))
                for i in range(3)]

    def length(self) -> float:
        """Return a step after which the last two terms are within the tolerance."""
        h = 1e300
        for n in (self.order - 1, self.order):
            largest = max(abs(float(series[n].mid())) for series in (*self.w, *self.q))
            h = min(h, (TOLERANCE / largest) ** (1 / n) if largest > 0 else h)
        return h

    def at(self, h: arb) -> list:
        """Return omega and q at a distance h, to 100 digits."""
        out = []
        for series in (*self.w, *self.q):
            total = arb(0)
            for c in reversed(series):
                total = total * h + c
            out.append(total.mid())
        return out


def invert(I: list) -> list:
    """Return the inverse of a symmetric (3, 3) tensor."""

    def minor(i: int, j: int) -> arb:
        a, b, c, d = (j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3
        return I[a][c] * I[b][d] - I[a][d] * I[b][c]

    determinant = sum((I[0][j] * minor(j, 0) for j in range(3)), arb(0))
    return [[minor(i, j) / determinant for j in range(3)] for i in range(3)]


def compute(scene: dict, order: int) -> list[list]:
    """Return omega and q at the scene's times."""
    body = {"I": [[arb(v) for v in row] for row in scene["inertia"]]}
    body["inverse"] = invert(body["I"])
    t0 = arb(scene["t0"])
    q = [arb(v) for v in scene["attitude"]]
    size = sum((v * v for v in q), arb(0)).sqrt()
    start = [*(arb(v) for v in scene["omega"]), *(v / size for v in q)]
    found: dict[float, list] = {}
    edges = sorted({e for torque in scene["torques"] for window in torque.get("windows", ()) for e in window})
    for sign in (1, -1):
        times = sorted((t for t in scene["times"] if (t >= scene["t0"]) == (sign > 0)), key=lambda t: sign * t)
        if not times:
            continue
        stops = [e for e in edges[::sign] if sign * scene["t0"] < sign * e < sign * times[-1]] + [times[-1]]
        now, state = t0, start
        begin = scene["t0"]
        for stop in stops:
            middle = 0.5 * (begin + stop)
            acting = [torque for torque in scene["torques"] if "windows" not in torque or
                      any(a <= middle < b for a, b in torque["windows"])]
            while True:
                expansion = Expansion(body, acting, now, state, order)
                left = float((arb(stop) - now).mid())
                h = arb(stop) - now if abs(left) <= expansion.length() else arb(sign * expansion.length())
                for t in times:
                    if t not in found and float(sign * (now + h - arb(t)).mid()) >= 0:
                        found[t] = expansion.at(arb(t) - now)
                state = expansion.at(h)
                if abs(left) <= expansion.length():
                    now = arb(stop)
                    break
                now = (now + h).mid()
            begin = stop
    return [found[t] for t in scene["times"]]


def split(x: arb) -> list[float]:
    """Return a number as two float64 numbers."""
    high = float(x.mid())
    return [high, float((x - arb(high)).mid())]


def make() -> list[dict]:
    """Return the scenes with their truth."""
    scenes = draw()
    for index, scene in enumerate(scenes):
        one, two = compute(scene, 70), compute(scene, 60)
        apart = max(abs(float((a - b).mid())) for p, r in zip(one, two, strict=True) for a, b in zip(p, r, strict=True))
        print(f"scene {index}: {len(one)} samples, orders apart by {apart:.1e}")
        assert apart < 1e-40
        scene["truth"] = [[split(x) for x in line] for line in one]
    return scenes


def judge(scenes: list[dict]) -> int:
    """Return how many proofs do not hold the truth."""
    sys.path.insert(0, str(Path(__file__).parents[1] / "support"))
    from proofs import find_outside, make_scene

    import polhode as ph

    wrong = 0
    for index, scene in enumerate(scenes):
        motion = ph.solve(make_scene(scene), 1e-9, certify="proof")
        outside = find_outside(motion, np.array(scene["truth"]))
        wrong += bool(outside)
        print(f"scene {index}: {motion.error_kind}, error {motion.error:.1e}, {outside} numbers outside")
    return wrong


if __name__ == "__main__":
    made = make()
    if "--write" in sys.argv:
        FILE.write_text(json.dumps(made, indent=None, separators=(",", ":")) + "\n")
    sys.exit(judge(made) > 0)
