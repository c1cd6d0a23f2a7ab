"""Mass properties of meshes: exact fractions, closed forms, published values and trimesh; and what is refused."""

import pickle
import warnings
from fractions import Fraction

import levels
import numpy as np
import pytest
from meshes import TETRAHEDRON_FACES, box, exact, globe, inward, join, soup

import polhode as ph

EPS = 2.0**-53
TURN = ph.Rotation.from_rotvec((0.3, -1.1, 0.7)).as_matrix()


def errors(body, truth, density=1):
    """Relative errors of mass, centre (of the size or its own distance) and inertia (of its largest entry)."""
    volume, centre, inertia = truth
    largest = density * max(abs(x) for row in inertia for x in row)
    size = (largest / (density * volume)) ** 0.5
    mass = abs(Fraction(body.mass) / (density * volume) - 1)
    com = max(abs(Fraction(float(x)) - c) / max(Fraction(size), abs(c)) for x, c in zip(body.com, centre))
    moment = max(abs(Fraction(float(body.inertia.matrix[i, j])) - density * inertia[i][j]) / largest
                 for i in range(3) for j in range(3))
    return float(mass), float(com), float(moment)


def check(mesh, density=1.0, limit=4 * EPS, **options):
    body = ph.MassProperties.from_mesh(*mesh, density=density, **options)
    found = errors(body, exact(*mesh), Fraction(density))
    assert max(found) <= limit, found
    return body


def sliver(thickness):
    """A plate, turned anyhow: what the doubles of its corners say it is."""
    vertices, faces = box((-1, -0.5, -thickness), (1, 0.5, thickness))
    return vertices @ TURN.T, faces


def lollipop():
    """A ball on a long thin stick, one surface: far from the middle of its box."""
    def radius(x, y, z):
        return 1 if z > -0.98 else 40
    return globe(40, 20, radius, TURN)


MESHES = {
    "tetrahedron": (np.array([(0, 0, 0), (3, 0.1, 0), (0.2, 2, 0), (0.3, 0.4, 1)]), TETRAHEDRON_FACES),
    "box": box((-1, -2, -3), (1, 2, 3)),
    "turned box": (box((-1, -2, -3), (1, 2, 3))[0] @ TURN.T, box()[1]),
    "hollow box": join(box(), inward(box((-0.9, -0.8, -0.7), (0.9, 0.8, 0.7)))),
    "thin shell": join(globe(16, 8, turn=TURN), inward(globe(16, 8, lambda *v: 1 - 1e-7, TURN))),
    "two parts": join(box(), box((5, 0, 0), (6, 7, 0.1))),
    "sliver": sliver(1e-7),
    "needle": (box((-1e-6, -1e-6, -1), (1e-6, 1e-6, 1))[0] @ TURN.T, box()[1]),
    "lollipop": lollipop(),
    "potato": globe(32, 24, lambda x, y, z: 1 + 0.3 * x * y + 0.2 * z**3, TURN),
    "tiny": (box((-1, -2, -3), (1, 2, 3))[0] @ TURN.T * 1e-12, box()[1]),
    "huge": (box((-1, -2, -3), (1, 2, 3))[0] @ TURN.T * 1e12, box()[1]),
}


@pytest.mark.filterwarnings("ignore:vertices. the mesh is")
@pytest.mark.parametrize("name", MESHES)
def test_against_exact_fractions(name):
    check(MESHES[name])
    check(MESHES[name], density=2700.0)


FAR = [(name, offset) for name in MESHES for offset in (1.0, 1e3, 1e6)
       if name != "huge" and (offset == 1 or name not in ("sliver", "needle",
                                                          "thin shell"))]   # rounded away further out


@pytest.mark.filterwarnings("ignore:vertices. the mesh is")
@pytest.mark.parametrize("name, offset", FAR)
def test_far_from_the_origin(name, offset):
    """The vertices are moved, and rounded there: what they are then is the input."""
    vertices, faces = MESHES[name]
    extent = np.ptp(vertices, axis=0).max()
    moved = vertices + offset * extent * np.array([1, -0.7, 0.3])
    check((moved, faces))


@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_many_faces_in_plain_numbers_are_as_exact(offset):
    vertices, faces = globe(60, 30, lambda x, y, z: 1 + 0.3 * x * y + 0.2 * z**3, TURN)
    mesh = vertices + offset, faces
    assert ph._core.mesh_is_refined(*mesh) is False
    check(mesh)


def test_many_faces_that_need_more():
    flat, faces = globe(60, 30, lambda *v: 1.0)
    flat = flat * (1, 1, 1e-8) @ TURN.T
    assert ph._core.mesh_is_refined(flat, faces) is True
    check((flat, faces))


