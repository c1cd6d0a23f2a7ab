"""The homework polhode grew from (docs/seed.md): its formulas, those that are right and the five that are not.

Truth is exact Fractions, or mpmath with 40 digits on arbitrary motions; the library is held against it.
"""

import tomllib
from fractions import Fraction
from itertools import product
from pathlib import Path

import mpmath
import numpy as np
import pytest
from mpmath import matrix, mpf

import polhode as ph

SCENES = Path(__file__).parents[3] / "scenes"
MOMENTS = (mpf("1.3"), mpf("2.1"), mpf("2.9"))
T = mpf("0.7")


@pytest.fixture(autouse=True)
def forty_digits():
    with mpmath.workdps(40):
        yield


# ---- helpers: the textbook's matrices, on a motion that no symmetry favours


def phi(t):
    return mpf("0.3") + mpf("1.1") * t + mpmath.sin(2 * t) / 3


def theta(t):
    return mpf("1.2") + mpmath.cos(mpf("1.7") * t) / 4


def psi(t):
    return mpf("-0.4") + mpf("0.8") * t - mpmath.sin(mpf("1.3") * t) / 2


def turn_z(a):
    return matrix([[mpmath.cos(a), mpmath.sin(a), 0], [-mpmath.sin(a), mpmath.cos(a), 0], [0, 0, 1]])


def turn_x(a):
    return matrix([[1, 0, 0], [0, mpmath.cos(a), mpmath.sin(a)], [0, -mpmath.sin(a), mpmath.cos(a)]])


def space_to_body(angles):
    """A = B C D."""
    return turn_z(angles[2]) * turn_x(angles[1]) * turn_z(angles[0])


def rates(angles, speeds):
    """Formula 1.2: the angular velocity in body axes."""
    (_, th, ps), (dph, dth, dps) = angles, speeds
    return [dph * mpmath.sin(th) * mpmath.sin(ps) + dth * mpmath.cos(ps),
            dph * mpmath.sin(th) * mpmath.cos(ps) - dth * mpmath.sin(ps),
            dps + dph * mpmath.cos(th)]  # fmt: skip


def angles_at(t):
    return [phi(t), theta(t), psi(t)]


def speeds_at(t):
    return [mpmath.diff(f, t) for f in (phi, theta, psi)]


def omega_at(t):
    return rates(angles_at(t), speeds_at(t))


def kinetic(angles, speeds):
    return sum(i * w**2 for i, w in zip(MOMENTS, rates(angles, speeds), strict=True)) / 2


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def axial(m):
    return [(m[2, 1] - m[1, 2]) / 2, (m[0, 2] - m[2, 0]) / 2, (m[1, 0] - m[0, 1]) / 2]


def euler_torque():
    """N = I w' + w x I w in body axes at T: what torque the arbitrary motion needs."""
    w = omega_at(T)
    slopes = [mpmath.diff(lambda t, i=i: omega_at(t)[i], T) for i in range(3)]
    momentum = [i * x for i, x in zip(MOMENTS, w, strict=True)]
    return [i * s + c for i, s, c in zip(MOMENTS, slopes, cross(w, momentum), strict=True)]


def lagrange_force(k):
    """d/dt dT/dv_k - dT/du_k of the angle u_k along the motion: the generalised force Q_k."""

    def momentum(t):
        speeds = speeds_at(t)
        return mpmath.diff(lambda v: kinetic(angles_at(t), [*speeds[:k], v, *speeds[k + 1 :]]), speeds[k])

    def by_angle(u):
        return kinetic([*angles_at(T)[:k], u, *angles_at(T)[k + 1 :]], speeds_at(T))

    return mpmath.diff(momentum, T, h=mpf("1e-9")) - mpmath.diff(by_angle, angles_at(T)[k])


# ---- problem 1: Euler's equations from Lagrange's


