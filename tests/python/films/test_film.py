"""Films: the solid has the inertia of the scene, the frames are those of the motion, and the page turns the body."""

import base64
import io
import json
import re
import shutil

import numpy as np
import pytest

import polhode as ph
from polhode._plot.film import writer
from polhode._plot.film.film import MOST
from polhode._plot.film.solid import choose_axis, find_arm, make_solid, sphere

pytest.importorskip("matplotlib")
import browser  # noqa: E402  tests/support

BLOCK = (0.20, 0.40, 0.52)
TILTED = ph.Rotation.from_euler("ZXZ", (0.3, 0.5, 0.1))
RACKET = ph.FreeMotion(BLOCK, (1e-3, 5, 1e-3))
TOP = ph.HeavyTop((1, 1, 0.5), 2.0, (0.1, 0, 6), TILTED)


def scene(inertia, **changes):
    return ph.Scene(inertia=inertia, omega=(1, 2, 3), times=np.linspace(0, 4, 9), **changes)


def inertia_of(solid):
    """The tensor of the solid's triangles as a uniform body of mass 1, about the origin."""
    corners = solid.corners.reshape(-1, 3).round(12)   # equal corners have equal bits
    body = ph.MassProperties.from_mesh(corners, np.arange(len(corners)).reshape(-1, 3), mass=1.0)
    return body.about((0, 0, 0)).matrix


@pytest.mark.parametrize("inertia", [
    BLOCK, (0.52, 0.20, 0.40), (1.0, 1.0, 1.0),
    ph.InertiaTensor([[2.0, 0.25, 0.1], [0.25, 1.8, 0], [0.1, 0, 2.5]]),
])
@pytest.mark.parametrize(("body", "close"), [("box", 1e-12), ("ellipsoid", 0.02)])
@pytest.mark.parametrize("arm", [None, (0.1, 0.2, -0.4)])
def test_the_solid_has_the_inertia_of_the_scene(inertia, body, close, arm):
    torques = [] if arm is None else [ph.torques.Gravity(3.0, arm)]
    given = scene(inertia, torques=torques)
    found, wanted = inertia_of(make_solid(given, body)), given.inertia.matrix
    np.testing.assert_allclose(found / np.trace(found), wanted / np.trace(wanted), atol=close)
    solid = make_solid(given, body)
    assert np.isclose(np.linalg.norm(solid.corners, axis=2).max(), 1)
    middle = solid.corners.mean(axis=(0, 1))
    if arm is None:
        assert solid.arm is None and np.abs(middle).max() < 0.02
    else:   # the centre of mass lies along the arm
        assert np.allclose(middle / np.linalg.norm(middle), np.array(arm) / np.linalg.norm(arm), atol=0.02)


def test_triangles_face_outward():
    for body in ("box", "ellipsoid"):
        solid = make_solid(scene(BLOCK), body)
        normal = np.cross(solid.corners[:, 1] - solid.corners[:, 0], solid.corners[:, 2] - solid.corners[:, 0])
        assert (np.sum(normal * solid.corners.mean(axis=1), axis=1) > 0).all()
        assert (np.sum(normal * solid.normals[:, 0], axis=1) > 0).all()
    area = np.linalg.norm(np.cross(*(sphere(40)[:, k] - sphere(40)[:, 0] for k in (1, 2))), axis=1).sum() / 2
    assert np.isclose(area, 4 * np.pi, rtol=5e-3)


def test_thin_and_flat_bodies_are_drawn():
    for inertia in ((1e-9, 1.0, 1.0), (1.0, 1.0, 2.0), (0.5, 0.5, 1.0)):
        assert np.isfinite(make_solid(scene(inertia)).corners).all()


