"""Small closed surfaces, and their mass properties in exact fractions."""

import struct
from fractions import Fraction

import numpy as np

BOX_FACES = np.array([(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2),
                      (2, 4, 6), (1, 3, 5), (3, 7, 5)], dtype=np.int64)
TETRAHEDRON_FACES = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)], dtype=np.int64)


def box(low=(-1, -1, -1), high=(1, 1, 1)):
    """Vertices and faces of a box; vertex 1 is along x from vertex 0, vertex 2 along y, vertex 4 along z."""
    corners = [[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)]
    return np.array(corners, dtype=float), BOX_FACES.copy()


def join(*meshes):
    """Several surfaces as one."""
    vertices, faces, count = [], [], 0
    for v, f in meshes:
        vertices.append(v)
        faces.append(f + count)
        count += len(v)
    return np.concatenate(vertices), np.concatenate(faces)


def inward(mesh):
    return mesh[0], mesh[1][:, ::-1].copy()


def globe(around=24, along=12, radius=lambda x, y, z: 1.0, turn=np.eye(3)):
    """A surface round the origin with the radius given for each direction: 2 around (along - 1) faces."""
    phi = 2 * np.pi * np.arange(around) / around
    rows = [np.array([[0, 0, 1.0]])]
    for theta in np.pi * np.arange(1, along) / along:
        ring = [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.full(around, np.cos(theta))]
        rows.append(np.stack(ring, axis=1))
    rows.append(np.array([[0, 0, -1.0]]))
    vertices = np.concatenate(rows)
    vertices = vertices * np.array([radius(*v) for v in vertices])[:, None] @ turn.T
    i, n = np.arange(around), (np.arange(around) + 1) % around
    last = len(vertices) - 1
    faces = [np.stack([0 * i, 1 + i, 1 + n], 1)]
    for j in range(along - 2):
        a, b = 1 + j * around, 1 + (j + 1) * around
        faces += [np.stack([a + i, b + i, b + n], 1), np.stack([a + i, b + n, a + n], 1)]
    a = 1 + (along - 2) * around
    faces.append(np.stack([a + i, 0 * i + last, a + n], 1))
    return vertices, np.concatenate(faces)


def soup(mesh):
    """The same faces, each with three vertices of its own, as STL files have them."""
    vertices, faces = mesh
    return vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)


def binary_stl(mesh, count=None, head=b"made by a test"):
    """The bytes of an STL file, in float32; `count` is what it claims."""
    corners = mesh[0][mesh[1]].astype("<f4")
    rows = b"".join(bytes(12) + c.tobytes() + bytes(2) for c in corners)
    return head.ljust(80, b"\0") + struct.pack("<I", len(corners) if count is None else count) + rows


def exact(vertices, faces):
    """Volume, centre and inertia about it (density 1) of the doubles as they are: a sum over tetrahedra from 0."""
    fractions = [[Fraction(float(x)) for x in v] for v in vertices]
    grain = max(x.denominator for v in fractions for x in v)   # a power of two: in its parts all are whole numbers
    points = [[int(x * grain) for x in v] for v in fractions]
    volume, first, second = 0, [0] * 3, [[0] * 3 for _ in range(3)]
    for i, j, k in np.asarray(faces).tolist():
        a, b, c = points[i], points[j], points[k]
        d = (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
             + a[2] * (b[0] * c[1] - b[1] * c[0]))
        s = [a[m] + b[m] + c[m] for m in range(3)]
        volume += d
        for m in range(3):
            first[m] += d * s[m]
            for n in range(m, 3):
                second[m][n] += d * (a[m] * a[n] + b[m] * b[n] + c[m] * c[n] + s[m] * s[n])
    centre = [Fraction(f, 4 * volume * grain) for f in first]
    volume = Fraction(volume, 6 * grain**3)
    C = [[Fraction(second[min(m, n)][max(m, n)], 120 * grain**5) - volume * centre[m] * centre[n] for n in range(3)]
         for m in range(3)]
    trace = C[0][0] + C[1][1] + C[2][2]
    return volume, centre, [[(trace if m == n else 0) - C[m][n] for n in range(3)] for m in range(3)]


def seamed(around=24, along=12, gap=0.0):
    """A ball as CAD programs mesh it: its seam and its poles are computed anew for each face.

    With `gap` = 0 the ends of the seam differ by sin(2 pi) = -2e-16, else by that length.
    """
    def point(i, j):
        phi, theta = 2 * np.pi * i / around, np.pi * j / along
        shift = gap if i == around and 0 < j < along else 0.0
        return np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi) + shift, np.cos(theta)

    vertices = np.array([point(i, j) for j in range(along + 1) for i in range(around + 1)])
    faces = []
    for j in range(along):
        for i in range(around):
            a, b = j * (around + 1) + i, (j + 1) * (around + 1) + i
            faces += [(a, b, b + 1)] * (j < along - 1) + [(a, b + 1, a + 1)] * (j > 0)
            if j == along - 1:
                faces[-1] = (a, b + 1, a + 1)
    return vertices, np.array(faces, dtype=np.int64)
