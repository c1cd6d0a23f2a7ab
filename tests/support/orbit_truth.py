"""A body under torques of orbits by Taylor series in 34 digits, with each orbit's position and velocity as states."""

import mpmath

mp = mpmath.mp.clone()
mp.dps = 34
ORDER = 30


def convolve(a, b, n):
    return mp.fsum(a[j] * b[n - j] for j in range(n + 1))


def cross(a, b, n):
    """Row n of the cross product of two vectors of series."""
    return [convolve(a[(i + 1) % 3], b[(i + 2) % 3], n) - convolve(a[(i + 2) % 3], b[(i + 1) % 3], n) for i in range(3)]


class Series:
    """Rows of a vector, one list a component."""

    def __init__(self, start):
        self.rows = [[mp.mpf(x)] for x in start]

    def __getitem__(self, i):
        return self.rows[i]


def add_power(square, exponent, made, n):
    """Row n of square^exponent."""
    if n == 0:
        made.append(square[0] ** exponent)
        return
    total = mp.fsum((exponent * j - (n - j)) * square[j] * made[n - j] for j in range(1, n + 1))
    made.append(total / (n * square[0]))


def rotation(q, n, products):
    """Row n of R_WB from the products of two components of q."""
    for i in range(4):
        for j in range(i, 4):
            products[i, j].append(convolve(q[i], q[j], n))
    x = {key: value[n] for key, value in products.items()}
    return [[x[3, 3] + x[0, 0] - x[1, 1] - x[2, 2], 2 * (x[0, 1] - x[2, 3]), 2 * (x[0, 2] + x[1, 3])],
            [2 * (x[0, 1] + x[2, 3]), x[3, 3] - x[0, 0] + x[1, 1] - x[2, 2], 2 * (x[1, 2] - x[0, 3])],
            [2 * (x[0, 2] - x[1, 3]), 2 * (x[1, 2] + x[0, 3]), x[3, 3] - x[0, 0] - x[1, 1] + x[2, 2]]]


def step(inertia, inverse, orbits, state, h, torque):
    """One step of w, q and all (r, v); `torque` gives row n of tau_B from the rows of what is known."""
    w, q = Series(state[:3]), Series(state[3:7])
    places = [Series(state[7 + 6 * k: 10 + 6 * k]) for k in range(len(orbits))]
    speeds = [Series(state[10 + 6 * k: 13 + 6 * k]) for k in range(len(orbits))]
    products = {(i, j): [] for i in range(4) for j in range(i, 4)}
    R = [[[] for _ in range(3)] for _ in range(3)]
    squares, cubes, memory = [[] for _ in orbits], [[] for _ in orbits], {}
    momentum = [[] for _ in range(3)]
    for n in range(ORDER):
        for i, row in enumerate(rotation(q, n, products)):
            for j, entry in enumerate(row):
                R[i][j].append(entry)
        for k in range(len(orbits)):
            squares[k].append(mp.fsum(convolve(places[k][i], places[k][i], n) for i in range(3)))
            add_power(squares[k], mp.mpf(-3) / 2, cubes[k], n)
        for i in range(3):
            momentum[i].append(mp.fsum(inertia[i][j] * w[j][n] for j in range(3)))
        tau = torque(n, R, places, speeds, squares, w, memory)
        spin = cross(w.rows, momentum, n)
        push = [tau[i] - spin[i] for i in range(3)]
        for i in range(3):
            w[i].append(mp.fsum(inverse[i][j] * push[j] for j in range(3)) / (n + 1))
        for k, mu in enumerate(orbits):
            for i in range(3):
                pull = -mu * convolve(places[k][i], cubes[k], n)
                places[k][i].append(speeds[k][i][n] / (n + 1)), speeds[k][i].append(pull / (n + 1))
        turn = [convolve(q[3], w[0], n) + convolve(q[1], w[2], n) - convolve(q[2], w[1], n),
                convolve(q[3], w[1], n) + convolve(q[2], w[0], n) - convolve(q[0], w[2], n),
                convolve(q[3], w[2], n) + convolve(q[0], w[1], n) - convolve(q[1], w[0], n),
                -convolve(q[0], w[0], n) - convolve(q[1], w[1], n) - convolve(q[2], w[2], n)]
        for i in range(4):
            q[i].append(turn[i] / (2 * (n + 1)))
    rows = w.rows + q.rows + [row for k in range(len(orbits)) for row in places[k].rows + speeds[k].rows]
    ends = [mp.polyval(row[::-1], h) for row in rows]
    size = max(abs(row[-1]) * h ** (len(row) - 1) / max(1, abs(row[0])) for row in rows)
    return ends, size


def gradients(inertia, mus):
    """The torque sum of 3 mu |r|^-5 r x (J r)."""
    def torque(n, R, places, speeds, squares, w, memory):
        tau = [mp.mpf(0)] * 3
        for k, mu in enumerate(mus):
            r, h, force, fifth = memory.setdefault(k, ([[], [], []], [[], [], []], [[], [], []], []))
            for i in range(3):
                r[i].append(mp.fsum(convolve(R[j][i], places[k][j], n) for j in range(3)))
            for i in range(3):
                h[i].append(mp.fsum(inertia[i][j] * r[j][n] for j in range(3)))
            add_power(squares[k], mp.mpf(-5) / 2, fifth, n)
            for i, value in enumerate(cross(r, h, n)):
                force[i].append(value)
            tau = [tau[i] + 3 * mu * convolve(force[i], fifth, n) for i in range(3)]
        return tau
    return torque


def solve(inertia, omega, attitude, orbits, times, torque=None):
    """w and q at increasing times from 0; orbits are (mu, r0, v0)."""
    J = mp.matrix([[mp.mpf(x) for x in row] for row in inertia])
    inverse = (J**-1).tolist()
    mus = [mp.mpf(mu) for mu, _, _ in orbits]
    state = [mp.mpf(x) for x in (*omega, *attitude)] + [mp.mpf(x) for _, r, v in orbits for x in (*r, *v)]
    norm = mp.sqrt(mp.fsum(x * x for x in state[3:7]))
    state[3:7] = [x / norm for x in state[3:7]]
    torque = torque or gradients(J.tolist(), mus)
    t, h, found = mp.mpf(0), mp.mpf(times[-1]) / 16, []
    for end in times:
        while t < end:
            size = mp.inf
            length = min(h, mp.mpf(end) - t)
            while size > mp.mpf(10) ** -22:
                new, size = step(J.tolist(), inverse, mus, state, length, torque)
                h = length * min(mp.mpf(2), mp.mpf("0.8") * (mp.mpf(10) ** -23 / (size + mp.mpf(10) ** -60)) ** (
                    mp.mpf(1) / ORDER))
                if size > mp.mpf(10) ** -22:
                    length = h
            state, t = new, t + length
        found.append([float(x) for x in state[:7]])
    return found
