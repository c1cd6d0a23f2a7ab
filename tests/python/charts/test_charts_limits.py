"""The pictures of the charts: their parts lie within them and apart, and nothing is drawn beside its axes."""

import layout
import numpy as np
from matplotlib.text import Text

import polhode as ph
from polhode._harness.truth import Truth
from polhode.charts import choice, pictures
from polhode.charts.measure import Point, SceneResult

SCENE = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(1.0, 2.0, 3.0), times=np.linspace(0, 1, 5), name="tiny")
TRUTH = Truth(np.ones((1, 3)), np.ones((1, 4)), "stored", "", 3e-16, 1e-13)
VALUES = [10.0**-k for k in range(3, 13)]


def curve(name, family, least):
    """Errors as small as the tolerance, but not below `least`."""
    return [Point(name, family, f"{v:g}", v, error=max(v, least),
                  seconds=1e-3 * v**-0.2, repeats=1, stats={"steps": 100})
            for v in VALUES]


def test_names_in_the_picture_of_the_limits_lie_apart(tmp_path, monkeypatch):
    boxes = {}

    def look(figure, *_):
        (axes,) = figure.axes
        figure.canvas.draw()
        # Of the words alone: an annotation's own extent includes its line to the curve.
        boxes.update({text.get_text(): Text.get_window_extent(text) for text in axes.texts})
        assert axes.get_legend() is None
        return []

    monkeypatch.setattr(pictures.style, "save", look)
    kinds = {"rk45": "method", "dop853": "method", "heyoka": "peer", "SciPy RK45": "peer"}
    points = [p for name, family in kinds.items() for p in curve(name, family, 2e-5)] + curve("taylor", "method", 0.0)
    pictures.limits([SceneResult(SCENE, "made up", TRUTH, points, [])], tmp_path)
    names = list(boxes)
    assert {"rk45", "dop853", "taylor", "in grey: heyoka, SciPy RK45"} < set(names)
    assert not [(a, b) for i, a in enumerate(names) for b in names[:i] if boxes[a].overlaps(boxes[b])]


def look_at(figures):
    def look(figure, *_):
        figures.append(figure)
        return []
    return look


def timed(name, family, errors, seconds):
    return [Point(name, family, f"{v:g}", v, error=e, seconds=s, fastest=s, slowest=s, repeats=1,
                  stats={"steps": 100}) for v, e, s in zip(VALUES, errors, seconds)]


def charted(count):
    """Scenes with a closed form, own methods, beaten ones, and another program that takes three times as long."""
    times = [1e-3 * 1.6**k for k in range(10)]
    points = [*timed("rk45", "method", VALUES, times), *timed("bs23", "method", VALUES, [5 * t for t in times]),
              *timed("SciPy RK45", "peer", VALUES, [3 * t for t in times]),
              Point("FreeMotion", "exact", "closed form", 0.0, "", error=1e-15, seconds=1e-6, fastest=1e-6,
                    slowest=1e-6, repeats=5),
              Point("solve", "plan", "1e-6", 1e-6, "", error=1e-7, seconds=2e-3, fastest=2e-3, slowest=2e-3, repeats=5)]
    points += [Point(name, "cheap", "0.25 s", 0.25, "step", error=error, seconds=1e-4, fastest=1e-4, slowest=1e-4)
               for name, error in (("free", 1e-11), ("dmv8", 1e-2))]
    per_turn = {"free": 5e-15, "dmv8": 1e-15, "jolt": 0.6, "rk4": 1e-7}
    return [SceneResult(SCENE.replace(name=f"S{i}"), "made up", TRUTH, points, [], per_turn=per_turn)
            for i in range(count)]


def test_every_part_of_a_picture_lies_within_it_and_apart(tmp_path, monkeypatch):
    figures, results = [], charted(5)
    monkeypatch.setattr(pictures.style, "save", look_at(figures))
    pictures.overview(results[:2], tmp_path)
    choice.picture(results, tmp_path)
    pictures.work_precision(results[0], tmp_path)
    for figure in figures:
        layout.check(figure)
        for axes in figure.axes:
            across, up = sorted(axes.get_xlim()), sorted(axes.get_ylim())
            for line in axes.get_lines():
                if line.get_transform() is axes.transData:
                    x, y = line.get_data()
                    assert across[0] <= min(x) and max(x) <= across[1] and up[0] <= min(y) and max(y) <= up[1]
                assert axes.xaxis.get_zorder() < line.get_zorder()   # the grid is behind
    overview = layout.boxes(figures[0])
    left = [box.x0 for name, box in overview.items() if name.startswith(("Closed forms", "one thread", "legend",
                                                                         "For an engine"))]
    assert len(left) == 4 and max(left) - min(left) < 5   # one edge at the left


def test_grey_names_are_smaller_and_stand_beside_their_curves(tmp_path, monkeypatch):
    figures = []
    monkeypatch.setattr(pictures.style, "save", look_at(figures))
    seconds = [1e-2] * 4
    weak = timed("weak", "method", [1e-3, 1e-4, 1e-5, 1e-6], seconds)
    points = [*weak, *timed("rk45", "method", [1e-3, 1e-5, 1e-7, 1e-9], [1e-3, 2e-3, 3e-3, 1e-2])]
    pictures.work_precision(SceneResult(SCENE, "made up", TRUTH, points, []), tmp_path)
    texts = {text.get_text(): text for text in figures[0].axes[0].texts}
    assert texts["weak"].get_fontsize() < texts["rk45"].get_fontsize()
    # rk45 ends at the same height, three decades to the right: nothing is in the way of four letters.
    assert texts["weak"].xyann[1] == texts["rk45"].xyann[1] == 0


def test_the_plan_is_in_front_and_what_is_beaten_behind():
    order = [pictures.style.line(name, family, pale)["zorder"] for name, family, pale in (
        ("solve", "plan", False), ("rk45", "method", False), ("heyoka", "peer", False), ("rk4", "method", True))]
    assert order == sorted(order, reverse=True) and len(set(order)) == 4
