"""The style of the bibliography: a work's label is its key."""

from pybtex.plugin import register_plugin
from pybtex.style.formatting.unsrt import Style as Unsorted
from pybtex.style.labels import BaseLabelStyle


class Keys(BaseLabelStyle):
    """Labels that are keys."""

    def format_labels(self, entries):
        """Yield the key of each entry."""
        for entry in entries:
            yield entry.key


class Style(Unsorted):
    """Plain entries under their keys."""

    default_label_style = "keys"


def register() -> None:
    """Make both known to pybtex."""
    register_plugin("pybtex.style.labels", "keys", Keys)
    register_plugin("pybtex.style.formatting", "keys", Style)
