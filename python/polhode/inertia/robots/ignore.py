"""Findings that someone looked at and excused, each with the reason."""

from __future__ import annotations

import dataclasses
import fnmatch
import os
import pathlib
import tomllib
from collections.abc import Sequence

from ... import _files
from ..._core import InvalidInput
from ..codes import CODES


@dataclasses.dataclass
class Rule:
    """One excuse. In `link` and `file`, `*` and `?` stand for any letters; without `code` it excuses every finding."""

    link: str
    reason: str
    code: str = ""
    file: str = ""
    used: bool = False

    def excuses(self, link: str, code: str, file: str) -> bool:
        """Return whether a finding is excused."""
        path = file.replace(os.sep, "/")
        return (fnmatch.fnmatchcase(link, self.link) and (not self.code or self.code == code)
                and (not self.file or fnmatch.fnmatchcase(path, self.file)
                     or fnmatch.fnmatchcase(path, f"*/{self.file}")))

    def __str__(self) -> str:
        return " ".join(part for part in (repr(self.link), self.code, self.file and f"in {self.file}") if part)


def rules(given: Sequence[str | os.PathLike[str] | Rule]) -> list[Rule]:
    """Read rules: `LINK=reason`, or the name of a TOML file with tables `[[ignore]]`.

    Raises
    ------
    InvalidInput
        For a rule without a reason, and for a file that cannot be read or has other keys.
    """
    found: list[Rule] = []
    for one in given:
        if isinstance(one, Rule):
            found.append(one)
            continue
        text = os.fspath(one)
        link, equals, reason = text.partition("=")
        if equals and not (text.endswith(".toml") and pathlib.Path(text).is_file()):
            if not link.strip() or not reason.strip():
                raise InvalidInput(f"ignore: must be LINK=reason with both of them, or a TOML file; got {text[:60]!r}")
            found.append(Rule(link.strip(), reason.strip()))
        elif not text.endswith(".toml") and not pathlib.Path(text).is_file():
            raise InvalidInput(f"ignore: must be LINK=reason, or a TOML file of rules; got {text[:60]!r} without a "
                               "reason")
        else:
            found += _from_file(_files.to_path(text, "ignore"))
    return found


def _from_file(file: pathlib.Path) -> list[Rule]:
    try:
        content = tomllib.loads(_files.read(file, _files.TEXT).decode())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InvalidInput(f"{file}: is no TOML: {str(error)[:100]}") from None
    entries = content.get("ignore", [])
    if set(content) - {"ignore"} or not isinstance(entries, list):
        raise InvalidInput(f"{file}: must hold tables [[ignore]] alone, got {', '.join(map(repr, content))[:100]}")
    found = []
    for number, entry in enumerate(entries, 1):
        where = f"{file}: ignore {number}"
        if not isinstance(entry, dict) or not all(isinstance(value, str) for value in entry.values()):
            raise InvalidInput(f"{where}: must be a table of texts")
        if other := set(entry) - {"link", "code", "file", "reason"}:
            raise InvalidInput(f"{where}: unknown key {min(other)!r}; there are link, code, file and reason")
        if not entry.get("link") or not entry.get("reason", "").strip():
            raise InvalidInput(f"{where}: must have a link and a reason")
        if entry.get("code", "PI001") not in CODES:
            raise InvalidInput(f"{where}: code: must be one of PI001 to PI206, got {entry['code'][:20]!r}")
        found.append(Rule(entry["link"], entry["reason"], entry.get("code", ""), entry.get("file", "")))
    return found
