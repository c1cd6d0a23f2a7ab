"""The commands."""

from __future__ import annotations

import functools
import pathlib
import sys
from collections.abc import Callable
from typing import Annotated, Any

import typer

from .. import _files, _wings
from .._core import IntegrationFailure, InvalidInput, __version__
from .._scene.scene import Scene
from .._solve import calibrate as calibration
from .._solve.costs import cache_file
from .._solve.plan import plan as make_plan
from .._solve.solve import methods as method_records
from .._solve.solve import solve
from . import files, show
from .options import Json, need_matplotlib
from .streams import PipeClosed, say, write_json

app = typer.Typer(name="polhode", add_completion=False, no_args_is_help=True, rich_markup_mode=None,
                  pretty_exceptions_enable=False, context_settings={"help_option_names": ["-h", "--help"]},
                  help="Rotational motion of rigid bodies: attitude and angular velocity at given times.")


def _command(function: Callable[..., int | None], **settings: bool) -> Callable[..., None]:
    """Make a function a command. Its result is the exit status; bad input gives one line and status 2."""

    @app.command(context_settings=settings)
    @functools.wraps(function)
    def wrapped(*args: Any, **kwargs: Any) -> None:
        try:
            status = function(*args, **kwargs) or 0
        except InvalidInput as error:
            say(str(error))
            status = 2
        except IntegrationFailure as error:
            say(str(error))
            status = 1
        except BrokenPipeError:   # typer would end with status 1
            raise PipeClosed from None
        except MemoryError as error:
            say(str(error) or "out of memory")
            status = 1
        raise typer.Exit(status)

    return wrapped


@app.callback(invoke_without_command=True)
def _top(version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False) -> None:
    if version:
        print(f"polhode {__version__}")
        raise typer.Exit(0)


@_command
def run(
    scene: Annotated[str, typer.Argument(help="A scene file, or the name of a scene of polhode, such as S1.")],
    accuracy: Annotated[
        float | None, typer.Option(help="Largest error of any sample; 1e-9 if no tolerance is given.")] = None,
    method: Annotated[str | None, typer.Option(help="Method to use: exact, or one of `polhode methods`.")] = None,
    rtol: Annotated[float | None, typer.Option(help="Relative tolerance of a step.")] = None,
    atol: Annotated[float | None, typer.Option(help="Absolute tolerance of a step.")] = None,
    step: Annotated[float | None, typer.Option(help="Step of a fixed-step method [s].")] = None,
    max_steps: Annotated[
        int | None, typer.Option(help="Stop after this number of steps; 10 million, of a proof one million.")] = None,
    proof: Annotated[bool, typer.Option("--proof", help="Prove bounds of the exact motion.")] = False,
    output: Annotated[
        pathlib.Path | None, typer.Option("-o", "--output", help="Write all samples: .csv, .npz or .json.")] = None,
    picture: Annotated[
        pathlib.Path | None, typer.Option("--plot",
                                          help="Draw polhode, angles and invariants: .png, .svg or .pdf.")] = None,
    animate: Annotated[
        pathlib.Path | None, typer.Option(help="Write a film of the rotating body: .html, .gif or .mp4.")] = None,
    as_json: Json = False,
) -> int:
    """Compute the rotational motion of a scene at its sample times.

    Prints the first and last samples, the drift of the invariants, and the cost.
    """
    if output is not None:
        files.check(output)
    if picture is not None:
        need_matplotlib("pictures need")
        files.check(picture, (".png", ".svg", ".pdf"), "plot")
    if animate is not None:
        files.check(animate, (".html", ".gif", ".mp4"), "animate")
        _wings.load("_plot.film")
    with show.Bar("solving") as bar:
        motion = solve(Scene.load(scene), accuracy, method=method, rtol=rtol, atol=atol, step=step, max_steps=max_steps,
                       certify="proof" if proof else True, progress=bar.fraction)
    if output is not None:   # before all that may fail at a closed or full stdout
        files.write(output, motion)
    if picture is not None:
        with _files.whole(picture) as draft:
            motion.plot().savefig(draft, dpi=160)
    if animate is not None:
        from .body import find_mesh

        motion.animate(body=find_mesh(scene) or "box").save(animate)
    if as_json:
        write_json(files.to_json(motion))
    else:
        show.motion(motion)
    for written in filter(None, (output, picture, animate)):
        print(f"wrote {written}", file=sys.stderr if as_json else sys.stdout)
    return 0 if motion.success else 1


