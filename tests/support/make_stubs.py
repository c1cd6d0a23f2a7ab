"""Write the type stubs of the compiled module from the module itself.

    python tests/support/make_stubs.py [FOLDER]        (make stubs)

FOLDER is python/polhode/_core unless given. Run it after every change of a binding's signature or docstring.
"""

import importlib
import inspect
import pathlib
import re
import sys
import tempfile
import types

import pybind11_stubgen

import polhode

MODULE = "polhode._core"
HOME = pathlib.Path(__file__).parents[2] / "python/polhode/_core"


def bring_home(module: types.ModuleType) -> list[str]:
    """Let every class say where it is compiled, not where it is shown: a stub must define it, not import it back."""
    names = []
    for name, value in vars(module).items():
        if inspect.isclass(value) and type(value).__name__ == "pybind11_type":
            names.append(f"{value.__module__}.{name}")
            value.__module__ = module.__name__
        elif inspect.ismodule(value) and value.__name__.startswith(module.__name__ + "."):
            names += bring_home(value)
    return names


def tidy_signature(line: str, public: list[str], home: str) -> str:
    for name in public:   # signatures were written with the public names
        package, _, last = name.rpartition(".")
        line = re.sub(rf"\b{re.escape(name)}\b", last if package != home else name, line)
    line = re.sub(r"(def __eq__\(self.*, arg0): \w+\)", r"\1: object)", line)
    line = re.sub(r"\btuple\b(?!\[)", "tuple[typing.Any, ...]", line)
    line = re.sub(r"\bdict\b(?!\[)", "dict[str, typing.Any]", line)
    return re.sub(r"\b(list|Iterable|Sequence|Callable)\b(?!\[)", r"\1[typing.Any]", line)


def torque_signatures(text: str) -> str:
    """The torques' constructors take *args and read them by their records; the records know the signature too."""
    types_of = {"real": "float", "vector": "numpy.typing.ArrayLike", "matrix": "numpy.typing.ArrayLike",
                "choice": "str", "orbit": "typing.Any"}
    for record in polhode.torques.records():
        parameters = [f"{p['name']}: "
                      f"{types_of[p['kind']]}" + (f" = {p['default']!r}" if p["default"] is not None else "")
                      for p in record["parameters"]]
        ways = [r for r in polhode.torques.records() if r["key"] == record["key"]]
        if record == ways[0] and len(ways) > 1:   # its first class makes the others, too
            others = [p["name"] for way in ways[1:] for p in way["parameters"]]
            parameters = [p if " = " in p else p + " = ..." for p in parameters]
            parameters += ["*", *(f"{name}: typing.Any = ..." for name in others)]
        start = text.index(f"class {record['name']}:")
        head, body = text[:start], text[start:]
        text = head + body.replace("(self, *args, **kwargs)", f"({', '.join(['self', *parameters])})",
                                   1) if parameters else text
    text = text.replace("**kwargs) -> None", "**parameters: numpy.typing.ArrayLike) -> None")   # of Formula
    for name in ("with_parameters", "with_starts"):
        text = text.replace(f"{name}(self, **kwargs)", f"{name}(self, **numbers: numpy.typing.ArrayLike)")
    return text.replace("import typing\n", "import numpy\nimport numpy.typing\nimport typing\n",
                        1) if "numpy." in text else text


def tidy(text: str, public: list[str], home: str) -> str:
    lines = [line.rstrip() for line in text.splitlines() if not line.startswith("__all__")]   # it has none: invented
    lines = [tidy_signature(line, public, home) if re.match(r" *def .*:$", line) else line for line in lines]
    text = re.sub(r"^ +def __getattribute__\(.*\n(?: {8}.*\n)*", "", "\n".join(lines) + "\n", flags=re.M)   # a guard
    # The result is a class of the package, which the compiled module cannot name.
    text, found = re.subn(r"^( +def sensitivity\(self: FreeMotion, .*) -> typing.Any:$", r"\1 -> Sensitivity:", text,
                          flags=re.M)
    if found:
        text = text.replace("import typing\n", "import typing\n\n"
                            "from polhode._sensitivity.sensitivity import Sensitivity\n", 1)
    text = re.sub(r"^(from polhode\._core import (\w+))$", r"\1 as \2", text, flags=re.M)   # its names, not only used
    return re.sub(r"^(__version__: str) = .*$", r"\1", text, flags=re.M)


def main(folder: pathlib.Path) -> None:
    public = bring_home(importlib.import_module(MODULE))
    with tempfile.TemporaryDirectory() as made:
        pybind11_stubgen.main([MODULE, "-o", made, "--exit-code"])
        base = pathlib.Path(made, *MODULE.split("."))
        files = {path.relative_to(base): path.read_text() for path in base.rglob("*.pyi")}
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        home = ".".join([MODULE, *name.with_suffix("").parts]).removesuffix(".__init__")
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        tidied = tidy(text, public, home)
        (folder / name).write_text(torque_signatures(tidied) if name.stem == "torques" else tidied)
    for stale in set(folder.rglob("*.pyi")) - {folder / name for name in files}:
        stale.unlink()


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else HOME)