def test_a_mesh_is_taken_as_it_is(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    block = trimesh.creation.box((1, 2, 3))
    block.apply_translation((5, 0, 0))
    block.export(tmp_path / "block.stl")
    for body in (block, (block.vertices, block.faces), tmp_path / "block.stl", str(tmp_path / "block.stl")):
        solid = make_solid(scene(BLOCK), body)
        assert np.allclose(np.ptp(solid.corners.reshape(-1, 3), axis=0) * np.sqrt(14) / 2, (1, 2, 3), rtol=1e-6)
        assert np.allclose(solid.corners.reshape(-1, 3).mean(axis=0), 0, atol=1e-6)
    block.faces = block.faces[:-1]   # open: it has no volume, and is drawn about its middle
    corners = make_solid(scene(BLOCK), block).corners.reshape(-1, 3)
    assert np.allclose(corners.min(axis=0), -corners.max(axis=0), atol=1e-6)
    many = np.zeros((60_001, 3), int)
    for wrong, why in (("cube", "cube"), (([[0, 0, 0]], [[0, 0, 7]]), "must be 'box'"), (3, "must be 'box'"),
                       (([[0, 0, 0]], many), "60,000")):
        with pytest.raises(ph.InvalidInput, match=why):
            make_solid(scene(BLOCK), wrong)


def test_the_axis_is_the_arm_or_the_one_nearest_to_omega():
    assert np.allclose(choose_axis(scene(BLOCK), None), (0, 0, 1))
    assert np.allclose(choose_axis(scene(BLOCK).replace(omega=(0.1, -3, 0)), None), (0, -1, 0))
    held = scene(BLOCK, torques=[ph.torques.Gravity(3.0, (0, 0.3, 0.4))])
    assert np.allclose(choose_axis(held, None), (0, 0.6, 0.8)) and np.allclose(find_arm(held), (0, 0.6, 0.8))
    assert np.allclose(choose_axis(held, (2, 0, 0)), (1, 0, 0))
    for wrong in ((0, 0, 0), (1, 2), (np.nan, 0, 0)):
        with pytest.raises(ph.InvalidInput, match="axis"):
            choose_axis(held, wrong)


@pytest.mark.parametrize("form", [RACKET, TOP], ids=["racket", "top"])
def test_the_frames_are_those_of_the_motion(form):
    film = form.animate(6.0)
    omega, attitude = form.at(film.t)
    assert film.t[0] == 0 and film.t[-1] == 6 and len(film.t) <= MOST and np.allclose(np.diff(film.t), film.t[1])
    np.testing.assert_allclose(film.omega, omega, atol=3e-2)
    assert np.abs(np.sum(film.attitude * attitude, axis=1)).min() > 1 - 1e-4
    assert (np.sum(film.attitude[1:] * film.attitude[:-1], axis=1) > 0).all()


def page_of(film):
    return json.loads(re.search(r'id="film">(.*?)</script>', film.to_html(), flags=re.S)[1])


def unpack(text):
    return np.frombuffer(base64.b64decode(text), "<f4")


def test_the_page_holds_the_motion_and_asks_for_nothing():
    film = RACKET.animate(8.0)
    text, content = film.to_html(), page_of(film)
    assert not re.search(r'(src|href)="', text) and "MIT License" in text and "<script type=" in text
    assert np.allclose(unpack(content["attitude"]).reshape(-1, 4), film.attitude, atol=1e-6)
    corners, normals, colours = (unpack(content["solid"][name]).reshape(-1, 3)
                                 for name in ("corners", "normals", "colours"))
    assert corners.shape == normals.shape == colours.shape and (0 <= colours).all() and (colours <= 1).all()
    assert np.array_equal(colours[::3], colours[1::3])   # a triangle has one colour
    semi, path = np.array(content["poinsot"]["semi"]), unpack(content["poinsot"]["path"]).reshape(-1, 3)
    assert np.allclose(((path / semi) ** 2).sum(axis=1), 1, atol=1e-2)   # omega lies on its ellipsoid
    assert len(text) < 900_000
    name = "</script><b>{{ data }}"
    odd = ph.solve(scene(BLOCK, name=name)).animate().to_html()
    assert name not in odd and "&lt;/script&gt;&lt;b&gt;{{ data }}" in odd
    assert "<iframe srcdoc=" in film._repr_html_() and film._repr_html_().count("<") == 2


def test_a_film_has_the_title_that_is_given_and_the_arrow_of_a_constant_momentum():
    film = RACKET.animate(6.0, title="A <racket>")
    text = film.to_html()
    assert film.title == "A <racket>" and "<h1>A &lt;racket&gt;</h1>" in text and ", and L</figcaption>" in text
    assert page_of(film)["momentum"] is not None and film.keeps_momentum
    held = TOP.animate(6.0)
    assert held.title == "HeavyTop" and page_of(held)["momentum"] is None
    assert ", and L</figcaption>" not in held.to_html() and not held.keeps_momentum
    with pytest.raises(ph.InvalidInput, match="title"):
        RACKET.animate(6.0, title=3)


def test_what_cannot_be_shown_is_refused(tmp_path):
    bare = ph.solve(scene(BLOCK, want="omega"))
    with pytest.raises(ph.InvalidInput, match="must have the attitude"):
        bare.animate()
    with pytest.raises(ph.InvalidInput, match="two times"):
        RACKET.animate([1.0])
    with pytest.raises(ph.InvalidInput, match=r"must end in .html, .gif or .mp4"):
        RACKET.animate(1.0).save(tmp_path / "film.avi")
    with pytest.raises(ph.InvalidInput, match="fps"):
        RACKET.animate(1.0).save(tmp_path / "film.gif", fps=0)
    assert not list(tmp_path.iterdir())


def test_a_gif_has_frames_that_move(tmp_path):
    image = pytest.importorskip("PIL.Image")
    path = RACKET.animate(6.0, body="ellipsoid").save(tmp_path / "film.gif", fps=2)
    with image.open(path) as film:
        assert film.n_frames == 12 and film.info["duration"] == 500
        frames = []
        for k in (0, 7):
            film.seek(k)
            frames.append(np.asarray(film.convert("RGB")).astype(int))
    half = frames[0].shape[1] // 2
    moved = np.abs(frames[1] - frames[0]).sum(axis=2) > 60
    assert moved[40:, :half].mean() > 0.02 and 0 < moved[40:, half:].mean() < 0.02   # the body, and the dot of omega


def test_a_film_has_its_panels_side_by_side_and_room_for_its_title(monkeypatch):
    """A title of seventy letters beside the time; neither the body nor the ellipsoid reaches into the other panel."""
    from polhode._plot import picture

    figures = []

    class Kept(picture.Picture):
        def __init__(self, **options):
            super().__init__(**options)
            figures.append(self)

    monkeypatch.setattr(picture, "Picture", Kept)
    name = "A block thrown about its intermediate axis, as it is seen at the side"
    film = ph.solve(scene(BLOCK, name=name)).animate()
    (frame,) = writer._frames(film, [0])
    left, right = (axes.bbox for axes in figures[0].axes)
    assert 0 <= left.x0 < left.x1 <= right.x0 < right.x1 <= figures[0].bbox.x1
    assert (frame[:, -4:] == 255).all()   # nothing is cut off at the edge


def test_an_mp4_by_ffmpeg_or_a_plain_refusal(tmp_path, monkeypatch):
    film = RACKET.animate(6.0)
    if shutil.which("ffmpeg"):
        assert b"ftyp" in film.save(tmp_path / "film.mp4", fps=2).read_bytes()[:32]
    monkeypatch.setattr("shutil.which", lambda name: None)
    with pytest.raises(ph.InvalidInput, match="needs ffmpeg"):
        film.save(tmp_path / "none.mp4")


def test_run_writes_a_film(tmp_path):
    from typer.testing import CliRunner

    from polhode.cli.app import app

    file = tmp_path / "racket.html"
    result = CliRunner().invoke(app, ["run", "S2", "--accuracy", "1e-6", "--animate", str(file)])
    assert result.exit_code == 0 and f"wrote {file}" in result.stdout and "<title>S2</title>" in file.read_text()
    wrong = CliRunner().invoke(app, ["run", "S2", "--animate", str(tmp_path / "film.avi")])
    assert wrong.exit_code == 2 and "animate: must end in .html, .gif or .mp4" in wrong.stderr


def seen(tab):
    """What the page shows: the pixels of the body's canvas, and those of the ellipsoid's."""
    from PIL import Image

    found = []
    for canvas in ("document.getElementById('body')", "document.querySelector('#poinsot canvas')"):
        data = tab.run(f"{canvas}.toDataURL()").partition(",")[2]
        with Image.open(io.BytesIO(base64.b64decode(data))) as picture:
            found.append(np.asarray(picture.convert("RGBA")).astype(int))
    return found


@pytest.mark.skipif(browser.find() is None, reason="no Chromium: apt install chromium")
@pytest.mark.parametrize(("form", "width", "dark"), [(RACKET, 1000, False), (TOP, 390, True)], ids=["racket", "top"])
def test_the_body_turns_in_a_browser(form, width, dark, tmp_path):
    pytest.importorskip("PIL")
    page = form.animate(8.0).save(tmp_path / "film.html")
    with browser.Browser(f"{page.as_uri()}#t=1.5", width, 700, dark) as tab:
        theme = "dark" if dark else "light"
        tab.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": theme}])
        tab.wait("document.body && document.body.dataset.drawn")
        if tab.run("document.body.dataset.drawn") == "no":
            pytest.skip(f"no WebGL in this Chromium: {tab.run('document.getElementById(`trouble`).textContent')}")
        assert tab.errors == [] and [url for url in tab.requests if not url.startswith(("file:", "data:"))] == []
        assert tab.run("document.documentElement.scrollWidth <= window.innerWidth")
        body, ellipsoid = seen(tab)
        covered = body[..., 3] > 200
        assert 0.05 < covered.mean() < 0.8 and len(np.unique(body[covered][:, :3], axis=0)) > 20
        slide = ("(() => { const slider = document.getElementById('time'); slider.value = %s; "
                 "slider.dispatchEvent(new Event('input')); return document.getElementById('clock').textContent; })()")
        assert tab.run(slide % 3.9).startswith("3.9")
        later = seen(tab)
        assert (np.abs(later[0] - body).sum(axis=2) > 60).mean() > 0.05   # the body
        moved = (np.abs(later[1] - ellipsoid).sum(axis=2) > 60).mean()
        assert 0 < moved < 0.05   # the dot and its line alone
        tab.run(slide % 1.5)
        assert (np.abs(seen(tab)[0] - body).sum(axis=2) > 60).mean() < 0.002   # the same time, the same picture
        ink = tab.run("getComputedStyle(document.body).backgroundColor")
        assert ink == ("rgb(19, 20, 22)" if dark else "rgb(255, 255, 255)")
