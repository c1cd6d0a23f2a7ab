"""What the README shows works after what the README installs; the commands of all pages exist."""

import contextlib
import importlib.metadata
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tomllib

import pytest

ROOT = pathlib.Path(__file__).parents[3]
PAGES = [ROOT / "README.md", *(page for folder in ("", "start", "tutorials", "howto", "about")
                               for page in sorted((ROOT / "docs" / folder).glob("*.md")))]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]

# Runs the blocks of standard input, one after another, without the modules that the first argument names.
PROGRAM = """
import json, sys
hidden = set(json.loads(sys.argv[1]))

class Hidden:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name.partition(".")[0] in hidden:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

for name in [name for name in sys.modules if name.partition(".")[0] in hidden]:
    del sys.modules[name]
sys.meta_path.insert(0, Hidden)
for block in json.load(sys.stdin):
    exec(compile(block, "README.md", "exec"), {})
"""


def name_of(requirement):
    return re.sub(r"[-_.]+", "-", re.match(r"[\w.-]+", requirement)[0]).lower()


def hidden_modules(*extras):
    """Return the top-level modules of all that is installed here and that polhode with these extras does not bring."""
    asked = [*PROJECT["dependencies"], *(r for extra in extras for r in PROJECT["optional-dependencies"][extra])]
    brought, ahead = {"polhode"}, [name_of(r) for r in asked]
    while ahead:
        if (name := ahead.pop()) not in brought:
            brought.add(name)
            with contextlib.suppress(importlib.metadata.PackageNotFoundError):   # for other systems
                ahead += [name_of(r) for r in importlib.metadata.requires(name) or [] if "extra ==" not in r]
    return sorted(module for module, distributions in importlib.metadata.packages_distributions().items()
                  if not brought & {name_of(d) for d in distributions})


def run_alone(blocks, folder, *extras):
    command = [sys.executable, "-c", PROGRAM, json.dumps(hidden_modules(*extras))]
    return subprocess.run(command, input=json.dumps(blocks), capture_output=True, text=True, cwd=folder,
                          env=os.environ | {"MPLBACKEND": "agg"})


def test_a_module_that_a_plain_installation_lacks_is_hidden(tmp_path):
    assert {"scipy", "matplotlib", "pytest"} <= set(hidden_modules()) and "numpy" not in hidden_modules()
    assert run_alone(["import numpy, polhode"], tmp_path).returncode == 0
    assert "No module named 'scipy'" in run_alone(["import scipy.linalg"], tmp_path).stderr


def test_the_python_blocks_print_what_they_say_after_a_plain_installation(tmp_path):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), flags=re.S)
    done = run_alone(blocks, tmp_path)
    assert done.returncode == 0, done.stderr
    expected = re.findall(r"^print\(.*\) +# (.*)$", "\n".join(blocks), flags=re.M)
    assert done.stdout.splitlines() == expected and len(expected) == 2


LESSONS = [page for folder in ("start", "tutorials", "howto")
           for page in sorted((ROOT / "docs" / folder).glob("*.md")) if "python\n" in page.read_text()]


@pytest.mark.parametrize("page", LESSONS, ids=lambda page: page.stem)
def test_a_lesson_runs_with_the_extras_that_it_asks_for(page):
    """The tutorials ask for `cli` and `plot` in their index; other pages name their extras."""
    text = page.read_text()
    extras = ("cli", "plot") if page.parent.name == "tutorials" else ("plot",) if "import matplotlib" in text else ()
    assert not extras or page.parent.name == "tutorials" or "extra `plot`" in " ".join(text.split())
    if "plot" in extras:
        pytest.importorskip("matplotlib")
    blocks = re.findall(r"^```(?:\{code-cell\} )?python\n(.*?)^```", text, flags=re.S | re.M)
    done = run_alone(["\n".join(blocks)], ROOT, *extras)
    assert done.returncode == 0, done.stderr


def commands(page):
    """Return the shell commands of a page: lines of its blocks and inline code, as lists of words."""
    text = page.read_text()
    plain = "\n".join(re.findall(r"^```(?:sh|text)?\n(.*?)^```", text, flags=re.S | re.M))
    outside = re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)
    lines = re.findall(r"^(?:\$ )?((?:make|polhode|pip|python3?) .*)$", plain, flags=re.M)
    lines += re.findall(r"^ {4}((?:make|polhode|pip|python3?) .*)$", outside, flags=re.M)
    lines += re.findall(r"`((?:make|polhode|pip|python3?) [^`]+)`", outside)
    return [shlex.split(line, comments=True) for line in lines]


def check(words):
    """Raise unless there is such a command: a target, a verb with its options, an extra, or a script's file."""
    program, first, *rest = words
    if program == "make":
        assert re.search(rf"^{re.escape(first)}:", (ROOT / "Makefile").read_text(), flags=re.M), f"no target {first}"
    elif program == "pip":
        extras = re.findall(r"\[(.*?)\]", " ".join(rest))
        assert first == "install" and set(",".join(extras).split(",")) <= {"", *PROJECT["optional-dependencies"]}
    elif program == "polhode" and not first.startswith("-"):
        typer = pytest.importorskip("typer")
        from polhode.cli.app import app

        verbs = typer.main.get_command(app).commands
        assert first in verbs, f"no command {first}"
        known = {option for parameter in verbs[first].params for option in (*parameter.opts, *parameter.secondary_opts)}
        assert {word for word in rest if word.startswith("-")} <= known, f"{words}: options are {sorted(known)}"
    elif program.startswith("python") and first.endswith(".py"):
        assert (ROOT / first).is_file(), f"no file {first}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_the_commands_of_a_page_exist(page):
    for words in commands(page):
        check(words)


def test_commands_are_found_and_wrong_ones_refused():
    found = commands(ROOT / "README.md")
    assert ["polhode", "plan", "S7b"] in found and ["make", "test"] in found
    for wrong in ("make nothing", "polhode nothing", "polhode run S5 --nothing", "pip install '.[nothing]'",
                  "python no.py"):
        with pytest.raises(AssertionError):
            check(shlex.split(wrong))
