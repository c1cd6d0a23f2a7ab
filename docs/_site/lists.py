"""Tables of the reference, made from the code's own lists, and texts from outside of this folder.

A page has `<!-- list: methods -->` where a table belongs, and `<!-- include: README.md to "a text" -->` for a text.
In a list of pages, `<!-- page: ../playground -->` stands for one that is listed as soon as it exists.
"""

import json
import re
from collections.abc import Callable, Iterable
from typing import Any

import polhode as ph

from .extras import playground
from .links import ROOT, rewrite

MARK = re.compile(r"^<!-- (list|include|page): ([\w./-]+)(?: to \"([^\"]+)\")? -->$", flags=re.MULTILINE)


def table(head: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """Return a table in Markdown."""
    head = list(head)
    cells = [[str(cell).replace("|", "\\|").replace("\n", " ") for cell in row] for row in rows]
    return "\n".join("| " + " | ".join(row) + " |" for row in [head, ["---"] * len(head), *cells])


def code(text: object) -> str:
    """Return a word as code, nothing for nothing."""
    return f"`{text}`" if text not in ("", None) else ""


def methods() -> str:
    """Return the records of the methods, those of engines apart."""
    def rows(comparison: bool) -> Any:
        for r in ph.methods():
            if r["comparison"] == comparison:
                yield (code(r["name"]), r["order"], r["driven_order"], r["dense_order"],
                       "tolerance" if r["adaptive"] else "`step=`", "yes" if r["implicit"] else "no", r["keeps"])

    def about(comparison: bool) -> str:
        return "\n\n".join(
            f"{code(r['name'])}\n: {r['doc']}" + (f" Needs: {r['needs']}." if r["needs"] else "") + f" *{r['source']}.*"
            for r in ph.methods() if r["comparison"] == comparison)

    head = ("method", "order", "with a torque", "between steps", "steps by", "implicit", "keeps")
    return (f"{table(head, rows(False))}\n\n{about(False)}\n\n## Steps for comparison\n\n"
            "Steps of game and robot engines. Charts and the atlas run them. A plan never chooses them.\n\n"
            f"{table(head, rows(True))}\n\n{about(True)}")


def models() -> str:
    """Return the closed forms."""
    return table(("model", "what it is", "source"),
                 ((code(form["name"]), form["doc"], form["source"]) for form in ph._core.closed_forms()))


def torques() -> str:
    """Return the records of the torques, each with its parameters."""
    parts = []
    for r in ph.torques.records():
        rows = ((code(p["name"]), p["kind"], p["unit"], p["doc"] + "".join(f", `{c}`" for c in p["choices"]),
                 "required" if p["default"] is None else code(p["default"])) for p in r["parameters"])
        parts.append(f"## {r['name']}\n\nIn a file: `kind = \"{r['key']}\"`. {r['doc']}\n\n"
                     f"{table(('parameter', 'type', 'unit', 'meaning', 'default'), rows)}\n\n"
                     + (f"Source: {r['source']}." if r["source"] else ""))
    return "\n\n".join(parts)


def commands() -> str:
    """Return every command with its arguments and options."""
    import typer

    from polhode.cli.app import app

    parts = []
    for name, command in typer.main.get_command(app).commands.items():
        rows = []
        for p in command.params:
            option = p.param_type_name == "option"
            names = ", ".join(code(o) for o in (*p.opts, *p.secondary_opts)) if option else code(p.name.upper())
            default = p.default if option and p.default not in (None, False, ()) else ""
            rows.append((names, getattr(p, "help", "") or "", code(default)))
        parts.append(f"## polhode {name}\n\n{command.help}\n\n{table(('name', 'meaning', 'default'), rows)}")
    return "\n\n".join(parts)


def plural(words: str) -> str:
    """Return a type in the plural."""
    return " or ".join(re.sub(r"^(number|string|integer|boolean|list|table)\b", r"\1s", part)
                       for part in words.split(" or "))


def to_type(schema: dict[str, Any]) -> str:
    """Return the type of a key, from its JSON Schema, in words."""
    if "const" in schema:
        return json.dumps(schema["const"])
    if "enum" in schema:
        return " or ".join(json.dumps(value) for value in schema["enum"])
    if "$ref" in schema:
        return "table " + schema["$ref"].rpartition("/")[2]
    several = schema.get("anyOf") or schema.get("oneOf")
    if several:
        return " or ".join(dict.fromkeys(to_type(one) for one in several if one.get("type") != "null"))
    if schema.get("type") == "array":
        least, most = schema.get("minItems"), schema.get("maxItems")
        count = f"{most} " if least == most and most else ""
        return f"list of {count}{plural(to_type(schema.get('items', {})))}"
    bounds = [f"{sign} {schema[key]}" for key, sign in
              (("minimum", ">="), ("exclusiveMinimum", ">"), ("maximum", "<=")) if key in schema]
    return " ".join([schema.get("type", "any"), *bounds])


def keys(model: Any) -> str:
    """Return the tables of a file's keys, from the schema that checks the file."""
    schema = model.model_json_schema()
    parts = []
    for title, part in {"The file": schema, **schema.get("$defs", {})}.items():
        required = part.get("required", [])
        rows = ((code(name), to_type(one), "required" if name in required else
                 "" if one.get("default") is None else code(json.dumps(one["default"])))
                for name, one in part.get("properties", {}).items())
        parts.append(f"### {title}\n\n{table(('key', 'type', 'default'), rows)}")
    return "\n\n".join(parts)


def scene_keys() -> str:
    """Return the keys of scene files."""
    import polhode.schema

    return keys(polhode.schema.scene_model())


def recipe_keys() -> str:
    """Return the keys of recipes."""
    import polhode.recipe

    return keys(polhode.recipe.recipe_model())


def classes() -> str:
    """Return the public exceptions."""
    return table(("exception", "is a", "raised for"),
                 ((code(f"ph.{one.__name__}"), code(one.__mro__[1].__name__), (one.__doc__ or "").split("\n\n")[0])
                  for one in (ph.InvalidInput, ph.IntegrationFailure)))


def findings() -> str:
    """Return the codes of findings about inertia data."""
    from polhode.inertia.codes import CODES

    return table(("code", "level", "meaning"),
                 ((f"[{c.name}](../codes/{c.name}.md)", c.level, c.title) for c in CODES.values()))


def headers() -> str:
    """Return the headers of the umbrella header, each with the lines before its first namespace."""
    return table(("header",), ((code(name),) for name in re.findall(
        r'#include "([^"]+)"', (ROOT / "cpp/include/polhode/polhode.hpp").read_text())))


def limits() -> str:
    """Return the pages that state what their subject cannot do."""
    found = []
    for page in sorted([*(ROOT / "docs").glob("*.md"), *(ROOT / "docs/notes").glob("*.md")]):
        text = page.read_text(encoding="utf-8")
        if re.search("^## Limits$", text, re.MULTILINE):
            title = text.partition("\n")[0].removeprefix("# ")
            found.append(f"- [{title}](../{page.relative_to(ROOT / 'docs').as_posix()}#limits)")
    return "\n".join(found)


def summary(text: str) -> str:
    """Return a table of what a page of the API documents, with the first line of each."""
    names = re.findall(r"^\.\. auto(?:class|function|exception):: (\S+)$", text, flags=re.MULTILINE)
    return "```{eval-rst}\n.. autosummary::\n   :nosignatures:\n\n   " + "\n   ".join(names) + "\n```"


def works() -> str:
    """Return how to cite polhode, from CITATION.cff."""
    text = (ROOT / "CITATION.cff").read_text()
    title, version = (re.search(rf'^{key}: "?([^"\n]+)"?$', text, re.MULTILINE)[1] for key in ("title", "version"))
    author = re.search(r"- name: (.+)$", text, re.MULTILINE)[1]
    return (f"```bibtex\n@software{{polhode,\n  author  = {{{{{author}}}}},\n  title   = {{{{{title}}}}},\n"
            f"  version = {{{version}}},\n}}\n```")


def against() -> str:
    """Return the comparisons of the charts that are worst for polhode."""
    from polhode.report import tables

    return tables.markdown(tables.against(json.loads((ROOT / "docs/results/charts.json").read_text())))


LISTS: dict[str, Callable[[], str]] = {
    "methods": methods, "models": models, "torques": torques, "shapes": ph.shapes.table, "commands": commands,
    "scene-keys": scene_keys, "recipe-keys": recipe_keys, "exceptions": classes, "findings": findings,
    "headers": headers, "citation": works, "limits": limits,
    "playground": playground, "against": against,
}


def fill(text: str, docname: str) -> str:
    """Return a page's text with its lists and included texts in place."""
    def put(found: re.Match[str]) -> str:
        kind, name, end = found.groups()
        if kind == "list":
            return summary(text) if name == "summary" else LISTS[name]()
        if kind == "page":
            return name if (ROOT / "docs" / docname).parent.joinpath(f"{name}.md").exists() else ""
        whole = (ROOT / name).read_text(encoding="utf-8")
        return rewrite(whole.partition(end)[0] if end else whole, docname, folder="")

    return MARK.sub(put, text)
