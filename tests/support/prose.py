"""Words per sentence of Markdown pages.

    python tests/support/prose.py docs/*.md README.md [--mean 18] [--worst 3]

Prints for each page the mean, the share of sentences above 25 words and the longest sentence; exits with 1 if a mean is
above the limit. Counted is running text: paragraphs, quotations and list items. Code blocks, indented blocks, tables,
headings, displayed formulas, pictures and HTML tags are left out. Code in a line and a formula in a line are one word
each; of a link only its text counts. A sentence ends at a full stop, a question or exclamation mark, and at the end of
its paragraph or list item; a colon or a semicolon does not end it. Fragments of one or two words are not sentences.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path
from typing import NamedTuple

LIMIT = 18.0        # words a sentence, on average over a page
LONG = 25           # words of the longest sentence that is welcome
FRAGMENT = 2        # words of what is a label, not a sentence

_WORD = re.compile(r"[^\W_]+(?:['’.,/:_^+\-][^\W_]+)*")
_END = re.compile(r"(?<=[.!?])[\"')\]*]*\s+(?=[\"'(\[*]*[A-Z0-9])")
_ABBREVIATION = re.compile(r"\b(e\.g|i\.e|cf|vs|al|eq|fig)\.$", re.IGNORECASE)


class Prose(NamedTuple):
    """What was counted on a page."""

    sentences: list[tuple[int, str]]   # words and text, the longest first

    @property
    def mean(self) -> float:
        """Words a sentence."""
        return sum(words for words, _ in self.sentences) / len(self.sentences) if self.sentences else 0.0

    @property
    def share_long(self) -> float:
        """The part of the sentences that have more than 25 words."""
        return sum(words > LONG for words, _ in self.sentences) / len(self.sentences) if self.sentences else 0.0


def find_paragraphs(text: str) -> list[str]:
    """Running text by paragraphs and list items, each on one line."""
    text = re.sub(r'<a id="[^"]*"></a>', "", text)
    text = re.sub(r"^(```|~~~).*?^\1[^\n]*$|\$\$.*?\$\$|<!--.*?-->", "\n\n", text, flags=re.DOTALL | re.MULTILINE)
    paragraphs: list[str] = []
    indented = open_ = in_list = False   # a code block by indentation follows an empty line, outside of lists
    for line in text.splitlines():
        item = re.match(r"\s*(?:[-*+]|\d+\.)\s+(.*)", line)
        if not line.strip():
            open_ = False
            continue
        indented = line.startswith("    ") and not item and not in_list and (indented or not open_)
        if indented or re.match(r"\s*(\||#{1,6}\s|!\[|<)", line):
            open_ = in_list = False
            continue
        in_list = bool(item) or (in_list and (open_ or line.startswith(" ")))
        if item or not open_:
            paragraphs.append((item[1] if item else line.lstrip("> ")).strip())
        else:
            paragraphs[-1] += " " + line.strip("> ")
        open_ = True
    return paragraphs


def strip_markup(text: str) -> str:
    """The same with code and formulas as one word, links as their text and no tags."""
    text = re.sub(r"``.*?``|`[^`]*`|\$[^$]*\$", "Code", text)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return re.sub(r"<[^>]+>|\*\*|__", "", text)


def split_sentences(paragraph: str) -> list[str]:
    """Sentences of a paragraph."""
    sentences: list[str] = []
    for part in _END.split(strip_markup(paragraph)):
        if sentences and _ABBREVIATION.search(sentences[-1]):
            sentences[-1] += " " + part
        else:
            sentences.append(part)
    return sentences


def count(text: str) -> Prose:
    """Count the sentences of a page."""
    found = [(len(_WORD.findall(sentence)), sentence.strip())
             for paragraph in find_paragraphs(text) for sentence in split_sentences(paragraph)]
    return Prose(sorted((one for one in found if one[0] > FRAGMENT), reverse=True))


def main(arguments: list[str] | None = None) -> int:
    """Print the counts of the pages named on the command line."""
    parser = argparse.ArgumentParser(description="Words per sentence of Markdown pages.")
    parser.add_argument("pages", nargs="+", type=Path)
    parser.add_argument("--mean", type=float, default=LIMIT, help="the largest mean that is right")
    parser.add_argument("--worst", type=int, default=1, help="how many of the longest sentences to print")
    asked = parser.parse_args(arguments)
    above = 0
    for page in asked.pages:
        prose = count(page.read_text(encoding="utf-8"))
        above += prose.mean > asked.mean
        print(f"{prose.mean:5.1f} words a sentence, {100 * prose.share_long:3.0f} % of {len(prose.sentences)} above "
              f"{LONG}: {page}")
        for words, sentence in prose.sentences[:asked.worst]:
            print(f"        {words}: {sentence}")
    return int(above > 0)


if __name__ == "__main__":
    sys.exit(main())
