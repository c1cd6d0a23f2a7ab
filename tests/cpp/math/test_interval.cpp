#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "polhode/math/detail/interval_functions.hpp"

using namespace polhode::math;

namespace {
constexpr double infinity = Interval::infinity;
/// The width of a set as a part of its middle.
double relative_radius(const Interval& a) { return a.radius / std::abs(a.middle.hi); }
}  // namespace

TEST_CASE("a result holds the exact one and is hardly wider") {
  const Interval third = Interval(1.0) / Interval(3.0);
  CHECK(relative_radius(third) < 1e-29);
  CHECK(third.lower() < third.upper());
  CHECK((third * Interval(3.0) - Interval(1.0)).contains(0.0));
  const Interval root = sqrt(Interval(2.0));
  CHECK((sqr(root) - Interval(2.0)).contains(0.0));
  CHECK(relative_radius(root) < 1e-29);
  // (1 + 2^-60)(1 - 2^-60) = 1 - 2^-120 is no double-double: only a radius can hold it.
  const Interval tiny(DD(1.0, 0x1p-60), 0.0), other(DD(1.0, -0x1p-60), 0.0);
  const Interval lack = Interval(1.0) - tiny * other;
  CHECK((lack.lower() <= 0x1p-120 && 0x1p-120 <= lack.upper()));
}

TEST_CASE("results hold MPFR's, to 106 bits") {
  // Made by tests/reference/interval_mpfr.py --write; the same script compares a million operations.
  std::ifstream file(POLHODE_REFERENCE "/interval.csv");
  REQUIRE(file.good());
  std::string line, cell;
  std::getline(file, line);
  int rows = 0;
  while (std::getline(file, line)) {
    std::vector<double> x;
    std::istringstream cells(line);
    while (std::getline(cells, cell, ',')) x.push_back(std::strtod(cell.c_str(), nullptr));
    REQUIRE(x.size() == 18);
    const Interval a(x[0]), b(x[1]);
    const IntervalSinCos trig = sincos(a);
    const Interval found[] = {a + b, a - b, a * b, a / b, sqr(a), sqrt(a), trig.sin, trig.cos};
    for (std::size_t i = 0; i < 8; ++i) {
      const double high = x[2 + 2 * i], low = x[3 + 2 * i];
      CAPTURE(i);
      CAPTURE(x[0]);
      CAPTURE(x[1]);
      CHECK((found[i] - Interval(DD(high, low), std::abs(high) * 0x1p-105)).contains(0.0));
      if (i < 6) CHECK(found[i].radius <= std::abs(high) * 0x1p-98);
    }
    ++rows;
  }
  CHECK(rows == 300);
}

TEST_CASE("sets that hold 0, and sets without a bound") {
  const Interval around(DD(1.0), 2.0);
  CHECK((Interval(1.0) / around).upper() == infinity);
  CHECK(sqr(around).lower() <= 0.0);
  CHECK(sqr(around).contains(9.0));
  CHECK(sqrt(around).contains(0.0));
  CHECK(sqrt(around).contains(std::sqrt(3.0)));
  CHECK((Interval(1e200) * Interval(1e200)).upper() == infinity);
  CHECK((Interval(infinity) * Interval(0.0)).lower() == -infinity);
  CHECK(Interval(NAN).contains(-1e300));
  CHECK((Interval(5e-324) * Interval(0.5)).contains(0.0));
  CHECK((Interval(5e-324) * Interval(0.5)).upper() > 0.0);
  CHECK(around.magnitude() >= 3.0);
  CHECK(around.mignitude() == 0.0);
  CHECK(Interval(DD(-5.0), 1.0).mignitude() <= 4.0);
}

TEST_CASE("sine and cosine hold known values at any angle") {
  // To 40 digits by mpmath, as double-doubles.
  const IntervalSinCos one = sincos(Interval(1.0));
  CHECK((one.sin - Interval(DD(0.8414709848078965, 1.776845092935536e-18), 2e-33)).contains(0.0));
  CHECK((one.cos - Interval(DD(0.5403023058681398, -4.760954612604417e-17), 3e-33)).contains(0.0));
  CHECK(relative_radius(one.sin) < 1e-29);
  for (double angle = -50.0; angle < 50.0; angle += 0.37) {
    const IntervalSinCos found = sincos(Interval(angle));
    CHECK((sqr(found.sin) + sqr(found.cos) - Interval(1.0)).contains(0.0));
    CHECK(found.sin.middle.hi == doctest::Approx(std::sin(angle)).epsilon(1e-14));
    CHECK(found.cos.middle.hi == doctest::Approx(std::cos(angle)).epsilon(1e-14));
  }
  CHECK(sincos(Interval(1e300)).sin.upper() >= 1.0);
  CHECK(sincos(Interval(DD(0.0), 2.0)).cos.lower() <= -0.4);
}

TEST_CASE("functions hold known values, and each other") {
  // To 40 digits by mpmath, as double-doubles.
  CHECK((exp(Interval(1.0)) - Interval(DD(2.718281828459045, 1.4456468917292502e-16), 2e-32)).contains(0.0));
  CHECK((log(Interval(3.0)) - Interval(DD(1.0986122886681098, -9.07129723500153e-17), 1e-32)).contains(0.0));
  CHECK((tanh(Interval(0.5)) - Interval(DD(0.46211715726000974, 2.1916603238260928e-17), 1e-32)).contains(0.0));
  CHECK((atan2(Interval(1.0), Interval(-2.0)) - Interval(DD(2.677945044588987, 1.5527705369303147e-16), 2e-32)).contains(0.0));
  for (double x = -30.0; x < 30.0; x += 0.37) {
    const Interval power = exp(Interval(x));
    CHECK(relative_radius(power) < 1e-26);
    CHECK((log(power) - Interval(x)).contains(0.0));
    CHECK((power * exp(Interval(-x)) - Interval(1.0)).contains(0.0));
    CHECK((tanh(Interval(x)) * (sqr(power) + Interval(1.0)) - (sqr(power) - Interval(1.0))).contains(0.0));
    const IntervalSinCos trig = sincos(Interval(0.1 * x));
    CHECK((atan2(trig.sin, trig.cos) - Interval(0.1 * x)).contains(0.0));
  }
  // Wide sets hold the values at their ends, and unbounded ones are told.
  const Interval wide(DD(0.7), 0.25);
  for (const double end : {0.45, 0.95}) {
    CHECK(exp(wide).contains(std::exp(end)));
    CHECK(log(wide).contains(std::log(end)));
    CHECK(tanh(wide).contains(std::tanh(end)));
    CHECK(atan2(wide, Interval(-1.0)).contains(std::atan2(end, -1.0)));
  }
  CHECK_FALSE(log(Interval(DD(1.0), 1.0)).is_bounded());
  CHECK_FALSE(log(Interval(-1.0)).is_bounded());
  CHECK_FALSE(atan2(Interval(0.0), Interval(0.0)).is_bounded());
  CHECK_FALSE(atan2(Interval(DD(0.0), 1.0), Interval(DD(0.0), 1.0)).is_bounded());
  CHECK_FALSE(exp(Interval(1000.0)).is_bounded());
  CHECK(exp(Interval(-1000.0)).contains(0.0));
  CHECK(tanh(Interval::all()).upper() >= 1.0);
}
