"""Diagnosis: known faults found and named, valid bodies left alone, and the vectorised checks."""

import collections

import numpy as np
import pytest
from corruptions import KNOWN
from links import Link, numbers

import polhode as ph
from polhode.inertia import Flaw, check, diagnose, evidence

BLOCK = np.diag((0.20, 0.40, 0.52))


def body(name, seed):
    """A random link's numbers after a known corruption, and how its geometry is told."""
    rng = np.random.default_rng([seed, 7])
    link = Link(rng)
    mass, com, matrix = numbers(link.props, 5)
    return KNOWN[name][1](rng, float(mass), com, matrix), (float(mass), com, matrix), link


def told(link):
    return {"geometry": link.props, "extents": link.extents, "volume": link.volume}


def named(name, count, geometry, shift=0):
    """How often each cause was named, and among the data that are off by 2 % of the largest entry."""
    tally = collections.Counter()
    for seed in range(shift, shift + count):
        wrong, right, link = body(name, seed)
        if np.abs(wrong[2] / wrong[0] - right[2] / right[0]).max() < 0.02 * np.abs(right[2] / right[0]).max() and \
                np.array_equal(wrong[1], right[1]):
            tally["cannot show"] += 1
            continue
        found = diagnose(*wrong, **(told(link) if geometry else {}))
        tally[found.findings[0].cause if found.findings else "fine"] += 1
    return tally


def false_alarms(seeds):
    """Diagnoses of valid bodies, even and uneven, rounded or not, told with more or less of their geometry."""
    for seed in seeds:
        rng = np.random.default_rng(seed)
        link = Link(rng, aligned=rng.integers(3) == 0)
        props = (link.props, link.uneven(rng), link.uneven(rng, 0.05), link.uneven(rng, 0.95))[rng.integers(4)]
        mass, com, matrix = numbers(props, (None, 4, 6)[rng.integers(3)])
        for given, known in (((matrix,), {}), ((mass, com, matrix), {}), ((matrix,), {"geometry": link.props}),
                             ((mass, com, matrix), {"geometry": link.props}), ((mass, com, matrix), told(link))):
            found = diagnose(*given, **known)
            if not found.fine:
                yield seed, sorted(known), found.verdict


def test_valid_bodies_are_fine():
    assert not list(false_alarms(range(150)))


@pytest.mark.long
def test_no_valid_body_of_ten_thousand_is_accused():
    assert not list(false_alarms(range(10_000)))


@pytest.mark.parametrize("name", KNOWN)
def test_known_faults_are_named_with_geometry(name):
    tally = named(name, 12, geometry=True)
    assert tally[KNOWN[name][0]] == 12 - tally["cannot show"] > 0


@pytest.mark.long
@pytest.mark.parametrize("name", KNOWN)
def test_known_faults_of_a_thousand_are_named_with_geometry(name):
    tally = named(name, 1000, geometry=True)
    print(name, dict(tally))
    assert tally[KNOWN[name][0]] >= 0.95 * (1000 - tally["cannot show"]) > 500


SHOWN_ALONE = {   # by the numbers alone, of those that are found to be wrong at all
    "products with the other sign": 0.2, "URDF's order read as MuJoCo's": 0.95, "MuJoCo's order read as URDF's": 0.95,
    "parallel-axis term taken off twice": 0.7, "mass in g": 0.95, "tensor in kg mm^2": 0.95,
    "divided by 1e6 once too often": 0.95, "a decimal point in one entry": 0.6,
}


@pytest.mark.long
@pytest.mark.parametrize("name", SHOWN_ALONE)
def test_known_faults_of_a_thousand_are_named_without_geometry(name):
    tally = named(name, 1000, geometry=False)
    seen = 1000 - tally["cannot show"] - tally["fine"]
    print(name, dict(tally), seen / (1000 - tally["cannot show"]))
    assert tally[KNOWN[name][0]] >= 0.95 * seen
    assert seen >= SHOWN_ALONE[name] * (1000 - tally["cannot show"])