def test_angular_velocity_of_the_angles():
    """1.2 is the axial vector of A d(A^T)/dt."""
    slope = matrix(3, 3)
    for i, j in product(range(3), repeat=2):
        slope[i, j] = mpmath.diff(lambda t, i=i, j=j: space_to_body(angles_at(t))[j, i], T)
    turned = axial(space_to_body(angles_at(T)) * slope)
    assert max(abs(a - b) for a, b in zip(turned, omega_at(T), strict=True)) < mpf("1e-25")


def test_lagranges_psi_equation_is_eulers_third():
    assert abs(lagrange_force(2) - euler_torque()[2]) < mpf("1e-15")  # 1.5, N_z' alone: 1.6 prints Q_uv for Q_psi


def test_generalised_forces_are_the_torque_along_each_axis():
    """Q_phi, Q_theta, Q_psi: about space's z, the line of nodes, the body's z."""
    torque, (_, th, ps) = euler_torque(), angles_at(T)
    space_z = [mpmath.sin(th) * mpmath.sin(ps), mpmath.sin(th) * mpmath.cos(ps), mpmath.cos(th)]
    node = [mpmath.cos(ps), -mpmath.sin(ps), mpf(0)]
    for k, axis in enumerate((space_z, node, [mpf(0), mpf(0), mpf(1)])):
        assert abs(lagrange_force(k) - dot(torque, axis)) < mpf("1e-15")


def test_a_force_does_the_work_of_its_moment():
    """1.8 to 1.10: in body axes dr/dpsi = (-r_y, r_x, 0), so F . dr/dpsi = N_z'."""
    r, force = [mpf("0.3"), mpf("-0.7"), mpf("1.9")], [mpf("2.3"), mpf("0.4"), mpf("-1.1")]
    ph_, th, ps = angles_at(T)

    def place(u):
        return space_to_body([ph_, th, u]).T * matrix(r)

    moved = space_to_body([ph_, th, ps]) * matrix([mpmath.diff(lambda u, i=i: place(u)[i], ps) for i in range(3)])
    assert max(abs(a - b) for a, b in zip(moved, [-r[1], r[0], 0], strict=True)) < mpf("1e-25")
    assert abs(dot(force, moved) - cross(r, force)[2]) < mpf("1e-25")


def test_potential_and_force_are_one_thing():
    """1.3 as printed has both, L = T - V and Q = -dV/dpsi. With a V that drives this motion L leaves 0, T leaves Q."""
    force = euler_torque()[2]
    left_of_lagrangian = lagrange_force(2) + mpmath.diff(lambda u: -force * u, angles_at(T)[2])
    assert abs(left_of_lagrangian) < mpf("1e-15") < mpf("0.1") < abs(force)


# ---- problem 2: the block of sides 2a, 2b, 2c

BLOCKS = [  # a, b, c, mass
    (Fraction(3, 8), Fraction(1, 2), Fraction(5, 4), Fraction(12)),
    (Fraction(2), Fraction(1, 16), Fraction(1), Fraction(7, 4)),
]


def integral(low, high, power):
    return (Fraction(high) ** (power + 1) - Fraction(low) ** (power + 1)) / (power + 1)


def exact_tensor(a, b, c, mass, height=0):
    """sum of density times (r^2 E - r r^T) over |x| < a, |y| < b, height - c < z < height + c, in Fractions."""
    sides = [(-a, a), (-b, b), (height - c, height + c)]
    density = mass / (8 * a * b * c)

    def moment(i, j):
        powers = [(i == k) + (j == k) for k in range(3)]
        return density * np.prod([integral(*side, p) for side, p in zip(sides, powers, strict=True)])

    trace = sum(moment(k, k) for k in range(3))
    return [[trace * (i == j) - moment(i, j) for j in range(3)] for i in range(3)]


def about(tensor, axis):
    return sum(axis[i] * tensor[i][j] * axis[j] for i, j in product(range(3), repeat=2)) / sum(x * x for x in axis)


def assert_near(value, exact):
    np.testing.assert_allclose(np.asarray(value, float), np.array(exact, dtype=float), rtol=5e-16, atol=0)


