"""The wings: parts of polhode that can be left out. This file alone knows them; docs/about/wings.md is their contract.

A wing is a record in `WINGS`. `.ci/wings` deletes each wing's files in a copy, and tests the rest.
"""

from __future__ import annotations

import importlib
import pathlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from ._core import InvalidInput

if TYPE_CHECKING:
    from . import atlas as atlas
    from . import charts as charts
    from . import report as report
    from ._ensemble.ensemble import Ensemble as Ensemble
    from ._ensemble.run import ensemble as ensemble
    from ._exchange.ephemeris import AttitudeEphemeris as AttitudeEphemeris
    from ._judge.judgement import Judgement as Judgement
    from ._judge.run import judge as judge
    from ._plot.film.film import Film as Film
    from .inertia import robots as robots


class Wing(NamedTuple):
    """A part that can be left out.

    `files` are folders and files below this package, `outside` those below the repository's root. Its tests are the
    folder of its name in tests/python. `names` are names of `polhode`, each with the module that holds it or that it
    is. `commands` are those of the command line, each with its module. `suffixes` are those of files that its modules
    write and read, for `Motion.save` and `load`. `exceptions` are private names that the wing
    imports against its contract; none is added.
    """

    name: str
    files: tuple[str, ...]
    names: Mapping[str, str] = {}
    commands: Mapping[str, str] = {}
    outside: tuple[str, ...] = ()
    suffixes: Mapping[str, str] = {}
    exceptions: Mapping[str, str] = {}


WINGS = (
    Wing("robots", ("inertia/robots", "cli/robot.py", "cli/formats.py", "cli/show_robots.py"),
         exceptions={"inertia.breaches": "Breach breaches",
                     "inertia.codes": "CODES LEVELS",
                     "inertia.corruptions": "Cause undo",
                     "inertia.diagnosis": "CONVINCED GEOMETRY_UNITS LARGEST nearest",
                     "inertia.evidence": "Bodies DENSEST Evidence Geometry ROUNDED apart from_spread reference single "
                                         "spread stack weigh"}),
    Wing("charts", ("charts", "atlas", "report", "_harness", "cli/charts.py", "cli/show_charts.py", "cli/atlas.py"),
         names={name: name for name in ("atlas", "charts", "report")},
         commands={name: "cli.charts" for name in ("chart", "report", "atlas")},
         exceptions={"_build": "processor",
                     "_core": "closed_form_refusal closed_forms drift find_closed_form method_refusal reference",
                     "_scene.files": "find_scene read_toml",
                     "_scene.scene": "scene_folder",
                     "_solve.motion": "Floats"}),
    Wing("ensemble", ("_ensemble", "cli/ensemble.py"),
         names={"Ensemble": "_ensemble.ensemble", "ensemble": "_ensemble.run"},
         commands={"ensemble": "cli.ensemble"},
         exceptions={"_core": "_Summary _draw _mean_attitude",
                     "_scene.bodies": "attitude_of body_inertia body_model place_meshes",
                     "_scene.files": "make_scene read_toml",
                     "_scene.recipe": "find_recipe",
                     "_scene.validation": "euler_model kinds model one_of validate"}),
    Wing("films", ("_plot/film",),
         exceptions={"_plot.panels": "DRAW Drawing",
                     "_plot.picture": "Picture",
                     "_plot.poinsot": "View family make_view",
                     "_plot.track": "Track",
                     "_solve.motion": "Floats"}),
    Wing("judge", ("_judge", "cli/judge.py"),
         names={"Judgement": "_judge.judgement", "judge": "_judge.run"},
         commands={"judge": "cli.judge"}),
    Wing("exchange", ("_exchange",),
         names={"AttitudeEphemeris": "_exchange.ephemeris"},
         suffixes=dict.fromkeys((".aem", ".a", ".bc"), "_exchange.files")),
    Wing("web", (), outside=("web",)),
)
HOME = pathlib.Path(__file__).parent


class MissingWing(InvalidInput, ImportError):
    """A name belongs to a wing that is not installed."""


def is_there(name: str) -> bool:
    """Return True if the files of a wing are installed."""
    return all((HOME / file).exists() for wing in WINGS if wing.name == name for file in wing.files)


def find_wing(module: str) -> Wing | None:
    """Return the wing that a module belongs to, by its dotted name without `polhode.`."""
    path = pathlib.PurePosixPath(module.replace(".", "/"))
    places = {*map(str, (path, *path.parents)), f"{path}.py"}
    return next((wing for wing in WINGS if places & set(wing.files)), None)


def load(module: str) -> Any:
    """Import a module by its dotted name without `polhode.`.

    Raises
    ------
    MissingWing
        It belongs to a wing that is not installed.
    """
    wing = find_wing(module)
    if wing is not None and not is_there(wing.name):
        raise MissingWing(say_missing(wing))
    return importlib.import_module(f"{__package__}.{module}")


def find_suffix(suffix: str) -> str | None:
    """Return the module that writes and reads files with a suffix, by its dotted name without `polhode.`."""
    return next((wing.suffixes[suffix] for wing in WINGS if suffix in wing.suffixes), None)


def list_suffixes() -> tuple[str, ...]:
    """Return the suffixes of all wings' files."""
    return tuple(suffix for wing in WINGS for suffix in wing.suffixes)


def say_missing(wing: Wing) -> str:
    """Return the sentence that refuses what belongs to a wing."""
    return f"polhode is installed without its wing {wing.name!r}"


def list_names(there: bool = True) -> dict[str, str]:
    """Return the public names of the wings that are installed, or of all wings, each with its module."""
    return {name: module for wing in WINGS if not there or is_there(wing.name) for name, module in wing.names.items()}


if not TYPE_CHECKING:   # else every name would be one
    def __getattr__(name: str) -> Any:
        if name == "Film":   # the type that `animate` returns, for those that read signatures
            return load("_plot.film.film").Film
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
