"""Comments and private docstrings are plain: short sentences on average, and without private idioms."""

import re
from pathlib import Path

import comments
import prose
import pytest

ROOT = Path(__file__).parents[3]
FILES = {
    "cpp": sorted(path for folder in ("cpp", "python/bindings") for path in (ROOT / folder).rglob("*.[ch]pp")),
    "python": sorted((ROOT / "python/polhode").rglob("*.py")),
}
READ = {"cpp": comments.read_cpp, "python": comments.read_python}
MEAN = 12.0   # words a sentence; 11.4 in C++ and 11.1 in Python
IDIOM = re.compile(
    r"\b(told|tells|nobody|whatever|heard|worth|birth|dear|poor|poisons?|poisoned|crew|landed|seat|scout|shake|"
    r"at the door|loose run|asked for|by itself|what is no number|anyhow|hand(s|ed)? over)\b", re.IGNORECASE)


def read(language):
    return [text for path in FILES[language] for text in READ[language](path.read_text(encoding="utf-8"))]


@pytest.mark.parametrize("language", FILES)
def test_sentences_of_comments_are_short_on_average(language):
    sentences = [words for text in read(language) for words, _ in prose.count(text).sentences]
    assert len(sentences) > 1500 and sum(sentences) / len(sentences) <= MEAN


def test_no_idiom_comes_back():
    found = [(idiom[0], text) for language in FILES for text in read(language) for idiom in IDIOM.finditer(text)]
    assert not found, "say it in the field's words"


def test_comments_are_found():
    text = "/// One sentence\n/// of two lines.\nint a;  ///< its own comment\n"
    assert comments.read_cpp(text) == ["One sentence\nof two lines.", "its own comment"]
    program = '"""A module.\n\nMore."""\n\n\ndef _f():\n    """Private."""\n    return 1  # a comment\n'
    assert comments.read_python(program) == ["A module.", "Private.", "a comment"]
