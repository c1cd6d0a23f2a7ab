"""
The classes of polhode.torques.
"""
from __future__ import annotations
import numpy
import numpy.typing
import numpy
import numpy.typing
import typing
class Constant:
    """
    Constant(torque, frame="body")

    A torque with constant components, in body axes (a thruster) or in space axes.

    Parameters
    ----------
    torque : array_like, shape (3,)
        its components in the frame named [N m]
    frame : str
        the axes in which the components are constant: body|space

    Raises
    ------
    InvalidInput
        For a wrong shape, or numbers that are not finite.

    References
    ----------
    Goldstein, Poole, Safko 2002, Classical Mechanics, sec. 5.5
    """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, torque: numpy.typing.ArrayLike, frame: str = 'body') -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def as_formula(self, inertia: typing.Any = None) -> Formula:
        """
        Return the same torque as a formula, which is never replaced.

        Parameters
        ----------
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].

        Returns
        -------
        Formula
            With `recognise` False, and with the parameters of the torque by their names.

        Raises
        ------
        InvalidInput
            For a torque that depends on the inertia, without it.
        """
    def value(self, t: typing.Any, omega: typing.Any, attitude: typing.Any, inertia: typing.Any = None, states: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the torque at one state.

        Parameters
        ----------
        t : float
            Time [s].
        omega : array_like, shape (3,)
            Rates in body axes [rad/s].
        attitude : array_like, shape (4,)
            Unit quaternion (x, y, z, w).
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].
        states : dict, optional
            Numbers of the torque's own states by name, each with the shape of its start; the starts if left out.

        Returns
        -------
        ndarray, shape (3,)
            In body axes [N m].
        """
    @property
    def frame(self) -> typing.Any:
        ...
    @property
    def torque(self) -> typing.Any:
        ...
    @property
    def traits(self) -> dict[str, typing.Any]:
        """
        dict: uses_time, uses_attitude, uses_rates, has_potential.
        """
class Gravity:
    """
    Gravity(weight, arm)

    Uniform gravity on a body held at a pivot: tau_B = arm x (-weight R_WB^T e_z).

    Parameters
    ----------
    weight : float
        m g; gravity points along -z of space [N]
    arm : array_like, shape (3,)
        from the pivot to the centre of mass, in body axes [m]

    Raises
    ------
    InvalidInput
        For a wrong shape, or numbers that are not finite.

    References
    ----------
    Goldstein, Poole, Safko 2002, Classical Mechanics, sec. 5.7
    """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, weight: float, arm: numpy.typing.ArrayLike) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def as_formula(self, inertia: typing.Any = None) -> Formula:
        """
        Return the same torque as a formula, which is never replaced.

        Parameters
        ----------
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].

        Returns
        -------
        Formula
            With `recognise` False, and with the parameters of the torque by their names.

        Raises
        ------
        InvalidInput
            For a torque that depends on the inertia, without it.
        """
    def value(self, t: typing.Any, omega: typing.Any, attitude: typing.Any, inertia: typing.Any = None, states: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the torque at one state.

        Parameters
        ----------
        t : float
            Time [s].
        omega : array_like, shape (3,)
            Rates in body axes [rad/s].
        attitude : array_like, shape (4,)
            Unit quaternion (x, y, z, w).
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].
        states : dict, optional
            Numbers of the torque's own states by name, each with the shape of its start; the starts if left out.

        Returns
        -------
        ndarray, shape (3,)
            In body axes [N m].
        """
    @property
    def arm(self) -> typing.Any:
        ...
    @property
    def traits(self) -> dict[str, typing.Any]:
        """
        dict: uses_time, uses_attitude, uses_rates, has_potential.
        """
    @property
    def weight(self) -> typing.Any:
        ...
