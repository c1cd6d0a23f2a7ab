#include "polhode/torque/custom.hpp"

#include <cmath>

#include "checks.hpp"

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

double Custom::compute_potential(const TorqueInput& in) const {
  double unit[4];
  normalise(in.attitude, unit);
  return potential_ == nullptr ? 0.0 : potential_(in.t, unit, data_);
}

}  // namespace polhode::torques
