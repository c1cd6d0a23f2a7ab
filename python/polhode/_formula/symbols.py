"""Symbols: what a function gets in place of numbers while it is traced."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from .._core import symbols as _core
from .places import refuse

_np: Any = np   # NumPy with symbols, of which its type hints know nothing
_BOOL = ("write np.where(condition, a, b), np.clip, np.minimum or np.maximum, and np.stack([...]) for np.array([...]) "
         "within these")


class Condition:
    """A comparison of symbols, for `np.where`."""

    __array_ufunc__ = None

    def __init__(self, items: Any) -> None:
        self._items = items

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        if function is not np.where:
            refuse(f"np.{function.__name__} of a condition", "write np.where(condition, a, b)")
        return _where(*args, **kwargs)

    def __bool__(self) -> bool:
        refuse("the truth of a condition, as in if, and, min() or max()", _BOOL)

    def __and__(self, other: Any) -> Any:
        refuse("a combination of conditions", "write one np.where within another")

    __or__ = __rand__ = __ror__ = __xor__ = __invert__ = __and__


def numbers_of(value: Any) -> Any:
    """Return an array of objects: numbers of the core, or floats."""
    if isinstance(value, Symbol):
        return value._items
    array = np.asarray(value)
    if array.dtype != object:
        if array.dtype.kind not in "biuf":
            refuse(f"a value of type {array.dtype}", "compute with real numbers")
        return array.astype(float).astype(object)
    items = np.empty(array.shape, object)
    for index, item in np.ndenumerate(array):
        if isinstance(item, Symbol) and item.ndim == 0:
            items[index] = item._items[()]
        elif isinstance(item, _core.Number):
            items[index] = item
        elif isinstance(item, (int, float, np.floating, np.integer)):
            items[index] = float(item)
        else:
            refuse(f"an array that holds {type(item).__name__}", "compute with arrays of numbers")
    return items


def joined(items: list[Any]) -> Symbol:
    """Return a vector of numbers of the core."""
    box = np.empty(len(items), object)
    box[:] = items
    return Symbol(box)


def _each(function: Callable[..., Any], *values: Any) -> Symbol:
    made = np.frompyfunc(function, len(values), 1)(*(numbers_of(value) for value in values))
    return Symbol(made)


def _compare(negated: bool, a: Any, b: Any) -> Condition:
    compare = np.frompyfunc(lambda x, y: _core.compare(x, y, negated), 2, 1)
    return Condition(_box(compare(numbers_of(a), numbers_of(b))))


def _box(items: Any) -> Any:
    if isinstance(items, np.ndarray):
        return items
    box = np.empty((), object)
    box[()] = items
    return box


def _power(base: Any, exponent: Any) -> Symbol:
    powers = exponent
    if isinstance(exponent, Symbol) or np.asarray(exponent).dtype == object:
        constants = [getattr(item, "constant", item) for item in numbers_of(exponent).ravel()]
        if any(constant is None for constant in constants):
            refuse("a power whose exponent is no constant", "write np.exp(exponent * np.log(base))")
        powers = np.reshape(np.array(constants, float), numbers_of(exponent).shape)
    return _each(_core.power, base, powers)


def _sum(items: Any) -> Any:
    total: Any = 0.0
    for item in items:
        total = _core.add(total, item) if not (isinstance(total, float) and total == 0.0) else item
    return total


def _product(a: Any, b: Any) -> Symbol:
    left, right = numbers_of(a), numbers_of(b)
    if left.ndim == 0 or right.ndim == 0 or left.ndim > 2 or right.ndim > 2 or \
            left.shape[-1] != right.shape[-2 if right.ndim == 2 else 0]:
        refuse(f"a product of shapes {left.shape} and {right.shape}", "multiply vectors and matrices that fit")
    rows, columns = np.atleast_2d(left), right if right.ndim == 2 else right[:, None]
    made = np.empty((rows.shape[0], columns.shape[1]), object)
    for i in range(made.shape[0]):
        for j in range(made.shape[1]):
            made[i, j] = _sum(_core.multiply(x, y) for x, y in zip(rows[i], columns[:, j], strict=True))
    return Symbol(made.reshape(left.shape[:-1] + (right.shape[1:] if right.ndim == 2 else ())))


def _unsigned(function: Callable[[Any], Any]) -> Callable[[Any], Symbol]:
    return lambda a: _each(function, a)


def _subtract(a: Any, b: Any) -> Any:
    return _core.subtract(a, b)


_UFUNCS: dict[Any, Callable[..., Any]] = {
    np.add: lambda a, b: _each(_core.add, a, b), np.subtract: lambda a, b: _each(_subtract, a, b),
    np.multiply: lambda a, b: _each(_core.multiply, a, b), np.divide: lambda a, b: _each(_core.divide, a, b),
    np.negative: lambda a: _each(lambda x: _core.subtract(0.0, x), a), np.positive: lambda a: a,
    np.power: _power, np.float_power: _power, np.square: lambda a: _each(lambda x: _core.multiply(x, x), a),
    np.reciprocal: lambda a: _each(lambda x: _core.divide(1.0, x), a),
    np.hypot: lambda a, b: _each(lambda x, y: _core.sqrt(_core.add(_core.multiply(x, x), _core.multiply(y, y))), a, b),
    np.arctan: lambda a: _each(lambda x: _core.arctan2(x, 1.0), a), np.arctan2: lambda a, b: _each(_core.arctan2, a, b),
    np.minimum: lambda a, b: _each(_core.minimum, a, b), np.maximum: lambda a, b: _each(_core.maximum, a, b),
    np.radians: lambda a: _each(lambda x: _core.multiply(x, np.pi / 180), a),
    np.deg2rad: lambda a: _each(lambda x: _core.multiply(x, np.pi / 180), a),
    np.greater: lambda a, b: _compare(False, a, b), np.less: lambda a, b: _compare(False, b, a),
    np.less_equal: lambda a, b: _compare(True, a, b), np.greater_equal: lambda a, b: _compare(True, b, a),
    np.matmul: _product, np.absolute: _unsigned(_core.absolute), np.fabs: _unsigned(_core.absolute),
    np.sign: _unsigned(_core.sign), np.sqrt: _unsigned(_core.sqrt), np.exp: _unsigned(_core.exp),
    np.log: _unsigned(_core.log), np.sin: _unsigned(_core.sin), np.cos: _unsigned(_core.cos),
    np.tan: _unsigned(_core.tan), np.tanh: _unsigned(_core.tanh),
}


def _where(condition: Any, *values: Any) -> Symbol:
    if len(values) != 2:
        refuse("np.where of one argument", "write np.where(condition, a, b)")
    if isinstance(condition, Condition):
        return Symbol(np.frompyfunc(_core.where, 3, 1)(condition._items, *(numbers_of(v) for v in values)))
    if isinstance(condition, Symbol):
        refuse("a number as a condition", "write np.where(number > 0, a, b)")
    picks = np.frompyfunc(lambda pick, a, b: a if pick else b, 3, 1)
    return Symbol(picks(np.asarray(condition, bool), *(numbers_of(v) for v in values)))


def _clip(a: Any, a_min: Any = None, a_max: Any = None, **limits: Any) -> Symbol:
    low, high = limits.pop("min", a_min), limits.pop("max", a_max)
    if limits:
        refuse(f"np.clip with {', '.join(limits)}", "write np.clip(a, low, high)")
    made = a if isinstance(a, Symbol) else Symbol(numbers_of(a))
    if low is not None:
        made = _np.maximum(made, low)
    return made if high is None else _np.minimum(made, high)


def _cross(a: Any, b: Any) -> Symbol:
    p, q = numbers_of(a), numbers_of(b)
    if p.shape != (3,) or q.shape != (3,):
        refuse(f"np.cross of shapes {p.shape} and {q.shape}", "give two vectors of shape (3,)")
    made = np.empty(3, object)
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):
        made[i] = _core.subtract(_core.multiply(p[j], q[k]), _core.multiply(p[k], q[j]))
    return Symbol(made)


def _dot(a: Any, b: Any) -> Symbol:
    if numbers_of(a).ndim == 0 or numbers_of(b).ndim == 0:
        return _each(_core.multiply, a, b)
    return _product(a, b)


def _total(a: Any, axis: Any = None) -> Symbol:
    items = numbers_of(a)
    if axis is None:
        return Symbol(_sum(items.ravel()))
    return Symbol(np.apply_along_axis(lambda row: _box(_sum(row)), axis, items))


def norm(v: Any, smooth: float = 0.0) -> Symbol:
    """Return sqrt(v . v + smooth^2) of symbols."""
    squares = [_core.multiply(x, x) for x in numbers_of(v).ravel()]
    return Symbol(_core.sqrt(_core.add(_sum(squares), float(smooth) ** 2)))


def friction(load: Any, rate: Any) -> Symbol:
    """Return the dry friction of symbols."""
    return _each(_core.friction, load, rate)


def _norm(x: Any, ord: Any = None, axis: Any = None) -> Symbol:
    if ord not in (None, 2) or axis is not None or numbers_of(x).ndim != 1:
        refuse("this form of np.linalg.norm", "write np.linalg.norm(v) of a vector")
    return norm(x)


def _joined(join: Callable[..., Any]) -> Callable[..., Symbol]:
    return lambda arrays, axis=0: Symbol(join([numbers_of(a) for a in arrays], axis=axis))


_FUNCTIONS: dict[Any, Callable[..., Any]] = {
    np.where: _where, np.clip: _clip, np.cross: _cross, np.dot: _dot, np.sum: _total, np.linalg.norm: _norm,
    np.outer: lambda a, b: _each(_core.multiply, numbers_of(a).ravel()[:, None], numbers_of(b).ravel()),
    np.inner: _dot, np.vdot: _dot, np.stack: _joined(np.stack), np.concatenate: _joined(np.concatenate),
    np.hstack: lambda arrays: Symbol(np.hstack([numbers_of(a) for a in arrays])),
    np.transpose: lambda a: a.T, np.reshape: lambda a, shape: a.reshape(shape), np.ravel: lambda a: a.reshape(-1),
    np.shape: lambda a: a.shape, np.ndim: lambda a: a.ndim, np.size: lambda a: a._items.size,
    np.zeros_like: lambda a: np.zeros(a.shape), np.ones_like: lambda a: np.ones(a.shape),
}


class Symbol:
    """A number under construction, or an array of them."""

    __slots__ = ("_items",)
    __hash__ = None   # type: ignore[assignment]

    def __init__(self, items: Any) -> None:
        self._items = _box(items)

    def __new__(cls, items: Any) -> Symbol:
        return object.__new__(SymbolArray if np.ndim(items) > 0 else Symbol)

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(self._items.shape)

    @property
    def ndim(self) -> int:
        return int(self._items.ndim)

    @property
    def T(self) -> Symbol:
        return Symbol(self._items.T)

    def reshape(self, *shape: Any) -> Symbol:
        return Symbol(self._items.reshape(*shape))

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **options: Any) -> Any:
        if method == "reduce" and ufunc is np.add:
            return _total(inputs[0], options.get("axis"))
        if ufunc in (np.equal, np.not_equal):
            refuse("a comparison by == or !=", "compare by < or >")
        if ufunc not in _UFUNCS or method != "__call__":
            refuse(f"np.{ufunc.__name__}", "write it by + - * / ** and the functions of the documentation")
        if options:
            refuse(f"np.{ufunc.__name__} with {', '.join(options)}", "assign its result to a name")
        return _UFUNCS[ufunc](*inputs)

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        if function not in _FUNCTIONS:
            name = f"{function.__module__}.{function.__name__}".replace("numpy", "np")
            refuse(name, "write it by + - * / ** and the functions of the documentation")
        try:
            return _FUNCTIONS[function](*args, **kwargs)
        except TypeError:
            refuse(f"np.{function.__name__} with these arguments", "call it with arrays alone")

    def __bool__(self) -> bool:
        refuse("the truth of a number, as in if, and, min() or max()", _BOOL)

    def __float__(self) -> float:
        refuse("a number from a symbol, as by float(), math.sin() or an assignment into an array of floats",
               "write np.sin and the like, and np.stack([...]) of components")

    __int__ = __index__ = __complex__ = __float__

    def __add__(self, other: Any) -> Any:
        return _np.add(self, other)

    def __radd__(self, other: Any) -> Any:
        return _np.add(other, self)

    def __sub__(self, other: Any) -> Any:
        return _np.subtract(self, other)

    def __rsub__(self, other: Any) -> Any:
        return _np.subtract(other, self)

    def __mul__(self, other: Any) -> Any:
        return _np.multiply(self, other)

    def __rmul__(self, other: Any) -> Any:
        return _np.multiply(other, self)

    def __truediv__(self, other: Any) -> Any:
        return _np.divide(self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _np.divide(other, self)

    def __pow__(self, other: Any) -> Any:
        return _np.power(self, other)

    def __rpow__(self, other: Any) -> Any:
        return _np.power(other, self)

    def __matmul__(self, other: Any) -> Any:
        return _np.matmul(self, other)

    def __rmatmul__(self, other: Any) -> Any:
        return _np.matmul(other, self)

    def __neg__(self) -> Any:
        return _np.negative(self)

    def __pos__(self) -> Any:
        return self

    def __abs__(self) -> Any:
        return _np.absolute(self)

    def __lt__(self, other: Any) -> Any:
        return _np.less(self, other)

    def __gt__(self, other: Any) -> Any:
        return _np.greater(self, other)

    def __le__(self, other: Any) -> Any:
        return _np.less_equal(self, other)

    def __ge__(self, other: Any) -> Any:
        return _np.greater_equal(self, other)

    def __eq__(self, other: object) -> Any:
        return _np.equal(self, other)

    def __ne__(self, other: object) -> Any:
        return _np.not_equal(self, other)

    def sum(self, axis: Any = None) -> Any:
        return _total(self, axis)

    def dot(self, other: Any) -> Any:
        return _dot(self, other)

    def clip(self, low: Any = None, high: Any = None) -> Any:
        return _clip(self, low, high)

    # What NumPy calls on the entries of an array that np.array made of symbols.
    def sqrt(self) -> Any:
        return _np.sqrt(self)

    def exp(self) -> Any:
        return _np.exp(self)

    def log(self) -> Any:
        return _np.log(self)

    def sin(self) -> Any:
        return _np.sin(self)

    def cos(self) -> Any:
        return _np.cos(self)

    def tan(self) -> Any:
        return _np.tan(self)

    def tanh(self) -> Any:
        return _np.tanh(self)

    def arctan(self) -> Any:
        return _np.arctan(self)


class SymbolArray(Symbol):
    """An array of numbers under construction. It cannot be written into."""

    __slots__ = ()

    def __len__(self) -> int:
        return len(self._items)

    def __iter__(self) -> Iterator[Symbol]:
        return (self[i] for i in range(len(self)))

    def __getitem__(self, index: Any) -> Symbol:
        return Symbol(self._items[index])

    def __setitem__(self, index: Any, value: Any) -> None:
        refuse("an assignment into an array", "make a new array by np.stack([...])")
