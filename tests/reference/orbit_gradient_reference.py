"""Write orbit_gradient.json: gravity gradient on conics, in 34 digits, the orbit integrated beside the body."""

import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "support"))
import orbit_truth

FULL = [[1.0, 0.2, -0.1], [0.2, 1.8, 0.3], [-0.1, 0.3, 2.2]]
BOX = [[1.0, 0, 0], [0, 2.0, 0], [0, 0, 2.5]]
TIP = (0.1, -0.2, 0.3, 0.9)


def conic(e, q=1.0, mu=1.0):
    """The state at the periapsis, in a plane that is tilted."""
    v, c, s = math.sqrt(mu * (1 + e) / q), math.cos(0.7), math.sin(0.7)
    return mu, (q * c, q * s * 0.6, q * s * 0.8), (-v * s, v * c * 0.6, v * c * 0.8)


def cases():
    for name, e in (("circle", 0.0), ("e 0.1", 0.1), ("e 0.73", 0.73), ("e 0.97", 0.97), ("below 1", 1 - 1e-9),
                    ("1 ulp below 1", 1 - 2**-53), ("above 1", 1 + 1e-9), ("e 1.5", 1.5), ("e 4.2", 4.2)):
        yield name, BOX, (0.3, -0.2, 0.5), TIP, [conic(e)], [1.0, 4.0]
    yield "full tensor", FULL, (0.3, -0.2, 0.5), TIP, [conic(0.3)], [1.0, 4.0]
    yield "two bodies", BOX, (0.0, 0.0, 0.0), TIP, [conic(0.3), conic(1.7, 2.0, 3.0)], [1.0, 3.0]
    # towards the periapsis and past it: the orbit of case e 4.2, begun 6 before it
    mu, r, v = conic(4.2)
    yield "flyby", [[0.61, 0, 0], [0, 0.965, 0], [0, 0, 1.0]], (0.05, 0.02, -0.4), TIP, [(mu, r, v)], [6.0]


def main():
    found = []
    for name, inertia, omega, attitude, orbits, times in cases():
        rows = orbit_truth.solve(inertia, omega, attitude, orbits, times)
        found.append({"name": name, "inertia": inertia, "omega": omega, "attitude": attitude, "orbits": orbits,
                      "times": times, "states": rows})
        print(name, flush=True)
    path = pathlib.Path(__file__).with_name("orbit_gradient.json")
    path.write_text('{"cases": [\n' + ",\n".join(json.dumps(case) for case in found) + "\n]}\n")


if __name__ == "__main__":
    main()
