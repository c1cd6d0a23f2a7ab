#include "polhode/torque/torques.hpp"

namespace polhode {

TorqueTraits traits(const AnyTorque& torque) {
  return std::visit([](const auto& one) { return one.traits(); }, torque);
}

std::string_view torque_name(const AnyTorque& torque) {
  return std::visit([](const auto& lasting) { return lasting.record().name; }, torque);
}

TorqueSum summarize(std::span<const AnyTorque> torques) {
  TorqueSum sum;
  bool one_pattern = true, turning = false, standing_still = true;
  for (const AnyTorque& torque : torques) {
    const TorqueTraits one = traits(torque);
    if (one.vanishes) continue;
    ++sum.acting;
    sum.uses_time |= one.uses_time;
    sum.uses_attitude |= one.uses_attitude;
    sum.uses_rates |= one.uses_rates;
    sum.has_potential &= one.has_potential;
    sum.keeps_vertical &= one.keeps_vertical;
    if (one.pattern_rate != 0.0) {
      one_pattern &= !turning || one.pattern_rate == sum.pattern_rate;
      sum.pattern_rate = one.pattern_rate;
      turning = true;
    } else {
      // A potential that is symmetric about the vertical stands still and turns alike.
      one_pattern &= one.keeps_vertical && !one.uses_time;
      standing_still &= !one.uses_time;
    }
  }
  sum.keeps_energy = sum.has_potential && !turning && standing_still;
  sum.keeps_jacobi = sum.has_potential && turning && one_pattern;
  return sum;
}

}  // namespace polhode
