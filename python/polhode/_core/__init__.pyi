"""
The compiled core of polhode. Use the names of the package `polhode`, not these.
"""
from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import polhode
import typing

from polhode._sensitivity.sensitivity import Sensitivity
from . import attitude
from . import torques
from . import symbols
from . import exact
class InvalidInput(ValueError):
    pass
class IntegrationFailure(RuntimeError):
    pass
class PrincipalAxes:
    """
    Principal moments and axes, and which directions are arbitrary.

    Made by :meth:`InertiaTensor.principal`.
    """
    def __eq__(self: PrincipalAxes, arg0: object) -> bool:
        ...
    def __getstate__(self: PrincipalAxes) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], int]:
        ...
    def __hash__(self: PrincipalAxes) -> int:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self: PrincipalAxes) -> str:
        ...
    def __setstate__(self: PrincipalAxes, arg0: tuple[typing.Any, ...]) -> None:
        ...
    @property
    def arbitrary(self) -> str:
        """
        'none', 'plane' (every direction across `normal`) or 'sphere' (every direction).
        """
    @property
    def axes(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3, 3) R_BP: the columns are the principal axes in the given axes, right-handed.
        """
    @property
    def moments(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) principal moments, ascending [kg m^2].
        """
    @property
    def normal(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        (3,) the axis across the arbitrary plane, in the given axes; None when there is no such plane.
        """
    @property
    def symmetry(self) -> str:
        """
        'spherical', 'oblate' (the largest moment apart), 'prolate' (the smallest) or 'triaxial'.
        """
class InertiaTensor:
    """
    Inertia tensor of a body about a stated point, in given axes.

    The angular momentum is L = matrix @ omega, so the products of inertia stand in the matrix with their minus sign,
    I_xy = -sum of m x y. A tensor that no body can have is refused, by relative thresholds. A rod's zero axial moment and a
    point's zero tensor are valid. Tensors never change, compare and hash by value; arrays read from one are copies.

    Parameters
    ----------
    matrix : array_like, shape (3, 3)
        In axes B [kg m^2]. Entries across the diagonal may differ by 1e-12 of the largest one; their mean is taken.
    physical : bool
        False gives up the triangle inequality (no moment above the sum of the two others), for published cases that break
        it. Symmetry and moments that are not negative are asked for all the same.

    Raises
    ------
    InvalidInput
        Wrong shape, not finite, not symmetric, a negative moment, or a moment above the sum of the two others; with the
        axis, the deficit in per cent and the likely cause.
    """
    @staticmethod
    def _repr_html_(tensor: typing.Any) -> str:
        """
        Return the matrix of an InertiaTensor with its moments and axes.
        """
    @staticmethod
    def from_moments(moments: typing.Any, *, physical: bool = True) -> InertiaTensor:
        """
        The tensor with these moments about the given axes, in their order: unsorted is fine.

        Parameters
        ----------
        moments : array_like, shape (3,)
            About x, y, z [kg m^2].
        physical : bool
            As for the class.
        """
    def __eq__(self: InertiaTensor, arg0: object) -> bool:
        ...
    def __getstate__(self: InertiaTensor) -> tuple[numpy.typing.NDArray[numpy.float64], bool]:
        ...
    def __hash__(self: InertiaTensor) -> int:
        ...
    def __init__(self: InertiaTensor, matrix: typing.Any, *, physical: bool = True) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self: InertiaTensor) -> str:
        ...
    def __setstate__(self: InertiaTensor, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def about_axis(self: InertiaTensor, direction: typing.Any) -> float:
        """
        Moment of inertia about the line through the point of reference along a direction [kg m^2].

        Parameters
        ----------
        direction : array_like, shape (3,)
            In the given axes, of any length but zero.
        """
    def principal(self: InertiaTensor, gap: typing.Any = None) -> PrincipalAxes:
        """
        Moments, axes, symmetry and which directions are arbitrary, in one object.

        Parameters
        ----------
        gap : float, optional
            Moments closer than this part of the largest count as equal. By default 16 units of rounding, 3.6e-15; data with six
            digits need 1e-6.

        Returns
        -------
        PrincipalAxes
        """
    def rotated(self: InertiaTensor, rotation: typing.Any) -> InertiaTensor:
        """
        The tensor in axes A, R_AB @ matrix @ R_AB.T.

        Parameters
        ----------
        rotation : Rotation or array_like, shape (4,)
            Takes components in the given axes B to components in A; a quaternion is scalar last.
        """
    @property
    def axes(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3, 3) R_BP: the columns are the principal axes in the given axes, right-handed, in the moments' order; the
        signs by the rule of :func:`polhode.inertia.principal_axes`.
        """
    @property
    def matrix(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3, 3) the tensor in the given axes, exactly symmetric [kg m^2].
        """
    @property
    def moments(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) principal moments, ascending [kg m^2].
        """
    @property
    def physical(self) -> bool:
        """
        True if the triangle inequality was checked.
        """
    @property
    def symmetry(self) -> str:
        """
        'spherical', 'oblate' (the largest moment apart), 'prolate' (the smallest) or 'triaxial'.
        """
class MassProperties:
    """
    Mass, centre of mass and inertia of a body.

    Parameters
    ----------
    mass : float
        Positive [kg].
    com : array_like, shape (3,)
        Centre of mass, from the origin of the body's axes B [m].
    inertia : InertiaTensor or array_like, shape (3, 3)
        About the centre of mass, in axes B [kg m^2].

    Raises
    ------
    InvalidInput
        A mass that is not positive, anything not finite, and what InertiaTensor refuses.
    """
    @staticmethod
    def _repr_html_(body: typing.Any) -> str:
        """
        Return mass, centre of mass and tensor.
        """
    @staticmethod
    def from_file(path: typing.Any, *, density: typing.Any = None, mass: typing.Any = None, unit: typing.Any = 'm', check: bool = True, repair: typing.Any = None, weld: typing.Any = 1e-09) -> MassProperties:
        """
        The solid inside the surface that a file holds: STL, or with the `mesh` extra OBJ, PLY, glTF.

        Files do not tell their unit: say it. The rest is as for :meth:`from_mesh`.

        Parameters
        ----------
        path : str or PathLike
            The format goes by the suffix.
        density, mass : float
            One of them [kg/m^3], [kg].
        unit : float or str
            Length of a unit of the file [m], or one of "m", "dm", "cm", "mm", "um", "km", "in", "ft".
        check : bool
            As for `from_mesh`.
        repair : {"flip"}, optional
            As for `from_mesh`.
        weld : float
            As for `from_mesh`.

        Returns
        -------
        MassProperties

        Raises
        ------
        InvalidInput
            A file that cannot be read, is cut short or does not hold what it says, and what `from_mesh` refuses.
        """
    @staticmethod
    def from_mesh(vertices: typing.Any, faces: typing.Any, *, density: typing.Any = None, mass: typing.Any = None, unit: typing.Any = 'm', check: bool = True, repair: typing.Any = None, weld: typing.Any = 1e-09) -> MassProperties:
        """
        The solid of uniform density inside a surface of triangles, exact for its vertices wherever they are.

        The surface must be closed, every edge between two faces that pass it in opposite directions. Vertices at one place
        count as one; so do those of open edges that lie nearer than `weld` times the mesh's size, as CAD programs write them.
        :func:`polhode.mesh.report` counts them, and describes holes. The surface may have several parts and cavities (shells
        wound inward); where parts overlap, the overlap counts twice: a part inside another is warned of, surfaces that cross are not looked for.

        Parameters
        ----------
        vertices : array_like, shape (n, 3)
            In the body's axes, in units of `unit`. C-contiguous float64 is taken without a copy.
        faces : array_like of integers, shape (m, 3)
            Vertices of each triangle, counter-clockwise as seen from outside. C-contiguous int32 and int64 need no copy.
        density : float
            [kg/m^3]; or else
        mass : float
            [kg] of the whole.
        unit : float or str
            Length of a unit of the vertices [m], or one of "m", "dm", "cm", "mm", "um", "km", "in", "ft".
        check : bool
            False leaves out all that is asked of the surface: fast, and wrong without a word when it is open.
        repair : {"flip"}, optional
            Turns a surface that is wound inward as a whole, and warns that it did.
        weld : float
            Part of the longest side of the box round the mesh, 0 or from 1e-15 to 0.01. Where open edges are left, their
            vertices nearer than that take the place of the first of them. 0 takes equal vertices alone.

        Returns
        -------
        MassProperties

        Warns
        -----
        UserWarning
            A mesh longer than 2 km or shorter than 2 um, which may be a wrong unit; one that was turned; a solid inside
            another, which may be a cavity wound the wrong way.

        Raises
        ------
        InvalidInput
            An open, inverted or non-manifold surface, with counts and the first faces; an index that names no vertex; a vertex
            that is not finite; no volume; density or mass not positive.

        References
        ----------
        B. Mirtich, J. Graphics Tools 1(2) (1996) 31; D. Eberly, Polyhedral mass properties (revisited) (2002).
        """
    @staticmethod
    def from_points(masses: typing.Any, positions: typing.Any) -> MassProperties:
        """
        A rigid set of point masses.

        Parameters
        ----------
        masses : array_like, shape (n,)
            All positive [kg].
        positions : array_like, shape (n, 3)
            In the body's axes [m].
        """
    @staticmethod
    def from_tensor(mass: typing.Any, com: typing.Any, inertia: typing.Any, *, about: typing.Any = (0, 0, 0)) -> MassProperties:
        """
        From a tensor about another point, as CAD reports give it: the parallel axes theorem, backwards.

        Parameters
        ----------
        mass : float
            Positive [kg].
        com : array_like, shape (3,)
            Centre of mass, from the origin of the body's axes [m].
        inertia : InertiaTensor or array_like, shape (3, 3)
            About the point `about`, in the body's axes [kg m^2].
        about : array_like, shape (3,)
            From the origin [m]; the origin itself unless given.

        Raises
        ------
        InvalidInput
            When no body has them: the tensor about the centre of mass has a negative moment, or one above the sum of the two
            others.
        """
    def __add__(self: MassProperties, arg0: MassProperties) -> MassProperties:
        """
        Both bodies as one, given in the same axes from the same origin.
        """
    def __eq__(self: MassProperties, arg0: object) -> bool:
        ...
    def __getstate__(self: MassProperties) -> tuple[float, numpy.typing.NDArray[numpy.float64], InertiaTensor]:
        ...
    def __hash__(self: MassProperties) -> int:
        ...
    def __init__(self: MassProperties, mass: typing.Any, com: typing.Any, inertia: typing.Any) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self: MassProperties) -> str:
        ...
    def __setstate__(self: MassProperties, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def __sub__(self: MassProperties, arg0: MassProperties) -> MassProperties:
        """
        The first body with the second taken out of it; refused when no body is left.
        """
    def about(self: MassProperties, point: typing.Any) -> InertiaTensor:
        """
        InertiaTensor about another point: the parallel axes theorem.

        Parameters
        ----------
        point : array_like, shape (3,)
            From the origin, in the body's axes [m].
        """
    def moved(self: MassProperties, rotation: typing.Any = (0, 0, 0, 1), translation: typing.Any = (0, 0, 0)) -> MassProperties:
        """
        The same body placed elsewhere: its point p goes to R_AB p + translation.

        Parameters
        ----------
        rotation : Rotation or array_like, shape (4,)
            Takes components in the body's axes B to components in A; a quaternion is scalar last.
        translation : array_like, shape (3,)
            In axes A [m].
        """
    @property
    def com(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) centre of mass, from the origin, in the body's axes [m].
        """
    @property
    def inertia(self) -> InertiaTensor:
        """
        InertiaTensor about the centre of mass, in the body's axes.
        """
    @property
    def mass(self) -> float:
        """
        Mass [kg].
        """
class _MagneticField:
    @staticmethod
    def dipole(arg0: typing.Any, arg1: typing.SupportsFloat | typing.SupportsIndex, arg2: typing.SupportsFloat | typing.SupportsIndex, arg3: typing.SupportsFloat | typing.SupportsIndex, arg4: typing.SupportsFloat | typing.SupportsIndex) -> _MagneticField:
        ...
    @staticmethod
    def gauss(arg0: typing.Any, arg1: typing.SupportsFloat | typing.SupportsIndex, arg2: collections.abc.Sequence[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]], arg3: collections.abc.Sequence[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]], arg4: typing.SupportsFloat | typing.SupportsIndex, arg5: typing.SupportsFloat | typing.SupportsIndex) -> _MagneticField:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    @typing.overload
    def at(self, arg0: typing.SupportsFloat | typing.SupportsIndex) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @typing.overload
    def at(self, arg0: typing.SupportsFloat | typing.SupportsIndex, arg1: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
        ...
class FreeMotion(exact._ClosedForm):
    """
    Torque-free motion of any rigid body, in closed form at any time.

    One class for the sphere, symmetric and triaxial bodies, steady rotation, rest, needles and the separatrix, exactly and
    nearly. The error against the exact motion of the same float64 input is a few units of rounding at every time.

    Parameters
    ----------
    inertia : InertiaTensor, or array_like of shape (3,)
        About the centre of mass (or a fixed point), in body axes [kg m^2]; three numbers are principal moments in the given
        axes, in any order.
    omega : array_like, shape (3,)
        Angular velocity at t = 0, in body axes [rad/s].
    attitude : array_like of shape (4,), or a Rotation
        Body to space at t = 0, (x, y, z, w).
    physical : bool
        False gives up the triangle inequality for three moments, as in :class:`InertiaTensor`.

    Raises
    ------
    InvalidInput
        Not finite, a body no mass makes, one without a moment about some axis, or an attitude that is not unit.

    Notes
    -----
    Jacobi (1850), "Sur la rotation d'un corps", J. reine angew. Math. 39, in the Cayley-Klein form; see docs/exact.md.
    """
    def __eq__(self: FreeMotion, arg0: object) -> bool:
        ...
    def __getstate__(self: FreeMotion) -> tuple[InertiaTensor, numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        ...
    def __hash__(self: FreeMotion) -> int:
        ...
    def __init__(self: FreeMotion, inertia: typing.Any, omega: typing.Any, attitude: typing.Any = (0, 0, 0, 1), *, physical: bool = True) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self: FreeMotion) -> str:
        ...
    def __setstate__(self: FreeMotion, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def at(self: FreeMotion, t: typing.Any, *, progress: typing.Any = None) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Angular velocity and attitude at the given times.

        Parameters
        ----------
        t : array_like, any shape
            Times [s], negative ones too, up to abs(omega t) = 1e25 rad.
        progress : True or callable, optional
            ``progress(times done, all times)`` is called about fifty times a second. What it raises ends the call. True writes
            a line with the time left to stderr.

        Returns
        -------
        omega : ndarray, shape (..., 3)
            In body axes [rad/s].
        attitude : ndarray, shape (..., 4)
            Body to space, unit, (x, y, z, w).
        """
    def euler_angles(self: FreeMotion, t: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
        """
        Angles about the angular momentum.

        Parameters
        ----------
        t : array_like, any shape
            Times [s].

        Returns
        -------
        ndarray, shape (..., 3)
            (phi, theta, psi) [rad], intrinsic z-x-z of the body axes in a space frame whose z axis is the angular momentum
            (space z turned there the shortest way): precession, nutation and spin. phi and psi in [-pi, pi].
        """
    def flip_times(self: FreeMotion, begin: typing.Any, end: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
        """
        When the racket flips.

        Parameters
        ----------
        begin, end : float
            The span [s], both ends included.

        Returns
        -------
        ndarray, shape (n,)
            Ascending times at which omega's component along the intermediate axis passes through zero. Empty unless the three
            moments differ and the motion is not steady.
        """
    def herpolhode(self: FreeMotion, t: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
        """
        Poinsot's point of contact in space axes.

        Parameters
        ----------
        t : array_like, any shape
            Times [s].

        Returns
        -------
        ndarray, shape (..., 3)
            The polhode's point turned by the attitude; it stays in the plane L . v = sqrt(2 T) [kg^-1/2 m^-1].
        """
    def polhode(self: FreeMotion, t: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
        """
        Poinsot's point of contact in body axes.

        Parameters
        ----------
        t : array_like, any shape
            Times [s].

        Returns
        -------
        ndarray, shape (..., 3)
            omega / sqrt(2 T), on the inertia ellipsoid [kg^-1/2 m^-1].
        """
    def sensitivity(self: FreeMotion, t: typing.Any, wrt: typing.Any = ('omega', 'inertia'), side: str = 'space') -> Sensitivity:
        """
        The motion and its derivatives at the given times.

        Parameters
        ----------
        t : array_like, any shape
            Times [s], as for :meth:`at`.
        wrt : str or sequence of str
            What to differentiate with respect to, in the order of the columns: 'omega' (omega at t = 0), 'inertia' (the
            principal moments at fixed omega; ascending for a full tensor), 'attitude' (a small rotation at t = 0), 'axes' (a
            small rotation of the principal axes in the body), each three columns, and 'time', one.
        side : {'space', 'body'}
            Small rotations of the attitude R: exp(d theta) R in space axes, or R exp(d theta) in body axes.

        Returns
        -------
        Sensitivity
            `omega`, `attitude`, `d_omega` and `d_attitude` of shape (..., 3, n), `columns`, `transition`.

        Raises
        ------
        InvalidInput
            An unknown name, a name twice, or abs(omega t) > 1e25 rad.

        Notes
        -----
        The error of a column is a few units of rounding of its size, in every regime. See docs/sensitivity.md.
        """
    @property
    def _picture(self) -> tuple[list[typing.Any], list[typing.Any], float, float]:
        """
        The torques and rotors of its scene, its period [s] or 0, the longest span to draw [s].
        """
    @property
    def angular_momentum(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) in space axes, constant [kg m^2/s].
        """
    @property
    def attitude(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4,) attitude at t = 0.
        """
    @property
    def energy(self) -> float:
        """
        Kinetic energy [J].
        """
    @property
    def inertia(self) -> InertiaTensor:
        """
        The InertiaTensor.
        """
    @property
    def kind(self) -> str:
        """
        'rest', 'spherical', 'steady', 'oblate', 'prolate', 'about_least', 'about_greatest' (the
        principal axis that omega encircles) or 'separatrix'.
        """
    @property
    def omega(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) omega at t = 0, in body axes [rad/s].
        """
    @property
    def period(self) -> float:
        """
        Period of omega [s]: infinite on the separatrix, 0 where omega is constant.
        """
    @property
    def precession_rate(self) -> float:
        """
        Mean rate of precession about the angular momentum [rad/s].
        """
class Gyrostat(exact._ClosedForm):
    """
    Torque-free motion of a rigid body with rotors, in closed form at any time.

    Euler's equations are J omega' = (J omega + h) x omega with the rotors' momentum h constant in the body. One class for
    every body and every h: near and on steady turns, separatrices and symmetries too. The error against the exact motion of
    the same float64 input is a few units of rounding at every time. With h = 0 the answers are those of FreeMotion.

    Parameters
    ----------
    inertia : InertiaTensor, or array_like of shape (3,)
        About the centre of mass, in body axes, with the rotors locked [kg m^2]; three numbers are principal moments in the
        given axes, in any order. Beside `momentum` of rotors that are free on their bearings: less their axial parts.
    rotors : sequence of Rotor, optional
        Held at a constant speed relative to the body, or free on their bearings, without windows of time.
    momentum : array_like, shape (3,), optional
        In their place: the rotors' momentum h in body axes [kg m^2/s]. 0 if neither is given.
    omega : array_like, shape (3,)
        Angular velocity of the body at t = 0, in body axes [rad/s].
    attitude : array_like of shape (4,), or a Rotation
        Body to space at t = 0, (x, y, z, w).

    Raises
    ------
    InvalidInput
        Not finite, a body no mass makes, one without a moment about some axis, or an attitude that is not unit.

    Notes
    -----
    Zhukovsky (1885); Volterra (1899), Acta Math. 22; Wittenburg (1977), Dynamics of Systems of Rigid Bodies; see
    docs/gyrostat.md.
    """
    def __eq__(self: Gyrostat, arg0: object) -> bool:
        ...
    def __getstate__(self: Gyrostat) -> tuple[InertiaTensor, numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        ...
    def __hash__(self: Gyrostat) -> int:
        ...
    def __init__(self: Gyrostat, inertia: typing.Any, *, rotors: typing.Any = None, momentum: typing.Any = None, omega: typing.Any, attitude: typing.Any = (0, 0, 0, 1)) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self: Gyrostat) -> str:
        ...
    def __setstate__(self: Gyrostat, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def at(self: Gyrostat, t: typing.Any) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Angular velocity and attitude at the given times.

        Parameters
        ----------
        t : array_like, any shape
            Times [s], negative ones too, up to abs(omega t) = 1e25 rad.

        Returns
        -------
        omega : ndarray, shape (..., 3)
            In body axes [rad/s].
        attitude : ndarray, shape (..., 4)
            Body to space, unit, (x, y, z, w).
        """
    def euler_angles(self: Gyrostat, t: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
        """
        Angles about the total momentum.

        Parameters
        ----------
        t : array_like, any shape
            Times [s].

        Returns
        -------
        ndarray, shape (..., 3)
            (phi, theta, psi) [rad], intrinsic z-x-z of the body axes in a space frame whose z axis is the total momentum
            (space z turned there the shortest way): precession, nutation and spin. phi and psi in [-pi, pi].
        """
    def polhode(self: Gyrostat, t: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
        """
        The total momentum in body axes.

        Parameters
        ----------
        t : array_like, any shape
            Times [s].

        Returns
        -------
        ndarray, shape (..., 3)
            J omega + h [kg m^2/s]: on a sphere about 0 and on an ellipsoid of constant energy about h.
        """
    @property
    def _picture(self) -> tuple[list[typing.Any], list[typing.Any], float, float]:
        """
        The torques and rotors of its scene, its period [s] or 0, the longest span to draw [s].
        """
    @property
    def angular_momentum(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) total momentum in space axes, constant [kg m^2/s].
        """
    @property
    def attitude(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4,) attitude at t = 0.
        """
    @property
    def energy(self) -> float:
        """
        omega . J omega / 2, constant [J].
        """
    @property
    def inertia(self) -> InertiaTensor:
        """
        The InertiaTensor.
        """
    @property
    def kind(self) -> str:
        """
        'rest', 'steady', 'precession', 'paired', 'single' or 'separatrix'.

        'steady': omega is constant. 'precession': omega runs on a circle at a constant rate. 'paired': there is
        a second curve of the same energy and momentum. 'single': there is none.
        """
    @property
    def momentum(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) the rotors' momentum h in body axes [kg m^2/s].
        """
    @property
    def omega(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) omega at t = 0, in body axes [rad/s].
        """
    @property
    def period(self) -> float:
        """
        Period of omega [s]: infinite on a separatrix, 0 where omega is constant.
        """
class DampedFree(exact._ClosedForm):
    """
    A free body with damping proportional to its angular momentum, -c I omega.

    In closed form at any time, for any body: it is the free motion in the slowed time s = (1 - exp(-c t)) / c, with omega
    multiplied by exp(-c t). The error is that of FreeMotion.

    Parameters
    ----------
    inertia : InertiaTensor, or array_like of shape (3,)
        About the centre of mass (or a fixed point), in body axes [kg m^2]; three numbers are principal moments in the given
        axes, in any order.
    damping : float
        The rate c [1/s]. A negative rate drives the body.
    omega : array_like, shape (3,)
        Angular velocity at t = 0, in body axes [rad/s].
    attitude : array_like of shape (4,), or a Rotation
        Body to space at t = 0, (x, y, z, w).

    Raises
    ------
    InvalidInput
        Not finite, a body no mass makes, one without a moment about some axis, or an attitude that is not unit.

    Notes
    -----
    A change of time in Euler's equations; see docs/damped_free.md.
    """
    def __eq__(self: DampedFree, arg0: object) -> bool:
        ...
    def __getstate__(self: DampedFree) -> tuple[InertiaTensor, float, numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        ...
    def __hash__(self: DampedFree) -> int:
        ...
    def __init__(self: DampedFree, inertia: typing.Any, damping: typing.Any, omega: typing.Any, attitude: typing.Any = (0, 0, 0, 1)) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self: DampedFree) -> str:
        ...
    def __setstate__(self: DampedFree, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def at(self: DampedFree, t: typing.Any) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Angular velocity and attitude at the given times.

        Parameters
        ----------
        t : array_like, any shape
            Times [s], negative ones too.

        Returns
        -------
        omega : ndarray, shape (..., 3)
            In body axes [rad/s].
        attitude : ndarray, shape (..., 4)
            Body to space, unit, (x, y, z, w).

        Raises
        ------
        InvalidInput
            A time that is not finite, or at which a driven body is beyond float64.
        """
    def slowed_time(self: DampedFree, t: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        The time at which the free body has this attitude.

        Parameters
        ----------
        t : float
            Time [s].

        Returns
        -------
        float
            (1 - exp(-c t)) / c [s].
        """
    @property
    def _picture(self) -> tuple[list[typing.Any], list[typing.Any], float, float]:
        """
        The torques and rotors of its scene, its period [s] or 0, the longest span to draw [s].
        """
    @property
    def attitude(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4,) attitude at t = 0.
        """
    @property
    def damping(self) -> float:
        """
        The rate c [1/s].
        """
    @property
    def free(self) -> FreeMotion:
        """
        The FreeMotion in slowed time.
        """
    @property
    def inertia(self) -> InertiaTensor:
        """
        The InertiaTensor.
        """
    @property
    def omega(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) omega at t = 0, in body axes [rad/s].
        """
    @property
    def total_angle(self) -> float:
        """
        Bound on the angle of rotation from t = 0 on, abs(omega) / c [rad]; infinite for c <= 0.
        """
class Pendulum(exact._ClosedForm):
    """
    The plane pendulum: any body on a pivot under gravity that swings about one body axis.

    In closed form at any time and at every energy: swings of any size, rotation over the top, the separatrix between them,
    rest. The axis may be any of the three body axes. It must be principal, horizontal and at right angles to the arm, and
    omega must lie along it. These conditions are tested exactly. The error against the exact motion of the same float64
    input is a few units of rounding at every time.

    Parameters
    ----------
    inertia : InertiaTensor, or array_like of shape (3,)
        About the pivot, in body axes [kg m^2]; three numbers are principal moments in the given axes, in any order.
    weight : float
        m g [N]. Gravity points along -z of space.
    arm : array_like, shape (3,)
        From the pivot to the centre of mass, in body axes [m].
    omega : array_like, shape (3,)
        Angular velocity at t = 0, in body axes [rad/s].
    attitude : array_like of shape (4,), or a Rotation
        Body to space at t = 0, (x, y, z, w).

    Raises
    ------
    InvalidInput
        Not finite, a body no mass makes, an attitude that is not unit, or no plane pendulum, with the reason.

    Notes
    -----
    E. T. Whittaker, "Analytical Dynamics" (1937), section 44; see docs/pendulum.md.
    """
    def __eq__(self: Pendulum, arg0: object) -> bool:
        ...
    def __getstate__(self: Pendulum) -> tuple[InertiaTensor, float, numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        ...
    def __hash__(self: Pendulum) -> int:
        ...
    def __init__(self: Pendulum, inertia: typing.Any, weight: typing.Any, arm: typing.Any, omega: typing.Any, attitude: typing.Any = (0, 0, 0, 1)) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self: Pendulum) -> str:
        ...
    def __setstate__(self: Pendulum, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def at(self: Pendulum, t: typing.Any) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Angular velocity and attitude at the given times.

        Parameters
        ----------
        t : array_like, any shape
            Times [s], negative ones too, up to 1e25 rad.

        Returns
        -------
        omega : ndarray, shape (..., 3)
            In body axes [rad/s].
        attitude : ndarray, shape (..., 4)
            Body to space, unit, (x, y, z, w).

        Raises
        ------
        InvalidInput
            A time that is not finite, or too long for its phase to have digits.
        """
    @property
    def _picture(self) -> tuple[list[typing.Any], list[typing.Any], float, float]:
        """
        The torques and rotors of its scene, its period [s] or 0, the longest span to draw [s].
        """
    @property
    def arm(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) from the pivot to the centre of mass, in body axes [m].
        """
    @property
    def attitude(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4,) attitude at t = 0.
        """
    @property
    def axis(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) the axis of rotation in body axes, with omega along it.
        """
    @property
    def frequency(self) -> float:
        """
        Angular frequency of small swings, sqrt(m g r / I) [rad/s].
        """
    @property
    def inertia(self) -> InertiaTensor:
        """
        The InertiaTensor about the pivot.
        """
    @property
    def kind(self) -> str:
        """
        'rest', 'swinging', 'rotating' or 'separatrix'.
        """
    @property
    def omega(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) omega at t = 0, in body axes [rad/s].
        """
    @property
    def period(self) -> float:
        """
        Period of the rate [s]: infinite on the separatrix, 0 at rest.
        """
    @property
    def weight(self) -> float:
        """
        m g [N].
        """
class HeavyTop(exact._ClosedForm):
    """
    Lagrange's top: a symmetric body held at a point of its axis, under gravity.

    In closed form at any time: looping, cuspidal and monotone precession, both steady precessions, sleeping and hanging
    tops on both sides of stability, planar and spherical pendulums, next to and on the homoclinic motion. The error against
    the exact motion of the same float64 input is a few units of rounding at every time.

    Parameters
    ----------
    inertia : array_like of shape (3,), InertiaTensor, or array_like of shape (3, 3)
        About the pivot, in body axes, two moments equal [kg m^2]; three numbers are moments along the body axes. The
        symmetry axis is body z for (A, A, C); else the axis of the third moment, its largest component positive.
    weight_arm : float
        Mass times gravity times the distance of the centre of mass from the pivot, signed along the symmetry axis [N m].
        Gravity points along -z of space.
    omega : array_like, shape (3,)
        Angular velocity at t = 0, in body axes [rad/s].
    attitude : array_like of shape (4,), or a Rotation
        Body to space at t = 0, (x, y, z, w).
    rotor : float, optional
        Momentum of rotors about the symmetry axis, constant in the body [kg m^2/s], as of a toy gyroscope's wheel. The
        inertia is then as for Gyrostat.

    Raises
    ------
    InvalidInput
        Not finite, a body no mass makes, no two moments equal, an attitude that is not unit, or rates beyond float64.

    Notes
    -----
    F. Klein and A. Sommerfeld, "Ueber die Theorie des Kreisels" (1897-1910); see docs/heavy_top.md.
    """
    def __eq__(self: HeavyTop, arg0: object) -> bool:
        ...
    def __getstate__(self: HeavyTop) -> tuple[InertiaTensor, float, numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], float]:
        ...
    def __hash__(self: HeavyTop) -> int:
        ...
    def __init__(self: HeavyTop, inertia: typing.Any, weight_arm: typing.Any, omega: typing.Any, attitude: typing.Any = (0, 0, 0, 1), rotor: typing.Any = 0.0) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self: HeavyTop) -> str:
        ...
    def __setstate__(self: HeavyTop, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def at(self: HeavyTop, t: typing.Any) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Angular velocity and attitude at the given times.

        Parameters
        ----------
        t : array_like, any shape
            Times [s], negative ones too, up to abs(omega t) = 1e25 rad.

        Returns
        -------
        omega : ndarray, shape (..., 3)
            In body axes [rad/s].
        attitude : ndarray, shape (..., 4)
            Body to space, unit, (x, y, z, w).

        Raises
        ------
        InvalidInput
            A time that is not finite, or too long for its phase to have digits.
        """
    @property
    def _picture(self) -> tuple[list[typing.Any], list[typing.Any], float, float]:
        """
        The torques and rotors of its scene, its period [s] or 0, the longest span to draw [s].
        """
    @property
    def attitude(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4,) attitude at t = 0.
        """
    @property
    def axis(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) the symmetry axis in body axes, unit.
        """
    @property
    def energy(self) -> float:
        """
        Kinetic energy without that inside rotors, and weight_arm cos(tilt) [J].
        """
    @property
    def inertia(self) -> InertiaTensor:
        """
        The InertiaTensor about the pivot.
        """
    @property
    def kind(self) -> str:
        """
        'free' (no weight), 'sleeping', 'hanging', 'steady_precession', 'planar_pendulum',
        'spherical_pendulum', 'homoclinic', 'looping', 'cuspidal' or 'monotone'.
        """
    @property
    def nutation_period(self) -> float:
        """
        Period of the tilt [s]: infinite for 'homoclinic', 0 where the tilt is constant.
        """
    @property
    def omega(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) omega at t = 0, in body axes [rad/s].
        """
    @property
    def p_phi(self) -> float:
        """
        Angular momentum about space z, with rotors [kg m^2/s].
        """
    @property
    def p_psi(self) -> float:
        """
        Angular momentum about the symmetry axis, with rotors [kg m^2/s].
        """
    @property
    def precession_rate(self) -> float:
        """
        Mean rate of the axis about space z over a nutation [rad/s]. NaN for an axis that
        stays vertical, and for 'homoclinic'.
        """
    @property
    def rotor(self) -> float:
        """
        Momentum of rotors about the symmetry axis [kg m^2/s].
        """
    @property
    def tilt_bounds(self) -> tuple[float, float]:
        """
        (least, greatest) angle between the symmetry axis and space z [rad].
        """
    @property
    def weight_arm(self) -> float:
        """
        Signed along the symmetry axis [N m].
        """
class Controller:
    def __init__(self, parts: dict[str, typing.Any]) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def _call(self, arg0: typing.SupportsFloat | typing.SupportsIndex, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        ...
class Rotor:
    """
    Rotor(axis, *, momentum=None, inertia=None, speed=None, free=False, during=None, torque=0.0, viscous=0.0, coulomb=0.0, max_torque=None, max_speed=None, let=..., parameters=...)

    A symmetric rotor on an axis fixed in the body: a wheel, a propeller, a spinning platform.

    Euler's equations of the body become ``J omega' + omega x (J omega + h) = torque``. All rotors of a scene together give
    h. The inertia of a scene always includes its rotors, locked. A rotor that a motor holds at a constant relative speed
    leaves J as it is, and ``h = inertia * speed * axis``. A rotor that is free on its bearing has a constant absolute
    momentum about its axis, ``inertia * (speed + axis . omega)``. J is then less its axial moment.

    A motor and friction change the momentum of a free rotor by their torque e about the axis, and -e acts on the body:
    ``inertia * (speed' + axis . omega') = e``, with ``e = torque - viscous * speed - coulomb * sign(speed)``. The momentum
    is then a state of the motion, ``motion.states["rotor_momentum_0"]`` of the first rotor of a scene.

    Parameters
    ----------
    axis : array_like, shape (3,)
        Direction in body axes. It is divided by its length.
    momentum : float, optional
        Angular momentum about the axis [kg m^2/s]. Held: relative to the body. Free: absolute.
    inertia : float, optional
        Moment of inertia about the axis [kg m^2].
    speed : float, optional
        Speed relative to the body at the start [rad/s]. Give `momentum`, or `inertia` and `speed`, or `momentum` and
        `inertia`.
    free : bool
        True if no motor holds the speed. Without `inertia`, the scene's inertia must leave out the axial moment already.
    during : array_like, shape (n, 2) or (2,), optional
        Windows of time [s] in which a held rotor rotates; outside them it is at rest in the body. An
        empty list means never, no list means always. J omega + h is continuous
        where it starts or stops, so omega jumps by ``-J^-1 dh``.
    torque : float, str or callable, optional
        Torque of a motor on a free rotor about its axis [N m]. It is a number; a text such as
        ``"0.2 * omega.x - 0.01 * speed"`` of t, omega, attitude and speed [rad/s]; or ``torque(t, omega, attitude, p, s)``,
        which is traced once, with ``s.speed``. Texts have the words of `polhode.torques.Formula`.
    viscous : float, optional
        Viscous friction of a free rotor's bearing [N m s].
    coulomb : float, optional
        Dry friction of a free rotor's bearing [N m].
    max_torque : float, optional
        The motor's torque is cut to this size [N m].
    max_speed : float, optional
        The motor does not drive the rotor beyond this speed, in both senses [rad/s].
    let : dict of str, optional
        Names for shared parts of a text, in order.
    parameters : dict, optional
        Named numbers of a text or a function, ``p.kd`` in a function.

    Raises
    ------
    InvalidInput
        For an axis that is zero or not finite, numbers that are not finite, an inertia that is not positive, too many or
        too few numbers, and windows of a free rotor. For a motor or friction of a held rotor or of one without an inertia,
        and friction that is negative.

    Notes
    -----
    Wittenburg 1977, Dynamics of Systems of Rigid Bodies, sec. 4.6; Hughes 1986, Spacecraft Attitude Dynamics, ch. 6.
    """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, axis: typing.Any, *, momentum: typing.Any = None, inertia: typing.Any = None, speed: typing.Any = None, free: typing.Any = False, during: typing.Any = None, torque: typing.Any = 0.0, viscous: typing.Any = 0.0, coulomb: typing.Any = 0.0, max_torque: typing.Any = None, max_speed: typing.Any = None, let: typing.Any = None, parameters: typing.Any = None) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    @property
    def axis(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Unit vector in body axes, shape (3,).
        """
    @property
    def coulomb(self) -> float:
        """
        Dry friction of the bearing [N m].
        """
    @property
    def during(self) -> typing.Any:
        """
        tuple of (begin, end) [s], in the order of time; None if it always rotates.
        """
    @property
    def free(self) -> bool:
        """
        True if it is free on its bearing.
        """
    @property
    def inertia(self) -> float | None:
        """
        Moment about the axis [kg m^2], or None.
        """
    @property
    def let(self) -> dict[str, typing.Any]:
        """
        Shared parts of the motor's formula by name.
        """
    @property
    def max_speed(self) -> float | None:
        """
        The speed beyond which the motor does not drive [rad/s], or None.
        """
    @property
    def max_torque(self) -> float | None:
        """
        The most that the motor gives [N m], or None.
        """
    @property
    def momentum(self) -> float | None:
        """
        As given [kg m^2/s], or None.
        """
    @property
    def parameters(self) -> dict[str, typing.Any]:
        """
        Numbers of the motor's formula by name.
        """
    @property
    def speed(self) -> float | None:
        """
        Relative to the body at the start [rad/s], or None.
        """
    @property
    def torque(self) -> typing.Any:
        """
        Of the motor about the axis [N m]: a number, or the text of its formula.
        """
    @property
    def viscous(self) -> float:
        """
        Viscous friction of the bearing [N m s].
        """
class Damper:
    """
    Damper(*, inertia, viscous, rates=(0, 0, 0))

    A viscous slug: a sphere in a cavity of the body, full of a viscous fluid.

    With the rates sigma of the sphere relative to the body, the torque ``viscous * sigma`` acts on the body, and its opposite
    on the sphere: ``inertia * (sigma' + omega' + omega x sigma) = -viscous * sigma``. The inertia of a scene includes the
    sphere, locked. Its momentum ``inertia * (omega + sigma)`` is a state of the motion, ``motion.states["damper_momentum"]``.

    Parameters
    ----------
    inertia : float
        Moment of the sphere about its centre [kg m^2].
    viscous : float
        Damping between sphere and body [N m s].
    rates : array_like, shape (3,), optional
        Rates relative to the body at the start, body axes [rad/s].

    Raises
    ------
    InvalidInput
        For an inertia that is not positive, a negative damping, and numbers that are not finite.

    Notes
    -----
    Kane and Levinson 1985, Dynamics: Theory and Applications; Hughes 1986, Spacecraft Attitude Dynamics, sec. 3.7.
    """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, *, inertia: typing.Any, viscous: typing.Any, rates: typing.Any = (0.0, 0.0, 0.0)) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    @property
    def inertia(self) -> float:
        """
        Moment of the sphere about its centre [kg m^2].
        """
    @property
    def rates(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Relative to the body at the start, shape (3,) [rad/s].
        """
    @property
    def viscous(self) -> float:
        """
        Damping between sphere and body [N m s].
        """
class Changing:
    """
    Changing(pieces, *, before=None, after=None, physical=True)

    An inertia or a momentum that changes with time: a polynomial in each of its pieces.

    As `inertia` of a `Scene` it is the tensor of a body whose parts move or leave; as `momentum`, the angular momentum of
    parts inside, relative to the body axes. Values may jump between pieces; at such a time the later value holds.

    Parameters
    ----------
    pieces : iterable of (begin, end, terms)
        In the order of time, without gaps [s]. The value is ``A0 + A1 (t - begin) + A2 (t - begin)^2 + ...``, with the terms
        ``[A0, A1, ...]`` of shape (3,) or (3, 3) each. Three numbers are a vector, or the moments about the body axes.
    before, after : array_like, optional
        Constant values before the first piece and after the last.
    physical : bool
        Whether an inertia must have the triangle inequality at all times.

    Raises
    ------
    InvalidInput
        For no pieces, gaps, overlaps, numbers that are not finite, and terms of several shapes. A scene refuses an inertia
        that is not positive definite at some time.

    Examples
    --------
    >>> import polhode as ph
    >>> boom = ph.Changing.ramp((1, 2, 3), (2, 4, 5), (5, 15), order=1)
    >>> boom.at(10.0).tolist()
    [1.5, 3.0, 4.0]
    """
    @staticmethod
    def ramp(before: typing.Any, after: typing.Any, times: typing.Any, *, order: typing.Any = 5, physical: bool = True) -> Changing:
        """
        Return the change from one value to another between two times.

        With s from 0 to 1 between the times it is s for order 1, ``s^2 (3 - 2 s)`` for order 3, and ``s^3 (10 - 15 s + 6 s^2)`` for
        order 5, whose rate and acceleration vanish at both ends.

        Parameters
        ----------
        before, after : array_like, shape (3,) or (3, 3)
            Constant values before and after.
        times : (float, float)
            Begin and end [s].
        order : {1, 3, 5}
            Degree of the polynomial.
        physical : bool
            Whether an inertia must have the triangle inequality at all times.

        Returns
        -------
        Changing
            A constant, a polynomial, and a constant.

        Raises
        ------
        InvalidInput
            For times that are not finite or not in order, values of several shapes, and another order.
        """
    @staticmethod
    def table(t: typing.Any, values: typing.Any, *, physical: bool = True) -> Changing:
        """
        Return values that are linear between given times, and constant outside.

        Parameters
        ----------
        t : array_like, shape (n,)
            Times in their order, at least two [s].
        values : array_like, shape (n, 3) or (n, 3, 3)
            The values there.
        physical : bool
            Whether an inertia must have the triangle inequality at all times.

        Returns
        -------
        Changing
            A constant, n - 1 linear pieces, and a constant.

        Raises
        ------
        InvalidInput
            For times that are not in order or not finite, and another number of values.
        """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, pieces: typing.Any, *, before: typing.Any = None, after: typing.Any = None, physical: bool = True) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def at(self, t: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the values at times.

        Parameters
        ----------
        t : array_like
            Times [s]. At the time of a jump the later value holds.

        Returns
        -------
        ndarray, shape (..., 3) or (..., 3, 3)

        Raises
        ------
        InvalidInput
            For a time outside the pieces.
        """
    @property
    def physical(self) -> bool:
        """
        Whether an inertia must have the triangle inequality.
        """
    @property
    def pieces(self) -> tuple[typing.Any, ...]:
        """
        tuple of (begin, end, terms), with the constant ones before and after.
        """
class Scene:
    def __init__(self, inertia: typing.Any, omega: typing.Any, attitude: typing.Any, torques: collections.abc.Iterable[typing.Any], times: typing.Any, want: typing.Any, t0: typing.Any, name: typing.Any, rotors: collections.abc.Iterable[typing.Any], damper: typing.Any, momentum: typing.Any, leaving: bool, controllers: collections.abc.Iterable[typing.Any] = ()) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def torque(self, t: typing.Any, omega: typing.Any, attitude: typing.Any, states: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the sum of the torques at one state, or at many.

        Parameters
        ----------
        t : float, or array_like of shape (n,)
            Time [s].
        omega : array_like, shape (3,) or (n, 3)
            Rates in body axes [rad/s].
        attitude : array_like, shape (4,) or (n, 4)
            Unit quaternions (x, y, z, w).
        states : dict, optional
            Numbers of the formulas' states by name; the starts if left out.

        Returns
        -------
        ndarray, shape (3,) or (n, 3)
            In body axes [N m], without the torques of rotors.
        """
    @property
    def attitude(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def carrier_inertia(self) -> InertiaTensor:
        """
        InertiaTensor J that moves with omega: `inertia` less the axial moments of free rotors and the damper's.
        """
    @property
    def changing(self) -> Changing | None:
        """
        The inertia of a body that changes, or None. `inertia` is then that of the start.
        """
    @property
    def damper(self) -> Damper | None:
        """
        The viscous slug in the body, or None.
        """
    @property
    def inertia(self) -> InertiaTensor:
        ...
    @property
    def leaving(self) -> bool:
        """
        Whether matter that leaves takes its momentum along.
        """
    @property
    def momentum(self) -> Changing | None:
        """
        The momentum of parts inside the body, or None.
        """
    @property
    def name(self) -> str:
        ...
    @property
    def omega(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def rotor_momentum(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        h, the sum of the rotors' momenta in body axes at the start, shape (3,) [kg m^2/s].
        """
    @property
    def rotors(self) -> tuple[typing.Any, ...]:
        ...
    @property
    def states(self) -> dict[str, typing.Any]:
        """
        dict: the starts of the states that formulas have, by name.
        """
    @property
    def t0(self) -> float:
        ...
    @property
    def times(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def want(self) -> tuple[typing.Any, ...]:
        ...
class CostFactors:
    """
    The time of each method on this machine over its forecast, by name.
    """
    def __init__(self, factors: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex]) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
class PlannedScene:
    """
    A scene and what was decided for it, once.
    """
    def __init__(self, scene: Scene, options: dict[str, typing.Any]) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    @property
    def parts(self) -> dict[str, typing.Any]:
        ...
    @property
    def report(self) -> dict[str, typing.Any]:
        ...
class Answer:
    def __call__(self, arg0: typing.Any) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def states_at(self, arg0: typing.Any) -> dict[str, typing.Any]:
        ...
    @property
    def asked(self) -> float:
        ...
    @property
    def attitude(self) -> typing.Any:
        ...
    @property
    def attitude_lower(self) -> typing.Any:
        ...
    @property
    def attitude_upper(self) -> typing.Any:
        ...
    @property
    def error(self) -> float:
        ...
    @property
    def error_kind(self) -> str:
        ...
    @property
    def events(self) -> list[typing.Any]:
        ...
    @property
    def has_dense(self) -> bool:
        ...
    @property
    def message(self) -> str:
        ...
    @property
    def omega(self) -> typing.Any:
        ...
    @property
    def omega_lower(self) -> typing.Any:
        ...
    @property
    def omega_upper(self) -> typing.Any:
        ...
    @property
    def plan(self) -> dict[str, typing.Any]:
        ...
    @property
    def planned(self) -> PlannedScene:
        ...
    @property
    def proved_span(self) -> typing.Any:
        ...
    @property
    def states(self) -> dict[str, typing.Any]:
        ...
    @property
    def states_lower(self) -> typing.Any:
        ...
    @property
    def states_upper(self) -> typing.Any:
        ...
    @property
    def stats(self) -> dict[str, typing.Any]:
        ...
    @property
    def status(self) -> str:
        ...
    @property
    def t(self) -> typing.Any:
        ...
    @property
    def ticks(self) -> list[typing.Any]:
        ...
class _FoundSensitivity:
    """
    What `sensitivity` found.
    """
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    @property
    def attitude(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def columns(self) -> list[str]:
        ...
    @property
    def d_attitude(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def d_omega(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def d_states(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def error(self) -> typing.Any:
        ...
    @property
    def omega(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def runs(self) -> int:
        ...
    @property
    def scale(self) -> list[int]:
        ...
    @property
    def steps(self) -> int:
        ...
    @property
    def uncertain(self) -> str:
        ...
class _ManyScenes:
    """
    The scenes of many bodies.
    """
    def __init__(self, scenes: list[typing.Any], moments: typing.Any, omega: typing.Any, attitude: typing.Any, t0: typing.Any, times: typing.Any) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
class _Orbit:
    @staticmethod
    def from_elements(arg0: dict[str, typing.Any]) -> _Orbit:
        ...
    @staticmethod
    def from_state(arg0: typing.SupportsFloat | typing.SupportsIndex, arg1: typing.Any, arg2: typing.Any, arg3: typing.SupportsFloat | typing.SupportsIndex) -> _Orbit:
        ...
    @staticmethod
    def table(arg0: typing.Any, arg1: typing.Any, arg2: typing.Any, arg3: typing.SupportsFloat | typing.SupportsIndex) -> _Orbit:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def at(self, arg0: typing.Any) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        ...
    def eclipses(self, arg0: typing.Any, arg1: typing.Any, arg2: typing.Any, arg3: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def e(self) -> float:
        ...
    @property
    def kind(self) -> str:
        ...
    @property
    def mu(self) -> float:
        ...
    @property
    def periapsis_distance(self) -> float:
        ...
    @property
    def period(self) -> float:
        ...
class _Summary:
    @staticmethod
    def from_record(quantities: list[typing.Any], times: typing.SupportsInt | typing.SupportsIndex, record: dict[str, typing.Any]) -> _Summary:
        ...
    def __init__(self, quantities: list[typing.Any], times: typing.SupportsInt | typing.SupportsIndex) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def add_free(self, first: typing.SupportsInt | typing.SupportsIndex, inertia: typing.Any, omega: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], attitude: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], times: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], threads: typing.SupportsInt | typing.SupportsIndex = 0) -> None:
        ...
    def add_states(self, first: typing.SupportsInt | typing.SupportsIndex, omega: typing.Any = None, attitude: typing.Any = None, inertia: typing.Any = None, values: typing.Any = None) -> None:
        ...
    def edges(self, quantity: typing.SupportsInt | typing.SupportsIndex) -> numpy.typing.NDArray[numpy.float64]:
        ...
    def merge(self, other: _Summary) -> None:
        ...
    def record(self) -> dict[str, typing.Any]:
        ...
    @property
    def bodies(self) -> int:
        ...
    @property
    def failed(self) -> int:
        ...
    @property
    def times(self) -> int:
        ...
def _complete_K(arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
    ...
def _draw(kind: str, seed: typing.SupportsInt | typing.SupportsIndex, key: str, first: typing.SupportsInt | typing.SupportsIndex, count: typing.SupportsInt | typing.SupportsIndex, parameters: typing.Any, attempt: typing.SupportsInt | typing.SupportsIndex = 0) -> numpy.typing.NDArray[numpy.float64]:
    ...
def _draw_key(key: str) -> int:
    ...
def _draw_words(seed: typing.SupportsInt | typing.SupportsIndex, key: str, first: typing.SupportsInt | typing.SupportsIndex, count: typing.SupportsInt | typing.SupportsIndex, attempt: typing.SupportsInt | typing.SupportsIndex = 0) -> numpy.typing.NDArray[numpy.uint64]:
    ...
def _first_home(home: str) -> str:
    """
    The place of the package that called this first in the process.
    """
def _free_motion(arg0: typing.Any, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg3: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg4: dict[str, typing.Any], arg5: typing.Any, arg6: bool, arg7: typing.SupportsInt | typing.SupportsIndex, arg8: bool, arg9: typing.Any) -> int:
    ...
def _free_motion_of_one(arg0: typing.Any, arg1: typing.Any, arg2: typing.Any, arg3: typing.Any) -> typing.Any:
    ...
def _free_sensitivity(arg0: typing.Any, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg3: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg4: typing.Any, arg5: str, arg6: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg7: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg8: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg9: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg10: typing.SupportsInt | typing.SupportsIndex) -> int:
    ...
def _gyrostat(arg0: typing.Any, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg3: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg4: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg5: dict[str, typing.Any], arg6: typing.Any, arg7: bool, arg8: typing.SupportsInt | typing.SupportsIndex, arg9: bool, arg10: typing.Any) -> int:
    ...
def _heavy_top(arg0: typing.Any, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg3: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg4: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg5: dict[str, typing.Any], arg6: typing.Any, arg7: bool, arg8: typing.SupportsInt | typing.SupportsIndex, arg9: bool, arg10: typing.Any) -> int:
    ...
def _jacobi(arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    ...
def _make_drag(arg0: collections.abc.Sequence[typing.Any], arg1: typing.Any, arg2: typing.SupportsFloat | typing.SupportsIndex, arg3: typing.SupportsFloat | typing.SupportsIndex, arg4: typing.SupportsFloat | typing.SupportsIndex, arg5: typing.SupportsFloat | typing.SupportsIndex, arg6: typing.SupportsFloat | typing.SupportsIndex) -> torques.Formula:
    ...
def _make_solar_pressure(arg0: collections.abc.Sequence[typing.Any], arg1: typing.Any, arg2: typing.SupportsFloat | typing.SupportsIndex) -> torques.Formula:
    ...
def _match_quadratics(arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg3: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg4: typing.SupportsInt | typing.SupportsIndex, arg5: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], arg6: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg7: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg8: typing.SupportsInt | typing.SupportsIndex, arg9: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg10: bool, arg11: bool) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    ...
def _mean_attitude(moments: typing.Any) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    ...
def _multiply_d(arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
    ...
def _multiply_f(arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float32], arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float32]) -> numpy.typing.NDArray[numpy.float32]:
    ...
def _nome(arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
    ...
def _parameter_names(scene: Scene, group: str) -> list[str]:
    ...
def _periodogram(arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg2: typing.SupportsInt | typing.SupportsIndex, arg3: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"]) -> numpy.typing.NDArray[numpy.float64]:
    ...
def _project_lines(arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg3: collections.abc.Sequence[typing.Annotated[collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], "FixedSize(2)"]], arg4: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"], arg5: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"], arg6: typing.SupportsInt | typing.SupportsIndex) -> numpy.typing.NDArray[numpy.float64]:
    ...
def _sensitivities(many: _ManyScenes, bodies: typing.SupportsInt | typing.SupportsIndex, times: typing.SupportsInt | typing.SupportsIndex, groups: collections.abc.Sequence[str], accuracy: typing.SupportsFloat | typing.SupportsIndex, certify: bool, side: str, max_steps: typing.SupportsInt | typing.SupportsIndex, threads: typing.SupportsInt | typing.SupportsIndex, refuse: bool, numbers: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = []) -> dict[str, typing.Any]:
    ...
def _solve_many(many: _ManyScenes, bodies: typing.SupportsInt | typing.SupportsIndex, times: typing.SupportsInt | typing.SupportsIndex, omega_out: typing.Any, attitude_out: typing.Any, options: dict[str, typing.Any], threads: typing.SupportsInt | typing.SupportsIndex, refuse: bool, numbers: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = []) -> dict[str, typing.Any]:
    ...
def _step_d(arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg3: typing.SupportsFloat | typing.SupportsIndex, arg4: typing.Any, arg5: bool, arg6: typing.SupportsInt | typing.SupportsIndex, arg7: typing.SupportsFloat | typing.SupportsIndex, arg8: typing.SupportsFloat | typing.SupportsIndex, arg9: typing.SupportsInt | typing.SupportsIndex) -> None:
    ...
def _step_f(arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float32], arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float32], arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float32], arg3: typing.SupportsFloat | typing.SupportsIndex, arg4: typing.Any, arg5: bool, arg6: typing.SupportsInt | typing.SupportsIndex, arg7: typing.SupportsFloat | typing.SupportsIndex, arg8: typing.SupportsFloat | typing.SupportsIndex, arg9: typing.SupportsInt | typing.SupportsIndex) -> None:
    ...
def _upper_normal_quantile(arg0: typing.SupportsFloat | typing.SupportsIndex) -> float:
    ...
def _upper_normal_tail(arg0: typing.SupportsFloat | typing.SupportsIndex) -> float:
    ...
def angular_momentum(scene: Scene, t: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], omega: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], attitude: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], states: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] = ...) -> numpy.typing.NDArray[numpy.float64]:
    ...
def build_info() -> dict[str, str]:
    """
    How the installed binary was built.
    """
def check_inertia(matrices: typing.Any) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.uint8]]:
    """
    (margins, flaws); see polhode.inertia.check.
    """
def closed_form_refusal(scene: Scene, type: str) -> str:
    """
    Why a class of closed forms is not that of a scene; empty if it is.
    """
def closed_forms() -> list[typing.Any]:
    """
    The closed forms, simplest first: name, type (the class), doc, source.
    """
def damper_rates(arg0: Scene, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
    ...
def drift(scene: Scene, t: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], omega: typing.Any, attitude: typing.Any, states: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] = ...) -> dict[str, float]:
    ...
def effect(scene: Scene, torque: typing.SupportsInt | typing.SupportsIndex) -> dict[str, typing.Any]:
    """
    A bound on what one torque changes, by the names of its record.
    """
def energy(scene: Scene, t: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], omega: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], attitude: typing.Any, states: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] = ...) -> numpy.typing.NDArray[numpy.float64]:
    ...
