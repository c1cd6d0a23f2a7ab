"""Comments and private docstrings are plain: short sentences, no private idioms. A turn is a revolution."""

import io
import re
import tokenize
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

# Names in which a turn is a revolution; `turns` counts them. A rotation, an angle and a vector have these names.
TURNS = re.compile(r"a_turn|full_turn|inverse_turn|quarter_turn|turn_of|TURN|\w*_?per_turn\w*|PER_TURN|steps_a_turn"
                   r"|turned_edges", re.ASCII)


def read(language):
    return [text for path in FILES[language] for text in READ[language](path.read_text(encoding="utf-8"))]


@pytest.mark.parametrize("language", FILES)
def test_sentences_of_comments_are_short_on_average(language):
    sentences = [words for text in read(language) for words, _ in prose.count(text).sentences]
    assert len(sentences) > 1500 and sum(sentences) / len(sentences) <= MEAN


def test_no_idiom_comes_back():
    found = [(idiom[0], text) for language in FILES for text in read(language) for idiom in IDIOM.finditer(text)]
    assert not found, "say it in the field's words"


def list_names(path, text):
    """The names of the code, without comments and texts."""
    if path.suffix == ".py":
        return [token.string for token in tokenize.generate_tokens(io.StringIO(text).readline)
                if token.type == tokenize.NAME]
    return re.findall(r"[A-Za-z_]\w*", re.sub(r'R"\((.*?)\)"|//[^\n]*|"(\\.|[^"\\\n])*"', " ", text, flags=re.DOTALL))


def find_turns(names):
    """Names with turn, turned or turning as a word, which is no revolution."""
    words = re.compile(r"(?:(?:^|_)[Tt]|(?<=[a-z])T)urn(?:ed|ing)?(?=_|[A-Z]|$)")
    return sorted({name for name in names if words.search(name) and not TURNS.fullmatch(name)})


def test_a_turn_is_a_revolution():
    assert find_turns(["turn_by", "TurnSide", "return_it", "turned", "turns", "error_per_turn"]) == [
        "TurnSide", "turn_by", "turned"]
    found = {str(path): names for language in FILES for path in FILES[language]
             if (names := find_turns(list_names(path, path.read_text(encoding="utf-8"))))}
    assert not found, "say rotation, rotate, angle or what it is"


# Words of small metaphors that are gone from names. The field has a word for each: given, failed, costly, equivalent.
METAPHORS = re.compile(r"(?:^|_)(told|tells|poison(ed)?|dear|heard|nobody|crew|landed|birth|worth|scout|flight)(?=_|$)")
PUBLIC = {"in_flight"}   # of work that was given out and is not back: the term of schedulers


def test_no_metaphor_comes_back_as_a_name():
    assert METAPHORS.search("_told") and METAPHORS.search("warn_poisoned") and not METAPHORS.search("untold")
    found = {str(path): names for language in FILES for path in FILES[language]
             if (names := sorted({name for name in list_names(path, path.read_text(encoding="utf-8"))
                                  if METAPHORS.search(name.lower()) and name not in PUBLIC}))}
    assert not found, "say it in the field's words"


def test_comments_are_found():
    text = "/// One sentence\n/// of two lines.\nint a;  ///< its own comment\n"
    assert comments.read_cpp(text) == ["One sentence\nof two lines.", "its own comment"]
    program = '"""A module.\n\nMore."""\n\n\ndef _f():\n    """Private."""\n    return 1  # a comment\n'
    assert comments.read_python(program) == ["A module.", "Private.", "a comment"]
