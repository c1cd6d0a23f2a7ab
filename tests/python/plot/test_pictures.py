"""Pictures of closed forms and of motions: their parts, their spans, and that a notebook shows them."""

import json
import subprocess
import sys

import numpy as np
import pytest

import polhode as ph

pytest.importorskip("matplotlib")
from matplotlib.figure import Figure  # noqa: E402

from polhode._plot import style  # noqa: E402
from polhode._plot.closed_forms import find_span, make_scene, make_track  # noqa: E402
from polhode._plot.motion import PARTS, draw  # noqa: E402
from polhode._plot.track import of_motion  # noqa: E402

BLOCK = (0.20, 0.40, 0.52)
TILTED = ph.Rotation.from_euler("ZXZ", (0.3, 0.5, 0.1))
FORMS = {
    "FreeMotion": ph.FreeMotion(BLOCK, (1, 2, 3), TILTED),
    "Gyrostat": ph.Gyrostat(BLOCK, momentum=(0.3, -0.2, 0.5), omega=(1, 2, 3), attitude=TILTED),
    "HeavyTop": ph.HeavyTop((1, 1, 0.5), 2.0, (0.1, 0, 6), TILTED),
    "HeavyTop with a rotor": ph.HeavyTop((1, 1, 0.5), -2.0, (0.1, 0, 6), TILTED, rotor=1.5),
    "DampedFree": ph.DampedFree(BLOCK, 0.5, (1, 2, 3), TILTED),
    "Pendulum": ph.Pendulum(BLOCK, 2.0, (0, 0, -0.5), (1, 0, 0)),
}


@pytest.mark.parametrize("name", FORMS)
def test_the_scene_of_a_closed_form_has_its_motion(name):
    form = FORMS[name]
    times = np.linspace(0, 3, 7)
    motion = ph.solve(make_scene(form, times), method="dop853", rtol=1e-12)
    omega, attitude = form.at(times)
    np.testing.assert_allclose(motion.omega, omega, atol=1e-9)
    np.testing.assert_allclose(np.abs(np.sum(motion.attitude * attitude, axis=1)), 1, atol=1e-9)
    assert all(value < 1e-13 for value in make_track(form, times).drift.values())


@pytest.mark.parametrize("name", FORMS)
def test_every_closed_form_draws_itself(name):
    figure = FORMS[name].plot()
    assert isinstance(figure, Figure) and len(figure.axes) == 8
    assert figure._repr_png_().startswith(b"\x89PNG") and len(figure._repr_png_()) > 20_000
    assert len(FORMS[name].plot("rates").axes) == 1 and len(FORMS[name].plot(2.0, "rates", "energy").axes) == 2


def test_the_default_span_is_two_periods_or_ten_turns():
    free = FORMS["FreeMotion"]
    assert find_span(free) == 2 * free.period and make_track(free, None).t[-1] == 2 * free.period
    top = FORMS["HeavyTop"]
    assert find_span(top) == 2 * top.nutation_period
    steady = ph.FreeMotion(BLOCK, (0, 0, 3))
    assert np.isclose(find_span(steady), 10 * 2 * np.pi / 3)
    between = ph.FreeMotion(BLOCK, (0, 5, 1e-250))
    assert np.isclose(find_span(between), 4 * np.pi)   # its period is hundreds of turns, or endless
    assert find_span(ph.FreeMotion(BLOCK, (0, 0, 0))) == 1.0
    assert np.isclose(find_span(ph.DampedFree(BLOCK, 0.0, (0, 0, 3))), 10 * 2 * np.pi / 3)   # nothing damps it
    assert find_span(ph.DampedFree(BLOCK, 20.0, (0, 0, 3))) < 10 * 2 * np.pi / 3