def find_closed_form(scene: Scene) -> typing.Any:
    """
    The closed form that holds for a scene without windows, as its class; None if none does.
    """
def flushes_to_zero() -> bool:
    """
    Whether this thread takes numbers below 2.2e-308 for 0.
    """
def generalised_forces(arg0: typing.Any, arg1: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
    ...
def make_shape(name: str, values: collections.abc.Sequence[typing.Any]) -> MassProperties:
    """
    The body from all its parameters, in the record's order.
    """
def mesh_is_refined(vertices: typing.Any, faces: typing.Any) -> bool:
    """
    Integrated in double-double, as plain numbers would lose digits.
    """
def mesh_report(vertices: typing.Any, faces: typing.Any, weld: typing.Any = 1e-09) -> dict[str, typing.Any]:
    """
    What was found in a surface; see polhode.mesh.report.
    """
def method_records() -> list[typing.Any]:
    """
    The list of methods, a dict each.
    """
def method_refusal(arg0: str, arg1: Scene) -> str:
    """
    The reason why a method cannot integrate a scene, or an empty string.
    """
def principal_axes(matrices: typing.Any) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], int]:
    """
    (moments, axes, number of matrices that are not finite); see polhode.inertia.principal_axes.
    """
def reference(scene: Scene, order: typing.SupportsInt | typing.SupportsIndex, tolerance: typing.SupportsFloat | typing.SupportsIndex, max_steps: typing.SupportsInt | typing.SupportsIndex) -> typing.Any:
    """
    A named tuple of omega, attitude and steps of a scene by Taylor series in long double, as a reference.
    """