@_command
def plan(
    scenes: Annotated[list[str], typer.Argument(help="Scene files, or names such as S1.")],
    accuracy: Annotated[float | None, typer.Option(help="Largest error of any sample; 1e-9 if left out.")] = None,
    method: Annotated[str | None, typer.Option(help="Method to use: exact, or one of `polhode methods`.")] = None,
    certify: Annotated[bool, typer.Option(help="Bound the error with a certificate.")] = True,
    proof: Annotated[bool, typer.Option("--proof", help="Prove bounds of the exact motion.")] = False,
    as_json: Json = False,
) -> int:
    """Show how scenes would be solved, and why.

    Prints the properties of each scene, each closed form and method with its expected error and time, and the choice.
    """
    made = [make_plan(Scene.load(scene), accuracy, method=method, certify="proof" if proof else certify)
            for scene in scenes]
    if as_json:
        write_json([chosen.as_dict() for chosen in made])
    else:
        print("\n\n\n".join(map(str, made)))
    return 0


@_command
def fit(
    data: Annotated[pathlib.Path, typer.Argument(help="A CSV file with a header, or without one and --columns.")],
    sigma: Annotated[str, typer.Option(help="Noise of each sensor, such as omega=0.01,attitude=0.02.")],
    columns: Annotated[str | None, typer.Option(
        help="Names of the columns: t, omega_x to omega_z, attitude_x to attitude_w, axis_x to axis_z, direction_x to "
             "direction_z. All columns in their order, or some as name=column of the header: t=seconds,omega_x=x. "
             "Others are ignored. By default the header.")] = None,
    first: Annotated[float | None, typer.Option(
        "--from", help="Leave out what is earlier; times count from here.")] = None,
    last: Annotated[float | None, typer.Option("--to", help="Leave out what is later, in times of the file.")] = None,
    parameters: Annotated[str, typer.Option(
        "--fit", help="What to fit, of omega, attitude, inertia and axes.")] = "omega,attitude,inertia",
    axis: Annotated[str, typer.Option(help="The body axis that axis_* see in space.")] = "0,0,1",
    direction: Annotated[str | None, typer.Option(help="The space vector that direction_* see in the body.")] = None,
    bias: Annotated[bool, typer.Option("--bias", help="Fit a constant bias of the rates.")] = False,
    degrees: Annotated[bool, typer.Option("--degrees", help="Rates are in degrees a second.")] = False,
    loss: Annotated[str, typer.Option(help="linear, soft_l1, huber or cauchy.")] = "linear",
    seed: Annotated[int, typer.Option(help="Seed of the search for a start.")] = 0,
    picture: Annotated[pathlib.Path | None, typer.Option(
        "--plot", help="Draw motion, residuals, correlations and spread: .png, .svg or .pdf.")] = None,
    as_json: Json = False,
) -> int:
    """Fit a free body to measurements.

    Finds its start, the ratios of its moments and its principal axes, without start values. Prints the parameters with
    their standard errors, the ratios of the moments, what the data cannot tell, and other bodies that fit as well.
    """
    from . import fit as part

    if picture is not None:
        need_matplotlib("pictures need")
        files.check(picture, (".png", ".svg", ".pdf"), "plot")
    found = part.run(data, columns, sigma, parameters, axis, direction, bias, degrees, loss, seed, first, last)
    if picture is not None:
        with _files.whole(picture) as draft:
            found.plot().savefig(draft, dpi=160)
    if as_json:
        write_json(part.to_json(found))
    else:
        print(repr(found))
    return 0 if found.success else 1


@_command
def calibrate(as_json: Json = False) -> int:
    """Measure the speed of this machine for later plans.

    It takes less than 20 s. The result is saved in the user's cache folder.
    """
    with show.Bar("measuring") as bar:
        found = calibration.calibrate(lambda done, total: bar.fraction(done, total))
    if as_json:
        write_json({"file": str(cache_file()), "factors": found})
    else:
        show.calibration(found, str(cache_file()))
    return 0


