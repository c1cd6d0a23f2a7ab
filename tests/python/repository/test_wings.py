"""Wings can be taken off: the core does not know them, they use the core's public names, and a missing one is named."""

import ast
import functools
import importlib
import importlib.util
import pathlib
import re
import types

import numpy as np
import pytest
from test_codebase import PACKAGE, modules

import polhode as ph
from polhode import _wings

ROOT = pathlib.Path(__file__).parents[3]
# What wings may use beside the names of polhode and of its public modules.
NEUTRAL = {"_core.attitude", "_files", "_folders", "_workers", "_xml", "_wings", "_plot.style", "_plot.text",
           "cli.files", "cli.options", "cli.robot_options", "cli.show", "cli.streams", "cli.writers"}
WINGS = {wing.name: wing for wing in _wings.WINGS
         if _wings.is_there(wing.name) and all((ROOT / name).exists() for name in wing.outside)}


def imported(name, path):
    """What a file imports of the package, for type checkers too: pairs of a module and a name that is taken of it.

    A module that is imported whole comes with an empty name, and with each of its names that the file asks for.
    """
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    tree = ast.parse(path.read_text())
    whole = {}   # modules by the names that they have here
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            whole |= {alias.asname or alias.name: alias.name for alias in node.names
                      if alias.name.partition(".")[0] == "polhode"}
        elif isinstance(node, ast.ImportFrom):
            home = package.rsplit(".", node.level - 1)[0] if node.level else ""
            base = ".".join(filter(None, (home, node.module)))
            for alias in node.names if base.partition(".")[0] == "polhode" else ():
                place = PACKAGE.parent / f"{base}.{alias.name}".replace(".", "/")
                if place.is_dir() or place.with_suffix(".py").exists():
                    whole[alias.asname or alias.name] = f"{base}.{alias.name}"
                else:
                    yield base, alias.name
    yield from ((module, "") for module in whole.values())
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and ast.unparse(node.value) in whole:
            yield whole[ast.unparse(node.value)], node.attr


def strip(module):
    return module.removeprefix("polhode").removeprefix(".")


@functools.cache
def wing_of(module):
    wing = _wings.find_wing(strip(module)) if strip(module) else None
    return wing.name if wing else None


@functools.cache
def all_imports():
    """Each import as the module, its wing, what it imports and the name that it takes of it."""
    return {(name, wing_of(name), module, taken) for name, path in modules() if strip(name) != "_wings"
            for module, taken in imported(name, path)}


PUBLIC = [ph, *(getattr(ph, name) for name in ph.__all__ if isinstance(getattr(ph, name), types.ModuleType))]


def is_public(module, name):
    """Whether a wing may take a name of a module of the core, or the module itself: it is public, here or elsewhere."""
    if {strip(module), f"{strip(module)}.{name}"} & NEUTRAL or not name:
        return True
    taken = getattr(importlib.import_module(module), name)
    return any(getattr(public, name, None) is taken and name in getattr(public, "__all__", ()) for public in PUBLIC)


def test_no_module_imports_a_wing_that_is_not_its_own():
    found = all_imports()
    assert any(home == wing_of(used) == "ensemble" for _, home, used, _ in found) or "ensemble" not in WINGS
    assert not [f"{name} imports {used}" for name, home, used, _ in found if wing_of(used) not in (None, home)]


@pytest.mark.parametrize("wing", WINGS)
def test_a_wing_uses_public_names_and_these_exceptions_alone(wing):
    found = {}
    for _, home, module, name in all_imports():
        if home == wing and wing_of(module) is None and not is_public(module, name):
            found.setdefault(strip(module), set()).add(name)
    listed = {module: set(names.split()) for module, names in WINGS[wing].exceptions.items()}
    assert found == listed, "the list can only shrink"


def test_the_guard_knows_public_names():
    assert is_public("polhode._core", "InvalidInput") and is_public("polhode.torques", "Gravity")
    assert is_public("polhode._scene.scene", "Scene") and is_public("polhode._files", "read")
    assert not is_public("polhode._core", "_draw") and not is_public("polhode._scene.validation", "validate")


@pytest.mark.parametrize("wing", WINGS)
def test_a_wing_has_files_tests_and_a_page(wing):
    record = WINGS[wing]
    assert all((PACKAGE / file).exists() for file in record.files)
    assert list((ROOT / "tests/python" / wing).glob("test_*.py"))
    assert f"\n### The wing `{wing}`" in (ROOT / "docs/about/wings.md").read_text()


def test_no_build_file_names_the_folder_of_the_playground():
    files = [ROOT / "CMakeLists.txt", *(p for folder in ("cpp", "python", "tests")
                                        for p in (ROOT / folder).rglob("CMakeLists.txt"))]
    assert len(files) > 2 and not [p for p in files if re.search(r"\bweb\b", p.read_text())]


@pytest.fixture
def without_wings(monkeypatch, tmp_path):
    monkeypatch.setattr(_wings, "HOME", tmp_path)


def missing(name):
    return pytest.raises(_wings.MissingWing, match=f"^polhode is installed without its wing '{name}'$")


def test_names_of_a_missing_wing_say_so(without_wings):
    for name, wing in {"ensemble": "ensemble", "Ensemble": "ensemble", "charts": "charts", "atlas": "charts",
                       "report": "charts"}.items():
        with missing(wing):
            ph.__getattr__(name)   # a module that was imported before is an attribute
    with missing("robots"):
        ph.inertia.__getattr__("robots")
    assert issubclass(_wings.MissingWing, ImportError) and issubclass(_wings.MissingWing, ph.InvalidInput)
    assert _wings.list_names() == {} and "Ensemble" in _wings.list_names(there=False)


def test_films_and_stores_of_a_missing_wing_say_so(without_wings, tmp_path):
    motion = ph.solve(ph.Scene(inertia=(1, 2, 2.5), omega=(1, 2, 3), times=[0.0, 1.0]), 1e-9)
    with missing("films"):
        motion.animate()
    with missing("films"):
        ph.FreeMotion((1, 2, 2.5), (1, 2, 3)).animate()
    motion.save(tmp_path / "motion.npz")
    assert np.array_equal(ph.load(tmp_path / "motion.npz").omega, motion.omega)
    (tmp_path / "store").mkdir()
    (tmp_path / "store/zarr.json").write_text('{"zarr_format": 3, "node_type": "group", "attributes": {}}')
    with missing("ensemble"):
        ph.load(tmp_path / "store")


def run_command(*arguments):
    testing = pytest.importorskip("typer.testing")
    spec = importlib.util.find_spec("polhode.cli.app")
    app = importlib.util.module_from_spec(spec)   # made anew, as commands are added at import
    spec.loader.exec_module(app)
    return testing.CliRunner().invoke(app.app, arguments)


def test_commands_of_a_missing_wing_say_so(without_wings, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    pathlib.Path("robot.urdf").write_text("<robot/>")
    calls = {("ensemble", "recipe.toml", "--resume"): "ensemble", ("atlas", "--quick"): "charts",
             ("chart", "S1"): "charts", ("report",): "charts", ("inertia", "robot.urdf"): "robots",
             ("inertia", "."): "robots", ("run", "S1", "--animate", "film.html"): "films"}
    for arguments, wing in calls.items():
        done = run_command(*arguments)
        assert done.exit_code == 2 and f"polhode is installed without its wing '{wing}'" in done.output, arguments
    assert run_command("inertia", "S1").exit_code == 0
    assert "installed without its wing 'ensemble'" in run_command("--help").output
