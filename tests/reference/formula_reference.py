"""Makes formula.txt: random formulas with their values, derivatives and Taylor series by mpmath at 40 digits.

A function of a series is made from the function's own derivatives, in closed form, and powers of the series. The series
of a motion comes from Picard's iteration. No recurrence of polhode is used. Each value comes with a bound of the
rounding errors of its float64 evaluation, in units of 2^-53. Run: python formula_reference.py
"""

import operator
import pathlib
import random

import mpmath
from mpmath import mp, mpf

TABLE = pathlib.Path(__file__).with_name("formula.txt")
ORDER = 12
mp.dps = 40


class Number:
    """A value with the rounding error of its evaluation, in units of 2^-53."""

    def __init__(self, value, error=0):
        self.value, self.error = mpf(value), mpf(error)

    def rounded(self, error):
        self.error = error + abs(self.value)
        return self

    def __add__(self, other):
        return Number(self.value + other.value).rounded(self.error + other.error)

    def __sub__(self, other):
        return Number(self.value - other.value).rounded(self.error + other.error)

    def __mul__(self, other):
        error = abs(self.value) * other.error + abs(other.value) * self.error
        return Number(self.value * other.value).rounded(error)

    def __truediv__(self, other):
        z = self.value / other.value
        return Number(z).rounded((self.error + abs(z) * other.error) / abs(other.value))

    def apply(self, coefficients):
        value, slope = coefficients(self.value, 1)
        return Number(value).rounded(abs(slope) * self.error + 8 * abs(value))

    @property
    def start(self):
        return self.value


class Series:
    """Taylor coefficients."""

    def __init__(self, rows):
        self.rows = [mpf(row) for row in rows] + [mpf(0)] * (ORDER + 1 - len(rows))

    def __add__(self, other):
        return Series([a + b for a, b in zip(self.rows, other.rows, strict=True)])

    def __sub__(self, other):
        return Series([a - b for a, b in zip(self.rows, other.rows, strict=True)])

    def __mul__(self, other):
        return Series([mpmath.fdot(self.rows[:n + 1], other.rows[n::-1]) for n in range(ORDER + 1)])

    def __truediv__(self, other):
        return self * other.apply(power(-1))

    def apply(self, coefficients):
        slopes = coefficients(self.rows[0], ORDER)
        rest, total = Series([0, *self.rows[1:]]), Series([slopes[ORDER]])
        for slope in reversed(slopes[:ORDER]):
            total = total * rest + Series([slope])
        return total

    @property
    def start(self):
        return self.rows[0]


# Taylor coefficients 0..n of functions at a.

def power(c):
    return lambda a, n: [mpmath.binomial(c, k) * a ** (c - k) for k in range(n + 1)]


def exp(a, n):
    return [mpmath.exp(a) / mpmath.factorial(k) for k in range(n + 1)]


def log(a, n):
    return [mpmath.log(a), *(-(-1 / a) ** k / k for k in range(1, n + 1))]


def sin(a, n):
    return [mpmath.sin(a + k * mpmath.pi / 2) / mpmath.factorial(k) for k in range(n + 1)]


def cos(a, n):
    return sin(a + mpmath.pi / 2, n)


def atan(a, n):
    # the imaginary part of log(1 + i a)
    z = mpmath.mpc(0, 1) / mpmath.mpc(1, a)
    return [mpmath.atan(a), *(mpmath.im(-(-z) ** k / k) for k in range(1, n + 1))]


FUNCTIONS = {"sqrt": power(mpf("0.5")), "exp": exp, "log": log, "sin": sin, "cos": cos}


def quotient(above, below):
    """Two functions of one series, divided."""
    if isinstance(above, Number):
        # Not wider than needed: the errors of both parts are those of one function.
        value = above.value / below.value
        return Number(value).rounded((above.error + abs(value) * below.error) / abs(below.value))
    return above / below


def tan(a):
    return quotient(a.apply(sin), a.apply(cos))


def tanh(a):
    plus, minus = a.apply(exp), a.apply(lambda x, n: [(-1) ** k * c for k, c in enumerate(exp(-x, n))])
    return quotient(plus - minus, plus + minus)


def atan2(y, x):
    # Both are series or numbers; here x > 0.
    return (y / x).apply(atan)


