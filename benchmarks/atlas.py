"""The docs' copy of the atlas: `polhode atlas -o DIR`, then `python benchmarks/atlas.py DIR`.

Copies the matrix's numbers to benchmarks/results, the pictures to docs/pictures/atlas, and writes
docs/results/atlas.md from them. Without a folder the stored numbers stay, and the sentences about the families are
taken anew from the package.
"""

import json
import pathlib
import re
import shutil
import sys

from polhode.atlas.families import FAMILIES
from polhode.atlas.page import page

DOCS = pathlib.Path(__file__).parents[1] / "docs"
RESULTS, PICTURES = DOCS.parent / "benchmarks/results/atlas.json", DOCS / "pictures/atlas"
PAGE = DOCS / "results/atlas.md"
INTRODUCTION = """
`polhode atlas` and `python benchmarks/atlas.py` make this page.
[The atlas](../atlas.md) explains the settings and the verdicts.
"""


def render(content: dict) -> str:
    """Return docs/results/atlas.md."""
    return page(content, "../pictures/atlas/", INTRODUCTION)


def reword() -> None:
    """Give the stored results the sentences that the families have now."""
    content = json.loads(RESULTS.read_text())
    for family in FAMILIES:
        content["families"][family.name]["about"] = family.about
    RESULTS.write_text(json.dumps(content, indent=1, allow_nan=False) + "\n")
    PAGE.write_text(render(content))


def main() -> None:
    if len(sys.argv) == 1:
        return reword()
    folder = pathlib.Path(sys.argv[1])
    content = json.loads((folder / "atlas.json").read_text())
    RESULTS.parent.mkdir(exist_ok=True)
    PICTURES.mkdir(exist_ok=True)
    shutil.copy(folder / "atlas.json", RESULTS)
    for name in ["matrix", *content["families"]]:
        text = (folder / f"{name}.svg").read_text()
        # Half a thousandth of a point is enough for a line.
        text = re.sub(r"(\d+\.\d{2})\d+", r"\1", text)
        (PICTURES / f"{name}.svg").write_text(re.sub(r"[ \t]+\n", "\n", text))
    PAGE.write_text(render(content))


if __name__ == "__main__":
    main()
