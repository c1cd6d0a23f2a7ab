"""The report: tables and curves say what was measured, and the page works in a browser without a network."""

import importlib.util
import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import polhode as ph
from polhode.charts.candidates import candidates
from polhode.report import report, tables
from polhode.report.atlas_part import part
from polhode.report.atlas_part import write as write_atlas
from polhode.report.curves import GROUPS, figure
from polhode.report.page import _in_script, picture, render

pytest.importorskip("matplotlib")
pytest.importorskip("plotly")
import browser  # noqa: E402  tests/support

TINY = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(1.0, 2.0, 3.0), times=np.linspace(0, 1, 5), name="a <b> & c")
NAMES = ("FreeMotion", "rk45", "rk4", "euler")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys.modules["polhode.charts.chart"], "candidates",
                      lambda peers: [c for c in candidates(False) if c.name in NAMES])
        page = report(folder, scenes=["S5", TINY], budget=9, peers=False, with_atlas=False)
    return page, json.loads((folder / "charts" / "results.json").read_text())


class Page(HTMLParser):
    """Elements that must be closed, and what the page asks for."""

    def __init__(self):
        super().__init__()
        self.open, self.sources, self.ids = [], [], []

    def handle_starttag(self, tag, attributes):
        if tag not in ("meta", "link", "img", "br", "input"):
            self.open.append(tag)
        found = dict(attributes)
        self.sources += [found[key] for key in ("src", "href") if key in found]
        if "id" in found:
            self.ids.append(found["id"])

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_page_is_whole_and_asks_for_nothing_outside(made):
    page, _ = made
    parser = Page()
    parser.feed(page.read_text())
    assert parser.open == []
    assert {s.partition(":")[0] for s in parser.sources if not s.startswith("#")} == {"data", "plotly.min.js"}
    assert {s[1:] for s in parser.sources if s.startswith("#")} <= set(parser.ids)
    assert (page.parent / "plotly.min.js").stat().st_size > 1_000_000


def test_names_cannot_break_the_page(made):
    text = made[0].read_text()
    assert "a &lt;b&gt; &amp; c" in text and "a <b>" not in text
    assert _in_script({"x": "</script>"}) == '{"x":"\\u003c/script>"}'


def test_every_number_of_the_winners_is_in_the_results(made):
    _, content = made
    head, rows = tables.winners(content)
    assert head[2:] == ["error ≤ 1e-3", "error ≤ 1e-6", "error ≤ 1e-9", "error ≤ 1e-12"]
    scene = content["scenes"][0]
    for level, cell in zip(tables.LEVELS, rows[0][2:], strict=True):
        reaching = [p for p in scene["points"] if p["status"] == "answered" and p["error"] <= level]
        assert (cell in ("never", "not in the budget")) == (not reaching)
        if reaching:
            quickest = min(reaching, key=lambda p: p["seconds"])
            assert cell.startswith(quickest["candidate"] + " ") and quickest["error"] <= level


def test_tables_hold_every_scene_and_candidate(made):
    _, content = made
    cells = {row[0]: row[1:] for row in tables.best(content)[1]}
    assert set(cells) == set(NAMES) and cells["FreeMotion"][0] == "–"   # no closed form of S5
    assert len(tables.scenes(content)[1]) == 2 and "gravity" in tables.scenes(content)[1][0]
    assert any(name == "numpy" for name, _ in tables.machine(content))
    text = tables.markdown((["a", "b"], [["1", "x|y"]]))
    assert text == "| a | b |\n| --- | --- |\n| 1 | x\\|y |\n"


def test_what_was_not_done_in_time_has_not_failed():
    def cell(*runs):
        points = [{"candidate": "rk45", "status": status, "why": why, "error": 1e-3} for status, why in runs]
        return tables.best({"scenes": [{"name": "S1", "points": points}]})[1][0][1]

    late, out = ("failed", "not done within 0.1 s"), ("left out", "would take about 9 s")
    assert cell(late, out) == cell(out) == "too slow" and cell(late, ("failed", "crash")) == "failed"
    assert cell(late, ("answered", "")) == "1e-3"


def test_tables_say_where_the_budget_stopped_a_candidate():
    """The smallest error of what ran is not that of the program, and what was left out has not failed to reach."""
    def tables_of(*runs):
        points = [{"candidate": "peer", "family": "peer", "setting": setting, "status": status, "why": "would take 9 s",
                   "error": 0.3, "seconds": 1.0} for setting, status in runs]
        scene = {"name": "S1", "title": "", "points": points}
        return tables.best({"scenes": [scene]})[1][0][1], tables.winners({"scenes": [scene]})[1][1][2]

    done, out = "answered", "left out"
    assert tables_of(("1e-03", done), ("1e-06", done), ("1e-09", out), ("1e-12", out)) == (
        "0.3, stopped at rtol 1e-6", "not in the budget")
    assert tables_of(("0.25 s", done), ("0.125 s", out)) == ("0.3, stopped at 0.25 s", "not in the budget")
    assert tables_of(("1e-03", done), ("1e-06", "failed")) == ("0.3", "never")
    assert tables_of(("1e-03", out), ("1e-06", done))[0] == "0.3"
    assert tables_of(("1e-03", "failed"), ("1e-06", out)) == ("failed", "not in the budget")


