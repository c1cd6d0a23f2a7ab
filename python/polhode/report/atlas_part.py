"""What the page shows of an atlas: its matrix as a table, its pictures with the command that makes each again."""

from __future__ import annotations

import pathlib
from typing import Any, NamedTuple

from .. import _files
from . import page

SIGNS = {"holds": "●", "degrades": "◐", "fails": "✕", "unknown": "?", "none": "·"}


class Cell(NamedTuple):
    """A cell of the matrix: its sign and words, its level as a class, and the reason to be read on hovering."""

    text: str
    level: str
    why: str


def matrix(content: dict[str, Any]) -> tuple[list[str], list[tuple[str, list[Cell]]]]:
    """Return the families and, for each method, its cells; what a row does not have does not apply."""
    families = list(content["families"])
    nothing = {"level": "none", "text": "", "why": ""}
    rows = [(name, [_cell(row.get(family, nothing)) for family in families]) for name, row in content["matrix"].items()]
    return families, rows


def _cell(verdict: dict[str, Any]) -> Cell:
    level = verdict["level"]
    return Cell(f"{SIGNS.get(level, '')} {verdict['text']}".strip(), level, verdict["why"] or level)


def part(content: dict[str, Any], folder: pathlib.Path, options: str = "") -> dict[str, Any]:
    """Return what the template needs, from what stands in atlas.json and the pictures beside it."""
    pictures = []
    for name, family in content["families"].items():
        path = folder / f"{name}.svg"
        if path.is_file():
            pictures.append(page.picture(path, family["title"], f"{family['title']}.",
                                         f"polhode atlas {name}{options}"))
    said = "; ".join(f"{name}: {family['number']}"
                     for name, family in content["families"].items() if "number" in family)
    return {"matrix": matrix(content), "said": said, "pictures": pictures, "command": f"polhode atlas{options}",
            "broken": content.get("broken_claims", [])}


def write(content: dict[str, Any], folder: pathlib.Path) -> pathlib.Path:
    """Write the page of an atlas beside its pictures: index.html, which opens from disk."""
    options = " --quick" if content["quick"] else ""
    count = len(content["families"])
    lead = (f"{count} famil{'ies' if count != 1 else 'y'} of hard problems, polhode {content['polhode']['version']}, "
            f"{content['machine']['processor']}, {content['made']}.")
    path = folder / "index.html"
    _files.write(path, page.render_atlas(part(content, folder, options), lead), follow=False)
    return path
