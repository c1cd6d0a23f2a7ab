#include "polhode/torque/custom.hpp"

#include <algorithm>
#include <cmath>

#include "polhode/core/error.hpp"

namespace polhode::torques {
Custom::Custom(Function function, void* data, const Claims& claims, Potential potential,
               std::shared_ptr<const void> owner)
    : function_(function), data_(data), claims_(claims), potential_(potential), owner_(std::move(owner)) {
  if (function_ == nullptr) throw InvalidInput("Custom.function", "a function", "a null pointer");
}

const TorqueRecord& Custom::record() {
  static constexpr TorqueRecord record{"Custom", "custom",
                                       "A torque of the user's own: a Python callable or a compiled function pointer.",
                                       "", {}};
  return record;
}

Custom Custom::with_breaks(std::vector<double> times) const {
  for (const double t : times) {
    if (!std::isfinite(t)) throw InvalidInput("Custom.breaks", "finite times", to_text(t));
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  Custom other = *this;
  other.breaks_ = std::move(times);
  return other;
}

Custom Custom::between(double begin, double end) const {
  // A few units in the last place, because the function may compare a rounded quotient of the time.
  constexpr double units = 4 * std::numeric_limits<double>::epsilon();
  Custom other = *this;
  other.breaks_.clear();
  if (!(begin < end)) return other;
  const double next = std::nextafter(begin, end), last = std::nextafter(end, begin);
  if (next == end) {   // no time lies between: a window contains its begin
    other.begin_ = other.end_ = begin;
    return other;
  }
  const double most = (end - begin) / 1024;
  const auto step = [most](double t) {
    return std::min(most, std::max(units * std::abs(t), std::numeric_limits<double>::min()));
  };
  other.begin_ = std::max(begin + step(begin), next);
  other.end_ = std::min(end - step(end), last);
  return other;
}

double Custom::compute_potential(const TorqueInput& in) const {
  double unit[4];
  normalise(in.attitude, unit);
  return potential_ == nullptr ? 0.0 : potential_(in.t, unit, data_);
}

}  // namespace polhode::torques
