"""The style of the bibliography: a work's label is its key, and works stand in the order of their authors."""

from typing import Any

from pybtex.plugin import register_plugin
from pybtex.style.formatting import toplevel
from pybtex.style.formatting.unsrt import Style as Unsorted
from pybtex.style.formatting.unsrt import date, pages
from pybtex.style.labels import BaseLabelStyle
from pybtex.style.template import field, first_of, join, optional, optional_field, sentence, tag, words


class Keys(BaseLabelStyle):
    """Labels that are keys."""

    def format_labels(self, entries):
        """Yield the key of each entry."""
        for entry in entries:
            yield entry.key


class Style(Unsorted):
    """Plain entries under their keys; unlike pybtex's own, they keep the volume of an article without pages."""

    default_label_style = "keys"
    default_sorting_style = "author_year_title"

    def get_article_template(self, e: Any) -> Any:
        """Return the form of an article."""
        place = first_of[
            optional[join[field("volume"), optional["(", field("number"), ")"], optional[":", pages]]],
            optional[words["pages", pages]],
        ]
        return toplevel[
            self.format_names("author"),
            self.format_title(e, "title"),
            sentence[tag("em")[field("journal")], place, date],
            sentence[optional_field("note")],
            self.format_web_refs(e),
        ]


def register() -> None:
    """Make both known to pybtex."""
    register_plugin("pybtex.style.labels", "keys", Keys)
    register_plugin("pybtex.style.formatting", "keys", Style)