def test_closed_forms():
    for body, mesh in ((ph.shapes.box(48, (1, 2, 3)), MESHES["box"]),
                       (ph.shapes.tetrahedron(1, MESHES["tetrahedron"][0]), MESHES["tetrahedron"])):
        found = ph.MassProperties.from_mesh(*mesh, mass=body.mass)
        assert found.mass == body.mass
        np.testing.assert_allclose(found.com, body.com, rtol=0, atol=1e-16)
        np.testing.assert_allclose(found.inertia.matrix, body.inertia.matrix, rtol=0,
                                   atol=4e-16 * body.inertia.moments[2])


def test_tonons_tetrahedron():
    """F. Tonon, J. Math. Stat. 1 (2004) 8, density 1: printed with the rounding of its own computation, about 1e-8."""
    corners = [(8.33220, -11.86875, 0.93355), (0.75523, 5.0, 16.37072), (52.61236, 5.0, -5.38580), (2.0, 5.0, 3.0)]
    body = ph.MassProperties.from_mesh(corners, TETRAHEDRON_FACES, density=1)
    np.testing.assert_allclose(body.com, (15.92492, 0.78281, 3.72962), atol=3e-5)
    a, b, c = 43520.33257, 194711.28938, 191168.76173  # moments
    yz, xz, xy = 4417.66150, -46343.16662, 11996.20119  # products, without the tensor's minus sign
    np.testing.assert_allclose(body.inertia.matrix, [(a, -xy, -xz), (-xy, b, -yz), (-xz, -yz, c)], rtol=3e-8)


# ---- what is refused, and what is forgiven


def refusal(*mesh, **options):
    with pytest.raises(ph.InvalidInput) as refused:
        ph.MassProperties.from_mesh(*mesh, **{"density": 1.0, **options})
    return str(refused.value)


def test_what_is_no_closed_surface():
    vertices, faces = box()
    text = refusal(vertices, faces[:-1])
    assert text.startswith("faces: must be a closed surface") and "3 open edges (first faces 3, 7, 10)" in text
    turned = faces.copy()
    turned[4] = turned[4, ::-1]
    assert "3 edges between faces wound against each other (first faces 0, 4, " in refusal(vertices, turned)
    text = refusal(vertices, np.concatenate([faces, faces]))
    assert "18 edges shared by more than two faces" in text and "12 faces given again (a part given twice?)" in text
    touching = join(box(), box((1, 1, -1), (2, 2, 1)))
    assert ph.MassProperties.from_mesh(*touching, density=1).mass == 10
    assert "1 edges shared by more than two faces" in refusal(*soup(touching))
    assert ph.MassProperties.from_mesh(*soup(touching), density=1, check=False).mass == 10


def test_inside_out():
    vertices, faces = inward(box())
    for check in (True, False):
        text = refusal(vertices, faces, check=check)
        assert text.startswith("faces: must be round a positive volume, got -8") and 'repair="flip"' in text
    assert np.all(ph.MassProperties.from_mesh(*box(), density=1).com == 0)
    with pytest.warns(UserWarning, match="turned over"):
        body = ph.MassProperties.from_mesh(vertices, faces, density=1, repair="flip")
    assert body == ph.MassProperties.from_mesh(*box(), density=1) \
        == ph.MassProperties.from_mesh(*box(), density=1, repair="flip")
    hollow = join(box(), inward(box((-0.5,) * 3, (0.5,) * 3)))
    with pytest.warns(UserWarning, match="turned over"):
        assert ph.MassProperties.from_mesh(*inward(hollow), density=1, repair="flip").mass == 7


def test_a_part_that_is_turned_is_no_cavity():
    aside = join(box(), inward(box((2, 2, 2), (2.5, 2.5, 2.5))))
    assert "a surface of 12 faces (first face 12) that is wound inward and lies inside no other" in refusal(*aside)
    assert ph.MassProperties.from_mesh(*aside, density=1, check=False).mass == 7.875


def test_equal_vertices_count_as_one_and_faces_that_are_edges_as_nothing():
    body = ph.MassProperties.from_mesh(*box(), density=1)
    assert ph.MassProperties.from_mesh(*soup(box()), density=1) == body
    vertices, faces = box()
    again = np.concatenate([vertices, vertices[:1] * (1, 1, 1)])
    split = faces.copy()
    split[0, 0] = 8
    assert ph.MassProperties.from_mesh(again, split, density=1) == body
    assert ph.mesh.report(again, split)["merged"] and not ph.mesh.report(vertices, faces)["merged"]
    more = np.concatenate([faces, [(3, 3, 3), (0, 1, 1)]])
    assert ph.MassProperties.from_mesh(vertices, more, density=1) == body
    assert ph.mesh.report(vertices, more)["degenerate"] == 2