@pytest.mark.parametrize("block", BLOCKS)
def test_block_about_its_centre(block):
    a, b, c, mass = block
    printed = [mass * (b * b + c * c) / 3, mass * (a * a + c * c) / 3, mass * (a * a + b * b) / 3]
    exact = exact_tensor(*block)
    assert exact == [[printed[i] * (i == j) for j in range(3)] for i in range(3)]
    body = ph.shapes.box(float(mass), [float(a), float(b), float(c)])
    assert_near(body.inertia.matrix, exact)
    assert_near(body.inertia.moments, sorted(printed))


def test_the_integral_needs_its_density():
    """2.2 as printed, without M/(8abc), gives 8abc (b^2 + c^2)/3."""
    a, b, c, mass = BLOCKS[0]
    bare = exact_tensor(a, b, c, 8 * a * b * c)[0][0]
    assert bare == 8 * a * b * c * (b * b + c * c) / 3 != mass * (b * b + c * c) / 3


@pytest.mark.parametrize("block", BLOCKS)
def test_block_about_the_centre_of_a_face(block):
    a, b, c, mass = block
    printed = [mass * (b * b + 4 * c * c) / 3, mass * (a * a + 4 * c * c) / 3, mass * (a * a + b * b) / 3]
    assert exact_tensor(*block, height=c) == [[printed[i] * (i == j) for j in range(3)] for i in range(3)]
    body = ph.shapes.box(float(mass), [float(a), float(b), float(c)])
    for side in (1, -1):
        assert_near(body.about([0, 0, side * float(c)]).matrix, np.diag(printed))


@pytest.mark.parametrize("block", BLOCKS)
def test_block_about_its_diagonals(block):
    a, b, c, mass = block
    body = ph.shapes.box(float(mass), [float(a), float(b), float(c)])
    space = 2 * mass / 3 * (a * a * b * b + b * b * c * c + a * a * c * c) / (a * a + b * b + c * c)
    assert about(exact_tensor(*block), (a, b, c)) == space
    assert_near(body.inertia.about_axis([float(a), float(b), float(c)]), space)

    face = 2 * mass / 3 * (a * a * b * b + 2 * b * b * c * c + 2 * a * a * c * c) / (a * a + b * b)
    assert about(exact_tensor(*block, height=c), (a, b, 0)) == face
    assert_near(body.about([0, 0, float(c)]).about_axis([float(a), float(b), 0]), face)

    parallel = mass / 3 * (2 * a * a * b * b + a * a * c * c + b * b * c * c) / (a * a + b * b)
    assert_near(body.inertia.about_axis([float(a), float(b), 0]), parallel)
    assert face == parallel + mass * c * c, "the diagonal lies in the face, not through the centre of mass"


# ---- problem 3: L^2 and T of the free body


def free_slopes(w):
    """L' and w' of the free body by Euler's equations, L_i' = -eps_ijk w_j L_k."""
    momentum = [i * x for i, x in zip(MOMENTS, w, strict=True)]
    slope = [-x for x in cross(w, momentum)]
    return momentum, slope, [s / i for s, i in zip(slope, MOMENTS, strict=True)]


def epsilon(i, j, k):
    return (j - i) * (k - i) * (k - j) // 2


OMEGA = [mpf("0.9"), mpf("-1.4"), mpf("0.6")]


def test_square_of_the_angular_momentum():
    """3.3 is the slope of L_i L_i. Of the printed 3.2, 2 L_i L_i, it would be half the slope."""
    momentum = [i * x for i, x in zip(MOMENTS, OMEGA, strict=True)]
    slope = [mpf("0.2"), mpf("1.1"), mpf("-0.3")]  # any L', so that nothing is zero

    def square(t):
        return sum((p + t * s) ** 2 for p, s in zip(momentum, slope, strict=True))

    assert abs(mpmath.diff(square, 0) - 2 * dot(momentum, slope)) < mpf("1e-30")
    assert abs(mpmath.diff(lambda t: 2 * square(t), 0) - 4 * dot(momentum, slope)) < mpf("1e-30")
    assert abs(dot(momentum, slope)) > 1