def test_given_times_are_those_of_the_samples():
    times = np.array([3.0, 1.0, 2.0])
    track = make_track(FORMS["FreeMotion"], times)
    assert track.t.tolist() == times.tolist() and (track.curve.t[0], track.curve.t[-1]) == (1.0, 3.0)
    assert np.allclose(track.omega, FORMS["FreeMotion"].at(times)[0], rtol=0, atol=0)
    backwards = make_track(FORMS["FreeMotion"], -2.0)
    assert backwards.t.min() == -2.0 and backwards.curve.t[0] == -2.0
    for wrong in (np.nan, [[1.0, 2.0]], []):
        with pytest.raises(ph.InvalidInput, match="t: must be finite times"):
            FORMS["FreeMotion"].plot(wrong)


def lines(axes):
    return {line.get_label(): np.column_stack(line.get_data()) for line in axes.get_lines()}


def test_rates_attitude_and_energy_show_the_numbers():
    motion = ph.solve(ph.Scene(inertia=BLOCK, omega=(1, 2, 3), times=np.linspace(0, 2, 201)), 1e-9)
    drawn = lines(motion.plot("rates").axes[0])
    for k, name in enumerate("xyz"):
        assert np.array_equal(drawn[name], np.column_stack([motion.t, motion.omega[:, k]]))
    drawn = lines(motion.plot("attitude").axes[0])
    shown = np.column_stack([drawn[name][:, 1] for name in "xyzw"])
    assert np.allclose(np.abs(np.sum(shown * motion.attitude, axis=1)), 1)
    assert np.abs(np.diff(shown, axis=0)).max() < 0.1   # q and -q are one attitude: the curve does not jump
    track = of_motion(motion)
    turned = track.curve.attitude * np.where(np.arange(201) % 7 < 3, -1, 1)[:, None]
    drawn = lines(draw(track._replace(curve=track.curve._replace(attitude=turned)), ("attitude",), None, None,
                       False).axes[0])
    assert max(np.abs(np.diff(drawn[name][:, 1])).max() for name in "xyzw") < 0.1
    rough = ph.solve(motion.scene, method="euler", step=0.01)
    (line,) = rough.plot("energy").axes[0].get_lines()
    assert np.allclose(np.abs(line.get_ydata()).max(), rough.drift["energy"], rtol=0.2) and rough.drift["energy"] > 1e-3


def test_the_momentum_lies_on_its_sphere_and_marks_on_the_curves():
    motion = ph.solve(ph.Scene(inertia=BLOCK, omega=(1, 2, 3), times=np.linspace(0, 2, 201)), 1e-9)
    axes = motion.plot("momentum", marks=[0.5, 1.5]).axes[0]
    for line in axes.get_lines():
        x, y = np.nan_to_num(line.get_data())
        if line.get_linewidth() > 1.1:   # not the ticks of the principal axes
            assert np.hypot(x, y).max() < 1 + 1e-9
    assert {"0.5 s", "1.5 s"} <= {text.get_text() for text in axes.texts}
    dashed = [line.get_xdata()[0] for line in motion.plot("rates", marks=[0.5, 1.5]).axes[0].get_lines()[3:]]
    assert dashed == [0.5, 1.5]
    assert len(motion.plot("rates", marks=3).axes[0].get_lines()) == 6
    for wrong in (-1, [np.inf]):
        with pytest.raises(ph.InvalidInput, match="marks"):
            motion.plot(marks=wrong)


@pytest.mark.parametrize("part", ["polhode", "momentum", "herpolhode", "axis"])
def test_the_motion_is_the_broadest_line_and_its_start_the_largest_dot(part):
    lines = FORMS["FreeMotion"].plot(part, marks=[0.5]).axes[0].get_lines()
    curves = [line for line in lines if line.get_marker() == "None"]
    motion = [line for line in curves if line.get_color() in (style.LIGHT.accent, style.LIGHT.path)]
    others = [line.get_linewidth() for line in curves if line not in motion]
    assert motion and min(line.get_linewidth() for line in motion) > max(others, default=0.0)
    dots = [line for line in lines if line.get_marker() == "o"]
    start, *marks = sorted(dots, key=lambda line: line.get_color() != style.LIGHT.ink)
    assert len(marks) == 1 and marks[0].get_markersize() < start.get_markersize()


