"""Every shape against integrals over its volume, done in 40 digits by rules that are exact for these integrands.

Each body is given as pieces: a map from the unit cube with its Jacobian. Polynomial directions are integrated by
Boole's rule (exact to degree 5), angles by the trapezoidal rule (exact for these trigonometric polynomials).
"""

import functools
import inspect
import pathlib
import pickle
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import polhode as ph

mp.mp.dps = 40
BOOLE = [(mp.mpf(i) / 4, mp.mpf(w) / 90) for i, w in enumerate([7, 32, 12, 32, 7])]
half = mp.mpf(1) / 2
ANGLE = [(mp.mpf(i) / 8, mp.mpf(1) / 8) for i in range(8)]
lengths = st.floats(0.1, 10)
stable = settings(derandomize=True, deadline=None, max_examples=6)


def turn(u):
    return mp.cos(2 * mp.pi * u), mp.sin(2 * mp.pi * u)


def reference(mass, pieces):
    """Centre and tensor about it, from the volume, first and second moments of pieces (map, Jacobian, rules)."""
    moments = [mp.mpf(0)] * 10
    for where, jacobian, rules in pieces:
        for u, wu in rules[0]:
            for v, wv in rules[1]:
                for w, ww in rules[2]:
                    (x, y, z), weight = where(u, v, w), wu * wv * ww * jacobian(u, v, w)
                    terms = (1, x, y, z, x * x, y * y, z * z, x * y, x * z, y * z)
                    moments = [m + weight * t for m, t in zip(moments, terms)]
    x, y, z, xx, yy, zz, xy, xz, yz = [m / moments[0] for m in moments[1:]]
    xx, yy, zz, xy, xz, yz = xx - x * x, yy - y * y, zz - z * z, xy - x * y, xz - x * z, yz - y * z
    m = mp.mpf(mass)
    return (x, y, z), mp.matrix([[m * (yy + zz), -m * xy, -m * xz], [-m * xy, m * (xx + zz), -m * yz],
                                 [-m * xz, -m * yz, m * (xx + yy)]])


def block(a, b, c, sign=1):
    return (lambda u, v, w: ((2 * u - 1) * a, (2 * v - 1) * b, (2 * w - 1) * c),
            lambda u, v, w: sign * 8 * a * b * c, (BOOLE, BOOLE, BOOLE))


def ball(a, b, c, low=-1, high=1, z0=0):
    """The part of an ellipsoid between the cosines low and high of the polar angle."""
    def where(u, v, w):
        cosine, (x, y) = low + (high - low) * v, turn(w)
        sine = mp.sqrt(1 - cosine**2)
        return a * u * sine * x, b * u * sine * y, z0 + c * u * cosine
    return where, lambda u, v, w: 2 * mp.pi * (high - low) * a * b * c * u**2, (BOOLE, BOOLE, ANGLE)


def round_solid(radius, z):
    """A solid round z: radius(v) and height z(v), both linear in v."""
    def where(u, v, w):
        x, y = turn(w)
        return radius(v) * u * x, radius(v) * u * y, z(v)
    return where, lambda u, v, w: radius(v) ** 2 * u * (z(1) - z(0)), (BOOLE, BOOLE, ANGLE)


def along(p, q, t):
    return tuple(a + t * (b - a) for a, b in zip(p, q))


def corners(p0, p1, p2, p3):
    """A tetrahedron by Duffy's map of the cube."""
    return (lambda u, v, w: along(p0, along(p1, along(p2, p3, w), v), u), lambda u, v, w: u**2 * v,
            (BOOLE, BOOLE, BOOLE))


def prism(points, h):
    p0, p1, p2 = points
    return (lambda u, v, w: (*along(p0, along(p1, p2, v), u), h * (w - half)), lambda u, v, w: u,
            (BOOLE, BOOLE, BOOLE))


def ring(R, r):
    def where(u, v, w):
        (c, s), (x, y) = turn(v), turn(w)
        return (R + r * u * c) * x, (R + r * u * c) * y, r * u * s
    return where, lambda u, v, w: (R + r * u * turn(v)[0]) * u, (BOOLE, ANGLE, ANGLE)


def tube(r, h):
    return (lambda u, v, w: (r * turn(w)[0], r * turn(w)[1], (u - half) * h), lambda u, v, w: 1,
            (BOOLE, BOOLE[:1], ANGLE))


def globe(r):
    solid = ball(r, r, r)
    return lambda u, v, w: solid[0](1, v, w), lambda u, v, w: 1, (BOOLE[:1], BOOLE, ANGLE)


