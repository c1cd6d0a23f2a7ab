"""The house keeps itself: arrows between the words, sizes, and the things that are easy to get wrong."""

import ast
import importlib.metadata
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

import polhode

ROOT = pathlib.Path(__file__).parents[3]
ORDER = ["core", "math", "attitude", "inertia", "formula", "torque", "exact", "ode", "clock", "scene", "method",
         "solve", "derivative", "reference", "batch", "spectrum", "orbit"]
MAY_USE = {
    "core": [],
    "math": ["core"],
    "attitude": ["core", "math"],
    "inertia": ["core", "math", "attitude"],
    "torque": ["core", "math", "attitude", "formula"],
    "exact": ["core", "math", "attitude", "inertia"],
    "ode": ["core", "math"],
    "formula": ["core", "math"],
    "clock": ["core", "formula", "torque"],
    "scene": ["core", "math", "attitude", "inertia", "torque", "clock"],
    "method": ORDER[:10],
    "solve": [*ORDER[:11], "orbit"],
    "derivative": ORDER[:12],
    "reference": ORDER[:12],
    "batch": ORDER[:13],
    "spectrum": ["core", "math"],
    "orbit": ["core", "math", "formula"],
}
# The rooms of `solve`, and what each may use; solve.cpp stands above them.
SOLVE_ROOMS = {"ground": [], "form": ["ground"], "run": ["ground"], "proof": ["ground"], "effect": ["ground"],
               "plan": ["ground", "form", "run", "effect"], "certify": ["ground", "form", "run", "proof", "plan"]}


def sources(*folders, suffixes=(".hpp", ".cpp", ".inl", ".def")):
    for folder in folders:
        yield from (p for p in sorted((ROOT / folder).rglob("*")) if p.suffix in suffixes)


@pytest.mark.parametrize("word", ORDER)
def test_includes_only_run_along_the_arrows(word):
    wrong = []
    for path in sources(f"cpp/include/polhode/{word}", f"cpp/src/{word}"):
        for used in re.findall(r'#include ["<](?:polhode/)?(\w+)/', path.read_text()):
            if used in ORDER and used != word and used not in MAY_USE[word]:
                wrong.append(f"{path.relative_to(ROOT)} uses {used}")
    assert not wrong


@pytest.mark.parametrize("room", SOLVE_ROOMS)
def test_rooms_of_solve_use_only_those_below(room):
    wrong = [f"{path.relative_to(ROOT)} uses {used}" for path in sources(f"cpp/src/solve/{room}")
             for used in re.findall(r'#include "solve/(\w+)/', path.read_text())
             if used != room and used not in SOLVE_ROOMS[room]]
    assert not wrong
    folders = {path.name for path in (ROOT / "cpp/src/solve").iterdir() if path.is_dir()}
    assert folders == set(SOLVE_ROOMS), "each folder has a line in the table"


def rooms(word):
    """The private files of a word by their names without ending, each with those that it includes."""
    found = {}
    for path in sources(f"cpp/src/{word}"):
        room = path.relative_to(ROOT / "cpp/src").with_suffix("").as_posix()
        used = re.findall(rf'#include "({word}/[\w/]+)\.(?:hpp|inl)"', path.read_text())
        found.setdefault(room, set()).update(set(used) - {room})
    return found


@pytest.mark.parametrize("word", ORDER)
def test_no_private_include_runs_back_up(word):
    # Kernels per instruction set include the table of levels that names them.
    below = {room: {used for used in all_used if "/lanes/" not in used} for room, all_used in rooms(word).items()}
    while below:
        floor = {room for room, used in below.items() if not used & below.keys()}
        assert floor, f"a circle among {sorted(below)}"
        below = {room: used for room, used in below.items() if room not in floor}


def test_kernels_are_not_shown_as_api():
    kinds = (".md", ".cpp", ".py")
    pages = [p for folder in ("examples", "docs") for p in (ROOT / folder).rglob("*") if p.suffix in kinds]
    assert not [p for p in pages if re.search(r"polhode/\w+/detail/", p.read_text())]


def test_no_python_under_cpp():
    assert not [p for p in sources("cpp") if re.search(r"Python\.h|pybind11", p.read_text())]


# What IEEE 754 does not fix, the system's mathematical library decides: its last bits differ between systems and
# processors. `math/detail/functions.hpp` has the same functions with the same bits everywhere.
NOT_FIXED = ("sin cos tan sincos asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 exp10 expm1 log log2 "
             "log10 log1p pow cbrt hypot erf erfc tgamma lgamma beta polar arg").split()


def find_library_calls(text):
    """The functions of the system's mathematical library that C++ code calls by a full name, such as `std::sin(`."""
    code = re.sub(r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"', "", text, flags=re.S)
    names = "|".join(NOT_FIXED)
    named = rf"(?:\bstd::|(?<![\w>])::|\b__builtin_)((?:{names})[fl]?)\b"
    return re.findall(rf"{named}|(?<![\w:.>])((?:{names})l)\s*\(", code)


def test_no_answer_comes_from_the_systems_mathematical_library():
    found = find_library_calls("a = std::sin(x) + ::pow(x, y) + sinl(x) + math::cos(x); using std::exp; "
                               "__builtin_cos(x); // std::cos(x)")
    assert ["".join(pair) for pair in found] == ["sin", "pow", "sinl", "exp", "cos"]
    assert not [f"{p.relative_to(ROOT)}: {''.join(call)}" for p in sources("cpp")
                for call in find_library_calls(p.read_text())]


@pytest.mark.skipif(sys.platform != "linux" or shutil.which("nm") is None, reason="needs nm")
def test_the_compiled_module_asks_the_system_for_no_such_function():
    done = subprocess.run(["nm", "-D", "--undefined-only", polhode._core.__file__], capture_output=True, text=True,
                          check=True)
    asked = {line.split()[-1].partition("@")[0] for line in done.stdout.splitlines()}
    assert "memcpy" in asked   # the list is one
    assert not {name for name in asked if name.rstrip("fl") in NOT_FIXED or name in NOT_FIXED}


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
    return [p for p in sorted(names) if p.is_file() and p.suffix in kinds
            and not {"__pycache__", "auto_gallery"} & set(p.parts)]


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


PACKAGE = ROOT / "python/polhode"
# The only circles are lazy lines: `Scene.load` reads files, and `Motion.plot` draws.
LAZY = {("polhode._scene.scene", "polhode._scene.files"), ("polhode._solve.motion", "polhode._plot.motion")}


def modules():
    """Every Python file of the package by its dotted name."""
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
        yield ".".join(parts[:-1] if parts[-1] == "__init__" else parts), path


def is_for_types(node):
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)


