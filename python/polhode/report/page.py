"""The page itself: what was measured, through one template."""

from __future__ import annotations

import base64
import json
import pathlib
import re
from importlib import resources
from typing import Any, NamedTuple

from .._core import InvalidInput
from .._plot.text import to_time
from . import curves, tables

TYPES = {".svg": "image/svg+xml", ".png": "image/png"}
BROAD = 600   # points


class Picture(NamedTuple):
    """A picture inside the page, and the command that makes it again."""

    data: str
    alt: str
    caption: str
    command: str
    broad: bool   # of several panels side by side, which a phone shows a part of


def picture(path: pathlib.Path, alt: str, caption: str = "", command: str = "") -> Picture:
    """Read a picture into a data address."""
    content = path.read_bytes()
    if path.suffix == ".svg":
        width = re.search(rb'<svg[^>]* width="([\d.]+)pt"', content)
        points = float(width[1]) if width else 0.0
    else:
        points = int.from_bytes(content[16:20]) / 2   # of a PNG
    data = base64.b64encode(content).decode("ascii")
    return Picture(f"data:{TYPES[path.suffix]};base64,{data}", alt, caption, command, points > BROAD)


def _text(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def _template(name: str) -> Any:
    """Return a template; includes and macros stand in the same folder."""
    try:
        from jinja2 import Environment, FunctionLoader, StrictUndefined
    except ImportError:
        raise InvalidInput("report: needs jinja2: pip install 'polhode[cli]'") from None
    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
                              loader=FunctionLoader(_text))
    return environment.get_template(name)


def render_atlas(atlas: dict[str, Any], lead: str) -> str:
    """Return the page of an atlas alone, from what `atlas_part.part` gives."""
    template = _template("atlas.html.j2")
    from markupsafe import Markup

    return str(template.render(title="polhode: where methods fail", lead=lead, css=Markup(_text("page.css")),
                               atlas=atlas))


def _in_script(content: Any) -> str:
    """JSON that cannot end the script element it stands in."""
    return json.dumps(content, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


def _kept_together(table: tuple[tables.Row, list[tables.Row]]) -> tuple[tables.Row, list[tables.Row]]:
    """No line may end between a number and its unit."""
    return table[0], [[re.sub(r" (?=[mµn]?s$)", "\u00a0", cell) for cell in row] for row in table[1]]


def render(
    content: dict[str, Any],
    folder: pathlib.Path,
    *,
    motions: list[Picture],
    atlas: dict[str, Any] | None,
    command: str,
    seconds: float,
) -> str:
    """Return the page.

    Parameters
    ----------
    content : dict
        What stands in results.json of a chart.
    folder : path
        Where that chart's pictures are.
    motions : list of Picture
    atlas : dict, optional
        matrix (head, rows), pictures, command.
    command : str
        That makes the page again.
    seconds : float
        It took to make.
    """
    template = _template("page.html.j2")
    from markupsafe import Markup

    all_names = " ".join(scene["name"] for scene in content["scenes"])
    command_of_all = f"polhode chart {all_names}"
    overview = [picture(folder / "overview.svg", "time against error, a small chart a scene", "All scenes.",
                        command_of_all)]
    if (folder / "which_method.svg").is_file():   # first: it answers what most people ask
        overview.insert(0, picture(folder / "which_method.svg", "the fastest method at each error, a row a scene",
                                   "Which method for my scene, and how fast.", command_of_all))
    if (folder / "limits.svg").is_file():
        overview.append(picture(folder / "limits.svg", "where no tolerance helps", "Where no tolerance helps.",
                                command_of_all))
    scenes = [{**scene, "command": f"polhode chart {scene['name']}",
               "picture": picture(folder / f"{scene['name'] or 'scene'}.svg", scene["finding"])}
              for scene in content["scenes"]]
    sections = [("speed", "Speed against accuracy"), ("scenes", "Scene by scene")]
    sections += [("atlas", "Where methods fail")] * bool(atlas) + [("motion", "The motions")] * bool(motions)
    sections += [("machine", "Machine and versions")]
    count = sum(point["status"] == "answered" for scene in content["scenes"] for point in scene["points"])
    lead = (f"{count} results on {len(content['scenes'])} scenes, each compared with a reference of more digits. "
            "Errors and times are from one run on one machine.")
    return str(template.render(
        title="polhode: speed, accuracy, and where methods fail" if atlas else "polhode: speed and accuracy", lead=lead,
        css=Markup(_text("page.css")), script=Markup(_text("page.js")), sections=sections, overview=overview,
        winners=_kept_together(tables.winners(content)), scenes=scenes, scene_table=tables.scenes(content),
        best=tables.best(content),
        failures=tables.failures(content), atlas=atlas, motions=motions, machine=tables.machine(content),
        startups=tables.startups(content), measure=content["measure"], took=to_time(seconds), command=command,
        figures=Markup(_in_script([curves.figure(scene) for scene in content["scenes"]]))))
