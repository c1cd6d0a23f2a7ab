"""Coverage-guided fuzzing of the readers of files, which are Python: `files.py KIND [options of libFuzzer]`.

Needs atheris. Without a kind it prints all of them. The kinds, their seeds and their readers are those of
tests/python/files/test_fuzz.py.
"""

import contextlib
import pathlib
import sys
import tempfile
import types
import warnings

import atheris

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "python/files"))

import test_fuzz
import trimesh.exchange.load  # noqa: F401  loaded late otherwise, without its counters

import polhode as ph

PARTS = ("polhode", "trimesh.exchange", "tomllib")


def count_branches():
    """Gives the functions of the readers their counters; not all of Python's, which would be slow."""
    for name, module in list(sys.modules.items()):
        if not name.startswith(PARTS):
            continue
        for key, item in list(vars(module).items()):
            if isinstance(item, types.FunctionType) and item.__module__ == name:
                setattr(module, key, atheris.instrument_func(item))
            elif isinstance(item, type) and item.__module__ == name:
                for part, method in list(vars(item).items()):
                    if isinstance(method, types.FunctionType):
                        setattr(item, part, atheris.instrument_func(method))


def main(name, options):
    seed, read = test_fuzz.SEEDS[name]
    with contextlib.suppress(ph.InvalidInput):
        read(pathlib.Path("no such file"))   # loads what is loaded late
    count_branches()
    folder = pathlib.Path(tempfile.mkdtemp())
    file = folder / name
    corpus = folder / "corpus"
    corpus.mkdir()
    (corpus / "seed").write_bytes(seed)

    def try_bytes(data):
        file.write_bytes(data)
        try:
            read(file)
        except ph.InvalidInput as refusal:
            assert "\n" not in str(refusal).strip(), refusal

    warnings.simplefilter("ignore")   # of meshes that are kilometres long, say
    atheris.Setup([sys.argv[0], *options, str(corpus)], try_bytes)
    atheris.Fuzz()


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(sys.argv[1], sys.argv[2:])
    else:
        print(*test_fuzz.SEEDS)