class GravityGradient:
    """
    GravityGradient(mean_motion, phase=0)

    Gravity gradient on a circular orbit: tau_B = 3 n^2 u x (I u), u = R_WB^T (cos a, sin a, 0), a = n t + phase.

    Parameters
    ----------
    mean_motion : float
        n, the rate of the circular orbit, which lies in the plane z = 0 of space [rad/s]
    phase : float
        the orbit angle from space x at t = 0 [rad]

    Raises
    ------
    InvalidInput
        For a wrong shape, or numbers that are not finite.

    References
    ----------
    Hughes 1986, Spacecraft Attitude Dynamics, sec. 8.1
    """
    @classmethod
    def __new__(cls: typing.Any, *args: typing.Any, **numbers: typing.Any) -> typing.Any:
        """
        GravityGradient of an orbit is a class of its own.
        """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, mean_motion: float = ..., phase: float = 0.0, *, orbit: typing.Any = ...) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def as_formula(self, inertia: typing.Any = None) -> Formula:
        """
        Return the same torque as a formula, which is never replaced.

        Parameters
        ----------
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].

        Returns
        -------
        Formula
            With `recognise` False, and with the parameters of the torque by their names.

        Raises
        ------
        InvalidInput
            For a torque that depends on the inertia, without it.
        """
    def value(self, t: typing.Any, omega: typing.Any, attitude: typing.Any, inertia: typing.Any = None, states: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the torque at one state.

        Parameters
        ----------
        t : float
            Time [s].
        omega : array_like, shape (3,)
            Rates in body axes [rad/s].
        attitude : array_like, shape (4,)
            Unit quaternion (x, y, z, w).
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].
        states : dict, optional
            Numbers of the torque's own states by name, each with the shape of its start; the starts if left out.

        Returns
        -------
        ndarray, shape (3,)
            In body axes [N m].
        """
    @property
    def mean_motion(self) -> typing.Any:
        ...
    @property
    def phase(self) -> typing.Any:
        ...
    @property
    def traits(self) -> dict[str, typing.Any]:
        """
        dict: uses_time, uses_attitude, uses_rates, has_potential.
        """
class OrbitGradient:
    """
    OrbitGradient(orbit)

    Gravity gradient on an orbit: tau_B = 3 mu / |r|^5 r x (I r), r = R_WB^T r_W.

    Parameters
    ----------
    orbit : Orbit
        the path of the centre of mass about the attracting one, or of that one about the body

    Raises
    ------
    InvalidInput
        For a wrong shape, or numbers that are not finite.

    References
    ----------
    Hughes 1986, Spacecraft Attitude Dynamics, sec. 8.1
    """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, orbit: typing.Any) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def as_formula(self, inertia: typing.Any = None) -> Formula:
        """
        Return the same torque as a formula, which is never replaced.

        Parameters
        ----------
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].

        Returns
        -------
        Formula
            With `recognise` False, and with the parameters of the torque by their names.

        Raises
        ------
        InvalidInput
            For a torque that depends on the inertia, without it.
        """
    def value(self, t: typing.Any, omega: typing.Any, attitude: typing.Any, inertia: typing.Any = None, states: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the torque at one state.

        Parameters
        ----------
        t : float
            Time [s].
        omega : array_like, shape (3,)
            Rates in body axes [rad/s].
        attitude : array_like, shape (4,)
            Unit quaternion (x, y, z, w).
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].
        states : dict, optional
            Numbers of the torque's own states by name, each with the shape of its start; the starts if left out.

        Returns
        -------
        ndarray, shape (3,)
            In body axes [N m].
        """
    @property
    def orbit(self) -> typing.Any:
        ...
    @property
    def traits(self) -> dict[str, typing.Any]:
        """
        dict: uses_time, uses_attitude, uses_rates, has_potential.
        """