def require_kept(array: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], name: str) -> None:
    """
    Raises InvalidInput for a number that this thread takes for 0.
    """
def rotor_speed(arg0: Scene, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg2: typing.Annotated[numpy.typing.ArrayLike, numpy.float64], arg3: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
    ...
def sensitivity(scene: Scene, groups: collections.abc.Sequence[str], accuracy: typing.SupportsFloat | typing.SupportsIndex, certify: bool, side: str, max_steps: typing.SupportsInt | typing.SupportsIndex, rescale: bool = False, body: typing.SupportsInt | typing.SupportsIndex = 0) -> _FoundSensitivity:
    """
    The motion of a scene and its derivatives.
    """
def shape_records() -> list[typing.Any]:
    """
    (name, doc, ((parameter, size, doc), ...)) of every shape.
    """
def shape_volume(name: str, values: collections.abc.Sequence[typing.Any]) -> float:
    """
    The volume of a body, from all its parameters, in the record's order.
    """
def solve(scene: Scene, options: dict[str, typing.Any], plan: typing.Any = None) -> Answer:
    ...
def to_numbers(value: typing.Any, name: str, shape: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], finite: bool = True) -> numpy.typing.NDArray[numpy.float64]:
    """
    A float64 array of this shape, or InvalidInput.
    """
def torque_records() -> list[typing.Any]:
    """
    The list of torques: name, scene-file key, doc, source, parameters.
    """
def unit_in_metres(unit: typing.Any) -> float:
    """
    Length of a unit, given by its name or in metres.
    """
__version__: str
