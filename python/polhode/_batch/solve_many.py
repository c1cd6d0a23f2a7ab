"""Many scenes, or one scene from many starts, in one call."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core, _export
from .._attitude.arrays import require_bool, require_text, to_items
from .._keywords import checked
from .._scene.plain import to_plain
from .._scene.scene import Scene
from .._scene.wanted import At, MotionAt, MotionOm, Om, Wanted
from .._sensitivity.driven import check_groups, split_states
from .._sensitivity.sensitivity import Sensitivity
from .._solve.motion import Floats
from .._solve.record import same_record
from .._solve.solve import check_max_steps, to_body
from .broadcast import WIDTHS, check_errors, check_threads, to_attitudes, to_rows


@dataclass(frozen=True, eq=False)
class Motions(Wanted[MotionOm, MotionAt]):
    """The result of `solve_many`, body by body.

    Attributes
    ----------
    omega : ndarray, shape (bodies, samples, 3), or None without it in `want`
        Angular velocity in body axes [rad/s]; NaN at times that a body did not reach.
    attitude : ndarray, shape (bodies, samples, 4), or None without it in `want`
        Unit quaternions (x, y, z, w), body to space; NaN at times that a body did not reach.
    status, message, method : tuple of str
        As in `Motion`, for each body.
    t_reached : ndarray, shape (bodies,)
        The last time that each body reached [s].
    error : ndarray, shape (bodies,)
        The error of each body, as in `Motion`; NaN if not estimated.
    steps : ndarray of int, shape (bodies,)
        The number of steps of each body.
    success : ndarray of bool, shape (bodies,)
        True if a body reached its end with the requested accuracy, as in `Motion.success`.
    lanes : ndarray of bool, shape (bodies,)
        True if a body was integrated in SIMD lanes together with others, False if by `solve`.
    refused : ndarray of bool, shape (bodies,)
        With errors="nan": True for a start that no body can have. Its samples are NaN, and its message says why.
    sensitivity : Sensitivity, or None
        With `sensitivity=`: the derivatives, body by body. All its arrays begin with the axis of the bodies. Rows of a
        body whose derivatives failed are NaN, and its message says why.
    scenes : Scene or list of Scene
    options : dict
        The other keywords: ``solve_many(motions.scenes, **motions.options)`` repeats the motions.
    """

    omega: MotionOm
    attitude: MotionAt
    status: tuple[str, ...]
    message: tuple[str, ...]
    method: tuple[str, ...]
    t_reached: Floats
    error: Floats
    steps: npt.NDArray[np.int64]
    success: npt.NDArray[np.bool_]
    lanes: npt.NDArray[np.bool_]
    refused: npt.NDArray[np.bool_]
    scenes: Scene | list[Scene] = field(default_factory=list)
    options: dict[str, Any] = field(default_factory=dict)
    sensitivity: Sensitivity = None   # type: ignore[assignment]   # of sensitivity=

    def _states(self) -> dict[str, Floats]:
        return {name: array for name, array in (("omega", self.omega), ("attitude", self.attitude))
                if array is not None}

    def _outcomes(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in ("t_reached", "error", "steps", "success", "lanes", "refused")}

    def _times(self) -> Floats:
        """The sample times: (times,), or (bodies, times) if the scenes have their own."""
        if "times" in self.options:
            own: Floats = self.options["times"]
            return own
        if isinstance(self.scenes, Scene):
            return self.scenes.times
        rows = np.array([scene.times for scene in self.scenes])
        return rows[0] if len(rows) and (rows == rows[0]).all() else rows

    def to_pandas(self) -> Any:
        """Return the samples as a pandas.DataFrame, a row for each body and time."""
        bodies, times = len(self.status), self._times()
        count = times.shape[-1]
        index = {"body": np.repeat(np.arange(bodies), count),
                 "t": times.reshape(-1) if times.ndim == 2 else np.tile(times, bodies)}
        return _export.to_pandas(index, self._states())

    def to_xarray(self) -> Any:
        """Return the samples as an xarray.Dataset with units; omega (body, time, axis)."""
        return _export.to_xarray(("body", "time"), {"time": self._times()}, self._states(), {"kind": "motions"},
                                 self._outcomes())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the motions with all that repeats them to a .npz file or a .zarr folder, for `polhode.load`.

        The loaded motions are equal to these. Derivatives are not saved.

        Raises
        ------
        InvalidInput
            For another suffix.
        """
        _export.save(_export.check_path(path), *self._record())

    def _record(self) -> tuple[dict[str, Any], dict[str, Any]]:
        """What a file keeps."""
        scenes = to_plain(self.scenes) if isinstance(self.scenes, Scene) else [to_plain(scene) for scene in self.scenes]
        starts = {f"start_{name}": value for name, value in self.options.items() if isinstance(value, np.ndarray)}
        options = {name: value for name, value in self.options.items() if not isinstance(value, np.ndarray)}
        about = {"kind": "motions", "scenes": scenes, "options": options, "status": self.status,
                 "message": self.message, "method": self.method}
        return about, {**self._states(), **self._outcomes(), **starts}

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Motions):
            return NotImplemented
        return same_record(self._record(), other._record())

    def __hash__(self) -> int:
        return hash((self.status, self.t_reached.tobytes()))

    def _repr_html_(self) -> str:
        from .._plot.tables import of_motions

        return of_motions(self)

    def __repr__(self) -> str:
        return (f"Motions({len(self.status)} bodies, {int(self.success.sum())} with success, "
                f"{int(self.steps.sum())} steps)")