class Damping:
    """
    Damping(matrix)

    Linear damping: tau_B = -C w_B.

    Parameters
    ----------
    matrix : array_like, shape (3, 3) or (3,)
        C in body axes; three numbers stand for a diagonal matrix [N m s]

    Raises
    ------
    InvalidInput
        For a wrong shape, or numbers that are not finite.

    References
    ----------
    Hughes 1986, Spacecraft Attitude Dynamics, sec. 5.2
    """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, matrix: numpy.typing.ArrayLike) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def as_formula(self, inertia: typing.Any = None) -> Formula:
        """
        Return the same torque as a formula, which is never replaced.

        Parameters
        ----------
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].

        Returns
        -------
        Formula
            With `recognise` False, and with the parameters of the torque by their names.

        Raises
        ------
        InvalidInput
            For a torque that depends on the inertia, without it.
        """
    def value(self, t: typing.Any, omega: typing.Any, attitude: typing.Any, inertia: typing.Any = None, states: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the torque at one state.

        Parameters
        ----------
        t : float
            Time [s].
        omega : array_like, shape (3,)
            Rates in body axes [rad/s].
        attitude : array_like, shape (4,)
            Unit quaternion (x, y, z, w).
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].
        states : dict, optional
            Numbers of the torque's own states by name, each with the shape of its start; the starts if left out.

        Returns
        -------
        ndarray, shape (3,)
            In body axes [N m].
        """
    @property
    def matrix(self) -> typing.Any:
        ...
    @property
    def traits(self) -> dict[str, typing.Any]:
        """
        dict: uses_time, uses_attitude, uses_rates, has_potential.
        """
class AngularDamping:
    """
    AngularDamping(rate)

    Damping proportional to the angular momentum: tau_B = -c I w_B.

    Parameters
    ----------
    rate : float
        c, the rate at which the angular momentum decays; a negative rate drives the body [1/s]

    Raises
    ------
    InvalidInput
        For a wrong shape, or numbers that are not finite.

    References
    ----------
    angularDamping of the physics engines; docs/damped_free.md
    """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, rate: float) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def as_formula(self, inertia: typing.Any = None) -> Formula:
        """
        Return the same torque as a formula, which is never replaced.

        Parameters
        ----------
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].

        Returns
        -------
        Formula
            With `recognise` False, and with the parameters of the torque by their names.

        Raises
        ------
        InvalidInput
            For a torque that depends on the inertia, without it.
        """
    def value(self, t: typing.Any, omega: typing.Any, attitude: typing.Any, inertia: typing.Any = None, states: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the torque at one state.

        Parameters
        ----------
        t : float
            Time [s].
        omega : array_like, shape (3,)
            Rates in body axes [rad/s].
        attitude : array_like, shape (4,)
            Unit quaternion (x, y, z, w).
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].
        states : dict, optional
            Numbers of the torque's own states by name, each with the shape of its start; the starts if left out.

        Returns
        -------
        ndarray, shape (3,)
            In body axes [N m].
        """
    @property
    def rate(self) -> typing.Any:
        ...
    @property
    def traits(self) -> dict[str, typing.Any]:
        """
        dict: uses_time, uses_attitude, uses_rates, has_potential.
        """