def test_broad_pictures_are_known_by_their_width(tmp_path):
    for name, width in (("narrow.svg", 518), ("broad.svg", 1036.8)):
        (tmp_path / name).write_text(f'<svg height="300pt" width="{width}pt" xmlns="http://www.w3.org/2000/svg"/>')
        assert picture(tmp_path / name, "").broad == (width > 1000)


def test_failures_are_told_once_with_their_settings():
    def point(setting, status, why):
        return {"candidate": "rk45", "setting": setting, "status": status, "why": why}

    content = {"scenes": [{"name": "S1", "points": [point("1e-03", "answered", ""), point("1e-04", "failed", "crash"),
                                                    point("1e-05", "left out", "late"),
                                                    point("1e-06", "left out", "late")]}]}
    assert tables.failures(content)[1] == [["S1", "rk45", "1e-04", "failed: crash"],
                                           ["S1", "rk45", "1e-05 to 1e-06", "left out: late"]]


def test_curves_hold_every_point_that_answers_something(made):
    _, content = made
    for scene in content["scenes"]:
        drawn = figure(scene)["data"]
        assert {trace["group"] for trace in drawn} <= set(GROUPS.values())
        for trace in drawn:
            points = [p for p in scene["points"] if p["candidate"] == trace["name"] and p["status"] == "answered"]
            shown = [p for p in points if p["error"] < 4 or not p["swept"]]
            assert trace["y"] == [p["seconds"] for p in shown]
            assert trace["pale"] == (trace["name"] in scene["dominated"])
            assert all(p["setting"] in text for p, text in zip(shown, trace["text"], strict=True))


def test_all_points_of_the_curves_lie_within_their_axes(made):
    """Log axes, accuracy to the right: a point off by nearly pi is the last that is drawn, half as much beside it."""
    _, content = made
    for scene in content["scenes"]:
        shown = figure(scene)
        (left, right), (low, high) = (shown["layout"][axis]["range"] for axis in ("xaxis", "yaxis"))
        for trace in shown["data"]:
            assert all(right < np.log10(x) < left for x in trace["x"])
            assert all(low < np.log10(y) < high for y in trace["y"])
        assert np.log10(np.pi) < left < np.log10(10)   # an attitude is never further off than pi
        for line in shown["layout"]["shapes"]:
            assert line["yref"] == "paper" and (line["y0"], line["y1"]) == (0, 1)   # from the bottom to the top
            assert right < np.log10(line["x0"]) < left


def test_the_budget_is_a_few_minutes_and_more_for_everything(tmp_path, monkeypatch):
    given = []

    def charted(*_, budget, **__):
        given.append(budget)
        raise ph.InvalidInput("enough")

    monkeypatch.setattr(sys.modules["polhode.report.report"], "chart", charted)
    for options in ({}, {"full": True}, {"budget": 7.0}):
        with pytest.raises(ph.InvalidInput, match="enough"):
            report(tmp_path, **options)
    quick, full, own = given
    assert 60 <= quick <= 180 < full and own == 7.0   # the docs: a few minutes, the quick atlas among them


def test_the_atlas_has_its_matrix_and_pictures(made, tmp_path):
    def verdict(level, text):
        return {"level": level, "text": text, "number": 1.0, "why": "because"}

    atlas = {"families": {"racket": {"title": "The racket"}, "gimbal": {"title": "Gimbal lock"}},
             "broken_claims": ["rk45 does not hold"],
             "matrix": {"rk45": {"group": "methods", "racket": verdict("fails", "at 1e-4"),
                                 "gimbal": verdict("holds", "1e-12")},
                        "dmv8": {"group": "engines", "racket": verdict("degrades", "at 5")}}}
    (tmp_path / "racket.svg").write_text("<svg xmlns='http://www.w3.org/2000/svg'/>")
    shown = part(atlas, tmp_path, " --quick")
    families, rows = shown["matrix"]
    assert families == ["racket", "gimbal"] and [name for name, _ in rows] == ["rk45", "dmv8"]
    assert [cell.level for _, cells in rows for cell in cells] == ["fails", "holds", "degrades", "none"]
    assert [p.command for p in shown["pictures"]] == ["polhode atlas racket --quick"]
    text = render(made[1], made[0].parent / "charts", motions=[], atlas=shown, command="polhode report", seconds=1.0)
    parser = Page()
    parser.feed(text)
    assert parser.open == [] and "atlas" in parser.ids and 'class="degrades"' in text and "rk45 does not hold" in text


def test_compact_results_give_the_same_tables(made):
    _, content = made
    small = json.loads(json.dumps(tables.compact(content), allow_nan=False))
    assert tables.winners(small) == tables.winners(content) and tables.best(small) == tables.best(content)
    assert len(json.dumps(small)) < 0.8 * len(json.dumps(content))


