"""Screenshots of the site, light and dark, wide and narrow, by a headless Chromium without a network.

    python tests/support/site_pictures.py build/site build/site-pictures

A page must load nothing from outside of the folder, run without an error, and be no wider than the window.
"""

from __future__ import annotations

import sys
from pathlib import Path

from browser import Browser

PAGES = ("index", "playground", "evidence/index", "tutorials/racket", "theory/jacobi_theta", "which_method")
WIDTHS = (1400, 390)


def take(site: Path, page: str, width: int, theme: str, folder: Path) -> list[str]:
    """Write one screenshot, and return what is wrong with the page."""
    url = (site / f"{page}.html").resolve().as_uri()
    with Browser(url, width=width, height=900, phone=width < 600) as browser:
        browser.wait("document.readyState === 'complete'")
        browser.run(f"localStorage.setItem('theme', '{theme}'); document.body.dataset.theme = '{theme}'")
        browser.wait("[...document.images].every(image => image.loading === 'lazy' || image.complete)")
        browser.picture(folder / f"{page.replace('/', '-')}-{theme}-{width}.png", whole=False)
        seen = browser.run("document.documentElement.scrollWidth")
        outside = [asked for asked in browser.requests if not asked.startswith(("file:", "data:", "about:"))]
        wrong = [f"asks for {asked}" for asked in outside] + browser.errors
        return wrong + ([f"is {seen} pixels wide in a window of {width}"] if seen > width else [])


def search(site: Path, word: str) -> int:
    """Return how many pages the site's own search finds, from the disk."""
    with Browser((site / "search.html").resolve().as_uri() + f"?q={word}") as browser:
        browser.wait("document.querySelector('#search-results p')?.textContent.includes('found')")
        return browser.run("document.querySelectorAll('#search-results li').length")


def main(site: str, folder: str) -> int:
    """Take all screenshots; 1 if a page is wrong, or the search finds nothing."""
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    status = int(search(Path(site), "separatrix") < 3)
    if status:
        print("the search finds nothing")
    for page in PAGES:
        for width in WIDTHS:
            for theme in ("light", "dark"):
                for text in take(Path(site), page, width, theme, target):
                    print(f"{page}, {theme}, {width} pixels: {text}")
                    status = 1
    return status


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
