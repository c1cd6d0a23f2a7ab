"""A page about an ensemble: what was drawn, what became of it, and the spread of each quantity against time."""

from __future__ import annotations

import html
import io
import json
from typing import Any

import numpy as np

from .._core import __version__
from .._plot import style
from .ensemble import Ensemble
from .picture import draw

MOST_POINTS = 12
CSS = """body{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#1d2733;background:#fff}
table{border-collapse:collapse}td,th{padding:.2em 1em .2em 0;text-align:left;border-bottom:1px solid #e4e8ec}
figure{margin:2em 0}svg{max-width:100%;height:auto}pre{background:#f4f6f8;padding:1em;overflow:auto}"""


def picture(run: Ensemble, name: str, point: int = 0) -> str:
    """Return the spread of a quantity against time as SVG."""
    held = io.StringIO()
    figure = draw(run, (name,), point)
    with style.settings():
        figure.savefig(held, format="svg", metadata={"Date": None})
    return held.getvalue()[held.getvalue().index("<svg"):]


def _table(rows: dict[str, Any]) -> str:
    cells = "".join(f"<tr><th>{html.escape(str(key))}</th><td>{html.escape(str(value))}</td></tr>"
                    for key, value in rows.items())
    return f"<table>{cells}</table>"


def page(run: Ensemble) -> str:
    """Return the page as HTML. It needs no network."""
    recipe = run._recipe
    title = html.escape(recipe.title)
    counts = {"bodies that are done": f"{run.done} of {run.total}", **{
        key.replace("_", " "): f"{value:.3g}" if isinstance(value, float) else value
        for key, value in run.counts.items() if key != "bodies"}}
    if not np.isnan(run.certified):
        counts["share certified"] = f"{100 * run.certified:.4g} %"
    parts = [f"<h1>{title}</h1>", f"<p>{html.escape(str(recipe.raw.get('about', '')))}</p>", "<h2>Bodies</h2>",
             _table(counts)]
    shown = run.points[:MOST_POINTS]
    for index, settings in enumerate(shown):
        if settings:
            parts.append(f"<h2>{html.escape(', '.join(f'{key} = {value}' for key, value in settings.items()))}</h2>")
        else:
            parts.append("<h2>Spread against time</h2>")
        parts += [f"<figure>{picture(run, name, index)}<figcaption>{html.escape(name)}</figcaption></figure>"
                  for name in run.summary]
    if len(run.points) > len(shown):
        parts.append(f"<p>{len(run.points) - len(shown)} more points of the sweep are not shown.</p>")
    parts += ["<h2>Recipe</h2>", f"<pre>{html.escape(json.dumps(recipe.raw, indent=1))}</pre>",
              _table({"polhode": __version__, "hash of the recipe": recipe.hash})]
    return (f"<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><title>{title}</title><style>{CSS}</style>"
            f"</head><body>{''.join(parts)}</body></html>\n")