def _rows(value: Any, width: int, name: str) -> Floats:
    array = to_attitudes(value, 6) if name == "attitude" else to_rows(value, name, None)
    if array.ndim not in (1, 2) or array.shape[-1] != width:
        raise _core.InvalidInput(f"{name}: must be of shape ({width},) or (bodies, {width}), got {array.shape}")
    return array


def _starts_of(scene: Scene, starts: dict[str, Any]) -> tuple[dict[str, Floats], dict[str, Floats | None], int]:
    """Return what was given as arrays, the same as rows of bodies or None, and the number of bodies."""
    given: dict[str, Floats] = {}
    for name, width in (("inertia", 3), ("omega", 3), ("attitude", 4)):
        if starts[name] is not None:
            given[name] = _rows(starts[name], width, name)
    for name, axes in (("t0", ("bodies",)), ("times", ("bodies", "samples"))):
        if starts[name] is not None:
            array = to_rows(starts[name], name, None)
            if array.ndim != len(axes) or 0 in array.shape[1:]:
                raise _core.InvalidInput(f"{name}: must be of shape ({', '.join(axes)}), got {array.shape}")
            given[name] = np.ascontiguousarray(array)
    sizes = {array.shape[0] for name, array in given.items() if array.ndim == 2 or name == "t0"}
    if len(sizes) != 1:
        raise _core.InvalidInput(
            f"solve_many: with one scene must get starts of one number of bodies, got {sorted(sizes) or 'none'}")
    bodies = sizes.pop()
    rows: dict[str, Floats | None] = {
        name: np.ascontiguousarray(np.broadcast_to(given.get(name, own), (bodies, own.shape[-1])))
        for name, own in (("inertia", given.get("inertia")), ("omega", scene.omega), ("attitude", scene.attitude))
        if own is not None}
    return given, {name: rows.get(name, given.get(name)) for name in starts}, bodies


def _numbers(numbers: Iterable[int] | None, bodies: int) -> list[int]:
    if numbers is None:
        return []
    found = [to_body(number) for number in to_items(numbers, "numbers", "whole numbers")]
    if len(found) != bodies:
        raise _core.InvalidInput(f"numbers: must be one for each body, {bodies}, got {len(found)}")
    return found