def test_indices_of_eulers_equation():
    """3.4 with w_j keeps L^2 and T. As printed, with w_i, it is another equation and keeps neither."""
    momentum, slope, speed = free_slopes(OMEGA)
    right = [-sum(epsilon(i, j, k) * OMEGA[j] * momentum[k] for j in range(3) for k in range(3)) for i in range(3)]
    assert right == slope
    assert abs(dot(momentum, slope)) < mpf("1e-35")  # 3.5: L^2' / 2
    assert abs(dot(OMEGA, slope)) < mpf("1e-35")  # 3.7: T'
    assert abs(dot(OMEGA, [i * s for i, s in zip(MOMENTS, speed, strict=True)])) < mpf("1e-35")  # 3.6

    printed = [-sum(epsilon(i, j, k) * OMEGA[i] * momentum[k] for j in range(3) for k in range(3)) for i in range(3)]
    assert abs(dot(momentum, printed)) > 1 and abs(dot(OMEGA, printed)) > 1


# ---- problem 4: angles of the free symmetric body


def test_angular_velocity_as_printed_a_second_time():
    """4.7 has cos(psi) where 1.2 has sin(psi): wrong as soon as theta moves."""
    (_, th, ps), (dph, dth, _) = angles_at(T), speeds_at(T)
    printed = dph * mpmath.sin(th) * mpmath.cos(ps) - dth * mpmath.cos(ps)
    assert abs(printed - omega_at(T)[1]) > mpf("0.1")
    assert rates((0, th, ps), (dph, 0, 0))[1] == dph * mpmath.sin(th) * mpmath.cos(ps), "no harm where theta' = 0"


def symmetric_body():
    """S3: moments I_x = I_y, I_z, amplitude A and w_z of the rates (A sin(at+b), A cos(at+b), w_z)."""
    return mpf(0.4), mpf(0.2), mpf(0.5), mpf(4)


def test_angles_of_the_free_symmetric_body():
    """phi = (L/I_x) t + C, theta constant, psi = (I_x - I_z)/I_x w_z t + b: put into 1.2 they give the rates."""
    i_x, i_z, amplitude, w_z = symmetric_body()
    size = mpmath.hypot(i_x * amplitude, i_z * w_z)
    th, a, b = mpmath.acos(i_z * w_z / size), (i_x - i_z) / i_x * w_z, mpf("0.8")
    for t in (mpf(0), mpf("0.37"), mpf(11)):
        found = rates([0, th, a * t + b], [size / i_x, 0, a])
        exact = [amplitude * mpmath.sin(a * t + b), amplitude * mpmath.cos(a * t + b), w_z]
        assert max(abs(x - y) for x, y in zip(found, exact, strict=True)) < mpf("1e-35")
    for same in (amplitude / mpmath.sin(th), i_z * w_z / (i_x * mpmath.cos(th))):  # 4.9, and 4.12 with its t
        assert abs(same - size / i_x) < mpf("1e-35")
    assert abs(size - i_z * w_z / mpmath.cos(th)) < mpf("1e-35")  # 4.11
    assert abs(amplitude - i_z / i_x * mpmath.tan(th) * w_z) < mpf("1e-35")