@_command
def methods(as_json: Json = False) -> int:
    """List all methods; last, those for comparison."""
    records = method_records()
    if as_json:
        write_json(records)
    else:
        show.methods(records)
    return 0


@_command
def inertia(
    files: Annotated[list[str], typer.Argument(
        help="Robots (URDF, MJCF, SDF, xacro), folders of them, or - for stdin. Or one mesh (STL, OBJ, PLY, OFF, glTF, "
             "COLLADA). Or one TOML file with a [body] table, or the name of a scene.")],
    density: Annotated[float | None, typer.Option(help="Density of a mesh [kg/m^3].")] = None,
    mass: Annotated[float | None, typer.Option(help="Mass of a mesh [kg].")] = None,
    unit: Annotated[str, typer.Option(help="Unit of a mesh: m, cm, mm, um, in, ft, or a length [m].")] = "m",
    flip: Annotated[bool, typer.Option("--flip", help="Reverse the faces of a mesh that is wound inward.")] = False,
    weld: Annotated[float, typer.Option(
        help="Vertices of a mesh's open edges nearer than this part of its size count as one; 0: equal ones.")] = 1e-9,
    form: Annotated[str, typer.Option(
        "--format", help="Of robots: text, json, sarif, junit or github.")] = "text",
    fail_on: Annotated[str, typer.Option(
        help="Of robots: the level from which the exit status is 1: error, warning or remark.")] = "warning",
    ignore: Annotated[list[str] | None, typer.Option(
        help="Of robots: excuse findings, by LINK=reason or a TOML file of rules. May be repeated.")] = None,
    path: Annotated[list[str] | None, typer.Option(
        help="Of robots: a folder where packages, models and meshes are. May be repeated.")] = None,
    package: Annotated[list[str] | None, typer.Option(
        help="Of robots: NAME=FOLDER of a package. May be repeated.")] = None,
    fix: Annotated[bool, typer.Option(
        "--fix", help="Of robots: write NAME.fixed.SUFFIX with the numbers of named causes repaired.")] = False,
    xacro: Annotated[bool, typer.Option(help="Of robots: expand .xacro files, where xacro is installed.")] = True,
    as_json: Json = False,
) -> int:
    """Check the inertia of a body, or of every link of robots.

    Prints moments, principal axes, symmetry, and whether such a body can exist. For robots it prints what is wrong and
    the likely cause.
    """
    from . import part
    from .robot_options import Options, is_robot

    options = Options("json" if as_json else form, fail_on, tuple(ignore or ()), tuple(path or ()),
                            tuple(package or ()), fix, xacro)
    file = files[0]
    if len(files) > 1 or is_robot(file):
        _only_for_meshes(density=density, mass=mass, unit=unit != "m", flip=flip, weld=weld != 1e-9)
        status: int = _wings.load("cli.robot").run(files, options)
        return status
    if name := options.given() or ("--format" if form not in ("text", "json") else ""):
        raise InvalidInput(f"{name}: must be used with robots, got another file")
    if part.is_mesh(file):
        finding = part.examine(file, density, mass, unit, flip, weld)
    else:
        _only_for_meshes(density=density, mass=mass, unit=unit != "m", flip=flip, weld=weld != 1e-9)
        from .body import examine

        finding = examine(file)
    if options.form == "json":
        write_json(finding)
    else:
        show.body(finding)
    return 0 if finding["valid"] else 1


def _only_for_meshes(**options: Any) -> None:
    for name, value in options.items():
        if value:
            raise InvalidInput(f"--{name}: must be used with a mesh file, got another file")


def _refuse(name: str, why: str) -> None:
    """Add a command that says why it is not there."""
    def refused() -> int:
        raise _wings.MissingWing(why)

    refused.__name__, refused.__doc__ = name, f"({why})"
    _command(refused, ignore_unknown_options=True, allow_extra_args=True)


for _wing in _wings.WINGS:
    for _name, _module in _wing.commands.items():
        if _wings.is_there(_wing.name):
            _command(getattr(_wings.load(_module), _name))
        else:
            _refuse(_name, _wings.say_missing(_wing))
