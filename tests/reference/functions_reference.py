"""Makes functions.csv: elementary functions by mpmath at 40 digits and more, at hard and at random arguments.

A line is the function, its arguments, the nearest float64 number to the value, and what the value has beyond it in
units of its last place. The arguments are exact. Run: python functions_reference.py
"""

import math
import pathlib
import random

import mpmath
from mpmath import mp, mpf

TABLE = pathlib.Path(__file__).with_name("functions.csv")
COUNT = 70   # random arguments of a function, besides the chosen ones
# Where a rounding to the nearest multiple of pi / 2 is hardest, of all float64 numbers and of small ones.
HARD_ANGLES = (float.fromhex("0x1.6ac5b262ca1ffp+849"), 1.5707963267948966, 3.141592653589793, 4.71238898038469, 22.0,
               355.0, 710.0, 52174.0, 103993.0, 104348.0, 99999.99999999999, 100000.00000000001, 1e22, 2.0**60, 1.7e308)
TINY = (5e-324, 1e-310, 2.3e-308, 1e-200, 1e-20, 1e-9, 7.4e-9, 7.5e-9, 1.5e-8)


def near(x, steps=2):
    """A number and its neighbours."""
    found = [x]
    for direction in (-math.inf, math.inf):
        value = x
        for _ in range(steps):
            value = math.nextafter(value, direction)
            found.append(value)
    return found


def any_size(rng, low=-1022, high=1023):
    return math.ldexp(rng.choice((-1, 1)) * rng.uniform(1, 2), rng.randint(low, high))


def angles(rng):
    yield from TINY
    for angle in HARD_ANGLES:
        yield from near(angle, 1)
    yield from near(math.pi / 4)
    for _ in range(COUNT):
        yield rng.uniform(-1, 1)
        yield rng.uniform(-10, 10)
        yield math.nextafter(rng.randint(1, 60000) * math.pi / 2, math.inf)
        yield any_size(rng, 0, 1023)


def slopes(rng):
    """Arguments of atan, on both sides of where its pieces meet."""
    yield from TINY
    yield from (1e20, 1e300, 1.0)
    for k in range(17):
        yield from near((k + 0.5) / 16, 1)
    for _ in range(COUNT):
        yield rng.uniform(-1, 1)
        yield any_size(rng, -30, 60)


def points(rng):
    for y, x in ((5e-324, 1.0), (1e-310, -1.0), (1.0, 1e-310), (1e308, -1.7e308), (5e-324, 5e-324), (-1e-320, 3e-320),
                 (1e300, 1e-300), (3.0, 1e9), (-3.0, -1e9), (1e-300, -1e-290), (1.0, 1.0), (1.0, -1.0)):
        yield y, x
    for _ in range(2 * COUNT):
        yield rng.uniform(-1, 1), rng.uniform(-1, 1)
        x = any_size(rng, -900, 900)
        yield x * math.ldexp(rng.uniform(-1, 1), rng.randint(-60, 20)), x


def sines(rng):
    yield from (*TINY, 0.5, 1.0, -1.0, math.sqrt(0.5))
    yield from (1 - 2.0**-k for k in range(1, 54))
    for _ in range(COUNT):
        yield rng.uniform(-1, 1)
        yield any_size(rng, -30, -1)


def pairs(rng):
    for a in (5e-324, 1e-310, 1e-160, 1e160, 1.2e308):
        yield a, a
        yield a, 0.3 * a
    for _ in range(2 * COUNT):
        a = any_size(rng, -1000, 1000)
        yield a, a * math.ldexp(rng.uniform(-1, 1), rng.randint(-30, 3))


def triples(rng):
    yield 1e-310, 2e-310, 3e-310
    yield 1e308, -1e308, 1e307
    for _ in range(2 * COUNT):
        a = any_size(rng, -1000, 1000)
        yield a, a * rng.uniform(-2, 2), a * math.ldexp(rng.uniform(-1, 1), rng.randint(-30, 3))


def exponents(rng):
    yield from TINY
    yield from (709.782712893384, -708.3964185322641, -708.4, -709.0, -720.0, -740.0, -745.0, 0.34657359027997264, 0.35,
                -0.35, 100.0, -100.0)
    for _ in range(COUNT):
        yield rng.uniform(-1, 1)
        yield rng.uniform(-745, 709)
        yield any_size(rng, -60, 5)


def positive(rng):
    yield from (*TINY, 1.7e308, 2.0, 0.5)
    yield from near(1.0, 3)
    yield from near(math.sqrt(0.5), 1)
    for _ in range(COUNT):
        yield abs(any_size(rng))
        yield rng.uniform(0.5, 2)
        yield 1 + any_size(rng, -45, -4)


def any_numbers(rng):
    yield from (*TINY, 1.7e308, 1e101, 1.0)
    for _ in range(COUNT):
        yield any_size(rng)
        yield any_size(rng, -30, 4)


def powers(rng):
    for x, y in ((10.0, -308.0), (10.0, -320.0), (2.0, 0.5), (-3.0, 3.0), (-3.0, 4.0), (5e-324, 0.01),
                 (1 - 2.0**-53, 1e18), (1 + 2.0**-52, -1e18), (1.5, 1e-300), (10.0, 22.0), (10.0, 23.0)):
        yield x, y
    for _ in range(2 * COUNT):
        x = abs(any_size(rng, -60, 60))
        yield x, rng.uniform(-17, 11.8)
        yield rng.uniform(0.5, 2), rng.uniform(-700, 700)


FUNCTIONS = {
    "sin": (mpmath.sin, angles), "cos": (mpmath.cos, angles), "atan": (mpmath.atan, slopes),
    "atan2": (mpmath.atan2, points), "asin": (mpmath.asin, sines), "acos": (mpmath.acos, sines),
    "hypot": (lambda a, b: mpmath.sqrt(a * a + b * b), pairs),
    "hypot3": (lambda a, b, c: mpmath.sqrt(a * a + b * b + c * c), triples),
    "exp": (mpmath.exp, exponents), "expm1": (mpmath.expm1, exponents), "log": (mpmath.log, positive),
    "asinh": (mpmath.asinh, any_numbers),
    "cbrt": (lambda x: mpmath.sign(x) * mpmath.cbrt(abs(x)), any_numbers), "pow": (mpmath.power, powers),
}


def main():
    rng = random.Random(11)
    lines = []
    for name, (function, draw) in FUNCTIONS.items():
        for drawn in draw(rng):
            arguments = drawn if isinstance(drawn, tuple) else (drawn,)
            size = max(abs(math.frexp(a)[1]) for a in arguments)
            mp.dps = 60 + size if size > 60 else 100
            value = function(*map(mpf, arguments))
            nearest = float(value)
            beyond = float((value - mpf(nearest)) / mpf(math.ulp(nearest)))
            lines.append(",".join((name, *(a.hex() for a in arguments), nearest.hex(), f"{beyond:.4f}")))
    TABLE.write_text("\n".join(lines) + "\n")
    print(len(lines), "lines")


if __name__ == "__main__":
    main()