def test_the_command_says_where_the_page_is(tmp_path, monkeypatch):
    from typer.testing import CliRunner

    from polhode.cli.app import app

    monkeypatch.setattr("polhode.report.report", lambda folder, **options: folder / f"{len(options['scenes'])}.html")
    result = CliRunner().invoke(app, ["report", "-o", str(tmp_path)])
    assert result.exit_code == 0 and result.stdout == f"{tmp_path}/12.html\n"
    assert CliRunner().invoke(app, ["report", "S1", "--budget", "soon"]).exit_code == 2


@pytest.mark.skipif(browser.find() is None, reason="no Chromium: apt install chromium")
def test_the_page_is_dark_where_the_system_is(made):
    with browser.Browser(made[0].as_uri(), 1280, 800) as tab:
        tab.wait("document.body && document.body.dataset.drawn === 'all'")
        seen = {}
        for theme in ("light", "dark"):
            tab.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": theme}])
            seen[theme] = [tab.run(f"getComputedStyle({what}).{key}") for what, key in (
                ("document.body", "backgroundColor"), ("document.body", "color"),
                ("document.querySelector('figure img')", "filter"), ("document.querySelector('.curves')", "filter"))]
        assert seen["light"] == ["rgb(255, 255, 255)", "rgb(0, 0, 0)", "none", "none"]
        assert seen["dark"][:2] == ["rgb(19, 20, 22)", "rgb(207, 208, 208)"] and "invert" in seen["dark"][2]
        assert seen["dark"][2] == seen["dark"][3]
        tab.ask("Emulation.setEmulatedMedia", media="print",
                features=[{"name": "prefers-color-scheme", "value": "dark"}])
        assert tab.run("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"


def test_the_page_of_an_atlas_alone(tmp_path):
    cell = {"level": "fails", "text": "at 1e-4", "why": "because <b>"}
    content = {"families": {"racket": {"title": "The racket"}}, "matrix": {"rk45": {"racket": cell}}, "quick": True,
               "polhode": {"version": "9.9"}, "machine": {"processor": "abacus"}, "made": "today"}
    (tmp_path / "racket.svg").write_text("<svg xmlns='http://www.w3.org/2000/svg'/>")
    text = write_atlas(content, tmp_path).read_text()
    parser = Page()
    parser.feed(text)
    assert parser.open == [] and {s.partition(":")[0] for s in parser.sources} == {"data"}
    assert 'class="fails" title="because &lt;b&gt;"' in text and "1 family of" in text
    assert "polhode atlas racket --quick" in text


@pytest.mark.skipif(browser.find() is None, reason="no Chromium: apt install chromium")
@pytest.mark.parametrize(("width", "phone"), [(1280, False), (390, True)], ids=["desk", "phone"])
def test_the_page_in_a_browser(made, width, phone):
    page, content = made
    with browser.Browser(page.as_uri(), width, 800, phone) as tab:
        tab.wait("document.body && document.body.dataset.drawn === 'all'")
        assert tab.errors == []
        assert all(url.startswith(("file:", "data:", "blob:")) for url in tab.requests)
        assert tab.run("[...document.images].every((i) => i.complete && i.naturalWidth > 100)")
        assert tab.run("document.querySelectorAll('.curves .main-svg').length") >= len(content["scenes"])
        assert tab.run("document.documentElement.scrollWidth <= window.innerWidth")   # nothing hangs over
        shown = tab.run("document.querySelector('figure.broad img').offsetWidth")
        assert shown > 600   # several panels side by side are large enough to read, and scroll on a phone
        curve = "document.querySelector('.curves').data.find((t) => t.name === 'rk45').visible !== false"
        press = ("[...document.querySelector('.chips').querySelectorAll('button')]"
                 ".find((b) => b.textContent === '{}').click()")
        states = [tab.run(curve)]
        for word in ("rk45", "rk45", "methods", "methods"):
            tab.run(press.format(word))
            states.append(tab.run(curve))
        assert states == [True, False, True, False, True]
        tab.ask("Emulation.setEmulatedMedia", media="print")
        assert tab.run("getComputedStyle(document.querySelector('.curves')).display") == "none"
        assert tab.run("getComputedStyle(document.querySelector('.still')).display") == "block"


@pytest.mark.skipif(browser.find() is None, reason="no Chromium: apt install chromium")
def test_without_its_script_the_page_shows_still_pictures(made, tmp_path):
    page, content = made
    (tmp_path / "alone.html").write_text(page.read_text())
    with browser.Browser((tmp_path / "alone.html").as_uri()) as tab:
        tab.wait("document.readyState === 'complete'")
        shown = tab.run("[...document.querySelectorAll('.still img')].filter((i) => i.offsetWidth > 100).length")
        assert shown == len(content["scenes"])
        assert all(re.search("ERR_FILE_NOT_FOUND", text) for text in tab.errors)


def test_the_tables_in_the_documents_are_made_from_the_results_there():
    root = Path(__file__).parents[3]
    spec = importlib.util.spec_from_file_location("docs_results", root / "benchmarks/docs_results.py")
    made_by = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(made_by)
    content = json.loads((root / "docs/results/charts.json").read_text())
    assert (root / "docs/results/charts.md").read_text() == made_by.page(content)
    assert len(content["scenes"]) >= 10
