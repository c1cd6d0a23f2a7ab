"""Small changes of C++ sources, each a fault that a test should see."""

import re

SWAPS = {" < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > ", " == ": " != ", " != ": " == ", " && ": " || ",
         " || ": " && ", " + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " += ": " -= ", " -= ": " += ",
         "true": "false", "false": "true", "std::min": "std::max", "std::max": "std::min", "++": "--",
         "break;": "{}", "continue;": "{}"}
WORDS = "|".join(r"\b" + re.escape(key) if key[0].isalpha() else re.escape(key)
                 for key in sorted(SWAPS, key=len, reverse=True))
NUMBER = r"(?<![\w.\"])\d+(?:\.\d*)?(?:e[+-]?\d+)?(?![\w.])"
SITE = re.compile(f"(?P<swap>{WORDS})|(?P<number>{NUMBER})")
# Not code that runs at a test's time, or a text.
HIDDEN = re.compile(r"//[^\n]*|/\*.*?\*/|R\"\((.|\n)*?\)\"|\"(\\.|[^\"\\\n])*\"|'(\\.|[^'\\])'"
                    r"|^\s*(?:#|template|static_assert|using|namespace)[^\n]*"
                    r"|\btemplate <[^\n]*>|<[\w:, ]*>", re.M | re.S)


def find(text):
    """Yields (line, what was there, what is there now, the changed text of the file)."""
    shown = HIDDEN.sub(lambda match: re.sub(r"[^\n]", "\x01", match[0]), text)
    for match in SITE.finditer(shown):
        was = match[0]
        if match["swap"]:
            now = SWAPS[was]
        elif "." in was or "e" in was:
            now = f"({was} * 10 + 1e-3)" if float(was) == 0 else f"({was} * 10)"
        else:
            now = str(int(was) + 1)
        line = text.count("\n", 0, match.start()) + 1
        yield line, context(text, match), now.strip(), text[:match.start()] + now + text[match.end():]


def context(text, match):
    """The line with the place marked."""
    begin, end = text.rfind("\n", 0, match.start()) + 1, text.find("\n", match.end())
    return (text[begin:match.start()] + "[" + match[0] + "]" + text[match.end():end]).strip()
