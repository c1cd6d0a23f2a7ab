"""Mass properties of a mesh: time and error of polhode and of trimesh, side by side in one run.

    python benchmarks/mesh.py [--faces 1000000] [--repeat 5]

A potato of triangles, near the origin and a thousand and a million of its sizes away. Times are the processor's, of all
threads, and the clock's on the wall: the best of interleaved repeats, arrays in memory. Errors are those of the volume
and of the moments about the centre, as a part of the largest, against sums in 80-bit numbers over the same triangles
seen from nearby (their own error is below 1e-17).
"""

import argparse
import time

import numpy as np

import polhode as ph


def potato(count):
    """About so many triangles round the origin, turned anyhow."""
    around = 2 * int((count / 4) ** 0.5)
    along = around // 2
    theta, phi = np.pi * np.arange(1, along) / along, 2 * np.pi * np.arange(around) / around
    t, p = (g.ravel() for g in np.meshgrid(theta, phi, indexing="ij"))
    points = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], 1)
    points = np.concatenate([[(0, 0, 1)], points, [(0, 0, -1)]])
    x, y, z = points.T
    points = points * (1 + 0.3 * x * y + 0.2 * z**3)[:, None] @ ph.Rotation.from_rotvec((0.3, -1.1, 0.7)).as_matrix().T
    i, n, last = np.arange(around), (np.arange(around) + 1) % around, len(points) - 1
    faces = [np.stack([0 * i, 1 + i, 1 + n], 1), np.stack([last - around + i, 0 * i + last, last - around + n], 1)]
    for j in range(along - 2):
        a, b = 1 + j * around, 1 + (j + 1) * around
        faces += [np.stack([a + i, b + i, b + n], 1), np.stack([a + i, b + n, a + n], 1)]
    return points, np.concatenate(faces)


def reference(vertices, faces):
    """Volume, and inertia about the centre at density 1, in 80-bit numbers."""
    v = vertices.astype(np.longdouble)
    a, b, c = (v[faces[:, k]] for k in range(3))
    e, f = b - a, c - a   # before the reference point: exact
    origin = vertices[faces[:, 0]].mean(axis=0).astype(np.longdouble)
    a, b, c = a - origin, b - origin, c - origin
    normal = np.stack([e[:, 1] * f[:, 2] - e[:, 2] * f[:, 1], e[:, 2] * f[:, 0] - e[:, 0] * f[:, 2],
                       e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0]], 1)
    d = (a * normal).sum(axis=1)
    s = a + b + c
    volume = d.sum() / 6
    centre = (d[:, None] * s).sum(axis=0) / 24 / volume
    def moment(i, j):
        return (d * (a[:, i] * a[:, j] + b[:, i] * b[:, j] + c[:, i] * c[:, j] + s[:, i] * s[:, j])).sum() / 120

    second = np.array([[moment(i, j)
                        - volume * centre[i] * centre[j] for j in range(3)] for i in range(3)])
    return volume, np.trace(second) * np.eye(3) - second


def solvers(vertices, faces):
    narrow = faces.astype(np.int32)

    def polhode(**options):
        body = ph.MassProperties.from_mesh(vertices, narrow, density=1.0, **options)
        return body.mass, body.inertia.matrix

    found = {"polhode, check=False": lambda: polhode(check=False), "polhode": polhode}
    try:
        import trimesh
    except ImportError:
        return found

    def triangles():
        """Its integrals alone, from corners already put together."""
        answer = trimesh.triangles.mass_properties(corners, skip_inertia=False)
        return answer["mass"], np.array(answer["inertia"])

    def whole():
        body = trimesh.Trimesh(vertices, faces, process=False)
        return body.mass, body.moment_inertia

    corners = vertices[faces]
    return {**found, "trimesh, integrals": triangles, "trimesh, Trimesh": whole}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faces", type=int, default=1_000_000)
    parser.add_argument("--repeat", type=int, default=5)
    options = parser.parse_args()
    vertices, faces = potato(options.faces)
    print(f"{len(faces)} faces, {len(vertices)} vertices, simd {ph.build_info()['simd']}")
    print(f"{'away by':>8} {'solver':22} {'CPU ms':>9} {'clock ms':>9} {'volume':>9} {'inertia':>9}")
    for away in (0.0, 1e3, 1e6):
        moved = vertices + away
        volume, inertia = reference(moved, faces)
        entries = solvers(moved, faces)
        best, clock = dict.fromkeys(entries, np.inf), dict.fromkeys(entries, np.inf)
        answers = {}
        for _ in range(options.repeat):
            for name, call in entries.items():
                start, seen = time.process_time(), time.perf_counter()
                answers[name] = call()
                best[name] = min(best[name], time.process_time() - start)
                clock[name] = min(clock[name], time.perf_counter() - seen)
        for name, (found, matrix) in answers.items():
            errors = abs(found / volume - 1), np.abs(matrix - inertia).max() / np.abs(inertia).max()
            print(f"{away:8.0e} {name:22} {best[name] * 1e3:9.2f} {clock[name] * 1e3:9.2f} "
                  f"{float(errors[0]):9.1e} {float(errors[1]):9.1e}")


if __name__ == "__main__":
    main()
