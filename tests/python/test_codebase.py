"""The house keeps itself: arrows between the words, sizes, and the things that are easy to get wrong."""

import pathlib
import re

import pytest

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
