"""Links of the pages, which are written to be read as plain Markdown, too."""

import os
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
CITE = re.compile(r"(\()?\[([^\]]+)\]\((?:\.\./)*bibliography\.md#(\w+)\)(?(1)(?P<close>\))?)")
LINK = re.compile(r"\]\(((?![a-z]+:)[^)#\s]+)(#[^)\s]+)?\)")

# Files outside of this folder, and the pages of the site that show them.
SHOWN = {"CONTRIBUTING.md": "about/contributing.md", "SECURITY.md": "about/security.md",
         "CHANGELOG.md": "about/changelog.md", "README.md": "index.md", "examples": "auto_gallery/index.rst",
         "scenes/reference/README.md": "evidence/truth.md"}


def to_cite(found: re.Match[str]) -> str:
    """Return a citation for a link into the bibliography."""
    opened, text, key = found[1], found[2], found[3]
    cite = f"{{cite:p}}`{key}`"
    if text == key:
        return cite if found["close"] or not opened else f"({cite}"
    return f"{opened or ''}{text} {cite}{found['close'] or ''}"


def rewrite(text: str, docname: str, folder: str | None = None) -> str:
    """Return a page's text with citations, and with links that lead within the site.

    `folder` is where the text itself stands, from the top of the repository; by default it is the page's.
    """
    here = os.path.join("docs", os.path.dirname(docname))
    folder = here if folder is None else folder

    def to_page(found: re.Match[str]) -> str:
        path = os.path.normpath(os.path.join(folder, found[1]))
        if path in SHOWN:
            path = f"docs/{SHOWN[path]}"
        elif folder == here or not (ROOT / path).exists():
            return found[0]
        return f"]({os.path.relpath(path, here)}{found[2] or ''})"

    return LINK.sub(to_page, CITE.sub(to_cite, text))
