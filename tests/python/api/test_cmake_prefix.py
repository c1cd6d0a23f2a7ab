"""`ph.cmake_prefix()` of an installation from the source, of the two wheels, and without the C++ library."""

import pathlib
import sys

import pytest

import polhode as ph
from polhode import _core


@pytest.fixture
def module_alone(tmp_path, monkeypatch):
    """The compiled module in a folder without the C++ library, as its wheel installs it."""
    monkeypatch.setattr(_core, "__file__", str(tmp_path / "polhode" / "_core.so"))
    monkeypatch.setattr(sys, "path", [str(tmp_path)])
    monkeypatch.delitem(sys.modules, "polhode_cpp", raising=False)
    monkeypatch.setattr(sys, "path_importer_cache", {})
    return tmp_path


def install_library(folder, version):
    header = folder / "polhode_cpp/include/polhode/core/version.hpp"
    header.parent.mkdir(parents=True)
    header.write_text(f'#define POLHODE_VERSION "{version}"\n')
    (folder / "polhode_cpp/__init__.py").touch()


def test_the_library_beside_the_module_comes_first(module_alone):
    install_library(module_alone, ph.__version__)
    (module_alone / "polhode/lib/cmake/polhode").mkdir(parents=True)
    assert pathlib.Path(ph.cmake_prefix()) == module_alone / "polhode"


def test_the_other_wheel_is_found(module_alone):
    install_library(module_alone, ph.__version__)
    assert pathlib.Path(ph.cmake_prefix()) == module_alone / "polhode_cpp"


@pytest.mark.parametrize("version, why", [(None, "is not installed"), ("0.1.9", "in another version"),
                                          (ph.__version__ + "0", "in another version")])
def test_a_missing_or_other_library_is_refused_with_the_cure(module_alone, version, why):
    if version:
        install_library(module_alone, version)
    message = rf"^cmake_prefix: .*{why}: pip install polhode-cpp=={ph.__version__}, or"
    with pytest.raises(ph.InvalidInput, match=message):
        ph.cmake_prefix()
