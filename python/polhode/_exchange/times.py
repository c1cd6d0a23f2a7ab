"""Instants as text: the calendar of a file, without leap seconds."""

from __future__ import annotations

import datetime
import re

from .._core import InvalidInput

_FORM = re.compile(r"(\d{4})-(?:(\d{2})-(\d{2})|(\d{3}))T(\d{2}):(\d{2}):(\d{2})(\.\d*)?Z?")


def parse(text: str, what: str) -> tuple[datetime.datetime, float]:
    """Return the whole second of a text such as 2026-03-01T06:00:00.25, and the rest of it [s]."""
    found = _FORM.fullmatch(text.strip()) if isinstance(text, str) else None
    if found is None:
        raise InvalidInput(f"{what}: must be an instant such as '2026-03-01T06:00:00', got {text!r}")
    year, month, day, day_of_year, hour, minute, second, rest = found.groups()
    try:
        date = (datetime.datetime(int(year), int(month), int(day)) if month else
                datetime.datetime(int(year), 1, 1) + datetime.timedelta(days=int(day_of_year) - 1))
        whole = date.replace(hour=int(hour), minute=int(minute), second=int(second))
    except ValueError as error:
        raise InvalidInput(f"{what}: must be an instant of the calendar, got {text!r} ({error})") from None
    return whole, float(rest) if rest and rest != "." else 0.0


def parse_epoch(epoch: object) -> datetime.datetime:
    """Return the instant of t = 0."""
    if epoch is None:
        raise InvalidInput("epoch: must be given for this kind of file: the instant of t = 0, such as "
                           "'2026-03-01T06:00:00'")
    if not isinstance(epoch, str):
        raise InvalidInput(f"epoch: must be text such as '2026-03-01T06:00:00', got {type(epoch).__name__}")
    whole, rest = parse(epoch, "epoch")
    return whole + datetime.timedelta(microseconds=round(rest * 1e6))


def add(epoch: datetime.datetime, micros: int) -> datetime.datetime:
    """Return the instant some microseconds after an epoch."""
    try:
        return epoch + datetime.timedelta(microseconds=int(micros))
    except OverflowError:
        raise InvalidInput(f"epoch: must leave every time of the motion within the years 1 to 9999, "
                           f"got {epoch.isoformat()} and {micros / 1e6!r} s") from None


def show(moment: datetime.datetime) -> str:
    """Return the text of an instant with microseconds."""
    return moment.isoformat(timespec="microseconds")