def running(tree):
    """The nodes that may run, inside functions too; not those for type checkers."""
    yield tree
    for child in ast.iter_child_nodes(tree):
        if not is_for_types(child):
            yield from running(child)


def imports(name, path, known):
    """The modules of the package that a file imports, wherever in it."""
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    for node in running(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)
        elif isinstance(node, ast.ImportFrom):
            home = package.rsplit(".", node.level - 1)[0] if node.level else ""
            base = ".".join(filter(None, (home, node.module)))
            for alias in node.names:
                found = f"{base}.{alias.name}" if f"{base}.{alias.name}" in known else base
                if found in known and alias.name != "_core":   # the compiled module imports nothing of these
                    yield found


def import_graph():
    files = dict(modules())
    return {name: {used for used in imports(name, path, files) if used != name} for name, path in files.items()}


def find_circle(graph):
    """One circle of a graph, as a list of names, or none."""
    done, way = set(), []

    def visit(name):
        if name in way:
            return [*way[way.index(name):], name]
        if name in done:
            return []
        way.append(name)
        for used in sorted(graph[name]):
            if circle := visit(used):
                return circle
        done.add(way.pop())
        return []

    for name in graph:
        if circle := visit(name):
            return circle
    return []


def test_python_imports_in_no_circle_but_the_two_lazy_lines():
    graph = import_graph()
    assert len(graph) > 100 and "polhode._solve.plan" in graph["polhode._solve.motion"]
    for name, lazy in LAZY:
        assert lazy in graph[name] and find_circle({**graph, name: graph[name]}), f"{lazy} is no longer lazy in {name}"
        graph[name] = graph[name] - {lazy}
    assert find_circle(graph) == []


def test_measurements_and_solvers_do_not_import_charts():
    wrong = [f"{name} imports {used}" for name, uses in import_graph().items() for used in uses
             if used.startswith("polhode.charts") and re.match(r"polhode\.(_|atlas)", name)]
    assert not wrong


PRODUCTS = (r"(\w|\[[^]]*\]) \* \S+( - [^-+,;]+? \* [^-+,;]+?){3}",            # the scalar part, by components
            r"- \(\w+\[\.\.\., :3\] \* \w+\[\.\.\., :3\]\)\.sum\(")     # and by vectors


def test_quaternions_are_multiplied_by_the_core():
    by_hand = ["pw * w - px * x - py * y - pz * z", "aw * bw - ax * bx - ay * by - az * bz",
               "p[..., 3] * q[..., 3] - (p[..., :3] * q[..., :3]).sum(-1)",
               "p[3] * q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2]"]
    assert all(any(re.search(product, text) for product in PRODUCTS) for text in by_hand)
    found = [path.name for _, path in modules() for product in PRODUCTS if re.search(product, path.read_text())]
    assert not found, "use Rotation, or _core.attitude"


def test_the_compiled_module_returns_no_long_tuple():
    wrong = []
    for path in sorted((PACKAGE / "_core").glob("*.pyi")):
        for function in ast.walk(ast.parse(path.read_text())):
            if not isinstance(function, ast.FunctionDef) or function.name.startswith("__") or any(
                    ast.unparse(kind) == "property" for kind in function.decorator_list):   # such as all torques
                continue
            if (kind := ast.unparse(function.returns) if function.returns else "").startswith("tuple["):
                parts = ast.parse(kind, mode="eval").body.slice
                if len(parts.elts) > 3 or any(ast.unparse(part) == "..." for part in parts.elts):
                    wrong.append(function.name)
    assert not wrong, "return an object with names"


def test_lines_of_python_have_120_columns():
    long = [f"{path.relative_to(ROOT)}:{number}" for folder in ("python", "tests", "benchmarks", "examples", "docs")
            for path in sorted((ROOT / folder).rglob("*.py"))
            for number, line in enumerate(path.read_text().splitlines(), 1) if len(line) > 120]
    assert not long


def test_python_passes_ruff():
    pytest.importorskip("ruff")
    command = [sys.executable, "-m", "ruff", "check", "--no-cache", "--output-format=concise", "."]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_every_target_of_make_says_what_it_does():
    rules = re.findall(r"^([a-z][a-z0-9-]*):(.*)$", (ROOT / "Makefile").read_text(), flags=re.M)
    assert len(rules) > 20 and not [name for name, rest in rules if " ## " not in rest]


def test_one_version():
    header = re.search(r'POLHODE_VERSION "([^"]+)"', (ROOT / "cpp/include/polhode/core/version.hpp").read_text())[1]
    citation = re.search(r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(), flags=re.M)[1]
    assert polhode.__version__ == importlib.metadata.version("polhode") == citation == header
    assert f"## {header}" in (ROOT / "CHANGELOG.md").read_text()