class Formula:
    """
    Formula(function=None, *, text=None, let=None, potential=None, states=None, orbits=None, recognise=True, **parameters)

    A torque of your own as a formula: traced once from a Python function, or written as text.

    The function is called when the torque is made, on symbols. No Python runs while a motion is computed. A formula that is
    a torque of this module (a constant, damping, gravity) is replaced by it when it is solved.

    Parameters
    ----------
    function : callable, optional
        ``function(t, omega, attitude, p)`` returns the torque in body axes, shape (3,) [N m]. omega is in body axes, shape
        (3,) [rad/s]. attitude is the unit quaternion (x, y, z, w), shape (4,). ``p.kd`` is the parameter kd. The function
        uses NumPy and `polhode.formula`.
    text : str, optional
        The same as text: ``"-kp * attitude.xyz * attitude.w - kd * omega"``. It is given in place of a function.
    let : dict of str, optional
        Names for shared parts of a text, in order.
    potential : callable or str, optional
        ``potential(t, attitude, p)`` returns V [J], or its text. The torque is its negative gradient on the rotations. It
        is given in place of a torque.
    states : dict, optional
        States of the torque's own, by name. Beside a function each has its start, a number or shape (n,). The function is
        then ``function(t, omega, attitude, p, s)`` and returns (torque, rates), a dict of the same names. Beside a text each
        is ``{"start": numbers, "rate": text}``.
    orbits : dict of Orbit, optional
        Orbits of a text by name: an orbit ``main`` gives ``main.r``, ``main.v`` [m, m/s], ``main.distance`` and
        ``main.inverse_distance``. A function calls ``orbit.at(t)`` instead.
    recognise : bool
        Whether the formula may be replaced by torques of this module.
    **parameters : float or array_like, shape (n,)
        Named numbers of the formula.

    Raises
    ------
    InvalidInput
        For a text that is no formula. For a function that cannot be traced: the message names the line and what to write
        instead. For a function whose numbers are not those of its formula. For a torque of another shape than (3,).

    See Also
    --------
    polhode.torques.Custom : a function that cannot be traced.
    """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, function: typing.Any = None, *, text: typing.Any = None, let: typing.Any = None, potential: typing.Any = None, states: typing.Any = None, orbits: typing.Any = None, recognise: typing.Any = True, **parameters: numpy.typing.ArrayLike) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def as_formula(self, inertia: typing.Any = None) -> Formula:
        """
        Return the same torque as a formula, which is never replaced.

        Parameters
        ----------
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].

        Returns
        -------
        Formula
            With `recognise` False, and with the parameters of the torque by their names.

        Raises
        ------
        InvalidInput
            For a torque that depends on the inertia, without it.
        """
    def energy(self, t: typing.Any, attitude: typing.Any) -> float:
        """
        Return the potential energy of a formula made from a potential; 0 without one.

        Parameters
        ----------
        t : float
            Time [s].
        attitude : array_like, shape (4,)
            Unit quaternion (x, y, z, w).

        Returns
        -------
        float
            V [J].
        """
    def rates(self, t: typing.Any, omega: typing.Any, attitude: typing.Any, states: typing.Any = None) -> dict[str, typing.Any]:
        """
        Return the rates of the torque's own states.

        Parameters
        ----------
        t : float
            Time [s].
        omega : array_like, shape (3,)
            Rates in body axes [rad/s].
        attitude : array_like, shape (4,)
            Unit quaternion (x, y, z, w).
        states : dict, optional
            Numbers of the states by name; the starts if left out.

        Returns
        -------
        dict
            A number, or a tuple of numbers, by name.
        """
    def value(self, t: typing.Any, omega: typing.Any, attitude: typing.Any, inertia: typing.Any = None, states: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the torque at one state.

        Parameters
        ----------
        t : float
            Time [s].
        omega : array_like, shape (3,)
            Rates in body axes [rad/s].
        attitude : array_like, shape (4,)
            Unit quaternion (x, y, z, w).
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].
        states : dict, optional
            Numbers of the torque's own states by name, each with the shape of its start; the starts if left out.

        Returns
        -------
        ndarray, shape (3,)
            In body axes [N m].
        """
    def with_parameters(self, **numbers: numpy.typing.ArrayLike) -> Formula:
        """
        Return the formula with other numbers of some of its parameters.

        Parameters
        ----------
        **parameters : float or array_like, shape (n,)
            Numbers by the names of its parameters, of the same shapes.

        Returns
        -------
        Formula

        Raises
        ------
        InvalidInput
            For a name that it does not have, or another shape.
        """
    def with_starts(self, **numbers: numpy.typing.ArrayLike) -> Formula:
        """
        Return the formula with other starts of some of its states.

        Parameters
        ----------
        **states : float or array_like, shape (n,)
            Numbers by the names of its states, of the same shapes.

        Returns
        -------
        Formula

        Raises
        ------
        InvalidInput
            For a name that it does not have, or another shape.
        """
    @property
    def let(self) -> dict[str, typing.Any]:
        """
        dict: names for shared parts of the text.
        """
    @property
    def orbits(self) -> dict[str, typing.Any]:
        """
        dict: the orbits of the text by name.
        """
    @property
    def parameters(self) -> dict[str, typing.Any]:
        """
        dict: the named numbers, sorted by name.
        """
    @property
    def potential(self) -> typing.Any:
        """
        str or None: the potential as text.
        """
    @property
    def recognise(self) -> bool:
        """
        bool: whether it may be replaced.
        """
    @property
    def states(self) -> dict[str, typing.Any]:
        """
        dict: of each state its start, and its rate as text.
        """
    @property
    def text(self) -> str:
        """
        str: the formula as text; empty for a potential.
        """
    @property
    def traits(self) -> dict[str, typing.Any]:
        """
        dict: uses_time, uses_attitude, uses_rates, has_potential.
        """
class Custom:
    """
    Custom(function, *, uses_time=True, uses_attitude=True, uses_rates=True, potential=None, data=None, breaks=())

    A torque of your own.

    Parameters
    ----------
    function : callable or compiled function pointer
        A Python callable ``function(t, omega, attitude)`` that returns the torque in body axes, shape (3,) [N m]; omega is
        in body axes, shape (3,) [rad/s], attitude is the unit quaternion (x, y, z, w). Or a function with the C signature
        ``void (double t, const double *omega, const double *attitude, double *torque, void *data)`` as a numba ``cfunc``,
        a ctypes function or a capsule: it is called with no Python in the loop.
    uses_time, uses_attitude, uses_rates : bool
        What the function looks at. A false claim makes answers wrong: claim only what is sure.
    potential : callable, optional
        ``potential(t, attitude)`` [J], in the same form as the function
        (``double (double t, const double *attitude, void *data)``), when the torque is conservative: energy is then watched.
    data : int, optional
        The address handed to a compiled function.
    breaks : sequence of float
        Times at which the function may jump or kink [s]: the edges of a pulse, the knots of a table. `solve` divides the
        span there, so that no step crosses one. At the end of a part the function is called slightly before it.

    Raises
    ------
    InvalidInput
        For what cannot be called, or an answer that has another shape than (3,), or is not finite at the start; one that is
        not finite later ends the run there, with everything up to there. What the function raises comes through as it is.
    """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, function: typing.Any, *, uses_time: bool = True, uses_attitude: bool = True, uses_rates: bool = True, potential: typing.Any = None, data: typing.Any = None, breaks: typing.Any = ()) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def value(self, t: typing.Any, omega: typing.Any, attitude: typing.Any, inertia: typing.Any = None, states: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the torque at one state.

        Parameters
        ----------
        t : float
            Time [s].
        omega : array_like, shape (3,)
            Rates in body axes [rad/s].
        attitude : array_like, shape (4,)
            Unit quaternion (x, y, z, w).
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].
        states : dict, optional
            Numbers of the torque's own states by name, each with the shape of its start; the starts if left out.

        Returns
        -------
        ndarray, shape (3,)
            In body axes [N m].
        """
    @property
    def breaks(self) -> tuple[typing.Any, ...]:
        ...
    @property
    def function(self) -> typing.Any:
        ...
    @property
    def traits(self) -> dict[str, typing.Any]:
        ...
