"""The docs' copy of the atlas: `polhode atlas -o DIR`, then `python benchmarks/atlas.py DIR`.

Copies the matrix's numbers to benchmarks/results, the pictures to docs/pictures/atlas, and writes docs/atlas.md from
them.
"""

import json
import pathlib
import re
import shutil
import sys

from polhode.atlas.page import page

DOCS = pathlib.Path(__file__).parents[1] / "docs"
RESULTS, PICTURES, PAGE = DOCS.parent / "benchmarks/results/atlas.json", DOCS / "pictures/atlas", DOCS / "atlas.md"
INTRODUCTION = """
```
polhode atlas --quick              # under a minute on two cores: every family, fewer values of what is swept
polhode atlas -o atlas             # the whole: some minutes on two cores
polhode atlas racket damping       # some families
```

Every way to turn a body that polhode has (what `solve` chooses by itself, the closed forms, each method of `polhode
methods` and Lagrange's equations in Euler angles) meets families of problems that are hard for a reason. Each family
sweeps one thing, holds the answers against a truth from outside, and gives everyone a verdict by a threshold that is
stated. Game and robot engines take some of these steps by default; they are here to be compared with, and no plan ever
chooses one.

**Settings.** Methods with a fixed step take 40 a turn unless the step is what is swept; methods that choose their steps
get a tolerance of 1e-14, and `solve` an accuracy of 1e-9, unless the tolerance is swept. Lower settings cost less and
reach less: [charts.md](charts.md) has both axes.

**Failures are points.** The work is done in processes that may die without harm. A run that bursts, returns NaN,
raises, crashes or hangs stands in the table with the reason, and the others go on. A run that does not end in its time
(`--limit`, 60 seconds of CPU for each), or would not, judged from shorter ones by a power law, is left out: that says
nothing about the method but what it costs. What every row cost stands in the results; dear families go first, so that
all cores end together.

**Files.** The folder (`-o`) gets a picture and a `.json` with every point of a family, the matrix, `atlas.json` with
machine and versions, and this page as `atlas.md`. Families that are finished there are kept when the command is run
again, so a long run can be stopped; `--fresh` runs them anew. In Python: `polhode.atlas.atlas(families, folder)`.

**Exit status.** 0: what polhode says of its own methods holds; those claims are tests too
([claims.py](../python/polhode/atlas/claims.py)). 1: one does not, and a line says which. 2: bad input.

A family is a file in `python/polhode/atlas/families` and a line in its list; a method joins by its record.
"""


def render(content: dict) -> str:
    """Return docs/atlas.md."""
    return page(content, "pictures/atlas/", INTRODUCTION)


def main() -> None:
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
