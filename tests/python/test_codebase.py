"""The house keeps itself: arrows between the words, sizes, and the things that are easy to get wrong."""

import importlib.metadata
import pathlib
import re
import subprocess
import sys

import pytest

import polhode

ROOT = pathlib.Path(__file__).parents[2]
ORDER = ["core", "math", "attitude", "inertia", "torque", "exact", "ode", "scene", "solve", "batch"]
MAY_USE = {
    "core": [],
    "math": ["core"],
    "attitude": ["core", "math"],
    "inertia": ["core", "math", "attitude"],
    "torque": ["core", "math", "attitude"],
    "exact": ["core", "math", "attitude", "inertia"],
    "ode": ["core", "math"],
    "scene": ["core", "math", "attitude", "inertia", "torque"],
    "solve": ORDER[:8],
    "batch": ORDER[:9],
}


def sources(*folders, suffixes=(".hpp", ".cpp", ".inl", ".def")):
    for folder in folders:
        yield from (p for p in sorted((ROOT / folder).rglob("*")) if p.suffix in suffixes)


@pytest.mark.parametrize("word", ORDER)
def test_includes_only_run_along_the_arrows(word):
    wrong = []
    for path in sources(f"cpp/include/polhode/{word}", f"cpp/src/{word}"):
        for used in re.findall(r'#include ["<]polhode/(\w+)/', path.read_text()):
            if used != word and used not in MAY_USE[word]:
                wrong.append(f"{path.relative_to(ROOT)} uses {used}")
    assert not wrong


def test_no_python_under_cpp():
    assert not [p for p in sources("cpp") if re.search(r"Python\.h|pybind11", p.read_text())]


def test_no_eigen_type_with_flag_dependent_alignment():
    pattern = re.compile(r"\b(Quaterniond|Vector2d|Vector4d|Matrix2d|Matrix4d|VectorXd|AngleAxisd)\b")
    assert not [f"{p}" for p in sources("cpp/include", "python/bindings") if pattern.search(p.read_text())]


def test_eigens_quaternion_is_not_used():
    # Its constructor takes (w, x, y, z) and its coefficients are (x, y, z, w): one of them is always read wrongly.
    assert not [p for p in sources("cpp", "python", "tests", "benchmarks", "examples") if "Quaternion<" in p.read_text()
                or re.search(r"\bQuaternion[df]\b", p.read_text())]


def texts():
    kinds = (".hpp", ".cpp", ".def", ".py", ".pyi", ".md", ".toml", ".txt", ".cmake", ".in", ".cff", ".sh", "")
    names = [p for p in (*ROOT.glob("*"), *ROOT.glob(".ci/*")) if p.name != ".git"]
    for folder in ("cpp", "python", "tests", "benchmarks", "examples", "scenes", "docs"):
        names += (ROOT / folder).rglob("*")
    return [p for p in sorted(names) if p.is_file() and p.suffix in kinds and "__pycache__" not in p.parts]


def test_a_file_is_one_that_a_reader_can_hold():
    tables = ("tableaus", "tables")
    long = {f"{p.relative_to(ROOT)}": n for p in texts() if p.suffix in (".hpp", ".cpp", ".py") and
            not set(tables) & set(p.parts) and (n := p.read_text().count("\n")) > 400}
    assert not long, "split them by their ideas"


def test_no_paths_of_somebodys_machine():
    pattern = re.compile("|".join(re.escape("/" + name + "/")
                                  for name in ("home", "root", "tmp", "work", "Users", "mnt")))
    found = [f"{p.relative_to(ROOT)}: {line.strip()}" for p in texts() if p.suffix != ".pyi"
             for line in p.read_text().splitlines() if pattern.search(line)]
    assert not found


def test_import_takes_numpy_alone():
    late = ("scipy", "matplotlib", "plotly", "pydantic", "typer", "rich", "mpmath", "trimesh", "numba")
    program = "import sys, polhode; print(*{name.partition('.')[0] for name in sys.modules})"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "numpy" in done.stdout.split()
    assert not set(late) & set(done.stdout.split())


def test_one_version():
    header = re.search(r'POLHODE_VERSION "([^"]+)"', (ROOT / "cpp/include/polhode/core/version.hpp").read_text())[1]
    citation = re.search(r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(), flags=re.M)[1]
    assert polhode.__version__ == importlib.metadata.version("polhode") == citation == header
    assert f"## {header}" in (ROOT / "CHANGELOG.md").read_text()