def evaluate(tree, names, kind):
    """The value of a tree (operation, operands...) with names for its leaves."""
    head, *rest = tree
    if head == "name":
        return names[rest[0]]
    if head == "number":
        return kind(rest[0]) if kind is Number else kind([rest[0]])
    if head == "^":
        base = evaluate(rest[0], names, kind)
        if rest[1] == int(rest[1]):
            product = base
            for _ in range(int(rest[1]) - 1):
                product = product * base
            return product
        return base.apply(power(mpf(rest[1])))
    a = [evaluate(operand, names, kind) for operand in rest]
    if head in FUNCTIONS:
        return a[0].apply(FUNCTIONS[head])
    if head in ("atan2", "tan", "tanh"):
        return {"atan2": atan2, "tan": tan, "tanh": tanh}[head](*a)
    if head == "where":
        return a[2] if a[0].start < a[1].start else a[3]
    if head == "min":
        return a[0] if a[0].start < a[1].start else a[1]
    if head == "max":
        return a[0] if a[0].start > a[1].start else a[1]
    if head == "abs":
        return a[0] if a[0].start > 0 else kind(0) - a[0] if kind is Number else Series([0]) - a[0]
    return {"+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv}[head](*a)


def text(tree):
    head, *rest = tree
    if head in ("name", "number"):
        return f"({rest[0]})" if head == "number" and rest[0] < 0 else f"{rest[0]}"
    if head == "^":
        return f"({text(rest[0])})^{rest[1]}" if rest[1] >= 0 else f"({text(rest[0])})^({rest[1]})"
    parts = [text(operand) for operand in rest]
    if head == "where":
        return f"where({parts[0]} < {parts[1]}, {parts[2]}, {parts[3]})"
    if head in FUNCTIONS or head in ("atan2", "tan", "tanh", "min", "max", "abs"):
        return f"{head}({', '.join(parts)})"
    return f"({parts[0]} {head} {parts[1]})"


def number(rng):
    return round(rng.uniform(-2, 2), 2) or 0.5


def positive(rng, names, depth):
    """1.5 + a^2 or the like: a safe divisor, root or logarithm."""
    a = draw(rng, names, depth - 1)
    return ("+", ("number", round(rng.uniform(1.2, 2.5), 2)), ("*", a, a))


def draw(rng, names, depth, switches=False):
    if depth <= 0 or rng.random() < 0.08:
        return ("name", rng.choice(names)) if rng.random() < 0.8 else ("number", number(rng))
    kinds = ["+", "-", "*", "*", "*", "/", "sqrt", "exp", "log", "sin", "cos", "tan", "tanh", "atan2", "^", "halves",
             "whole"] + (["where", "min", "max", "abs"] * 2 if switches else [])
    kind = rng.choice(kinds)

    def sub():
        return draw(rng, names, depth - 1, switches)

    if kind in "+-*":
        return (kind, sub(), sub())
    if kind == "/":
        return ("/", sub(), positive(rng, names, depth - 1))
    if kind in ("sqrt", "log"):
        return (kind, positive(rng, names, depth - 1))
    if kind == "^":
        return ("^", positive(rng, names, depth - 1), rng.choice((0.3, 1.7, -0.7)))
    if kind == "halves":
        return ("^", positive(rng, names, depth - 1), rng.choice((0.5, 1.5, -1.5, -0.5)))
    if kind == "whole":
        return ("^", ("sin", sub()), rng.choice((2, 3, 5)))
    if kind == "exp":
        return ("exp", ("*", ("number", 0.3), ("sin", sub())))
    if kind == "tan":
        return ("tan", ("*", ("number", 0.7), ("sin", sub())))
    if kind == "atan2":
        return ("atan2", sub(), positive(rng, names, depth - 1))
    if kind == "where":
        return ("where", sub(), sub(), sub(), sub())
    if kind in ("min", "max"):
        return (kind, sub(), sub())
    return (kind, sub())


STATES = ["omega.x", "omega.y", "omega.z", "attitude.x", "attitude.y", "attitude.z", "attitude.w", "h.x", "h.y"]
PARAMETERS = {"kp": 0.375, "kd": -1.25}
NAMES = [*STATES, "kp", "kd", "t"]


def start(rng):
    omega = [round(rng.uniform(-1, 1), 3) for _ in range(3)]
    attitude = rng.choice([[0.1, 0.5, 0.7, 0.5], [0.5, -0.5, 0.5, 0.5], [0.7, 0.1, -0.1, 0.7], [-0.5, 0.1, 0.5, 0.7]])
    return round(rng.uniform(-1, 1), 3), [*omega, *attitude, *(round(rng.uniform(-1, 1), 3) for _ in range(2))]


def row(values):
    return " ".join(mpmath.nstr(value, 20) for value in values)


def write_head(out, trees, vector, t, y):
    out.append("case")
    torque = f"[{', '.join(text(tree) for tree in trees[:3])}]"
    out.append(f"torque {torque}{vector}")
    out.append(f"rate [{', '.join(text(tree) for tree in trees[3:])}]")
    out.append("y " + " ".join(repr(x) for x in [t, *y]))


def write_values(out, rng, depth, switches):
    """Values with their error bounds, and the derivatives by the states and the parameters."""
    t, y = start(rng)
    trees = [draw(rng, NAMES, depth, switches) for _ in range(5)]
    point = [*map(mpf, y), *map(mpf, PARAMETERS.values()), mpf(t)]
    found = [evaluate(tree, dict(zip(NAMES, map(Number, point), strict=True)), Number) for tree in trees]
    write_head(out, trees, "", t, y)
    out.append("values " + row([x.value for x in found]))
    out.append("errors " + row([x.error for x in found]))
    for i in range(len(NAMES) - 1):

        def outputs(x, i=i):
            at = [Number(x if k == i else value) for k, value in enumerate(point)]
            return [evaluate(tree, dict(zip(NAMES, at, strict=True)), Number).value for tree in trees]

        with mpmath.workdps(60):
            step = mpf(10) ** -15
            ends = [outputs(point[i] + k * step) for k in (-2, -1, 1, 2)]
            slopes = [(a - 8 * b + 8 * c - d) / (12 * step) for a, b, c, d in zip(*ends, strict=True)]
        out.append("slopes " + row(slopes))


def turn_to_body(q, v):
    x, y, z, w = q
    two = Series([2])
    R = [[w * w + x * x - y * y - z * z, two * (x * y - w * z), two * (x * z + w * y)],
         [two * (x * y + w * z), w * w - x * x + y * y - z * z, two * (y * z - w * x)],
         [two * (x * z - w * y), two * (y * z + w * x), w * w - x * x - y * y + z * z]]
    return [R[0][i] * v[0] + R[1][i] * v[1] + R[2][i] * v[2] for i in range(3)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


VECTORS = ["", " + to_body([0, 0, 1])", " + to_body([0.25 * cos(0.5 * t + 1), 0.25 * sin(0.5 * t + 1), -0.5])",
           " + cross(to_body([cos(2 * t), sin(2 * t), 0]), [1, 2, 3] * to_body([cos(2 * t), sin(2 * t), 0]))",
           " + to_body([omega.x, 1, t * t])"]
INERTIA = [[2.0, 0.25, -0.125], [0.25, 3.0, 0.5], [-0.125, 0.5, 4.0]]


def space_vector(which, q, w, t):
    one = Series([1])
    if which == 0:
        return [Series([0])] * 3
    if which == 1:
        return turn_to_body(q, [Series([0]), Series([0]), one])
    if which == 2:
        angle, quarter = t * Series([0.5]) + one, Series([0.25])
        return turn_to_body(q, [quarter * angle.apply(cos), quarter * angle.apply(sin), Series([-0.5])])
    if which == 3:
        angle = t * Series([2])
        u = turn_to_body(q, [angle.apply(cos), angle.apply(sin), Series([0])])
        return cross(u, [Series([1 + i]) * u[i] for i in range(3)])
    return turn_to_body(q, [w[0], one, t * t])


def write_series(out, rng, depth, which, diagonal):
    """The Taylor series of a body's motion with two extra states."""
    t0, y0 = start(rng)
    trees = [draw(rng, NAMES, depth, which == 0) for _ in range(5)]
    inertia = mpmath.matrix([[INERTIA[i][j] if i == j or not diagonal else 0.0 for j in range(3)] for i in range(3)])
    inverse = inertia ** -1
    t, y = Series([t0, 1]), [Series([x]) for x in y0]
    for _ in range(ORDER):
        names = dict(zip(NAMES, [*y, *(Series([x]) for x in PARAMETERS.values()), t], strict=True))
        outputs = [evaluate(tree, names, Series) for tree in trees]
        w, q = y[:3], y[3:7]
        added = space_vector(which, q, w, t)
        h = [sum((w[j] * Series([inertia[i, j]]) for j in range(3)), Series([0])) for i in range(3)]
        tau = [outputs[i] + added[i] - c for i, c in enumerate(cross(w, h))]
        rates = [sum((tau[j] * Series([inverse[i, j]]) for j in range(3)), Series([0])) for i in range(3)]
        half = Series([0.5])
        rates += [half * (q[3] * w[0] + q[1] * w[2] - q[2] * w[1]), half * (q[3] * w[1] + q[2] * w[0] - q[0] * w[2]),
                  half * (q[3] * w[2] + q[0] * w[1] - q[1] * w[0]),
                  half * (Series([0]) - q[0] * w[0] - q[1] * w[1] - q[2] * w[2])]
        rates += outputs[3:]
        y = [Series([y0[i], *(r / (n + 1) for n, r in enumerate(rate.rows[:ORDER]))]) for i, rate in enumerate(rates)]
    write_head(out, trees, VECTORS[which], t0, y0)
    out.append(f"inertia {int(diagonal)}")
    for n in range(ORDER + 1):
        out.append("row " + row([x.rows[n] for x in y]))


def main():
    rng, out = random.Random(20261), []
    out.append("# made by formula_reference.py: formulas with kp = 0.375, kd = -1.25 and the states h.x, h.y")
    for i in range(60):
        write_values(out, rng, 2 + i % 3, i % 3 == 2)
    for i in range(40):
        write_series(out, rng, 1 + i % 3, i % 5, i % 2 == 0)
    TABLE.write_text("\n".join(out) + "\n")


if __name__ == "__main__":
    main()
