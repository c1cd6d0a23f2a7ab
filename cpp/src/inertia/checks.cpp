#include "polhode/inertia/checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "inertia/jacobi.hpp"
#include "polhode/inertia/inertia_tensor.hpp"

namespace polhode {
namespace {

bool all_finite(const double* m) {
  double sum = 0;  // NaN when any entry is NaN or infinite
  for (int i = 0; i < 9; ++i) sum += 0 * m[i];
  return sum == 0;
}

bool symmetric(const double* m) {
  double largest = 0;
  for (int i = 0; i < 9; ++i) largest = std::max(largest, std::abs(m[i]));
  const auto near = [&](double a, double b) {
    return std::abs(0.5 * a - 0.5 * b) <= 0.5 * InertiaTensor::tolerance * largest;  // halves: no overflow
  };
  return near(m[1], m[3]) && near(m[2], m[6]) && near(m[5], m[7]);
}

double mean(double a, double b) { return a == b ? a : 0.5 * a + 0.5 * b; }

std::uint8_t find_flaws(Vector3d moments, double* margin) {
  std::sort(moments.data(), moments.data() + 3);
  const double largest = std::max(std::abs(moments[0]), std::abs(moments[2]));
  if (largest == 0) {
    *margin = 0;
    return 0;
  }
  const Vector3d part = moments / largest;
  *margin = part[0] + part[1] - part[2];
  std::uint8_t flaws = 0;
  if (part[0] < -InertiaTensor::tolerance) flaws |= flaw_not_positive;
  if (*margin < -InertiaTensor::tolerance) flaws |= flaw_triangle;
  return flaws;
}

}  // namespace

void check_inertia(const double* I_B, std::size_t count, double* margins, std::uint8_t* flaws) {
  constexpr std::size_t lanes = 8;
  for (std::size_t first = 0; first < count; first += lanes) {
    const std::size_t used = std::min(lanes, count - first);
    inertia::Jacobi<lanes> solver;
    for (std::size_t lane = 0; lane < used; ++lane) {
      const double* const m = I_B + 9 * (first + lane);
      std::uint8_t& found = flaws[first + lane] = 0;
      if (!all_finite(m)) {
        found = flaw_not_finite;
        continue;
      }
      if (!symmetric(m)) found = flaw_not_symmetric;
      solver.load(lane, m[0], m[4], m[8], mean(m[1], m[3]), mean(m[2], m[6]), mean(m[5], m[7]));
    }
    solver.run();
    for (std::size_t lane = 0; lane < used; ++lane) {
      double& margin = margins[first + lane];
      if (flaws[first + lane] & flaw_not_finite) {
        margin = std::numeric_limits<double>::quiet_NaN();
      } else {
        flaws[first + lane] |= find_flaws(solver.moments(lane), &margin);
      }
    }
  }
}

}  // namespace polhode
