"""The picture of the scenes on which tighter tolerances do not help: its names are there and lie apart."""

import numpy as np
from matplotlib.text import Text

import polhode as ph
from polhode.charts import pictures
from polhode.charts.measure import Point, SceneResult
from polhode._harness.truth import Truth

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
