#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "polhode/step.hpp"

using namespace polhode;

// Literals of double are meant to be rounded here: -Wconversion, where it is on, says that they are.
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wfloat-conversion"

namespace {
typedef float FourFloats __attribute__((vector_size(16)));
}  // namespace

TEST_CASE("free step: literals of double serve a float body, a double one and lanes") {
  const step::Inertia<float> body = step::make_inertia(0.2, 0.4, 0.5);
  const step::Inertia<double> fine = step::make_inertia(0.2, 0.4, 0.5);
  const step::Inertia<float> same = step::make_inertia<float>(0.2, 0.4, 0.5);
  for (int i = 0; i < 3; ++i) {
    CHECK(body.a[i] == static_cast<float>(fine.a[i]));
    CHECK(std::abs(body.a[i] - same.a[i]) <= std::numeric_limits<float>::epsilon() * same.a[i]);
  }
  CHECK(body.scale == 2.0f);
  const step::Inertia<FourFloats> lanes = body;
  CHECK(lanes.a[0][3] == body.a[0]);

  step::Vec<float> given{0.02f, 2.0f, 0.05f}, wanted = given;
  step::kick(given, step::Vec<float>{1.0f, 2.0f, 3.0f}, 1.0 / 120);
  step::kick(wanted, step::Vec<float>{1.0f, 2.0f, 3.0f}, static_cast<float>(1.0 / 120));
  CHECK(given.x == wanted.x);
  step::Quat<float> q{0, 0, 0, 1}, p = q;
  step::drift_space(body, 1.0 / 60, given, q), step::drift_body(body, 1.0 / 60, given, q);
  step::drift_space<4>(step::make_principal(0.2f, 0.4f, 0.5f, 0.01f, 0.0f, 0.0f), 1.0 / 60, given, q);
  const float h = static_cast<float>(1.0 / 60);
  step::drift_space(body, h, wanted, p), step::drift_body(body, h, wanted, p);
  step::drift_space<4>(step::make_principal<float>(0.2, 0.4, 0.5, 0.01, 0, 0), h, wanted, p);
  CHECK((q.x == p.x && q.y == p.y && q.z == p.z && q.w == p.w && q.y != 0.0f));

  step::Vec<double> L{0.02, 2.0, 0.05};
  step::Quat<double> turned{0, 0, 0, 1};
  step::drift_space(fine, 1, L, turned);   // an int of seconds
  CHECK(turned.w != 1.0);
}