@pytest.mark.parametrize("name", KNOWN)
def test_the_repair_is_the_body_as_it_was(name):
    wrong, right, link = body(name, 3)
    (finding, *_) = diagnose(*wrong, **told(link)).findings
    np.testing.assert_allclose(finding.matrix / finding.mass, right[2] / right[0], rtol=1e-3,
                               atol=2e-4 * np.abs(right[2] / right[0]).max())
    np.testing.assert_allclose(finding.com, right[1], rtol=1e-3, atol=1e-12)


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
def test_a_tensor_alone_is_judged_alike_at_every_scale(scale):
    assert diagnose(BLOCK * scale).margin == pytest.approx(0.08 / 0.52)
    found = diagnose(np.diag((0.2, 0.4, 5.2)) * scale)
    (finding,) = found.findings
    assert (finding.what, finding.cause, finding.impossible) == ("triangle", "decimal", True)
    assert finding.per_cent == pytest.approx(100 * 4.6 / 5.2)
    np.testing.assert_allclose(finding.matrix, BLOCK * scale, rtol=1e-14)
    assert "about z" in finding.text and "izz" in finding.advice


@pytest.mark.parametrize("factor", [10.0, 0.1, 100.0, 0.01, 1000.0, 0.001])
def test_a_shifted_decimal_point_is_put_back(factor):
    """By one to three places."""
    wrong = np.diag((0.2, 0.5, 0.6 * factor))
    finding = next(f for f in diagnose(wrong).findings if f.cause == "decimal")
    np.testing.assert_allclose(finding.matrix, np.diag((0.2, 0.5, 0.6)), rtol=1e-12)


def test_what_is_broken_is_said_by_how_much():
    negative = diagnose(np.diag((-0.2, 0.4, 0.52)))
    assert negative.findings[0].what == "positive" and negative.findings[0].per_cent == pytest.approx(100 * 0.2 / 0.52)
    flat = diagnose(np.diag((0.3, 0.4, 0.7001)))
    assert flat.findings[0].cause == "rounding" and flat.findings[0].per_cent == pytest.approx(100 * 1e-4 / 0.7001)
    assert ph.InertiaTensor(flat.findings[0].matrix)
    assert diagnose(np.diag((0.2, np.nan, 0.5))).findings[0].what == "finite"
    assert diagnose(-1.0, (0, 0, 0), BLOCK).findings[0].what == "mass"
    assert diagnose(1.0, (0, 0, 0), np.zeros((3, 3))).findings[0].cause == "placeholder"
    assert diagnose(2.0, (0, 0, 0), np.eye(3), extents=[(-0.1,) * 3, (0.1,) * 3]).findings[0].what == "extent"


@pytest.mark.parametrize("change, cause", [((0, 1, 0.0), "triangle of zeros"), ((0, 1, 0.05), "sign"),
                                           ((0, 1, -0.5), "decimal"), ((0, 1, -0.07), "unknown"),
                                           ((0, 1, -0.050001), "rounding")])
def test_what_is_not_symmetric(change, cause):
    matrix = np.array([[0.2, -0.05, 0], [-0.05, 0.4, 0], [0, 0, 0.5]])
    wrong = matrix.copy()
    wrong[change[:2]] = change[2]
    (finding,) = diagnose(wrong).findings
    assert (finding.what, finding.cause) == ("symmetric", cause)
    assert np.array_equal(finding.matrix, finding.matrix.T)
    if cause in ("triangle of zeros", "decimal"):
        np.testing.assert_array_equal(finding.matrix, matrix)


def test_the_bound_of_the_extents_is_reached_by_no_body_within():
    """Two equal masses at the ends of a line: the most that its extent allows (BhatiaDavis2000)."""
    box = [(-0.5, -0.1, -0.1), (0.5, 0.1, 0.1)]
    ends = ph.MassProperties.from_points([1, 1, 0.01, 0.01], [(-0.5, 0, 0), (0.5, 0, 0), (0, 0.1, 0), (0, 0, 0.1)])
    assert diagnose(ends, extents=box).fine
    longer = ph.MassProperties(ends.mass, ends.com, ends.inertia.matrix * 1.3)
    assert diagnose(longer, extents=box).findings[0].what == "extent"


