"""The atlas as a Markdown page: the matrix and every picture, made from the results."""

from __future__ import annotations

from typing import Any

SYMBOLS = {"holds": "●", "degrades": "◐", "fails": "✕", "unknown": "?", "none": ""}


def _escaped(text: str) -> str:
    return text.replace("|", "\\|")


def _matrix(content: dict[str, Any]) -> list[str]:
    families = list(content["families"])
    lines = ["| | " + " | ".join(f"[{name}](#{name})" for name in families) + " |",
             "|---" * (len(families) + 1) + "|"]
    for name, row in content["matrix"].items():
        cells = [f"{SYMBOLS[row[f]['level']]} {row[f]['text']}".strip() for f in families]
        lines.append(f"| **{name}** | " + " | ".join(cells) + " |")
    return lines


def _listed(content: dict[str, Any], family: str, level: str) -> str:
    names = [name for name, row in content["matrix"].items() if row[family]["level"] == level]
    return ", ".join(names) if names else "none"


def costs(seconds: dict[str, float]) -> str:
    """Return the CPU time of a family's rows, and the three longest."""
    costliest = [f"{name} {spent:.0f} s" for name, spent in seconds.items() if spent >= 1][:3]
    return f"{sum(seconds.values()):.0f} s of CPU{', of them ' if costliest else ''}{', '.join(costliest)}"


def page(content: dict[str, Any], pictures: str = "", introduction: str = "") -> str:
    """Return Markdown.

    Parameters
    ----------
    content : dict
        The content of atlas.json.
    pictures : str
        Where the pictures are, as a prefix of their names.
    introduction : str
        The text before the matrix.
    """
    machine = content["machine"]
    whole = "" if not content["quick"] else " --quick"
    lines = ["# Where methods fail", "", introduction.strip(), ""] if introduction else ["# Where methods fail", ""]
    lines += [f"![Methods against families: what holds, what degrades, what fails]({pictures}matrix.svg)", "",
              f"`polhode atlas{whole}`, polhode {content['polhode']['version']}, {machine['processor']}, "
              f"{content['made']}; {content['cpu_seconds']:.0f} s of CPU time.", "",
              "● holds, ◐ degrades, ✕ fails, ? too slow to be known, empty: does not apply.", "", *_matrix(content), "",
              "| column | each cell states |", "|---|---|",
              *(f"| {name} | {_escaped(family['number'])} |" for name, family in content["families"].items()), ""]
    for name, family in content["families"].items():
        lines += [f"## {name}", "", f"**{family['title']}.** {family['about']}", "",
                  f"![{family['title']}]({pictures}{name}.svg)", "",
                  f"Swept: {family['sweeps']}. Truth: {family['truth']}. "
                  f"`polhode atlas {name}{whole}` makes it again: {costs(family['cpu_seconds'])}.", "",
                  "| | threshold | who |", "|---|---|---|",
                  f"| ● holds | {_escaped(family['holds'])} | {_listed(content, name, 'holds')} |",
                  f"| ◐ degrades | {_escaped(family['degrades'])} | {_listed(content, name, 'degrades')} |",
                  f"| ✕ fails | | {_listed(content, name, 'fails')} |", ""]
    return "\n".join(lines).rstrip() + "\n"
