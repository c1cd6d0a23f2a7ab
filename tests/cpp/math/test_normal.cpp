#include <doctest/doctest.h>

#include "polhode/math/detail/normal.hpp"

using namespace polhode::math;

TEST_CASE("tails of the normal distribution on both sides of their bounds, and 0 beyond 37") {
  // erfc(x / sqrt 2) / 2 by mpmath at 60 digits
  CHECK(upper_normal_tail(3.0) == doctest::Approx(0.001349898031630094526651815).epsilon(2.3e-16));
  CHECK(upper_normal_tail(3.1) == doctest::Approx(0.0009676032132183566019638532).epsilon(2.3e-16));
  CHECK(upper_normal_tail(37.0) / 5.725571222524576822683193e-300 == doctest::Approx(1.0).epsilon(4.5e-16));
  CHECK(upper_normal_tail(37.1) == 0.0);
  CHECK(upper_normal_tail(38.0) == 0.0);
  CHECK(upper_normal_tail(-37.1) == 1.0);
}
