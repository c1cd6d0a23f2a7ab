"""The pages of the documents are written in short sentences, and the count of their words is right."""

from pathlib import Path

import prose
import pytest

ROOT = Path(__file__).parents[3]
FOLDERS = ("", "notes", "start", "tutorials", "howto", "reference", "reference/python", "evidence", "about")
PAGES = [page for folder in FOLDERS for page in sorted((ROOT / "docs" / folder).glob("*.md"))] + [ROOT / "README.md"]

PAGE = """# A heading is no sentence

A paragraph of
five words. Its second sentence (with a [link of four words](page.md#a-b)) has `code with blanks` and $a + b$!
Is 1.5 one word? Yes.

- An item without a stop
- A second item: a colon does not end it

| a table | is left out. It is |
|---|---|

$$x = y .$$

    an indented block is code

```python
print("A sentence. Another one.")
```

> A quotation counts, too, e.g. Code and all.
"""


def test_sentences_and_words_are_counted():
    counted = prose.count(PAGE)
    assert [words for words, _ in counted.sentences] == [13, 9, 8, 5, 5, 4]
    assert counted.mean == 44 / 6 and counted.share_long == 0
    assert counted.sentences[0][1].startswith("Its second sentence (with a link of four words)")


def test_long_sentences_are_found():
    counted = prose.count("It " + "is " * 25 + "long. It is not.")
    assert [words for words, _ in counted.sentences] == [27, 3] and counted.share_long == 0.5


def test_the_command_prints_each_page_and_fails_above_the_mean(tmp_path, capsys):
    short, long = tmp_path / "short.md", tmp_path / "long.md"
    short.write_text("A page of five words.\n")
    long.write_text("A " + "very " * 30 + "long sentence.\n")
    assert prose.main([str(short)]) == 0 and prose.main([str(short), str(long), "--worst", "0"]) == 1
    out = capsys.readouterr().out
    assert "5.0 words a sentence,   0 % of 1 above 25" in out and "33.0 words a sentence, 100 % of 1 above 25" in out


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_the_sentences_of_a_page_are_short(page):
    counted = prose.count(page.read_text(encoding="utf-8"))
    if not counted.sentences:
        return   # a page that includes a file, or lists pages
    words, longest = counted.sentences[0]
    assert counted.mean <= prose.LIMIT, f"{counted.mean:.1f} words a sentence; the longest has {words}: {longest}"