def half_globe(r, z0, sign):
    """Half a spherical shell about (0, 0, z0), up or down; its area as a part of that of a tube of unit height."""
    shell = ball(r, r, r, min(0, sign), max(0, sign), z0)
    return lambda u, v, w: shell[0](1, v, w), lambda u, v, w: r, (BOOLE[:1], BOOLE, ANGLE)


@functools.cache
def gauss(n):
    """Gauss and Legendre's rule on (0, 1), 40 digits."""
    found = []
    for i in range(n):
        x = mp.cos(mp.pi * (i + mp.mpf(3) / 4) / (n + half))
        for _ in range(8):
            p, q = mp.mpf(1), mp.mpf(0)
            for k in range(1, n + 1):
                p, q = ((2 * k - 1) * x * p - (k - 1) * q) / k, p
            slope = n * (x * p - q) / (x * x - 1)
            x -= p / slope
        found.append(((1 + x) / 2, 1 / ((1 - x * x) * slope**2)))
    return found


def egg_shell(a, b, c):
    """The surface of an ellipsoid: rules that converge by a factor of 4 a node for axes within 1 to 1.5."""
    solid = ball(a, b, c)

    def area(u, v, w):
        cosine, (x, y) = 2 * v - 1, turn(w)
        return mp.sqrt((1 - cosine**2) * ((x / a) ** 2 + (y / b) ** 2) + (cosine / c) ** 2)

    return (lambda u, v, w: solid[0](1, v, w), area,
            (BOOLE[:1], gauss(32), [(mp.mpf(i) / 48, mp.mpf(1) / 48) for i in range(48)]))


POINT = st.tuples(*[st.floats(-5, 5)] * 3)
tetrahedra = st.tuples(POINT, st.tuples(*[lengths] * 3)).map(
    lambda t: [t[0], (t[0][0] + t[1][0], t[0][1], t[0][2] + 1), (t[0][0], t[0][1] + t[1][1], t[0][2] - 1),
               (t[0][0] + 1, t[0][1], t[0][2] + t[1][2])])
triangles = tetrahedra.map(lambda t: [p[:2] for p in t[:3]])

# name: (strategies of the parameters after the mass, the pieces made from them)
SHAPES = {
    "box": ([st.tuples(lengths, lengths, lengths)], lambda s: [block(*s)]),
    "sphere": ([lengths], lambda r: [ball(r, r, r)]),
    "half_ball": ([lengths], lambda r: [ball(r, r, r, 0, 1)]),
    "spherical_shell": ([lengths], lambda r: [globe(r)]),
    "ellipsoid": ([st.tuples(lengths, lengths, lengths)], lambda s: [ball(*s)]),
    "ellipsoid_shell": ([st.tuples(*[st.floats(1, 1.5)] * 3)], lambda s: [egg_shell(*s)]),
    "cylinder": ([lengths, lengths], lambda r, h: [round_solid(lambda v: r, lambda v: (v - half) * h)]),
    "cylindrical_shell": ([lengths, lengths], lambda r, h: [tube(r, h)]),
    "cone": ([lengths, lengths], lambda r, h: [round_solid(lambda v: r * (1 - v), lambda v: v * h)]),
    "frustum": ([lengths, st.one_of(st.just(0.0), lengths), lengths], lambda R, r, h: [
        round_solid(lambda v: R + (r - R) * v, lambda v: v * h)]),
    "capsule": ([lengths, st.one_of(st.just(0.0), lengths)], lambda r, h: [
        ball(r, r, r, 0, 1, h * half), ball(r, r, r, -1, 0, -h * half),
        (lambda u, v, w: round_solid(lambda _: r, lambda v: (v - half) * h)[0](u, v, w),
         lambda u, v, w: 2 * mp.pi * r**2 * h * u, (BOOLE, BOOLE, ANGLE))]),
    "capsule_shell": ([lengths, st.one_of(st.just(0.0), lengths)], lambda r, h: [
        half_globe(r, h * half, 1), half_globe(r, -h * half, -1),
        (tube(r, h)[0], lambda u, v, w: h, (BOOLE, BOOLE[:1], ANGLE))]),
    "torus": ([st.floats(5, 10), st.one_of(st.just(0.0), st.floats(0.1, 5))], lambda R, r: [ring(R, r)]),
    "rod": ([lengths], lambda h: [(lambda u, v, w: (0, 0, (u - half) * h), lambda u, v, w: 1,
                                   (BOOLE, BOOLE[:1], BOOLE[:1]))]),
    "disk": ([lengths], lambda r: [(lambda u, v, w: (r * u * turn(w)[0], r * u * turn(w)[1], 0),
                                    lambda u, v, w: u, (BOOLE, BOOLE[:1], ANGLE))]),
    "tetrahedron": ([tetrahedra], lambda p: [corners(*p)]),
    "triangular_prism": ([triangles, lengths], lambda p, h: [prism(p, h)]),
    "hollow_box": ([st.tuples(lengths, lengths, lengths), st.floats(1e-9, 0.1)], lambda s, w: [
        block(*s), block(*[x - mp.mpf(w) for x in s], sign=-1)]),
}


