"""Every example of the documents passes mypy and pyright, as a user's editor would check it."""

import json
import os
import pathlib
import re
import subprocess
import sys

import pytest
from test_docs import PAGES, ROOT

# matplotlib's 3D axes have no types of their own, so that pyright takes `zoom=1` for a whole number.
THEIRS = 'parameter "zoom" of type "int" in function "set_box_aspect"'
BLOCK = re.compile(r"^```(?:\{code-cell\} )?python\n(.*?)^```", flags=re.MULTILINE | re.DOTALL)


def write_programs(folder):
    """Write each page's examples as one program, at the lines that they have on the page; return the pages by file."""
    found = {}
    for page in PAGES:
        if "docs" not in page.parts and page.name != "README.md":
            continue
        text, lines = page.read_text(), []
        for block in BLOCK.finditer(text):
            lines += [""] * (text[:block.start(1)].count("\n") - len(lines)) + block[1].splitlines()
        if lines:
            name = re.sub(r"\W", "_", str(page.relative_to(ROOT).with_suffix("")))
            (folder / f"page_{name}.py").write_text("\n".join(lines) + "\n")
            found[f"page_{name}.py"] = str(page.relative_to(ROOT))
    for path in sorted((ROOT / "examples/python").glob("*.py")):
        (folder / f"example_{path.name}").write_text(path.read_text())
        found[f"example_{path.name}"] = str(path.relative_to(ROOT))
    return found


@pytest.fixture(scope="module")
def programs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("programs")
    found = write_programs(folder)
    assert len(found) > 50
    return folder, found


def run(*command, folder):
    environment = {**os.environ, "MYPYPATH": str(ROOT / "python")}
    return subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True, cwd=folder,
                          env=environment, check=False)


def check_by_mypy(folder):
    """Return mypy's complaints, a line each."""
    # Cells of a page use a name anew.
    done = run("-m", "mypy", "--config-file=", "--ignore-missing-imports", "--allow-redefinition-new",
               "--local-partial-types", "--cache-dir", folder / ".cache", ".", folder=folder)
    assert done.returncode in (0, 1), done.stdout + done.stderr
    return [line for line in done.stdout.splitlines() if ": error:" in line]


def check_by_pyright(folder):
    """Return pyright's complaints, a line each."""
    pytest.importorskip("pyright")
    (folder / "pyrightconfig.json").write_text(json.dumps({
        "extraPaths": [str(ROOT / "python")], "typeCheckingMode": "basic", "reportMissingImports": False,
        "reportMissingModuleSource": False, "reportAttributeAccessIssue": "error"}))
    done = run("-m", "pyright", "--outputjson", "--pythonpath", sys.executable, ".", folder=folder)
    assert done.returncode in (0, 1), done.stdout + done.stderr
    return [f"{pathlib.Path(one['file']).name}:{one['range']['start']['line'] + 1}: {one['message']}"
            for one in json.loads(done.stdout)["generalDiagnostics"]
            if one["severity"] == "error" and THEIRS not in one["message"]]


@pytest.mark.parametrize("check", [check_by_mypy, check_by_pyright])
def test_the_examples_of_the_documents_pass(check, programs):
    folder, found = programs
    complaints = [f"{found.get(line.partition(':')[0], '')} {line}" for line in check(folder)]
    assert not complaints, "\n".join(complaints)


@pytest.mark.parametrize("check", [check_by_mypy, check_by_pyright])
def test_what_want_leaves_out_is_none(check, tmp_path):
    head = "import polhode as ph\nscene = ph.Scene(inertia=(1, 2, 2.5), omega=(1, 2, 3), times=[0.0, 1.0]{})\n"
    good = head.format("") + "motion = ph.solve(scene)\nmotion.omega + 1.0, motion.attitude[0]\n"
    wrong = head.format(', want="omega"') + "motion = ph.solve(scene)\nmotion.omega + 1.0, motion.attitude[0]\n"
    many = head.format(", want=['attitude']") + "many = ph.solve_many([scene])\nmany.attitude[0], many.omega[0]\n"
    names = "import polhode as ph\nph.solve(ph.Scene.load('S1'), acuracy=1e-6)\nph.Event(max, dirction=1)\n"
    for name, text in (("good", good), ("wrong", wrong), ("many", many), ("names", names)):
        (tmp_path / f"{name}.py").write_text(text)
    lines = [line for line in check(tmp_path) if "polhode" not in line.partition(":")[0]]
    places = sorted({":".join(line.split(":")[:2]) for line in lines})
    assert places == ["many.py:4", "names.py:2", "names.py:3", "wrong.py:4"], lines