def test_zero_has_one_place():
    vertices, faces = soup(box((0, 0, 0), (1, 1, 1)))
    vertices[::2] += 0.0
    vertices[1::2][vertices[1::2] == 0] = -0.0
    assert ph.MassProperties.from_mesh(vertices, faces, density=1).mass == 1


def test_report():
    hollow = join(box(), inward(box((-0.5,) * 3, (0.5,) * 3)), box((3, 3, 3), (4, 5, 6)))
    found = ph.mesh.report(*hollow)
    assert (found["faces"], found["components"], found["cavities"]) == (36, 3, 1)
    assert list(found["low"]) == [-1, -1, -1] and list(found["high"]) == [4, 5, 6]
    assert ph.mesh.report(*inward(hollow))["inside_out"] and not found["inside_out"]


BOX = box()


@pytest.mark.parametrize("change, words", [
    ({"density": 0}, ["density: must be positive and finite, got 0"]),
    ({"density": np.nan}, ["density: must be finite"]),
    ({"density": None}, ["density: must be given, or else the mass, got neither"]),
    ({"mass": 1.0}, ["density: must be given, or else the mass, got both"]),
    ({"density": None, "mass": -1}, ["mass: must be positive"]),
    ({"unit": "yard"}, ["unit: must be a length in metres, or one of m, "]),
    ({"unit": 0}, ["unit: must be positive"]),
    ({"repair": "fill"}, ['repair: must be "flip" or None']),
    ({"faces": np.zeros((0, 3), int)}, ["faces: must be one triangle or more, got none"]),
    ({"faces": []}, ["faces: must be one triangle or more, got none"]),
    ({"faces": BOX[1] + 1}, ["faces: must be numbers of vertices, from 0 to below 8, got 8 in face 3 (counted from "
                             "1?)"]),
    ({"faces": (BOX[1] - 1).astype(np.int32)}, ["got -1 in face 0"]),
    ({"faces": BOX[1].astype(float)}, ["faces: must be an array of whole numbers"]),
    ({"faces": np.zeros((2, 4), int)}, ["faces: must be of shape (n, 3)", "quadrilaterals"]),
    ({"faces": "x"}, ["faces: must be an array of whole numbers"]),
    ({"vertices": np.zeros((8, 2))}, ["vertices: must be an array of shape (..., 3)"]),
    ({"vertices": np.zeros((2, 4, 3))}, ["vertices: must be of shape (n, 3)"]),
    ({"vertices": np.where(BOX[0] == BOX[0][5], np.nan, BOX[0])}, ["vertices: must be finite", "nan"]),
    ({"vertices": np.where(BOX[0] == 1, np.inf, BOX[0])}, ["vertices: must be finite", "inf"]),
    ({"vertices": BOX[0] * (1, 1, 0)}, ["faces: must be round a positive volume, got a surface that encloses none"]),
    ({"vertices": BOX[0] * 1e-60}, ["vertices: must be of a mesh between 1e-45 and 1e45"]),
    ({"vertices": BOX[0] * 1e60}, ["vertices: must be of a mesh between 1e-45 and 1e45"]),
])
@pytest.mark.parametrize("check", [True, False])
def test_bad_input_names_the_argument(change, words, check):
    given = {"vertices": BOX[0], "faces": BOX[1], "density": 1.0, "check": check, **change}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        text = refusal(given.pop("vertices"), given.pop("faces"), **given)
    for word in words:
        assert word in text
    assert "\n" not in text


@pytest.mark.parametrize("unit, metres", [("m", 1), ("mm", Fraction(1, 1000)), ("in", Fraction(254, 10000)),
                                          (0.001, Fraction(1, 1000)),
                                          ("ft", Fraction(3048, 10000)), (0.37, Fraction(0.37))])
def test_units(unit, metres):
    vertices, faces = MESHES["potato"]
    body = ph.MassProperties.from_mesh(vertices, faces, density=2700, unit=unit)
    volume, centre, inertia = exact(vertices, faces)
    truth = volume * metres**3, [c * metres for c in centre], [[x * metres**5 for x in row] for row in inertia]
    assert max(errors(body, truth, 2700)) <= 4 * EPS


@pytest.mark.parametrize("size, unit", [(1001, "m"), (5, "km"), (0.9e-6, "m"), (0.0009, "mm")])
def test_sizes_that_are_asked_about(size, unit):
    with pytest.warns(UserWarning, match="m long: is that meant?"):
        ph.MassProperties.from_mesh(BOX[0] * size, BOX[1], density=1, unit=unit)


# ---- the same bits


