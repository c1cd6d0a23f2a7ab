"""Types and checks of tables in files, and messages for wrong keys."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable
from functools import cache
from typing import Annotated, Any, NamedTuple

from .._core import InvalidInput


def _pydantic() -> Any:
    """Import pydantic, which is slow to import and needed for files only."""
    import pydantic

    return pydantic


class Kinds(NamedTuple):
    """Types of keys: a finite number, or a fixed count of numbers."""

    number: Any
    pair: Any
    windows: Any   # pairs, either of them perhaps infinite
    vector: Any
    quaternion: Any
    matrix: Any
    numbers: Any


def kinds() -> Kinds:
    """Return the types of scene files, strict: neither True nor "1" is a number."""
    field = _pydantic().Field
    number: Any = Annotated[float, field(allow_inf_nan=False)]

    def rows(row: Any, least: int, most: int | None = None) -> Any:
        return Annotated[list[row], field(min_length=least, max_length=most)]

    vector = rows(number, 3, 3)
    return Kinds(number, pair=rows(number, 2, 2), windows=rows(rows(float, 2, 2), 0), vector=vector,
                 quaternion=rows(number, 4, 4), matrix=rows(vector, 3, 3), numbers=rows(number, 1))


def model(name: str, check: Callable[[Any], None] | None = None, extra: str = "forbid", /, **fields: Any) -> Any:
    """Make the model of one table, with a check of its keys together."""
    p = _pydantic()

    def checked(table: Any) -> Any:
        if check is not None:
            check(table)
        return table

    return p.create_model(name, __config__=p.ConfigDict(extra=extra, strict=True),
                          __validators__={"checked": p.model_validator(mode="after")(checked)}, **fields)


def one_of(table: Any, *choices: str) -> None:
    """Raise ValueError unless exactly one of these keys is given."""
    given = [name for name in choices if getattr(table, name) is not None]
    if len(given) != 1:
        raise ValueError(f"give one of {', '.join(choices)}; got {' and '.join(given) or 'none of them'}")


@cache
def euler_model() -> Any:
    """Return the pydantic model of an attitude given by angles."""
    kind = kinds()
    return model("Euler", lambda table: one_of(table, "angles", "angles_deg"), sequence=(str, ...),
                 angles=(kind.numbers | None, None), angles_deg=(kind.numbers | None, None))


def _keys(schema: Any) -> set[str]:
    """Return all keys of a JSON Schema."""
    if isinstance(schema, list):
        return set().union(*map(_keys, schema))
    if not isinstance(schema, dict):
        return set()
    return set(schema.get("properties", {})).union(*map(_keys, schema.values()))


def _explain(table: Any, error: Any) -> str:
    """Return one line for one error of pydantic: the key, and what is wrong with it."""
    where = ".".join(str(part) for part in error["loc"]) or "the file"
    if error["type"] == "missing":
        return f"{where}: missing"
    if error["type"] == "extra_forbidden":
        key = str(error["loc"][-1])   # which another table may have
        near = difflib.get_close_matches(key, _keys(table.model_json_schema()) - {key}, n=1)
        return f"{where}: unknown key{f', did you mean {near[0]!r}?' if near else ''}"
    if error["type"] == "value_error":
        return f"{where}: {error['ctx']['error']}"
    if error["type"] == "union_tag_not_found":
        return f"{where}: missing the key 'kind'"
    if error["type"] == "union_tag_invalid":
        return f"{where}.kind: must be one of {error['ctx']['expected_tags']}; got {error['ctx']['tag']!r}"
    found = repr(error["input"])
    text = re.sub(r"^Input should|^List should", "must", error["msg"]).replace(" after validation", "")
    text = re.sub(r"a valid dictionary or instance of \w+", "a table", text)
    text = text.replace("a valid integer", "an integer").replace("a valid ", "a ")
    return f"{where}: {text}; got {found if len(found) < 60 else found[:57] + '...'}"


def validate(table: Any, data: dict[str, Any], where: str) -> Any:
    """Check data against the model of a table; one line names up to three wrong keys."""
    try:
        return table.model_validate(data)
    except _pydantic().ValidationError as error:
        lines = [_explain(table, finding) for finding in error.errors()[:3]]
        more = f" (and {error.error_count() - 3} more)" if error.error_count() > 3 else ""
        raise InvalidInput(f"{where}: {'; '.join(lines)}{more}") from None