def test_precession_is_not_what_is_printed():
    """Against the stored truth of S3: L/I_x turns right for 1000 s, 4.10 and 4.12 do not."""
    i_x, i_z, amplitude, w_z = symmetric_body()
    size = mpmath.hypot(i_x * amplitude, i_z * w_z)
    sine = i_x * amplitude / size
    with np.load(SCENES / "reference" / "S3.npz") as stored:
        times, attitude = stored["t"], stored["attitude"]
    # The body's axis goes round the fixed L with phi. L starts in the x-z plane of space: w = (A, 0, w_z) at t = 0.
    momentum = [i_x * amplitude / size, mpf(0), i_z * w_z / size]
    aside = cross(momentum, [0, 1, 0])  # in the plane of L and the body's axis at t = 0, square to L

    def precession(q):
        x, y, z, w = (mpf(c) for c in q)
        axis = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
        return mpmath.atan2(-axis[1], dot(axis, aside)), dot(axis, momentum)

    def off(angle, t, rate):
        return abs(mpmath.sin((angle - begin - rate * mpf(t)) / 2))

    begin = precession(attitude[0])[0]
    printed = i_x * amplitude / sine  # 4.10
    for t, q in zip(times[1::50], attitude[1::50], strict=True):
        angle, cosine = precession(q)
        assert abs(cosine - i_z * w_z / size) < 1e-15  # theta stays
        assert off(angle, t, size / i_x) < 2e-15
    angles = [precession(q)[0] for q in attitude[1::50]]
    assert max(off(angle, t, printed) for angle, t in zip(angles, times[1::50], strict=True)) > 0.9
    assert max(off(angle, t, 0) for angle, t in zip(angles, times[1::50], strict=True)) > 0.9  # 4.12: no t at all


def test_the_librarys_free_body_has_these_angles():
    """Precession L/I_x and spin (I_x - I_z)/I_x w_z about L, from the library's closed form."""
    i_x, i_z, amplitude, w_z = (float(x) for x in symmetric_body())
    body = ph.FreeMotion([i_x, i_x, i_z], [amplitude * np.sin(0.8), amplitude * np.cos(0.8), w_z])
    times = np.linspace(0, 1000, 101)
    angles = body.euler_angles(times)
    size = np.hypot(i_x * amplitude, i_z * w_z)

    def turns(found, rate):
        return np.abs(np.sin((found - found[0] - rate * times) / 2)).max()

    np.testing.assert_allclose(angles[:, 1], np.arccos(i_z * w_z / size), rtol=4e-15)
    assert turns(angles[:, 0], size / i_x) < 2e-12  # the float64 rates here are good to 1e-16 of 2000 rad
    assert turns(angles[:, 2], (i_x - i_z) / i_x * w_z) < 2e-12
    assert abs(np.sin((angles[0, 2] - 0.8) / 2)) < 1e-15
    assert turns(angles[:, 0], size) > 0.9  # 4.10: L instead of L/I_x


@pytest.mark.parametrize("name", ["S1", "S2", "S3"])
def test_the_librarys_free_body_keeps_both(name):
    """Problem 3 on the closed form: L^2 and T to rounding at every sample of the scene."""
    with np.load(SCENES / "reference" / f"{name}.npz") as stored:
        times, start = stored["t"], stored["omega"][0]
    moments = np.array(tomllib.loads((SCENES / f"{name}.toml").read_text())["body"]["moments"])
    omega, _ = ph.FreeMotion(moments, start).at(times)
    square, energy = np.sum((moments * omega) ** 2, axis=1), np.sum(moments * omega**2, axis=1) / 2
    np.testing.assert_allclose(square, square[0], rtol=8e-15)
    np.testing.assert_allclose(energy, energy[0], rtol=8e-15)


# ---- the library's rates


def test_the_librarys_rates_are_the_textbooks():
    """1.2 and its inverse, and the textbook's A = R_WB^T."""
    angles, speeds = [0.4, 1.1, -2.3], [0.9, -0.5, 1.7]
    exact = [float(w) for w in rates(angles, speeds)]
    np.testing.assert_allclose(ph.body_rates("ZXZ", angles, speeds), exact, atol=5e-16)
    np.testing.assert_allclose(ph.euler_rates("ZXZ", angles, exact), speeds, atol=2e-15)
    textbook = np.array(space_to_body(angles).tolist(), dtype=float)
    np.testing.assert_allclose(ph.Rotation.from_euler("ZXZ", angles).as_matrix().T, textbook, atol=4e-16)
