"""Answers of exercises: closed until the reader opens them."""

from typing import Any

from docutils import nodes
from docutils.parsers.rst import Directive


class Answer(Directive):
    """A part of a page under the word Answer, which opens it."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Return the content between the two ends of a `details` element."""
        inner = nodes.container()
        self.state.nested_parse(self.content, self.content_offset, inner)
        begin = '<details class="answer"><summary>Answer</summary>'
        return [nodes.raw("", begin, format="html"), *inner.children, nodes.raw("", "</details>", format="html")]


def setup(app: Any) -> None:
    """Make the directive known."""
    app.add_directive("answer", Answer)
