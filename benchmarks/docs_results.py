"""Brings the results of a chart into the documents, so that no number in them is written by hand.

    polhode chart scenes/*.toml -o results --budget 240s && python benchmarks/docs_results.py results

Writes docs/results/charts.json (every point, to three digits), docs/results/charts.md (tables made from that file) and
the pictures docs/pictures/overview.svg, limits.svg and those of some scenes. The charts of a report (its folder
`charts`) serve too. `--tables` makes the tables anew from the file that is there.
"""

import json
import pathlib
import re
import shutil
import sys

from polhode.report import tables

ROOT = pathlib.Path(__file__).parents[1]
RESULTS, PICTURES = ROOT / "docs/results", ROOT / "docs/pictures"
SCENES = ("S1", "S5")   # whose own chart is shown


def page(content):
    """The tables of docs/results/charts.md, all from the results file."""
    machine = content["machine"]
    versions = ", ".join(f"{name} {version}" for name, version in content["versions"].items())
    parts = [
        "# Results of the charts",
        "Made by `polhode chart` and `python benchmarks/docs_results.py`; every number is from "
        "[charts.json](charts.json).",
        f"{machine['processor']}, {machine['cores']} cores, compiler {content['polhode']['compiler']}, simd "
        f"{content['polhode']['simd']}, "
        f"Python {machine['python']}. {versions}.",
        "What is measured:",
        "\n".join(f"- {part}" for part in content["measure"].split("; ")),
        tables.how_they_ran(content),
        "## The fastest at each error",
        "`never`: every setting ran, and none reached the error. `not in the budget`: none of those that ran reached "
        "it, and the budget of time left some out.",
        tables.markdown(tables.winners(content)),
        "## The smallest error of each",
        "`stopped at` names the tightest setting that ran, where the budget of time left out tighter ones. The program "
        "may reach a smaller error there.",
        tables.markdown(tables.best(content)),
        "## Start-up",
        tables.markdown(tables.startups(content)),
        "## Findings",
        "\n".join(f"- **{scene['name']} {scene['title']}**: {scene['finding']}." for scene in content["scenes"]),
    ]
    return "\n\n".join(part.strip() for part in parts) + "\n"


def main(arguments):
    if arguments != ["--tables"]:
        folder = pathlib.Path(arguments[0])
        RESULTS.mkdir(exist_ok=True)
        content = tables.compact(json.loads((folder / "results.json").read_text()))
        text = json.dumps(content, separators=(",", ":"))
        text = re.sub(r"(\{\"candidate\")", r"\n\1", text)   # a point a line, so that changes can be read
        (RESULTS / "charts.json").write_text(text + "\n")
        for name in ("which_method", "overview", "limits", *SCENES):
            if (folder / f"{name}.svg").is_file():
                shutil.copy(folder / f"{name}.svg", PICTURES / f"{name}.svg")
    (RESULTS / "charts.md").write_text(page(json.loads((RESULTS / "charts.json").read_text())))


if __name__ == "__main__":
    main(sys.argv[1:])
