"""The site builds without a warning, its links hold, it needs no network, and every page is two clicks away."""

import html.parser
import importlib
import os
import re
import subprocess
import sys
import types
import urllib.parse
from pathlib import Path

import browser  # tests/support
import pytest

import polhode as ph

ROOT = Path(__file__).parents[3]
API = sorted((ROOT / "docs/reference/python").glob("*.md"))
MODULES = ("polhode", "polhode.inertia", "polhode.inertia.robots", "polhode.shapes", "polhode.torques", "polhode.mesh",
           "polhode.elliptic", "polhode.formula",
           "polhode.measured", "polhode.charts", "polhode.atlas", "polhode.report",
           "polhode.recipe", "polhode.schema")


def public_names():
    """Every public object by its shortest name; the members of a class stand with the class."""
    found = {}
    for module in map(importlib.import_module, MODULES):
        for name in getattr(module, "__all__", [name for name in vars(module) if not name.startswith("_")]):
            value = getattr(module, name)
            here = getattr(value, "__module__", module.__name__).startswith("polhode")
            if not isinstance(value, types.ModuleType) and here and not name.startswith("_"):
                if not hasattr(module, "__all__") and value.__module__ != module.__name__:
                    continue   # imported for its own use
                found.setdefault(id(value), f"{module.__name__}.{name}")
    return sorted(found.values())


def test_every_public_name_is_on_exactly_one_page():
    shown = [name for page in API for name in re.findall(r"^\.\. auto\w+:: (\S+)$", page.read_text(), flags=re.M)]
    assert len(shown) == len(set(shown)) and "polhode.solve" in shown
    assert sorted(shown) == public_names()


class Page(html.parser.HTMLParser):
    """Links and loaded files of a page; `content` are the links outside of the sidebar."""

    def __init__(self, path):
        super().__init__()
        self.ids, self.links, self.content, self.loaded, self._article = set(), [], [], [], 0
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        self.ids |= {given[key] for key in ("id", "name") if given.get(key)}
        self._article += tag == "article"
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
            if self._article:
                self.content.append(given["href"])
        if tag == "link" and given.get("rel") in ("stylesheet", "icon", "preload"):
            self.loaded.append(given["href"])
        if tag in ("script", "img", "iframe", "source") and given.get("src"):
            self.loaded.append(given["src"])

    def handle_endtag(self, tag):
        self._article -= tag == "article"


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The site, without running its notebooks and its gallery."""
    for name in ("sphinx", "myst_nb", "furo", "sphinx_gallery", "sphinxcontrib.katex", "sphinxcontrib.bibtex"):
        pytest.importorskip(name)
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-n", "-q", "-E", ROOT / "docs", folder]
    done = subprocess.run([str(part) for part in command], env={**os.environ, "POLHODE_DOCS_RUN": "0"},
                          capture_output=True, text=True, check=False, timeout=900)
    assert done.returncode == 0 and "WARNING" not in done.stderr, done.stderr
    return {path.relative_to(folder).as_posix(): Page(path) for path in folder.rglob("*.html")
            if "_static" not in path.parts}, folder


def resolve(name, link):
    """The page and the anchor of a link on a page, None for one that leads out."""
    parts = urllib.parse.urlsplit(link)
    if parts.scheme or parts.netloc:
        return None
    path = os.path.join(os.path.dirname(name), urllib.parse.unquote(parts.path)) if parts.path else name
    return os.path.normpath(path), urllib.parse.unquote(parts.fragment)


def test_links_lead_somewhere(site):
    pages, folder = site
    wrong = []
    for name, page in pages.items():
        for target in filter(None, (resolve(name, link) for link in [*page.links, *page.loaded])):
            path, anchor = target
            if not (folder / path).exists():
                wrong.append(f"{name}: no {path}")
            elif anchor and path in pages and anchor not in pages[path].ids:
                wrong.append(f"{name}: no {path}#{anchor}")
    assert len(pages) > 100 and not sorted(set(wrong))


def test_nothing_is_loaded_from_a_network(site):
    pages, folder = site
    assert not [(name, link) for name, page in pages.items() for link in page.loaded if not resolve(name, link)]
    styles = [path.read_text(encoding="utf-8") for path in (folder / "_static").rglob("*.css")]
    assert len(styles) > 3 and not [url for text in styles for url in re.findall(r"url\(['\"]?(https?:[^)]*)", text)]


def test_every_page_is_two_clicks_away(site):
    pages, _ = site
    reached = ahead = {"index.html"}
    for _ in range(2):
        ahead = {target[0] for name in ahead for link in pages[name].content
                 if (target := resolve(name, link)) and target[0] in pages} - reached
        reached = reached | ahead
    own = {"genindex.html", "search.html", "py-modindex.html"}
    assert not sorted(set(pages) - reached - own)


def test_formulas_are_rendered_when_the_site_is_built(site):
    _, folder = site
    text = (folder / "theory/jacobi_theta.html").read_text(encoding="utf-8")
    assert text.count('class="katex-display"') > 25 and "katex-error" not in text
    errors = [path.name for path in folder.rglob("*.html") if "katex-error" in path.read_text(encoding="utf-8")]
    assert not errors and not re.search(r"<script[^>]*(mathjax|katex)", text, flags=re.I)


def test_lists_of_the_reference_are_whole(site):
    _, folder = site
    for page, names in (("methods", [r["name"] for r in ph.methods()]), ("shapes", ph.shapes.__all__[:-2]),
                        ("torques", [r["key"] for r in ph.torques.records()])):
        text = (folder / f"reference/{page}.html").read_text(encoding="utf-8")
        assert not [name for name in names if f">{name}<" not in text and f"{name}&quot;" not in text], page


FIRST = """(() => {   // what the first screen shows
  const box = document.querySelector('.turning').getBoundingClientRect();
  const stills = [...document.querySelectorAll('.turning img')];
  return [box.top, box.bottom, stills.filter(image => image.naturalWidth > 0).length,
          document.querySelectorAll('.doors a').length, document.documentElement.scrollWidth];
})()"""


@pytest.mark.skipif(browser.find() is None, reason="no Chromium: apt install chromium")
def test_the_first_picture_is_on_the_first_screen(site, tmp_path):
    _, folder = site
    with browser.Browser((folder / "index.html").as_uri(), 1400, 900) as tab:
        tab.wait("document.readyState === 'complete'")
        for width in (1400, 390):
            for theme in ("light", "dark"):
                tab.ask("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1,
                        mobile=width < 600)
                tab.run(f"document.body.dataset.theme = '{theme}'")
                top, bottom, stills, doors, wide = tab.run(FIRST)
                assert 0 < top < bottom <= 900 and stills >= 1 and doors == 3 and wide <= width, (width, theme)
                tab.picture(tmp_path / f"index-{theme}-{width}.png", whole=False)
        assert tab.errors == [] and [url for url in tab.requests if not url.startswith(("file:", "data:"))] == []
    assert (folder / "_static/film.html").exists()
