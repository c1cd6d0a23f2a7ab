#include "solve/ground/proportional_damping.hpp"

#include <cmath>
#include <limits>

#include "polhode/math/detail/double_double.hpp"

namespace polhode {
namespace {

bool is_rounding_of(double rate, const Matrix3d& damping, const Matrix3d& I, bool& rounded) {
  rounded = false;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (rate * I(i, j) != damping(i, j)) return false;
      rounded |= std::fma(rate, I(i, j), -damping(i, j)) != 0.0;
    }
  }
  return true;
}

}  // namespace

std::optional<ProportionalDamping> find_proportional(const Matrix3d& damping, const Matrix3d& I) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Eigen::Index i = 0;
  I.diagonal().maxCoeff(&i);
  const double middle = damping(i, i) / I(i, i);
  if (!std::isfinite(middle) || middle == 0.0) return std::nullopt;
  const double below = std::nextafter(middle, -infinity), above = std::nextafter(middle, infinity);
  std::optional<ProportionalDamping> found;
  for (const double rate :
       {middle, below, above, std::nextafter(below, -infinity), std::nextafter(above, infinity)}) {
    bool rounded = false;
    if (!is_rounding_of(rate, damping, I, rounded)) continue;
    if (!found || (found->rounded && !rounded)) found = {rate, rounded};
  }
  return found;
}

std::optional<ProportionalDamping> find_proportional_damping(const Scene& scene) {
  ProportionalDamping sum;
  bool any = false;
  for (const AnyTorque& torque : scene.torques()) {
    if (traits(torque).vanishes) continue;
    ProportionalDamping one;
    if (const auto* angular = std::get_if<torques::AngularDamping>(&torque)) {
      one.rate = angular->rate();
    } else if (const auto* damping = std::get_if<torques::Damping>(&torque)) {
      const auto found = find_proportional(damping->matrix(), scene.inertia_B().matrix());
      if (!found) return std::nullopt;
      one = *found;
    } else {
      return std::nullopt;
    }
    const math::DD total = math::two_sum(sum.rate, one.rate);
    sum = {total.hi, sum.rounded || one.rounded || total.lo != 0.0};
    any = true;
  }
  if (!any || !std::isfinite(sum.rate)) return std::nullopt;
  return sum;
}

}  // namespace polhode