def test_a_point_of_reference_may_be_told():
    block = ph.shapes.box(12.0, (0.1, 0.2, 0.3)).moved(translation=(1.0, 0, 0))
    origin = block.about((0, 0, 0)).matrix
    assert diagnose(block.mass, block.com, origin, about=(0, 0, 0)).fine
    missing = diagnose(block.mass, block.com, block.inertia.matrix, about=(0, 0, 0))
    assert missing.findings[0].cause == "point"
    np.testing.assert_allclose(missing.findings[0].matrix, block.inertia.matrix, rtol=1e-12)


def test_axes_are_told_in_their_order():
    """x, y, z taken round in a ring, in tensor and centre: what was along y stands where x should be."""
    link = Link(np.random.default_rng(5))
    ring = np.eye(3)[[1, 2, 0]]
    (finding,) = diagnose(link.props.mass, ring @ link.props.com, ring @ link.props.inertia.matrix @ ring.T,
                          geometry=link.props).findings
    assert finding.cause == "axes" and "x, y, z should be z, x, y, in tensor and centre" in finding.advice
    np.testing.assert_allclose(finding.matrix, link.props.inertia.matrix, rtol=1e-12)
    np.testing.assert_allclose(finding.com, link.props.com, rtol=1e-12)


def test_what_is_given_is_asked_for():
    for wrong in (lambda: diagnose(), lambda: diagnose(1.0, BLOCK), lambda: diagnose(np.eye(2)),
                  lambda: diagnose("heavy", (0, 0, 0), BLOCK), lambda: diagnose(BLOCK, geometry=BLOCK),
                  lambda: diagnose(BLOCK, extents=[(1, 1, 1), (0, 0, 0)]), lambda: diagnose(BLOCK, about=(0, 0, 0)),
                  lambda: diagnose(BLOCK, volume=-1), lambda: diagnose(np.inf, (0, 0, 0), BLOCK)):
        with pytest.raises(ph.InvalidInput):
            wrong()


def test_check_agrees_with_the_door():
    rng = np.random.default_rng(1)
    factor = rng.normal(size=(500, 3, 3))
    matrices = factor @ factor.transpose(0, 2, 1) * 10.0 ** rng.uniform(-12, 12, (500, 1, 1))
    matrices = (matrices + matrices.transpose(0, 2, 1)) / 2
    matrices[::7] -= 0.3 * np.trace(matrices[::7], axis1=1, axis2=2)[:, None, None] * np.eye(3)
    matrices[::11, 0, 1] *= 1.01
    margins, flaws = check(matrices)
    assert len({int(f) for f in flaws}) >= 5
    for matrix, margin, flaw in zip(matrices, margins, flaws):
        a, b, c = np.linalg.eigvalsh((matrix + matrix.T) / 2)
        assert margin == pytest.approx((a + b - c) / max(abs(a), abs(c)), abs=1e-13)
        try:
            ph.InertiaTensor(matrix)
            said = ""
        except ph.InvalidInput as error:
            said = str(error)
        expected = Flaw.NOT_SYMMETRIC if "symmetric" in said else Flaw.NOT_POSITIVE if "negative" in said else \
            Flaw.TRIANGLE if "triangle" in said else Flaw(0)
        assert (flaw == 0) == (not said) and expected in Flaw(int(flaw))


def test_check_flags_what_is_not_finite_and_keeps_the_shape():
    stack = np.tile(BLOCK, (2, 5, 1, 1))
    stack[1, 3, 0, 0], stack[0, 2, 1, 1] = np.nan, np.inf
    margins, flaws = check(stack)
    assert margins.shape == flaws.shape == (2, 5)
    assert np.isnan(margins[1, 3]) and flaws[1, 3] == flaws[0, 2] == Flaw.NOT_FINITE and flaws.sum() == 2
    assert check(np.zeros((3, 3))) == (0.0, 0) and check(np.zeros((0, 3, 3)))[0].shape == (0,)
    with pytest.raises(ph.InvalidInput):
        check(np.eye(2))


