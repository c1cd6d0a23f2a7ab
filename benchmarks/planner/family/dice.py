"""What kinds draw with: numbers over decades, directions, bodies."""

import zlib

import numpy as np

import polhode as ph


class Dice:
    """Random numbers that depend on a seed, a name and an index alone."""

    def __init__(self, seed, name, index):
        self.rng = np.random.Generator(np.random.PCG64([seed, zlib.crc32(name.encode()), index]))

    def uniform(self, low, high, size=None):
        return self.rng.uniform(low, high, size)

    def decade(self, low, high, size=None):
        """10 to a power between two."""
        return 10 ** self.rng.uniform(low, high, size)

    def whole(self, low, high):
        """A whole number; both ends are possible."""
        return int(self.rng.integers(low, high + 1))

    def chance(self, share):
        return bool(self.rng.uniform() < share)

    def pick(self, items):
        return items[int(self.rng.integers(len(items)))]

    def order(self):
        return self.rng.permutation(3)

    def sign(self):
        return self.pick((-1.0, 1.0))

    def direction(self):
        v = self.rng.normal(size=3)
        return v / np.linalg.norm(v)

    def attitude(self):
        q = self.rng.normal(size=4)
        return q / np.linalg.norm(q)

    def near_vertical(self, tilt):
        """An attitude whose body z is `tilt` from space z."""
        angle = self.uniform(0, 2 * np.pi)
        lean = ph.Rotation.from_rotvec(tilt * np.array([np.cos(angle), np.sin(angle), 0]))
        return (lean * ph.Rotation.from_rotvec((0, 0, self.uniform(-np.pi, np.pi)))).as_quat()

    def box(self):
        """The moments of a solid box of unit mass with half sides over a decade."""
        a, b, c = self.decade(-1, 0, 3)
        return np.array([b * b + c * c, a * a + c * c, a * a + b * b]) / 3

    def breaks(self, count, low=0.0, high=1.0):
        """Numbers between two, ascending."""
        return np.sort(self.uniform(low, high, count))