@pytest.mark.parametrize("part", ["polhode", "momentum"])
def test_the_names_of_the_axes_stand_alike_beyond_their_tips(part):
    """Outward, and at one distance in points, whatever the length of the axis."""
    names = {text.get_text(): text for text in FORMS["FreeMotion"].plot(part).axes[0].texts}
    for name in ("axis 1", "axis 2", "axis 3"):
        tip, offset = np.array(names[name].xy), np.array(names[name].xyann)
        assert offset @ tip == pytest.approx(np.linalg.norm(offset) * np.linalg.norm(tip))
        assert np.linalg.norm(offset) == pytest.approx(np.linalg.norm(names["axis 1"].xyann))


def test_the_circles_of_latitude_lie_alike_above_and_below():
    axes = FORMS["FreeMotion"].plot("axis").axes[0]
    points = np.vstack([np.column_stack(line.get_data()) for line in axes.get_lines()
                        if line.get_color() == style.LIGHT.floor])
    points = points[np.isfinite(points).all(axis=1)]
    assert len(points) == 5 * 181
    apart = np.abs(points[:, None] + points[None]).sum(axis=2).min(axis=1)
    assert apart.max() < 1e-9   # each point has its opposite


def test_one_part_is_drawn_into_axes_of_the_callers():
    figure = Figure()
    left, right = figure.subplots(1, 2)
    motion = ph.solve(ph.Scene.load("S5"), 1e-6)
    assert motion.plot("angles", ax=left) is figure and FORMS["HeavyTop"].plot("axis", ax=right) is figure
    assert len(left.get_lines()) == 3 and right.get_lines()
    with pytest.raises(ph.InvalidInput, match="ax: must be given with one part, got 0"):
        motion.plot(ax=left)


@pytest.mark.parametrize("part", PARTS)
def test_a_dark_picture_is_dark_and_legible(part):
    figure = FORMS["FreeMotion"].plot(part, dark=True)
    assert figure.get_facecolor()[:3] == pytest.approx([int(style.DARK.paper[k:k + 2], 16) / 255 for k in (1, 3, 5)])
    figure.canvas.draw()
    for axes in figure.axes:
        texts = [axes.title, axes._left_title, *axes.texts, *axes.get_xticklabels(), *axes.get_yticklabels()]
        for text in texts:
            colour = text.get_color()
            assert int(colour[1:3], 16) > 0x80, (text.get_text(), colour)


PROGRAM = """
import json
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance()
shell.run_cell("import polhode as ph")
shown = shell.run_cell({cell!r}).result
data, _ = shell.display_formatter.format(shown)
print(json.dumps({{name: len(content) for name, content in data.items()}}))
"""


def test_a_notebook_shows_a_picture_without_magic():
    pytest.importorskip("IPython")
    cell = "ph.FreeMotion((1, 2, 2.5), (1, 2, 3)).plot('polhode')"
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", PROGRAM.format(cell=cell)], capture_output=True,
                          text=True, check=True)
    assert json.loads(done.stdout.splitlines()[-1])["image/png"] > 10_000


def test_an_executed_notebook_holds_the_picture(tmp_path):
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    cells = ["import polhode as ph", "ph.FreeMotion((1, 2, 2.5), (1, 2, 3)).plot('polhode')"]
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(text) for text in cells])
    (tmp_path / "book.ipynb").write_text(nbformat.writes(book))
    program = ("import nbformat, nbclient; book = nbformat.read('book.ipynb', 4); "
               "nbclient.NotebookClient(book, timeout=120, kernel_name='python3').execute(); "
               "print(sorted(book.cells[1].outputs[0].data), len(book.cells[1].outputs))")
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", program], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "['image/png', 'text/plain'] 1"
