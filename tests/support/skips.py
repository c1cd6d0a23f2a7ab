"""A summary of skipped tests by reason, at the end of a run: a skip for a missing tool is named."""

import collections
import re

# What the reasons of this suite say when a program, a package or a part of the machine is not there.
MISSING = re.compile(r"could not import '([\w.]+)'|^needs (.+)$|^no (Chromium|build tree)|lacks a (level)")


def tool(reason):
    """The missing tool that a reason names, or None."""
    found = MISSING.search(reason)
    return None if found is None else next(filter(None, found.groups())).split(":")[0]


def reason_of(report):
    """The reason of a skipped report of pytest, without its prefix."""
    text = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
    return text.removeprefix("Skipped: ")


def summary(reasons):
    """Lines, the missing tools first, each reason with its number of tests."""
    counted = collections.Counter(reasons)
    ordered = sorted(counted.items(), key=lambda item: (tool(item[0]) is None, -item[1], item[0]))
    return [f"{count:5d}  {f'MISSING {tool(reason)}: ' if tool(reason) else ''}{reason}" for reason, count in ordered]