def deep(value):
    return [deep(v) for v in value] if isinstance(value, (list, tuple)) else mp.mpf(value)


def test_every_shape_of_the_list_is_integrated_here():
    assert list(SHAPES) == [name for name in ph.shapes.__all__ if name not in ("table", "volume")]


@pytest.mark.parametrize("name", SHAPES)
def test_a_shape_is_its_integral_rounded_once(name):
    parameters, pieces = SHAPES[name]

    @stable
    @given(st.floats(0.1, 100), st.tuples(*parameters))
    def check(mass, values):
        body = getattr(ph.shapes, name)(mass, *values)
        com, tensor = reference(mass, pieces(*[deep(v) for v in values]))
        size = max(abs(float(x)) for x in np.ravel(np.array(values[0], dtype=float)))
        top = float(max(tensor[i, i] for i in range(3)))
        for i in range(3):
            assert abs(body.com[i] - com[i]) <= 4e-16 * max(size, abs(com[i]))
            for j in range(3):
                ulp = np.spacing(float(abs(tensor[i, j])) if i == j else top)
                assert abs(body.inertia.matrix[i, j] - tensor[i, j]) <= 0.51 * ulp + mp.mpf(10) ** -36
        assert body.mass == mass

    check()


@pytest.mark.parametrize("scale", [1e-12, 1e12])
@pytest.mark.parametrize("name", SHAPES)
def test_shapes_scale(name, scale):
    @settings(derandomize=True, deadline=None, max_examples=3)
    @given(st.tuples(*SHAPES[name][0]))
    def check(values):
        one = getattr(ph.shapes, name)(1.0, *values)
        other = getattr(ph.shapes, name)(3.0, *[np.multiply(v, scale) for v in values])
        top, back = one.inertia.moments[2], other.inertia.matrix / (3 * scale**2)
        np.testing.assert_allclose(back, one.inertia.matrix, rtol=1e-13, atol=1e-13 * top)
        assert other.inertia.symmetry == one.inertia.symmetry

    check()


def test_limits_of_one_shape_are_another():
    def same(a, b, rtol=1e-15):
        np.testing.assert_allclose(a.inertia.matrix, b.inertia.matrix, rtol=rtol, atol=0)

    s = ph.shapes
    same(s.capsule(2, 0.7, 0), s.sphere(2, 0.7))
    same(s.ellipsoid(2, (0.7, 0.7, 0.7)), s.sphere(2, 0.7))
    same(s.hollow_box(2, (1, 2, 3), 1), s.box(2, (1, 2, 3)))
    same(s.capsule_shell(2, 0.7, 0), s.spherical_shell(2, 0.7))
    same(s.ellipsoid_shell(2, (0.7, 0.7, 0.7)), s.spherical_shell(2, 0.7))
    same(s.frustum(2, 0.7, 0, 3), s.cone(2, 0.7, 3))
    same(s.frustum(2, 0.7, 0.7, 3), s.cylinder(2, 0.7, 3))
    ball_ = s.half_ball(1, 0.7) + s.half_ball(1, 0.7).moved(ph.Rotation.from_quat((1, 0, 0, 0)))
    same(ball_, s.sphere(2, 0.7))
    same(s.torus(2, 0.7, 0), s.cylindrical_shell(2, 0.7, 1e-12))
    same(s.cylinder(2, 0.7, 1e-12), s.disk(2, 0.7))
    thin = s.hollow_box(2, (1, 2, 3), 0)
    same(thin, s.hollow_box(2, (1, 2, 3), 1e-14), 1e-13)
    # six faces: a thin sheet of density 1 per area, as boxes of no thickness
    areas = {0: 24, 1: 12, 2: 8}
    total = None
    for axis, area in areas.items():
        sides = [1.0, 2.0, 3.0]
        where = np.zeros(3)
        where[axis] = sides[axis]
        sides[axis] = 1e-30
        for sign in (1, -1):
            face = s.box(2 * area / 88, sides).moved(translation=sign * where)
            total = face if total is None else total + face
    same(total, thin, 1e-14)


