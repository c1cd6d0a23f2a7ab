#include "polhode/torque/during.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "polhode/core/error.hpp"
#include "polhode/torque/torques.hpp"

namespace polhode::torques {
namespace {

std::string show(const Window& window) {
  return std::string("[").append(to_text(window.begin)).append(", ").append(to_text(window.end)).append("]");
}

}  // namespace

std::vector<Window> arrange(std::vector<Window> windows, std::string_view where) {
  for (const Window& window : windows) {
    if (window.begin < window.end) continue;
    const bool known = !std::isnan(window.begin) && !std::isnan(window.end);
    throw InvalidInput(where, "pairs of a begin and a later end", show(window),
                       !known                 ? ""
                       : window.begin == window.end ? "the window is empty"
                                              : "begin and end are swapped");
  }
  std::sort(windows.begin(), windows.end(), [](const Window& a, const Window& b) { return a.begin < b.begin; });
  std::vector<Window> merged;
  for (const Window& window : windows) {
    if (!merged.empty() && window.begin < merged.back().end) {
      throw InvalidInput(where, "apart from each other", show(merged.back()) + " and " + show(window),
                         "give two torques if both should act at once");
    }
    if (!merged.empty() && window.begin == merged.back().end) {
      merged.back().end = window.end;
    } else {
      merged.push_back(window);
    }
  }
  return merged;
}

During::During(LastingTorque torque, std::vector<Window> windows)
    : torque_(std::move(torque)), windows_(arrange(std::move(windows), "During.windows")) {
  const AnyTorque inner = to_any(torque_);
  const Formula* formula = find_formula(inner);
  if (formula == nullptr || formula->states().empty()) return;
  throw InvalidInput("During.torque", "a torque without states", "a Formula with the state " + formula->states()[0].name,
                     "its states go on outside the windows: write the window into the formula");
}

const TorqueRecord& During::record() {
  static constexpr TorqueRecord record{
      "During", "during", "Another torque within windows of time, and none outside.", "", {}};
  return record;
}

bool During::acts_at(double t) const {
  return std::any_of(windows_.begin(), windows_.end(),
                     [t](const Window& window) { return window.begin <= t && t < window.end; });
}

bool During::acts_throughout(double begin, double end) const {
  return std::any_of(windows_.begin(), windows_.end(),
                     [=](const Window& window) { return window.begin <= begin && end <= window.end; });
}

TorqueTraits During::traits() const {
  TorqueTraits traits = std::visit([](const auto& torque) { return torque.traits(); }, torque_);
  traits.uses_time = true;
  traits.pattern_rate = 0.0;   // a potential that is switched on and off conserves no energy
  traits.vanishes |= windows_.empty();
  return traits;
}

void During::add(const TorqueInput& in, double* tau_B) const {
  if (acts_at(in.t)) std::visit([&](const auto& torque) { torque.add(in, tau_B); }, torque_);
}

double During::compute_potential(const TorqueInput& in) const {
  return acts_at(in.t) ? std::visit([&](const auto& torque) { return torque.compute_potential(in); }, torque_) : 0.0;
}

}  // namespace polhode::torques