@checked
def solve_many(
    scenes: Scene[Om, At] | Iterable[Scene[Om, At]],
    *,
    inertia: npt.ArrayLike | None = None,
    omega: npt.ArrayLike | None = None,
    attitude: Any = None,
    t0: npt.ArrayLike | None = None,
    times: npt.ArrayLike | None = None,
    accuracy: float | None = None,
    method: str | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    step: float | None = None,
    max_steps: int = 10_000_000,
    leave_out: bool = True,
    threads: int | None = None,
    errors: str = "raise",
    sensitivity: str | Sequence[str] | None = None,
    side: str = "space",
    numbers: Iterable[int] | None = None,
) -> Motions[Om, At]:
    """Solve many scenes, or one scene from many starts.

    With ``rtol`` or ``atol``, the methods ``"rk45"`` (the default then) and ``"taylor"`` integrate eight bodies at once
    in SIMD lanes. Each body has its own time, step and error. rk45 gives the same bits as `solve`. taylor meets the
    same tolerance, with other bits. A `Formula` has lanes too: of its own by taylor, and those of the torque that it
    is. All other options, and bodies with a `Custom` torque, use `solve`.

    Parameters
    ----------
    scenes : Scene, or iterable of Scene
        One scene for each body, with equally many times and the same `want`. Or one scene for all bodies, whose starts
        are given below.
    inertia : array_like, shape (bodies, 3), optional
        With one scene: principal moments about the body axes, instead of the scene's [kg m^2].
    omega : array_like, shape (bodies, 3), optional
        With one scene: the starts' angular velocities in body axes [rad/s].
    attitude : array_like, shape (bodies, 4), or Rotation, optional
        With one scene: the starts' attitudes (x, y, z, w). Shapes (3,) and (4,) hold for all bodies.
    t0 : array_like, shape (bodies,), optional
        With one scene: the times of the starts [s].
    times : array_like, shape (bodies, samples), optional
        With one scene: the sample times of each body [s].
    accuracy, method, rtol, atol, step, max_steps, leave_out
        As in `solve`, for each body.
    threads : int, optional
        The number of threads; by default all of the machine. The result of a body has the same bits for any number of
        threads and with any other bodies.
    errors : {"raise", "nan"}
        With "nan" a start that no body can have fails alone: see `Motions.refused`. Options are refused all the same.
    sensitivity, side
        As in `solve`, for each body: what the motions are differentiated by, for `Motions.sensitivity`. Scenes with
        `accuracy`, or 1e-9, and all times; without `rtol`, `atol` and `step`.
    numbers : iterable of int, optional
        The numbers of the bodies, which decide what their controllers draw; 0, 1, 2 and so on if left out.

    Returns
    -------
    Motions
        A failed body does not affect the others. Its status gives the reason, and the samples it did not reach are NaN.

    Raises
    ------
    InvalidInput
        For everything that `solve` refuses, with the number of the body. See `errors` for impossible starts.
    """
    starts = {"inertia": inertia, "omega": omega, "attitude": attitude, "t0": t0, "times": times}
    given: dict[str, Any] = {}
    rows: dict[str, Floats | None] = dict.fromkeys(starts)
    if isinstance(scenes, Scene):
        given, rows, bodies = _starts_of(scenes, starts)
        listed = [scenes]
    else:
        listed = list(to_items(scenes, "scenes", "a Scene or several"))
        for name, value in starts.items():
            if value is not None:
                raise _core.InvalidInput(f"{name}: must be left out with a scene for each body, which has its own")
        bodies = len(listed)
        for i, scene in enumerate(listed):
            if not isinstance(scene, Scene):
                raise _core.InvalidInput(f"scenes[{i}]: must be a polhode.Scene, got {type(scene).__name__}")
            if scene.times.size != listed[0].times.size or scene.want != listed[0].want:
                raise _core.InvalidInput(f"scenes[{i}]: must have as many times as scenes[0] and the same want")
    for i, scene in enumerate(listed):
        for k, controller in enumerate(scene.controllers):
            if controller.function is not None:
                raise _core.InvalidInput(f"scenes[{i}].controllers[{k}]: must be traced among many bodies, got "
                                         "trace=False; Python would be called at each tick of each body")
    own = _numbers(numbers, bodies)
    require_text(method, "method")
    groups = None if sensitivity is None else check_groups(sensitivity, side)
    for name, number in (("rtol", rtol), ("atol", atol), ("step", step)):
        if groups and number is not None:
            raise _core.InvalidInput(f"{name}: must be left out with sensitivity=, which has an accuracy, "
                                     f"got {number!r}")
    workers, refuse = check_threads(threads), check_errors(errors)
    count = rows["times"].shape[1] if rows["times"] is not None else listed[0].times.size if listed else 0
    many = _core._ManyScenes(listed, *rows.values())
    want = listed[0].want if listed else ("omega", "attitude")
    out: dict[str, Any] = {name: np.empty((bodies, count, width)) if name in want else None
                           for name, width in WIDTHS.items()}
    options = {"accuracy": accuracy, "method": method, "rtol": rtol, "atol": atol, "step": step,
               "max_steps": check_max_steps(max_steps), "leave_out": require_bool(leave_out, "leave_out")}
    found = _core._solve_many(many, bodies, count, out["omega"], out["attitude"], options, workers, refuse, own)
    given |= {name: value for name, value in options.items()
              if value is not None and value != 10_000_000 and value is not True}
    given |= {} if refuse else {"errors": "nan"}
    given |= {"numbers": own} if own else {}
    derivatives = None
    if groups and bodies:
        made = _core._sensitivities(many, bodies, count, groups, 1e-9 if accuracy is None else accuracy, True,
                                     side, check_max_steps(max_steps), workers, refuse, own)
        found["message"] = tuple(f"{message}; no derivatives: {failure}" if failure else message
                                 for message, failure in zip(found["message"], made["failures"], strict=True))
        d_states = split_states(listed[0], made["d_states"])
        derivatives = Sensitivity(made["omega"], made["attitude"], made["d_omega"], made["d_attitude"],
                                  tuple(made["columns"]), side, made["error"], d_states)
    return Motions(omega=out["omega"], attitude=out["attitude"], **found,
                   scenes=scenes if isinstance(scenes, Scene) else listed, options=given,
                   sensitivity=derivatives)  # type: ignore[arg-type]   # as the field