@pytest.mark.parametrize("axes", [(1, 1e-3, 1e-6), (1e-6, 1, 1e6), (1, 1, 1e-9), (1, 1e-9, 1e-9), (1e-150, 1, 1e150),
                                  (3, 3, 1), (1, 3, 3), (5, 4.999999999, 5), (2, 1, 1e-12)])
def test_shells_of_needles_and_coins(axes):
    """Against the derivative of Carlson's R_G, which is the mean of g, to 30 digits."""
    with mp.workdps(60):
        x = [1 / mp.mpf(a) ** 2 for a in axes]
        top = max(x)

        def mean(*y):
            return mp.elliprg(*y)

        second = []
        for i in range(3):
            h = x[i] * mp.mpf(10) ** -18
            high, low = ([*x[:i], x[i] + s * h, *x[i + 1:]] for s in (1, -1))
            slope = (mean(*high) - mean(*low)) / (2 * h)   # error 1e-36 of it
            second.append(mp.mpf(axes[i]) ** 2 * (mp.mpf(1) / 4 + x[i] * slope / (2 * mean(*x))))
        truth = [second[1] + second[2], second[2] + second[0], second[0] + second[1]]
        found = ph.shapes.ellipsoid_shell(1, axes).inertia.matrix
        assert top > 0 and np.count_nonzero(found - np.diag(found.diagonal())) == 0
        for value, exact in zip(found.diagonal(), truth):
            assert abs(value / exact - 1) <= 0.51 * 2**-52


@pytest.mark.parametrize("call, name", [
    (lambda: ph.shapes.cylinder(1, 0, 2), "rod"), (lambda: ph.shapes.cylinder(1, 2, 0), "disk"),
    (lambda: ph.shapes.capsule(1, 0, 2), "rod"), (lambda: ph.shapes.capsule_shell(1, 0, 2), "rod"),
])
def test_thin_bodies_are_named(call, name):
    with pytest.raises(ph.InvalidInput, match=rf"positive and finite, got 0 \(a thin body\? that is shapes.{name}\)"):
        call()


def test_a_box_taken_apart_into_tetrahedra_and_put_together():
    a, b, c = 1.0, 2.0, 3.0
    cube = np.array([[x, y, z] for x in (-a, a) for y in (-b, b) for z in (-c, c)])
    parts = [(0, 3, 5, 6), (1, 0, 3, 5), (2, 0, 3, 6), (4, 0, 5, 6), (7, 3, 5, 6)]  # the middle one is a third of it
    body = None
    for i, part in enumerate(parts):
        piece = ph.shapes.tetrahedron(6.0 * (2 if i == 0 else 1) / 6, cube[list(part)])
        body = piece if body is None else body + piece
    np.testing.assert_allclose(body.inertia.matrix, ph.shapes.box(6.0, (a, b, c)).inertia.matrix, atol=1e-14 * 26)
    np.testing.assert_allclose(body.com, 0, atol=1e-15)


def test_a_tetrahedron_far_from_the_origin_loses_nothing():
    corner = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3.0]])
    near, far = ph.shapes.tetrahedron(1, corner), ph.shapes.tetrahedron(1, corner + 2.0**40)
    assert np.array_equal(near.inertia.matrix, far.inertia.matrix)


def test_tonons_tetrahedron():
    """F. Tonon, J. Math. Stat. 1 (2004) 8, density 1: printed with the rounding of its own computation, about 1e-8."""
    p = [(8.33220, -11.86875, 0.93355), (0.75523, 5.00000, 16.37072), (52.61236, 5.00000, -5.38580), (2.0, 5.0, 3.0)]
    volume = abs(np.linalg.det(np.array(p[1:]) - p[0])) / 6
    body = ph.shapes.tetrahedron(volume, p)
    np.testing.assert_allclose(body.com, (15.92492, 0.78281, 3.72962), atol=3e-5)
    a, b, c = 43520.33257, 194711.28938, 191168.76173  # moments
    yz, xz, xy = 4417.66150, -46343.16662, 11996.20119  # products, without the tensor's minus sign
    np.testing.assert_allclose(body.inertia.matrix, [(a, -xy, -xz), (-xy, b, -yz), (-xz, -yz, c)], rtol=3e-8)


