"""Running text of the sources: comments of C++ files, docstrings and comments of Python files."""

import ast
import io
import re
import tokenize


def read_cpp(text):
    """The comments of a C++ file: lines of comments that follow each other are one, those behind code stand alone."""
    found, block = [], []
    for line in [*text.splitlines(), ""]:
        if own := re.match(r"\s*//[/!]?<?\s?(.*)", line):
            block.append(re.sub(r"^[@\\]\w+(\[\w+\])?", "", own[1]))
            continue
        if block:
            found.append("\n".join(block))
        block = []
        if behind := re.search(r"\s//[/!]?<?\s(.*)$", line):
            found.append(behind[1])
    return found


def read_python(text):
    """The first paragraph of each docstring, of private functions too, and the comments."""
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef)
    docs = [ast.get_docstring(node) for node in ast.walk(ast.parse(text)) if isinstance(node, kinds)]
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    return ([doc.split("\n\n")[0] for doc in docs if doc]
            + [token.string.lstrip("# ") for token in tokens if token.type == tokenize.COMMENT])
