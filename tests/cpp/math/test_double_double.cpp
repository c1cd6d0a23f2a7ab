#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>

#include "polhode/math/detail/double_double.hpp"
#include "polhode/math/detail/phase.hpp"
#include "polhode/math/detail/sincos.hpp"
#include "polhode/math/detail/sincos_unfused.hpp"

using namespace polhode::math;

namespace {
/// |a / b - 1|; the reference b is itself a double-double.
double relative_error(DD a, DD b) { return std::abs(((a - b) / b).hi); }
}  // namespace

TEST_CASE("double-double arithmetic keeps 1e-31 relative") {
  const DD third = DD(1.0) / DD(3.0);
  CHECK(third.hi == 1.0 / 3.0);
  CHECK(std::abs((third * DD(3.0) - DD(1.0)).hi) < 1e-31);
  const DD root = sqrt(DD(2.0));
  CHECK(std::abs((root * root - DD(2.0)).hi) < 1e-31);
  CHECK(sqrt(DD(0.0)).hi == 0.0);
  const DD p = two_prod(1.0 + 0x1p-40, 1.0 - 0x1p-40);
  CHECK(p.hi == 1.0);
  CHECK(p.lo == -0x1p-80);
  CHECK((DD(1e16) + DD(1.0) - DD(1e16)).hi == 1.0);
  CHECK(DD(1.0, 1e-20) > DD(1.0));
}

TEST_CASE("double-double functions agree with 60-digit values") {
  // mpmath at 60 digits
  const SinCos s = sincos(DD(1.0));
  CHECK(relative_error(s.sin, {0.8414709848078965, 1.776845092935536e-18}) < 1e-30);
  CHECK(relative_error(s.cos, {0.5403023058681398, -4.760954612604417e-17}) < 1e-30);
  const SinCos far = sincos(DD(1e6));
  CHECK(relative_error(far.sin, {-0.34999350217129294, -1.5952848809323968e-17}) < 1e-26);
  CHECK(relative_error(exp(DD(1.0)), {2.718281828459045, 1.4456468917292502e-16}) < 1e-30);
  CHECK(relative_error(log(DD(10.0)), {2.302585092994046, -2.1707562233822494e-16}) < 1e-30);
  CHECK(relative_error(atan2(DD(1.0), DD(-2.0)), {2.677945044588987, 1.5527705369303147e-16}) < 1e-30);
  for (const double x : {-600.0, -3.5, -1e-9, 1e-20, 0.7, 4.0, 600.0}) {
    CHECK(std::abs((log(exp(DD(x))) - DD(x)).hi) < 1e-30 * std::max(1.0, std::abs(x)));
  }
  CHECK(exp(DD(-1e4)).hi == 0.0);
}

TEST_CASE("the phase of a billion turns keeps its fraction") {
  // t = 1e9 + 1/8 turns at a rate of 1 + 2^-70 cycles a second
  const double f = cycle_fraction(1e9 + 0.125, 1.0, 0x1p-70, 0.25);
  CHECK(f == doctest::Approx(0.375 + 1e9 * 0x1p-70).epsilon(1e-15));
  CHECK(std::abs(cycle_fraction(-7.75, 1.0, 0.0, 0.0)) == 0.25);
}

TEST_CASE("sincos of cycles is right to an ulp in every quadrant") {
  double worst = 0.0;
  for (int i = -4096; i <= 4096; ++i) {
    const double f = i / 8192.0 + 1e-7 * (i % 7) / 8.0;
    double s = 0, c = 0;
    sincos_cycles(f, s, c);
    const SinCos exact = sincos(DD(f) * scaled(pi<DD>(), 2.0));
    worst = std::max({worst, std::abs((DD(s) - exact.sin).hi), std::abs((DD(c) - exact.cos).hi)});
  }
  CHECK(worst < 1.7e-16);   // the documented bound; the code has the same bits on every machine
  CHECK(worst > 4e-17);
  double s = 1, c = 0;
  sincos_cycles(0.5, s, c);
  CHECK(std::abs(s) == 0.0);
  CHECK(c == -1.0);
  sincos_cycles(-0.25, s, c);
  CHECK(s == -1.0);
}

TEST_CASE("sincos without fused operations is right in every quadrant, up to the largest angle that it takes") {
  double worst = 0.0;
  const auto check = [&](double x) {
    double s = 0, c = 0;
    sincos_unfused(x, s, c);
    const SinCos exact = sincos(DD(x));
    worst = std::max({worst, std::abs((DD(s) - exact.sin).hi), std::abs((DD(c) - exact.cos).hi)});
  };
  for (int i = -4096; i <= 4096; ++i) {
    check(i / 512.0 + 1e-7 * (i % 7));
    check(i * (most_unfused_angle / 4096));
    check(i * 1.5707963267948966);   // next to a multiple of a quarter turn
  }
  CHECK(worst < 1.4e-16);   // the documented bound, as above
  CHECK(worst > 4e-17);
  double s = 1, c = 0;
  sincos_unfused(0.0, s, c);
  CHECK(s == 0.0);
  CHECK(c == 1.0);
}
