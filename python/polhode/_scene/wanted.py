"""Types of what `want` asks, for type checkers alone: `motion.omega` is an array unless `want` is without it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable
    from typing import Generic, Literal, TypeAlias, TypedDict

    import numpy as np
    import numpy.typing as npt
    from typing_extensions import TypeVar

    from .. import _core

    Floats: TypeAlias = npt.NDArray[np.float64]
    # A bare `Scene` may want anything; a bare `Motion` has both.
    Om = TypeVar("Om", bound=Floats | None, default=Any)
    At = TypeVar("At", bound=Floats | None, default=Any)
    MotionOm = TypeVar("MotionOm", bound=Floats | None, default=Floats)
    MotionAt = TypeVar("MotionAt", bound=Floats | None, default=Floats)
    OmegaAlone: TypeAlias = Literal["omega"] | Iterable[Literal["omega"]]
    AttitudeAlone: TypeAlias = Literal["attitude"] | Iterable[Literal["attitude"]]

    class Wanted(Generic[MotionOm, MotionAt]):
        """The types of omega and attitude: an array, or None."""

    class _Start(TypedDict):
        inertia: Any
        omega: npt.ArrayLike
        times: npt.ArrayLike

    class Parts(_Start, total=False):
        """The keywords of `Scene` but `want`."""

        attitude: Any
        torques: Iterable[Any] | Any
        t0: float
        name: str
        rotors: Iterable[_core.Rotor] | _core.Rotor
        damper: _core.Damper | None
        momentum: _core.Changing | None
        leaving: bool
        controllers: Iterable[Any] | Any
else:
    Om = At = MotionOm = MotionAt = OmegaAlone = AttitudeAlone = Parts = Any

    class Wanted:
        """Nothing at run time."""

        __slots__ = ()

        def __class_getitem__(cls, parts):
            return cls