def test_findings_carry_their_number():
    """Moments k times as large as a mass within the box allows are 100 (k - 1) % too large; density likewise."""
    extents = np.array([[-0.1, -0.2, -0.3], [0.1, 0.2, 0.3]])
    found = diagnose(12.0, (0, 0, 0), np.diag((500.0, 400.0, 300.0)), extents=extents).findings[0]
    factor = float(found.text.split()[1])
    assert found.what == "extent" and found.per_cent == pytest.approx(100 * (factor - 1), rel=2e-3)
    dense, thin = (diagnose(mass, (0, 0, 0), matrix).findings[0] for mass, matrix in (
        (1000.0, np.diag((1e-6, 1e-6, 1.2e-6))), (1e-9, np.diag((1.0, 1.0, 1.2)))))
    assert dense.what == thin.what == "density"
    assert "denser than osmium" in dense.text and "thinner than air" in thin.text


def test_products_at_the_level_of_rounding_say_nothing():
    """A diagonal tensor whose products are rounding agrees with a diagonal reference by chance in no number."""
    geometry = evidence.Geometry((), None, None, 0.0)
    mass = np.array([1.0])
    clean, rounded, full = (np.diag((1.0, 2.0, 2.5)) + part * (1 - np.eye(3)) for part in (0.0, 1e-7, 0.1))
    count = [evidence._informative(matrix[None], mass, geometry) for matrix in (clean, rounded, full)]
    assert count == [3.0, 3.0, 6.0]


GRAM, MM, CM, POUND, INCH = 1e-3, 1e-3, 1e-2, 0.45359237, 0.0254
UNITS = {   # the units of mass, tensor and centre in which the numbers were written, in kg, kg m^2 and m
    "g": (GRAM, 1, 1), "t": (1e3, 1, 1), "kg mm^2": (1, MM**2, 1), "kg mm^2, mm": (1, MM**2, MM),
    "g mm^2": (1, GRAM * MM**2, 1), "g mm^2, mm": (1, GRAM * MM**2, MM), "g, g mm^2": (GRAM, GRAM * MM**2, 1),
    "g, g mm^2, mm": (GRAM, GRAM * MM**2, MM), "kg cm^2": (1, CM**2, 1), "kg cm^2, cm": (1, CM**2, CM),
    "g cm^2": (1, GRAM * CM**2, 1), "g cm^2, cm": (1, GRAM * CM**2, CM), "g, g cm^2, cm": (GRAM, GRAM * CM**2, CM),
    "mm": (1, 1, MM), "cm": (1, 1, CM), "lb in^2": (1, POUND * INCH**2, 1),
}
TWICE = {name: tuple(1 / k for k in UNITS[name]) for name in (   # taken for these, but in SI already
    "kg mm^2", "kg mm^2, mm", "g mm^2", "g mm^2, mm", "kg cm^2", "g cm^2", "mm")}


@pytest.mark.parametrize("units", [*UNITS.values(), *TWICE.values()], ids=[*UNITS, *(f"twice {n}" for n in TWICE)])
def test_numbers_in_other_units_are_taken_back(units):
    """Mass and tensor up to one factor: that of the mass and the inverse of the tensor's cannot be told apart."""
    link = Link(np.random.default_rng(5))
    mass, com, matrix = numbers(link.props)
    kilograms, tensor, metres = units
    (finding, *_) = diagnose(mass / kilograms, com / metres, matrix / tensor, geometry=link.props).findings
    assert finding.cause == "units"
    np.testing.assert_allclose(finding.com, com, rtol=1e-9)
    np.testing.assert_allclose(finding.matrix / finding.mass, matrix / mass, rtol=1e-6)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [1, -1])
def test_mirrored_axes_are_named_and_the_centre_with_them(axis, sign):
    """A mirror turns one component of the centre; or the two others, if the frame was turned right-handed again."""
    link = Link(np.random.default_rng(5))
    mirror = np.diag(np.where(np.arange(3) == axis, -1.0, 1.0))
    mass, com, matrix = numbers(link.props)
    (finding,) = diagnose(mass, sign * mirror @ com, mirror @ matrix @ mirror, geometry=link.props).findings
    assert finding.advice.startswith(f"mirrored or left-handed axes: {'xyz'[axis]} points the other way")
    np.testing.assert_allclose(finding.com, com, rtol=1e-12)
    np.testing.assert_allclose(finding.matrix, matrix, rtol=1e-12)


