"""Random robot links for the diagnosis: a geometry of boxes and ellipsoids, and a body within it."""

import numpy as np

import polhode as ph


class Link:
    """A geometry as one uniform body (`props`, at its density), the box that holds it, its volume, and its parts."""

    def __init__(self, rng, aligned=False):
        size = 10 ** rng.uniform(-2, 0.3)
        self.parts, total = [], None
        for _ in range(rng.integers(1, 4)):
            half = size * rng.uniform(0.2, 1, 3) * (1, 1, rng.uniform(0.3, 1))
            turn = ph.Rotation.from_quat((0, 0, 0, 1)) if aligned else ph.Rotation.from_quat(unit(rng.normal(size=4)))
            place = size * rng.normal(size=3) * (0.7, 0.7, 0.7)
            block = bool(rng.integers(2))
            volume = (8 if block else 4 / 3 * np.pi) * half.prod()
            part = (ph.shapes.box if block else ph.shapes.ellipsoid)(volume, half).moved(turn, place)
            self.parts.append((block, half, turn.as_matrix(), place))
            total = part if total is None else total + part
        self.volume = total.mass
        density = 10 ** rng.uniform(2, 3.9)
        self.props = ph.MassProperties(total.mass * density, total.com, total.inertia.matrix * density)
        reach = [(np.abs(r) @ h if block else np.sqrt((r**2) @ h**2)) for block, h, r, _ in self.parts]
        self.extents = np.array([np.min([p - e for (*_, p), e in zip(self.parts, reach)], axis=0),
                                 np.max([p + e for (*_, p), e in zip(self.parts, reach)], axis=0)])

    def inside(self, rng):
        """A point of it."""
        block, half, turn, place = self.parts[rng.integers(len(self.parts))]
        x = rng.uniform(-1, 1, 3) if block else unit(rng.normal(size=3)) * rng.uniform() ** (1 / 3)
        return turn @ (half * x * 0.9) + place, half.min()

    def uneven(self, rng, share=None):
        """The same link with one to five heavy parts in it, with a share of its mass; none denser than lead."""
        share = rng.uniform(0.02, 0.9) if share is None else share
        total = scaled(self.props, 1 - share)
        weights = rng.dirichlet(np.ones(rng.integers(1, 6))) * share * self.props.mass
        for weight in weights:
            point, least = self.inside(rng)
            axes = least * rng.uniform(0.05, 0.5, 3)
            weight = min(weight, 11_000 * 4 / 3 * np.pi * axes.prod())
            total = total + ph.shapes.ellipsoid(weight, axes).moved(translation=point)
        return total


def unit(v):
    return v / np.linalg.norm(v)


def scaled(props, factor):
    return ph.MassProperties(props.mass * factor, props.com, props.inertia.matrix * factor)


def rounded(x, digits):
    """As printed with so many significant digits."""
    return np.vectorize(lambda v: float(f"{v:.{digits - 1}e}"))(np.asarray(x, dtype=float))


def numbers(props, digits=None):
    """Mass, com and matrix, rounded as files are."""
    parts = props.mass, props.com, props.inertia.matrix
    return tuple(parts if digits is None else (rounded(p, digits) for p in parts))
