"""Pictures of motion: Poinsot's curves are what they should be, and every scene has its picture."""

import numpy as np
import pytest

import polhode as ph

pytest.importorskip("matplotlib")
from polhode._plot.motion import PARTS  # noqa: E402
from polhode._plot.poinsot import family, herpolhode, in_front, make_view, outline  # noqa: E402
from polhode._plot.text import to_count, to_error, to_time  # noqa: E402
from polhode._plot.track import find_curve, find_moves  # noqa: E402

BLOCK = np.array([0.20, 0.40, 0.52])


def ellipsoid(semi, count=2000):
    points = np.random.default_rng(3).normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1)[:, None] * semi


def test_the_outline_encloses_the_ellipsoid_and_touches_it():
    semi, view = np.array([3.0, 1.0, 0.5]), make_view(20.0, 40.0)
    assert np.allclose([view.right @ view.up, view.right @ view.towards, np.linalg.norm(view.up)], [0, 0, 1])
    paper = np.stack([view.right, view.up], axis=1)
    edge, points = outline(semi, view), ellipsoid(semi) @ paper
    for direction in np.stack([np.cos(np.linspace(0, 6, 20)), np.sin(np.linspace(0, 6, 20))], axis=1):
        assert (points @ direction).max() < (edge @ direction).max() * (1 + 1e-9)
        assert (points @ direction).max() > (edge @ direction).max() * 0.97


def test_what_is_in_front_hides_what_is_behind():
    semi, view = np.array([3.0, 1.0, 0.5]), make_view()
    points = ellipsoid(semi)
    front = in_front(points, semi, view)
    assert (in_front(-points, semi, view) != front).all()
    nearer = points + 0.01 * view.towards   # leaves the ellipsoid from the front, enters it from behind
    assert ((((nearer / semi) ** 2).sum(axis=1) > 1) == front)[np.abs(points / semi**2 @ view.towards) > 0.05].all()


@pytest.mark.parametrize("moments", [BLOCK, np.array([0.2, 0.4, 0.4]), np.array([0.4, 0.4, 0.6])])
def test_polhodes_keep_energy_and_momentum(moments):
    curves, separatrix = family(moments, 3.0)
    assert curves and bool(separatrix) == (np.unique(moments).size == 3)
    for w in curves + separatrix:
        energy2, momentum2 = w**2 @ moments, w**2 @ moments**2
        np.testing.assert_allclose(energy2, 3.0, rtol=1e-12)
        np.testing.assert_allclose(momentum2, momentum2[0], rtol=1e-12)
    for w in separatrix:
        assert np.allclose(w**2 @ moments**2, 3.0 * moments[1])
        assert np.isclose(np.abs(w[:, 1]).max(), np.sqrt(3.0 / moments[1]))
    assert family(np.ones(3), 3.0) == ([], [])


def test_the_herpolhode_lies_across_the_angular_momentum():
    scene = ph.Scene(inertia=BLOCK, omega=(1, 2, 3), attitude=np.array([0.1, 0.7, 0.1, 0.7]),
                     times=np.linspace(0, 9, 50))
    motion = ph.solve(scene, accuracy=1e-9)
    momentum = motion.angular_momentum
    path = herpolhode(motion.rotation.apply(motion.omega), momentum[0])
    along = 2 * motion.energy[0] / np.linalg.norm(momentum[0])   # omega along L is constant
    np.testing.assert_allclose((path**2).sum(axis=1), (motion.omega**2).sum(axis=1) - along**2, rtol=1e-9)


@pytest.mark.parametrize(("name", "panels"), [("S1", 8), ("S4", 8), ("S5", 8), ("S6", 8), ("S7", 8), ("S9", 8)])
def test_every_scene_has_its_picture(name, panels, tmp_path):
    scene = ph.Scene.load(name)
    motion = ph.solve(scene.replace(times=scene.times[:40]), accuracy=1e-6)
    figure = motion.plot()
    assert len(figure.axes) == panels
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert any("polhode" in t or "path of ω" in t for t in titles) and "z-x-z angles" in titles
    assert ("herpolhode" in " ".join(titles)) == (name == "S1")
    figure.savefig(tmp_path / "motion.png")
    assert (tmp_path / "motion.png").stat().st_size > 20_000


