"""Attitudes: rotations of three-space, vectorised, under SciPy's names."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInput
from .._core import attitude as _kernels
from . import arrays

FloatArray = NDArray[np.float64]


class Rotation:
    """One rotation, or an array of them; as an attitude it maps body components to space components.

    Names and meanings are those of `scipy.spatial.transform.Rotation`, whose objects are accepted wherever a rotation
    is. What differs is said where it does: bad input is refused where SciPy repairs it (`from_quat`, `from_matrix`),
    `as_euler` never warns (see `gimbal_lock`), and equal attitudes compare equal. Objects are immutable.

    Parameters
    ----------
    quat : array_like, shape (..., 4), or a rotation
        As in `from_quat`.
    scalar_first : bool
        Whether the components come as (w, x, y, z).

    Examples
    --------
    >>> import polhode as ph
    >>> rotation = ph.Rotation.from_euler("ZXZ", [90, 0, 0], degrees=True)
    >>> rotation.apply([1.0, 0.0, 0.0]).round(12) + 0.0
    array([0., 1., 0.])
    """

    __slots__ = ("_quat",)
    __array_ufunc__ = None  # so that Rotation refuses an array times a rotation
    _quat: FloatArray

    def __init__(self, quat: Any, *, scalar_first: bool = False) -> None:
        _set(self, _quat_of(quat, scalar_first=scalar_first))

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a Rotation is immutable: cannot set {name!r}")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"a Rotation is immutable: cannot delete {name!r}")

    # ---- made from

    @staticmethod
    def from_quat(quat: Any, *, scalar_first: bool = False) -> Rotation:
        """From Hamilton quaternions.

        Parameters
        ----------
        quat : array_like, shape (..., 4)
            (x, y, z, w); of unit norm within 1e-6, then normalised. SciPy normalises any.
        scalar_first : bool
            Whether the components come as (w, x, y, z).

        Raises
        ------
        InvalidInput
            Norm 0 or further than 1e-6 from 1, NaN, inf, or another shape.
        """
        return Rotation(quat, scalar_first=scalar_first)

    @staticmethod
    def from_matrix(matrix: ArrayLike) -> Rotation:
        """From rotation matrices R_WB, v_W = R_WB v_B.

        Parameters
        ----------
        matrix : array_like, shape (..., 3, 3)
            Orthogonal within 1e-6 (largest entry of R^T R - 1), then replaced by the nearest rotation. SciPy takes
            the nearest rotation of any matrix of positive determinant.

        Raises
        ------
        InvalidInput
            Determinant <= 0, further from orthogonal, NaN, inf, or another shape.

        Notes
        -----
        Formula after Shepperd 1978, J. Guidance and Control 1, 223.
        """
        return _wrap(_kernels.from_matrix(matrix))

    @staticmethod
    def from_rotvec(rotvec: ArrayLike, degrees: bool = False) -> Rotation:
        """From rotation vectors: the rotation by the angle abs(v) about v.

        Parameters
        ----------
        rotvec : array_like, shape (..., 3)
            [rad], or degrees if `degrees`; of any length.

        Raises
        ------
        InvalidInput
            NaN, inf, or another shape.
        """
        return _wrap(_kernels.from_rotvec(rotvec, arrays.require_bool(degrees, "degrees")))

    @staticmethod
    def from_euler(seq: str, angles: ArrayLike, degrees: bool = False) -> Rotation:
        """From Euler angles.

        Parameters
        ----------
        seq : str
            One to three axes, neighbours different: upper case rotates about the axes as rotated so far (intrinsic),
            lower case about the fixed axes (extrinsic). The textbook's (phi, theta, psi) are "ZXZ".
        angles : array_like, shape (..., len(seq)); also a number for one axis
            [rad], or degrees if `degrees`, in the order of the letters.

        Raises
        ------
        InvalidInput
            Unknown sequence, NaN, inf, or another shape.
        """
        return _wrap(_kernels.from_euler(seq, angles, arrays.require_bool(degrees, "degrees")))

    @staticmethod
    def from_mrp(mrp: ArrayLike) -> Rotation:
        """From modified Rodrigues parameters e tan(angle / 4), shape (..., 3), of any length.

        p and its shadow -p / abs(p)^2 are the same rotation. InvalidInput for NaN, inf, or another shape.
        """
        return Rotation(arrays.from_mrp(mrp))

    @staticmethod
    def align_vectors(a: ArrayLike, b: ArrayLike, weights: ArrayLike | None = None) -> tuple[Rotation, float]:
        """The rotation that takes vectors b to vectors a with the least sum of weight abs(a - R b)^2.

        Parameters
        ----------
        a, b : array_like, shape (3,) or (n, 3)
            Of one pair, the directions are matched by the shortest rotation.
        weights : array_like, shape (n,), optional
            0 or more, 1 unless given. One may be inf: the directions of that pair are matched exactly.

        Returns
        -------
        rotation : Rotation
        rssd : float
            The square root of that sum, over the finite weights.

        Warns
        -----
        UserWarning
            When the vectors leave the rotation open, as parallel ones do. About an exact pair it is the shortest then.
        """
        quat, rssd = arrays.align(a, b, weights)
        return _wrap(quat), rssd

    @staticmethod
    def identity(num: int | None = None, *, shape: int | tuple[int, ...] | None = None) -> Rotation:
        """The rotation that does nothing: one, `num` of them, or an array of the shape."""
        quat = np.zeros((*arrays.to_shape(num, shape), 4))
        quat[..., 3] = 1.0
        return _wrap(quat)

    @staticmethod
    def random(
        num: int | None = None, rng: np.random.Generator | int | None = None, *,
        shape: int | tuple[int, ...] | None = None,
    ) -> Rotation:
        """Uniform over all rotations: one, `num` of them, or an array of the shape.

        Parameters
        ----------
        rng : numpy.random.Generator or a seed for one, optional
            The same generator gives the same rotations as SciPy's.
        """
        quat = np.random.default_rng(arrays.to_seed(rng)).normal(size=(*arrays.to_shape(num, shape), 4))
        return Rotation(quat / np.linalg.norm(quat, axis=-1, keepdims=True))

    @staticmethod
    def concatenate(rotations: Rotation | Iterable[Rotation]) -> Rotation:
        """Several rotations, each one or an array of them, in one array along the first dimension."""
        parts = (rotations,) if arrays.is_rotation(rotations) else arrays.to_items(rotations, "rotations", "several")
        if not parts:
            raise InvalidInput("rotations: must be at least one rotation, got an empty list")
        if len(parts) == 1:
            return Rotation(parts[0])
        quats = [quat[np.newaxis] if quat.ndim == 1 else quat for quat in map(_quat_of, parts)]
        if len({quat.shape[1:] for quat in quats}) > 1:
            shapes = ", ".join(str(quat.shape[:-1]) for quat in quats)
            raise InvalidInput(f"rotations: must be equal in all dimensions but the first, got {shapes}")
        return _wrap(np.concatenate(quats))

    # ---- given as

    def as_quat(self, canonical: bool = False, *, scalar_first: bool = False) -> FloatArray:
        """Quaternions, shape (..., 4): (x, y, z, w), or (w, x, y, z) if `scalar_first`.

        Parameters
        ----------
        canonical : bool
            Of q and -q take the one with w > 0; for w = 0 the one whose first non-zero component is positive.
        scalar_first : bool
        """
        quat = _kernels.canonical(self._quat) if arrays.require_bool(canonical, "canonical") else self._quat.copy()
        return np.roll(quat, 1, axis=-1) if arrays.require_bool(scalar_first, "scalar_first") else quat

    def as_matrix(self) -> FloatArray:
        """Rotation matrices R_WB, shape (..., 3, 3), v_W = R_WB v_B."""
        return _kernels.as_matrix(self._quat)

    def as_rotvec(self, degrees: bool = False) -> FloatArray:
        """The shortest rotation vectors, shape (..., 3) [rad], of length pi at most.

        At pi exactly (w = 0), where v and -v are the same rotation, the first non-zero component is positive.
        """
        return _kernels.as_rotvec(self._quat, arrays.require_bool(degrees, "degrees"))

    def as_mrp(self) -> FloatArray:
        """Modified Rodrigues parameters e tan(angle / 4), shape (..., 3), of length 1 at most.

        At a half turn, where p and -p are the same rotation, the first non-zero component is positive.
        """
        return arrays.as_mrp(self._quat)

    def as_euler(self, seq: str, degrees: bool = False) -> FloatArray:
        """Euler angles, shape (..., 3) [rad], in the order of the letters.

        Parameters
        ----------
        seq : str
            Three axes, as in `from_euler`.

        Returns
        -------
        angles : ndarray, shape (..., 3)
            The outer ones in [-pi, pi], the middle one in [0, pi] ("ZXZ") or [-pi/2, pi/2] ("ZYX"). Their matrix is
            this rotation's within 2e-15 at every distance from the pole. At gimbal lock the third angle is 0 and the
            middle one is the pole's; see `gimbal_lock`. No warning is given.

        Raises
        ------
        InvalidInput
            Unknown sequence.

        Notes
        -----
        Bernardes & Viollet 2022, PLoS ONE 17(11) e0276302, with the middle angle of sequences of three axes from its
        sine and cosine. SciPy sets the third angle to 0 within 1e-7 rad of the pole, here it is within 9e-16.
        """
        return _kernels.as_euler(seq, self._quat, arrays.require_bool(degrees, "degrees"))

    def gimbal_lock(self, seq: str) -> NDArray[np.bool_] | Any:
        """Where only the sum or the difference of the outer Euler angles is determined; a bool for one rotation.

        That is where the middle angle is within 9e-16 rad (4 units of rounding) of its pole: 0 or pi for "ZXZ",
        +-pi/2 for "ZYX".
        """
        locked = _kernels.gimbal_lock(seq, self._quat)
        return bool(locked) if self.single else locked

    def magnitude(self) -> FloatArray | Any:
        """The angle of the rotation, in [0, pi] [rad]; a float for one rotation."""
        angle = _kernels.magnitude(self._quat)
        return float(angle) if self.single else angle

    # ---- used

    def apply(self, vectors: ArrayLike, inverse: bool = False) -> FloatArray:
        """Rotate vectors: v_W = R_WB v_B, or v_B = R_WB^T v_W when `inverse`.

        Parameters
        ----------
        vectors : array_like, shape (..., 3)
            Its leading dimensions broadcast with those of the rotations.

        Raises
        ------
        InvalidInput
            NaN, inf, or a shape that does not fit.
        """
        return _kernels.apply(self._quat, vectors, arrays.require_bool(inverse, "inverse"))

    def inv(self) -> Rotation:
        """The inverse rotation; as an attitude, from space to body."""
        return _wrap(_kernels.conjugate(self._quat))

    def __mul__(self, other: Any) -> Rotation:
        """R_AB * R_BC = R_AC: first `other`, then this one. Shapes broadcast."""
        if hasattr(other, "as_quat"):
            return _wrap(_kernels.multiply(self._quat, _quat_of(other)))
        return NotImplemented

    def __rmul__(self, other: Any) -> Rotation:
        if hasattr(other, "as_quat"):
            return _wrap(_kernels.multiply(_quat_of(other), self._quat))
        return NotImplemented

    def __pow__(self, n: ArrayLike) -> Rotation:
        """The rotation about the same axis by n times the angle in [0, pi]; real n broadcast with the rotations."""
        power = arrays.to_exponents(n, self.shape)
        if power.ndim == 0 and abs(power) == 1.0:
            return self if power > 0 else self.inv()
        return Rotation.from_rotvec(power[..., np.newaxis] * self.as_rotvec())

    def mean(self, weights: ArrayLike | None = None) -> Rotation:
        """The rotation whose matrix is nearest to the mean of all matrices (chordal distance).

        Parameters
        ----------
        weights : array_like, optional
            0 or more, not all of them 0; they broadcast to the shape of the rotations.
        """
        return Rotation(arrays.mean(self._quat, weights))

    def spread(self, weights: ArrayLike | None = None) -> float:
        """2 asin of the root of the mean of sin^2(angle from `mean` / 2) [rad]: of small angles, their rms."""
        return arrays.spread(self._quat, weights)

    def approx_equal(self, other: Any, atol: float | None = None, degrees: bool = False) -> NDArray[np.bool_] | Any:
        """Whether the angle between the two is below `atol`, 1e-8 rad unless given; `degrees` alone gives a warning."""
        if arrays.require_bool(degrees, "degrees") and atol is None:
            warnings.warn("degrees: must be used with atol, which is 1e-8 rad now", UserWarning, stacklevel=2)
        unit = np.deg2rad(1.0) if degrees else 1.0
        limit = 1e-8 if atol is None else unit * arrays.to_number(atol, "atol")
        return (Rotation(other) * self.inv()).magnitude() < limit

    # ---- as a container

    @property
    def shape(self) -> tuple[int, ...]:
        """Of the array of rotations, () for one."""
        return self._quat.shape[:-1]

    @property
    def single(self) -> bool:
        """Whether this is one rotation and no array."""
        return self._quat.ndim == 1

    def __len__(self) -> int:
        self._refuse_single("has no len()")
        return len(self._quat)

    def __bool__(self) -> bool:
        return True

    def __getitem__(self, index: Any) -> Rotation:
        self._refuse_single("cannot be indexed")
        leading = index if isinstance(index, tuple) else (index,)
        return _wrap(np.ascontiguousarray(self._quat[(*leading, slice(None))]))

    def __iter__(self) -> Iterator[Rotation]:
        self._refuse_single("cannot be iterated over")
        return (_wrap(quat) for quat in self._quat)

    def _refuse_single(self, what: str) -> None:
        if self.single:
            raise TypeError(f"a single Rotation {what}")

    def __eq__(self, other: object) -> bool:
        """Whether both are the same, bit by bit up to the sign of each quaternion (see `approx_equal`)."""
        if not isinstance(other, Rotation):
            return NotImplemented
        return np.array_equal(self.as_quat(canonical=True), other.as_quat(canonical=True))

    def __hash__(self) -> int:
        return hash((self.shape, self.as_quat(canonical=True).tobytes()))

    def __reduce__(self) -> tuple[Any, ...]:
        return _wrap, (self._quat,)

    def __repr__(self) -> str:
        head = "Rotation.from_quat("
        return head + np.array2string(self._quat, separator=", ", threshold=40, floatmode="unique", prefix=head) + ")"


def _set(rotation: Rotation, quat: FloatArray) -> None:
    quat.flags.writeable = False
    object.__setattr__(rotation, "_quat", quat)


def _wrap(quat: FloatArray) -> Rotation:
    """Return the rotation of unit quaternions, without a copy."""
    rotation = object.__new__(Rotation)
    _set(rotation, quat)
    return rotation


def _quat_of(value: Any, *, scalar_first: bool = False) -> FloatArray:
    """Unit quaternions (..., 4) of a rotation, polhode's or SciPy's, or of an array."""
    if isinstance(value, Rotation):
        return value._quat
    if arrays.is_rotation(value):
        value, scalar_first = value.as_quat(), False
    return _kernels.normalize(value, arrays.require_bool(scalar_first, "scalar_first"))