GOOD = {
    "half_sides": (1, 2, 3), "semi_axes": (1, 2, 3), "radius": 1, "height": 2, "cylinder_height": 2, "major_radius": 2,
    "minor_radius": 1, "length": 2, "wall": 0.5,
    "base_radius": 2, "top_radius": 1,
}


def good(name):
    values = {"mass": 1.0}
    for parameter in list(inspect.signature(getattr(ph.shapes, name)).parameters)[1:]:
        if parameter == "vertices":
            values[parameter] = np.eye(3)[:, :2] if "prism" in name else np.eye(4)[:, :3]
        else:
            values[parameter] = GOOD[parameter]
    return values


@pytest.mark.parametrize("name", SHAPES)
def test_bad_parameters_are_refused_by_name(name):
    shape, values = getattr(ph.shapes, name), good(name)
    body = shape(**values)
    assert shape(*values.values()) == body == pickle.loads(pickle.dumps(body))
    for parameter, fine in values.items():
        size = np.shape(fine)
        bad = [np.full(size, x) for x in (np.nan, np.inf, -np.inf)] + ["text", None, np.zeros((2, 7)), 1j]
        if parameter != "vertices":
            bad.append(np.full(size, -1.0))
        if parameter not in ("cylinder_height", "minor_radius", "wall", "top_radius"):
            bad.append(np.full(size, 0.0))  # also the corners: all in one point
        for value in bad:
            with pytest.raises(ph.InvalidInput, match=f"^{parameter}:"):
                shape(**{**values, parameter: value})
    with pytest.raises(TypeError, match="missing a required argument"):
        shape(1.0)
    with pytest.raises(TypeError, match="unexpected"):
        shape(**values, colour=1)


@pytest.mark.parametrize("call, message", [
    (lambda: ph.shapes.torus(1, 1, 2), "minor_radius: must be at most major_radius"),
    (lambda: ph.shapes.hollow_box(1, (1, 2, 3), 1.5), "the walls would meet"),
    (lambda: ph.shapes.tetrahedron(1, [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.3, 0.4, 0)]), "four points in one plane"),
    (lambda: ph.shapes.triangular_prism(1, [(0, 0), (1, 1), (2, 2)], 1), "three points on one line"),
])
def test_bad_combinations(call, message):
    with pytest.raises(ph.InvalidInput, match=message):
        call()


def test_an_unknown_shape_lists_the_known_ones():
    with pytest.raises(AttributeError, match="no shape 'boxx'; there are box, sphere"):
        ph.shapes.boxx


def test_functions_read_like_functions():
    assert str(inspect.signature(ph.shapes.cylinder)).startswith("(mass: float, radius: float, height: float)")
    assert "half of each side [m]" in ph.shapes.box.__doc__ and "Parameters\n----------" in ph.shapes.box.__doc__
    assert ph.shapes.box.__name__ == "box"


def test_the_table_in_the_docs_is_the_list():
    page = (pathlib.Path(__file__).parents[3] / "docs" / "inertia.md").read_text()
    assert ph.shapes.table() in page


def test_the_homework_block():
    """Problem 2 of the homework: a block with sides 2a, 2b, 2c."""
    M, a, b, c = Fraction(7), Fraction(3), Fraction(5), Fraction(2)
    block_ = ph.shapes.box(float(M), (3, 5, 2))
    third = M / 3

    def is_diagonal_of(tensor, moments):
        np.testing.assert_allclose(tensor.matrix, np.diag([float(x) for x in moments]), rtol=3e-16, atol=0)

    is_diagonal_of(block_.inertia, (third * (b * b + c * c), third * (a * a + c * c), third * (a * a + b * b)))
    at_face = block_.about((0, 0, 2))  # the centre of a face of area 4ab
    is_diagonal_of(at_face, (third * (b * b + 4 * c * c), third * (a * a + 4 * c * c), third * (a * a + b * b)))
    space = 2 * third * (a * a * b * b + b * b * c * c + a * a * c * c) / (a * a + b * b + c * c)
    face = 2 * third * (a * a * b * b + 2 * b * b * c * c + 2 * a * a * c * c) / (a * a + b * b)
    through_centre = third * (2 * a * a * b * b + a * a * c * c + b * b * c * c) / (a * a + b * b)
    for x in (3, -3):
        for y in (5, -5):
            assert block_.inertia.about_axis((x, y, 2)) == pytest.approx(float(space), rel=4e-16)
            assert at_face.about_axis((x, y, 0)) == pytest.approx(float(face), rel=4e-16)
            assert block_.inertia.about_axis((x, y, 0)) == pytest.approx(float(through_centre), rel=4e-16)