@pytest.mark.parametrize("part", PARTS)
def test_each_part_alone(part):
    figure = ph.solve(ph.Scene.load("S5"), accuracy=1e-6).plot(part)
    assert len(figure.axes) == (3 if part == "angles" else 1)


def test_coarse_samples_are_drawn_as_curves_and_fine_ones_as_they_are():
    scene = ph.Scene(inertia=BLOCK, omega=(1, 2, 3), times=np.linspace(0, 50, 26))
    curve = find_curve(ph.solve(scene, accuracy=1e-6))
    omega, _ = ph.FreeMotion(BLOCK, (1, 2, 3)).at(curve.t)
    assert np.diff(curve.t).max() * 4 < 0.06 and curve.whole
    np.testing.assert_allclose(curve.omega, omega, atol=1e-4)
    fine = ph.solve(scene.replace(times=np.linspace(0, 1, 101)), accuracy=1e-6)
    assert find_curve(fine).omega.shape == (101, 3)
    assert not find_curve(ph.solve(scene.replace(times=np.linspace(0, 5000, 26)), accuracy=1e-3)).whole


def test_a_motion_that_cannot_be_solved_again_is_drawn_by_its_samples(monkeypatch):
    """Its samples are all there is, and they are the whole motion: the heading must not say "the first turns"."""
    motion = ph.solve(ph.Scene(inertia=BLOCK, omega=(1, 2, 3), times=np.linspace(0, 5, 11)), method="rk4", step=0.01)
    from polhode._plot import track
    monkeypatch.setattr(track, "solve", lambda *_, **__: type("M", (), {"status": "stopped", "omega": None}))
    curve = find_curve(motion)
    assert np.array_equal(curve.t, motion.t) and curve.whole


def test_what_should_hold_is_what_drift_says():
    for name in ("S1", "S5", "S6"):
        scene = ph.Scene.load(name)
        motion = ph.solve(scene.replace(times=scene.times[:60]), method="rk45", rtol=1e-5)
        moves = find_moves(motion)
        assert len(moves) == len(motion.drift)
        for ours, theirs in zip(sorted(v.max() for v in moves.values()), sorted(motion.drift.values()), strict=True):
            assert 0.05 * theirs < ours < 20 * theirs


def test_a_body_at_rest_and_one_without_attitude():
    rest = ph.solve(ph.Scene(inertia=BLOCK, omega=(0, 0, 0), times=[0.0, 1.0]), accuracy=1e-6)
    assert len(rest.plot().axes) == 8
    bare = ph.solve(ph.Scene(inertia=BLOCK, omega=(1, 2, 3), times=[0.0, 1.0], want=["omega"]), accuracy=1e-6)
    assert len(bare.plot().axes) == 4
    with pytest.raises(ph.InvalidInput, match="attitude"):
        bare.plot("angles")
    with pytest.raises(ph.InvalidInput, match="must be of polhode"):
        bare.plot("power")


def test_run_draws(tmp_path):
    from typer.testing import CliRunner

    from polhode.cli.app import app

    file = tmp_path / "S5.svg"
    result = CliRunner().invoke(app, ["run", "S5", "--plot", str(file)])
    assert result.exit_code == 0 and f"wrote {file}" in result.stdout and "z-x-z angles" in file.read_text()
    wrong = CliRunner().invoke(app, ["run", "S5", "--plot", str(tmp_path / "S5.bmp")])
    assert wrong.exit_code == 2 and "plot: must end in .png, .svg or .pdf" in wrong.stderr


@pytest.mark.parametrize(("found", "text"), [
    (to_time(2.46e-4), "246 µs"), (to_time(0.9999e-3), "1 ms"), (to_time(12.34), "12.3 s"), (to_time(5e-9), "5 ns"),
    (to_error(2.3e-5), "2e-5"), (to_error(0.23), "0.2"), (to_error(3.1), "3.1"), (to_error(0), "0"),
    (to_count(1_545_000), "1.5 million"), (to_count(65_432), "65 thousand"), (to_count(812), "812"),
])  # fmt: skip
def test_numbers_in_words(found, text):
    assert found == text