def test_types_of_index_and_layouts_do_not_matter():
    vertices, faces = MESHES["potato"]
    body = ph.MassProperties.from_mesh(vertices, faces, density=1)
    for dtype in (np.int32, np.uint32, np.uint64, np.int16):
        assert ph.MassProperties.from_mesh(vertices, faces.astype(dtype), density=1) == body
    assert ph.MassProperties.from_mesh(np.asfortranarray(vertices), faces.tolist(), density=1) == body
    assert pickle.loads(pickle.dumps(body)) == body


def test_every_instruction_set():
    """avx2 and avx512 to the bit, the baseline within the error stated."""
    program = (
        "import numpy as np, polhode as ph; from meshes import globe\n"
        "for n in (24, 80):\n"
        "    v, f = globe(n, n // 2, lambda x, y, z: 1 + 0.3 * x * y + 0.2 * z**3)\n"
        "    b = ph.MassProperties.from_mesh(v + 5, f[:-3], density=1, check=False)\n"
        "    print(*[float(x).hex() for x in (b.mass, *b.com, *b.inertia.matrix.ravel())])\n")
    found = levels.outputs(program, levels.LEVELS)
    assert found["avx2"] == found["avx512"]
    values = {level: np.array([float.fromhex(x) for x in text.decode().split()]) for level, text in found.items()}
    np.testing.assert_allclose(values["baseline"], values["avx2"], rtol=0, atol=4e-16 * 5)


# ---- surfaces inside each other


def shells(*signs):
    """Boxes inside each other, wound outward or inward."""
    return join(*((box if sign > 0 else lambda *b: inward(box(*b)))((-1 / n,) * 3, (1 / n,) * 3)
                  for n, sign in enumerate(signs, 1)))


def test_a_cavity_wound_the_wrong_way_is_warned_of():
    with pytest.warns(UserWarning, match="1 surfaces inside a solid are wound outward .*cavities wound the wrong way"):
        assert ph.MassProperties.from_mesh(*shells(1, 1), density=1).mass == 9
    assert ph.mesh.report(*shells(1, 1, 1))["embedded"] == 2
    assert ph.mesh.report(*inward(shells(1, 1)))["embedded"] == 1


def test_too_many_surfaces_to_compare_are_told():
    vertices, faces = box((0, 0, 0), (1, 1, 1))
    count = 10_000
    places = np.stack([2.0 * np.arange(count), np.zeros(count), np.zeros(count)], 1)
    many = ((vertices + places[:, None]).reshape(-1, 3), (faces + 8 * np.arange(count)[:, None, None]).reshape(-1, 3))
    found = ph.mesh.report(*many)
    assert found["components"] == count and 0 < found["unjudged"] < count and found["embedded"] == 0
    with pytest.warns(UserWarning) as caught:
        assert ph.MassProperties.from_mesh(*many, density=1).mass == count
    assert any("were not asked whether" in str(one.message) for one in caught)
    last = many[1].copy()
    last[-12:] = last[-12:, ::-1]   # one turned over is found all the same
    assert "lies inside no other" in refusal(many[0], last)


def test_solids_in_cavities_and_side_by_side_are_fine():
    found = ph.mesh.report(*shells(1, -1, 1, -1))
    assert (found["components"], found["cavities"], found["embedded"]) == (4, 2, 0)
    beside = join(box(), box((1, -1, -1), (2, 1, 1)), box((3, 0, 0), (4, 1, 1)))   # touching faces, and apart
    assert ph.mesh.report(*beside)["embedded"] == 0
    ring = join(box(), inward(box((-0.5,) * 3, (0.5,) * 3)), box((-0.25,) * 3, (0.25,) * 3))
    assert ph.mesh.report(*ring)["embedded"] == 0


def test_a_shell_in_the_box_of_another_is_not_yet_inside_it():
    """An inward cube in the notch of an L: within the box, outside the body."""
    outline = np.array([(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)], float)
    vertices = np.concatenate([np.column_stack([outline, np.full(6, z)]) for z in (0, 1)])
    caps = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)])
    sides = [(i, j, k) for i in range(6) for j, k in (((i + 1) % 6, (i + 1) % 6 + 6), ((i + 1) % 6 + 6, i + 6))]
    angle = vertices, np.concatenate([caps[:, ::-1], caps + 6, sides])
    assert ph.MassProperties.from_mesh(*angle, density=1).mass == 5
    outside = join(angle, inward(box((1.5, 1.5, 0.25), (2.5, 2.5, 0.75))))
    assert "lies inside no other" in refusal(*outside)
    inside = join(angle, inward(box((0.25, 1.5, 0.25), (0.75, 2.5, 0.75))))
    assert ph.MassProperties.from_mesh(*inside, density=1).mass == 4.75