class During:
    """
    During(torque, windows)

    Another torque within windows of time, and none outside: a thruster's firings, a brake that is let go.

    The span is cut where windows begin and end. Each piece has the torques that act there: where that leaves a closed form
    (a free body coasts between firings) it is evaluated, else it is stepped, and no step goes over a jump.

    Parameters
    ----------
    torque : a torque of polhode.torques
        Without windows of its own.
    windows : array_like, shape (n, 2) or (2,)
        A begin and a later end each [s], in any order; either may be infinite. Windows that touch are one. An empty list
        means that the torque never acts.

    Raises
    ------
    InvalidInput
        For a window that is empty, reversed or not a number, for two that overlap, and for what is no torque.
    """
    def __eq__(self, arg0: typing.Any) -> bool:
        ...
    def __getstate__(self) -> tuple[typing.Any, ...]:
        ...
    def __hash__(self) -> int:
        ...
    def __init__(self, torque: typing.Any, windows: typing.Any) -> None:
        ...
    def __reduce__(self) -> tuple[typing.Any, ...]:
        """
        Return what pickle makes the object from.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple[typing.Any, ...]) -> None:
        ...
    def value(self, t: typing.Any, omega: typing.Any, attitude: typing.Any, inertia: typing.Any = None, states: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        Return the torque at one state.

        Parameters
        ----------
        t : float
            Time [s].
        omega : array_like, shape (3,)
            Rates in body axes [rad/s].
        attitude : array_like, shape (4,)
            Unit quaternion (x, y, z, w).
        inertia : InertiaTensor or array_like, optional
            Of the body, for a torque that depends on it [kg m^2].
        states : dict, optional
            Numbers of the torque's own states by name, each with the shape of its start; the starts if left out.

        Returns
        -------
        ndarray, shape (3,)
            In body axes [N m].
        """
    @property
    def torque(self) -> typing.Any:
        """
        The torque that acts.
        """
    @property
    def traits(self) -> dict[str, typing.Any]:
        """
        dict: uses_time, uses_attitude, uses_rates, has_potential.
        """
    @property
    def windows(self) -> tuple[typing.Any, ...]:
        """
        tuple of (begin, end) [s], in the order of time.
        """
