#include "polhode/torque/during.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "polhode/core/error.hpp"

namespace polhode::torques {
namespace {

std::string show(const Window& window) {
  return std::string("[").append(to_text(window.begin)).append(", ").append(to_text(window.end)).append("]");
}

/// In the order of time, those that touch made one.
std::vector<Window> arrange(std::vector<Window> windows) {
  for (const Window& one : windows) {
    if (one.begin < one.end) continue;
    const bool known = !std::isnan(one.begin) && !std::isnan(one.end);
    throw InvalidInput("During.windows", "pairs of a begin and a later end", show(one),
                       !known                 ? ""
                       : one.begin == one.end ? "an empty window: nothing ever acts in it"
                                              : "begin and end are swapped");
  }
  std::sort(windows.begin(), windows.end(), [](const Window& a, const Window& b) { return a.begin < b.begin; });
  std::vector<Window> apart;
  for (const Window& one : windows) {
    if (!apart.empty() && one.begin < apart.back().end) {
      throw InvalidInput("During.windows", "apart from each other", show(apart.back()) + " and " + show(one),
                         "what acts twice at once is two torques");
    }
    if (!apart.empty() && one.begin == apart.back().end) {
      apart.back().end = one.end;
    } else {
      apart.push_back(one);
    }
  }
  return apart;
}

}  // namespace

During::During(LastingTorque torque, std::vector<Window> windows)
    : torque_(std::move(torque)), windows_(arrange(std::move(windows))) {}

const TorqueRecord& During::record() {
  static constexpr TorqueRecord record{
      "During", "during", "Another torque within windows of time, and none outside.", "", {}};
  return record;
}

bool During::acts_at(double t) const {
  return std::any_of(windows_.begin(), windows_.end(),
                     [t](const Window& one) { return one.begin <= t && t < one.end; });
}

bool During::acts_throughout(double begin, double end) const {
  return std::any_of(windows_.begin(), windows_.end(),
                     [=](const Window& one) { return one.begin <= begin && end <= one.end; });
}

TorqueTraits During::traits() const {
  TorqueTraits traits = std::visit([](const auto& one) { return one.traits(); }, torque_);
  traits.uses_time = true;
  traits.pattern_rate = 0.0;   // no potential that comes and goes keeps an energy, of whatever kind
  traits.vanishes |= windows_.empty();
  return traits;
}

void During::add(const TorqueInput& in, double* tau_B) const {
  if (acts_at(in.t)) std::visit([&](const auto& one) { one.add(in, tau_B); }, torque_);
}

double During::compute_potential(const TorqueInput& in) const {
  return acts_at(in.t) ? std::visit([&](const auto& one) { return one.compute_potential(in); }, torque_) : 0.0;
}

}  // namespace polhode::torques