@pytest.mark.parametrize("factor", [0.1, 0.01])
def test_the_mass_that_is_advised_is_the_mass_that_is_given_back(factor):
    link = Link(np.random.default_rng(5))
    mass, com, matrix = numbers(link.props)
    (finding,) = diagnose(mass * factor, com, matrix, geometry=link.props).findings
    assert finding.cause == "decimal" and finding.mass == pytest.approx(mass)
    assert f"{mass:.6g} instead of {mass * factor:.6g} kg" in finding.advice


def test_two_faults_at_once_are_both_told():
    """A decimal point, which no body can have, in a tensor that is in g m^2 besides."""
    box = ph.shapes.box(12.0, (0.1, 0.2, 0.3))
    wrong = 1e3 * box.inertia.matrix
    wrong[0, 0] *= 10
    first, second = diagnose(box.mass, box.com, wrong, geometry=box).findings
    assert (first.what, first.cause, second.what, second.cause) == ("triangle", "decimal", "size", "units")
    np.testing.assert_allclose(first.matrix, 1e3 * box.inertia.matrix)
    np.testing.assert_allclose(second.matrix, box.inertia.matrix)


@pytest.mark.parametrize(("factor", "broken"), [(19.9, False), (20.1, True), (1 / 99, False), (1 / 101, True)])
def test_a_size_is_broken_beyond_twenty_and_below_a_hundredth(factor, broken):
    box = ph.shapes.box(12.0, (0.1, 0.2, 0.3))
    sizes = [f for f in diagnose(box.mass, box.com, factor * box.inertia.matrix, geometry=box).findings
             if f.what == "size"]
    assert bool(sizes) == broken
    for finding in sizes:
        assert finding.per_cent == pytest.approx(100 * abs(factor - 1))


@pytest.mark.parametrize(("limit", "outward"), [(2.0, -1), (40_000.0, 1)])
def test_an_unlikely_density_costs_forty_nats(limit, outward):
    """Of mass over a volume of 1 m^3, just beyond the limit and just within it."""
    geometry = evidence.Geometry((), None, 1.0)

    def score(mass):
        return float(evidence.weigh(evidence.single(mass, np.zeros(3), 0.1 * mass * np.eye(3)), geometry).score[0])

    beyond, within = (score(limit * (1 + side * outward * 1e-9)) for side in (1, -1))
    assert beyond - within == pytest.approx(40.0, abs=1e-6)


def test_what_no_body_can_have_costs_sixty_nats_and_what_its_box_forbids_forty():
    def score(matrix, geometry):
        return float(evidence.weigh(evidence.single(1.0, np.zeros(3), matrix), geometry).score[0])

    flat = [np.diag((1.0, 1.0, 2.0 * (1 + slack))) for slack in (0.9e-3, 1.1e-3)]   # rounding to three digits is let
    assert score(flat[1], evidence.Geometry()) - score(flat[0], evidence.Geometry()) == pytest.approx(60, abs=1e-2)
    box = evidence.Geometry((), np.array([[-1.0] * 3, [1.0] * 3]), None, 0.0)
    ends = [s * np.diag((2.0, 2.0, 2.0)) for s in (1 - 1e-9, 1 + 1e-9)]   # second moments of 1: all mass at the corners
    assert score(ends[1], box) - score(ends[0], box) == pytest.approx(40, abs=1e-6)


def test_two_digits_are_enough_for_most_mirrors():
    """A repair within a hundredth of the geometry gains six times ln 30, twice what a cause needs."""
    mirror = np.diag((-1.0, 1.0, 1.0))
    advice = []
    for seed in range(20):
        link = Link(np.random.default_rng(seed))
        mass, com, matrix = numbers(link.props, 2)
        findings = diagnose(mass, com, mirror @ matrix @ mirror, geometry=link.props).findings
        advice += [finding.advice.partition(":")[0] for finding in findings]
    assert advice.count("mirrored or left-handed axes") >= 10
