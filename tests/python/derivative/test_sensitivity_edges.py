"""Derivatives at samples within some units in the last place of the ends of windows: closed forms and fixed point."""

import sys
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from ball_edges import KINDS, SPANS, WINDOWS, Ball

import polhode as ph

FOLDER = Path(__file__).parents[3] / "benchmarks/planner"
sys.path.insert(0, str(FOLDER))
from family.edges import draw_edges, make_scene  # noqa: E402
from family.exact import compute_exact  # noqa: E402

sys.path.remove(str(FOLDER))
H = Fraction(1, 2**75)   # by which an end moves, in spans


def find_worst(ball, s):
    """The largest error of a column over its stated error; every column has its own size at each sample."""
    scale = max(abs(rate) for rate in [*ball.rates(), ball.start])
    worst = 0.0
    for name, rows in ball.columns().items():
        c = s.columns.index(name)
        for i, (rate, angle) in enumerate(rows):
            error = max(abs(Fraction(s.d_omega[i, 2, c]) - rate) / scale, abs(Fraction(s.d_attitude[i, 2, c]) - angle))
            size = max(abs(Fraction(rate)) / scale, abs(angle))
            assert size > 0 or error == 0, (name, ball.times[i])
            worst = max(worst, float(error / size / Fraction(s.error[c])) if size else 0.0)
    return worst


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", SPANS)
@pytest.mark.parametrize("windows", WINDOWS)
def test_columns_next_to_edges(kind, name, windows):
    ball = Ball(kind, name, windows=windows)
    s = ph.solve(ball.scene, 1e-9, sensitivity=ball.groups()).sensitivity
    assert s.error.max() < (1e-8 if name == "least" else 1e-9)
    assert find_worst(ball, s) <= 1


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["forward", "backward", "middle", "farther"])
def test_a_sample_does_not_depend_on_later_ones(kind, name):
    """The last sample at an end of a window has the column that it has with more samples behind it."""
    ball = Ball(kind, name, last_at_edge=True)
    s = ph.solve(ball.scene, 1e-9, sensitivity=ball.groups()).sensitivity
    assert s.columns[-1].endswith("_end") and (s.d_omega[-1, 2, -1] or s.d_attitude[-1, 2, -1] or name == "backward")
    assert find_worst(ball, s) <= 1


@pytest.mark.parametrize("want", [("omega",), ("attitude",)])
@pytest.mark.parametrize("kind", KINDS)
def test_columns_have_both_parts_for_every_want(kind, want):
    balls = Ball(kind, "middle"), Ball(kind, "middle", want=want)
    whole, part = (ph.solve(ball.scene, 1e-9, sensitivity=ball.groups()).sensitivity for ball in balls)
    np.testing.assert_array_equal(whole.d_omega, part.d_omega)
    np.testing.assert_array_equal(whole.d_attitude, part.d_attitude)


def read_states(numbers):
    """Exact rates [rad/s] and quaternions as fractions."""
    rows, body = compute_exact(numbers)
    scale = Fraction(1, 1 << body.bits)
    return [([x * scale * body.time for x in row[:3]], [x * scale for x in row[3:]]) for row in rows]


def multiply(p, q):
    (a, b, c, w), (x, y, z, s) = p, q
    return [w * x + a * s + b * z - c * y, w * y + b * s + c * x - a * z, w * z + c * s + a * y - b * x]


def differentiate(numbers, changed, h):
    """Rows of d omega and of the rotation in space, by a quotient of exact states."""
    found = []
    for (w, q), (other, turned) in zip(read_states(numbers), read_states(changed), strict=True):
        slope = [(b - a) / h for a, b in zip(q, turned, strict=True)]
        rotation = [2 * x for x in multiply(slope, [-q[0], -q[1], -q[2], q[3]])]
        found.append([float((b - a) / h) for a, b in zip(w, other, strict=True)] + [float(x) for x in rotation])
    return np.array(found)


def list_ends(numbers):
    """Each end of a window as (list, index, window, end), and the name of its column."""
    for key, group in (("torques", "windows"), ("rotors", "during")):
        for i, one in enumerate(numbers[key]):
            for k, window in enumerate(one.get("windows", ())):
                for end in range(len(window)):
                    yield (key, i, k, end), f"{key}.{i}.{group}_{k}_{('begin', 'end')[end]}"


def move(numbers, place, h):
    """The numbers with one end moved to earlier times."""
    key, i, k, end = place
    windows = [list(window) for window in numbers[key][i]["windows"]]
    windows[k][end] = Fraction(windows[k][end]) - h
    changed = [dict(one) for one in numbers[key]]
    changed[i]["windows"] = windows
    return {**numbers, key: changed}


@pytest.mark.parametrize(("seed", "index"), [(1, 0), (1, 2), (1, 3), (1, 5), (1, 6), (1, 9), (1, 10), (1, 12)])
def test_ends_of_windows_of_random_scenes_in_fixed_point(seed, index):
    numbers = draw_edges(seed, index)
    places = dict((name, place) for place, name in list_ends(numbers))
    groups = sorted({name.rsplit("_", 2)[0] for name in places})
    s = ph.solve(make_scene(numbers), 1e-9, sensitivity=groups).sensitivity
    assert set(s.columns) == set(places)
    span = Fraction(max(numbers["times"])) - Fraction(min(numbers["times"]))
    scale = max(np.linalg.norm(s.omega, axis=1).max(), np.linalg.norm(numbers["omega"]))
    for c, name in enumerate(s.columns):
        truth = differentiate(numbers, move(numbers, places[name], H * span), -H * span)
        found = np.hstack([s.d_omega[:, :, c], s.d_attitude[:, :, c]])

        def sizes(rows):
            return np.maximum(np.linalg.norm(rows[:, :3], axis=1) / scale, np.linalg.norm(rows[:, 3:], axis=1))

        size, error = sizes(truth), sizes(found - truth)
        none = size < 1e-12 * size.max()   # what the quotient rounds
        assert (error[~none] <= s.error[c] * size[~none]).all(), name
        assert not found[none].any(), name
