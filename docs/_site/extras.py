"""Pages beside the site's own: the film of the first page, and the playground where it is built."""

import shutil
from pathlib import Path
from typing import Any

import polhode as ph

from .links import ROOT

PLAYGROUND = ROOT / "build/web/playground.html"


def make_film() -> Any:
    """Return the film of the first page: the racket of its example, from one flip to the next but one."""
    block = ph.shapes.box(12.0, (0.3, 0.2, 0.1))
    racket = ph.FreeMotion(block.inertia, omega=(0.01, 5, 0.01))
    return racket.animate(2 * racket.period, title="A block, thrown about its middle axis")


def playground() -> str:
    """Return the frame of the playground and a link to it, or how to build it."""
    shown = ""
    if (ROOT / "docs/pictures/playground.png").exists():   # by tests/support/film_stills.py
        shown = ("\n\n![The playground: a turning body beside its ellipsoid, and a chart of errors]"
                 "(pictures/playground.png)")
    if not PLAYGROUND.exists():
        return f"This copy of the site was built without the playground. `make web` builds it.{shown}"
    return ('<p><a class="reference external" href="_static/playground.html"><strong>Open the playground</strong></a>, '
            "alone on its page.</p>\n\n"
            '<iframe class="playground" src="_static/playground.html" title="The playground" loading="lazy"></iframe>'
            + shown)


def write(app: Any, exception: Exception | None) -> None:
    """Write both into the folder of static files."""
    if exception is None and app.builder.format == "html":
        static = Path(app.outdir) / "_static"
        make_film().save(static / "film.html")
        if PLAYGROUND.exists():
            shutil.copyfile(PLAYGROUND, static / "playground.html")


def changed(app: Any, env: Any, added: Any, changed: Any, removed: Any) -> list[str]:
    """Return the page that depends on a file outside of this folder."""
    return ["playground"] if "playground" in env.found_docs else []
