#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "polhode/inertia/checks.hpp"

using namespace polhode;

TEST_CASE("the checks of many tensors: margins and flaws do not depend on the neighbours") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::vector<double>> rows = {
      {1, 0, 0, 0, 1, 0, 0, 0, 1},     // a sphere
      {3, 0, 0, 0, 1, 0, 0, 0, 2},     // flat, at the limit
      {0, 0, 0, 0, 0, 0, 0, 0, 0},     // a point
      {1, 0, 0, 0, 2, 0, 0, 0, 5},     // above the sum of the two others
      {-1, 0, 0, 0, 2, 0, 0, 0, 2},    // negative
      {1, 0.1, 0, 0, 1, 0, 0, 0, 1},   // one triangle only
      {1, 0, 0, 0, nan, 0, 0, 0, 1},   //
      {2, 1, 0, 1, 2, 0, 0, 0, 2},     // moments 1, 2, 3
      {1e-300, 0, 0, 0, 1e-300, 0, 0, 0, 1.5e-300},
  };
  const std::vector<double> margin = {1, 0, 0, -0.4, -0.5, 0.9 / 1.05, nan, 0, 1 / 3.0};
  const std::vector<int> flaw = {0, 0, 0, flaw_triangle, flaw_not_positive | flaw_triangle, flaw_not_symmetric,
                                 flaw_not_finite, 0, 0};
  for (std::size_t copies : {1u, 3u}) {
    std::vector<double> in;
    for (std::size_t k = 0; k < copies; ++k)
      for (const auto& row : rows) in.insert(in.end(), row.begin(), row.end());
    std::vector<double> margins(in.size() / 9);
    std::vector<std::uint8_t> flaws(in.size() / 9);
    check_inertia(in.data(), margins.size(), margins.data(), flaws.data());
    for (std::size_t i = 0; i < margins.size(); ++i) {
      CAPTURE(i);
      CHECK(static_cast<int>(flaws[i]) == flaw[i % rows.size()]);
      if (std::isnan(margin[i % rows.size()])) {
        CHECK(std::isnan(margins[i]));
      } else {
        CHECK(margins[i] == doctest::Approx(margin[i % rows.size()]).epsilon(1e-14));
      }
    }
  }
}
