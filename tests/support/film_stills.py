"""The stills of the first page and of README, from the film of the site, and the picture of the playground.

    python tests/support/film_stills.py      # docs/pictures/turning_light.png, turning_dark.png and playground.png

It takes a Chromium with WebGL. The playground's picture is made where `make web` has built the page.
"""

import sys
import tempfile
from pathlib import Path

from browser import Browser

ROOT = Path(__file__).parents[2]
PICTURES = ROOT / "docs/pictures"
sys.path.insert(0, str(ROOT / "docs"))
WIDTH, HEIGHT, INSTANT = 736, 368, 3.55   # of the first page, in its pixels, and the time in the film [s]


def still(page, theme, path):
    """Write a picture of a film within a page, two dots a pixel."""
    with Browser(f"{page.as_uri()}#t={INSTANT}&within&theme={theme}", WIDTH, HEIGHT) as tab:
        tab.ask("Emulation.setDeviceMetricsOverride", width=WIDTH, height=HEIGHT, deviceScaleFactor=2, mobile=False)
        tab.wait("document.body && document.body.dataset.drawn")
        tab.run("window.dispatchEvent(new Event('resize'))")
        tab.picture(path, whole=False)


def main():
    from _site.extras import PLAYGROUND, make_film

    with tempfile.TemporaryDirectory() as folder:
        page = make_film().save(Path(folder) / "film.html")
        for theme in ("light", "dark"):
            still(page, theme, PICTURES / f"turning_{theme}.png")
    if PLAYGROUND.exists():
        with Browser(PLAYGROUND.as_uri(), 1280, 900) as tab:
            tab.wait("document.body && document.body.dataset.ready === 'yes'")
            tab.wait("document.getElementById('other').textContent !== ''")
            tab.run("document.getElementById('play').click(), document.getElementById('time').value = 0.13, "
                    "document.getElementById('time').dispatchEvent(new Event('input'))")
            tab.run("new Promise(done => setTimeout(done, 400))")
            tab.picture(PICTURES / "playground.png", whole=False)


if __name__ == "__main__":
    main()
