"""What the site needs beside its pages: citations from plain links, lists made from the code, KaTeX, films."""

import os
from typing import Any

from . import answers, extras, links, lists, style
from .formulas import katex_at_hand as katex_at_hand


def reset_matplotlib(gallery_conf: dict[str, Any], name: str) -> None:
    """Give each example of the gallery the site's settings of pictures, for sphinx-gallery."""
    import matplotlib

    matplotlib.use("agg")
    matplotlib.rc_file(os.environ["MATPLOTLIBRC"])


def read(app: Any, docname: str, source: list[str]) -> None:
    """Rewrite a page's text before it is parsed."""
    if not docname.startswith("auto_gallery"):
        source[0] = lists.fill(links.rewrite(source[0], docname), docname)


def setup(app: Any) -> dict[str, Any]:
    """Connect all of it to Sphinx."""
    style.register()
    answers.setup(app)
    app.connect("source-read", read)
    app.connect("env-get-outdated", extras.changed)
    app.connect("build-finished", extras.write)
    return {"parallel_read_safe": True}
