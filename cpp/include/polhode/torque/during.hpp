#pragma once

#include <vector>

#include "polhode/torque/list.hpp"

namespace polhode::torques {

/// A stretch of time; either end may be infinite [s].
struct Window {
  double begin, end;
  friend bool operator==(const Window&, const Window&) = default;
};

/// Another torque within windows of time, and none outside: a thruster's firings, a brake that is let go.
///
/// solve() cuts the span at the windows' ends and gives each piece the torques that act there, so that no method ever
/// steps over a jump, and what nothing acts on is evaluated by its closed form.
class During {
 public:
  /// @param windows  [begin, end) each, in any order; they may touch, and then are one
  /// @throws InvalidInput for a window that is empty, reversed or not a number, and for two that overlap
  During(LastingTorque torque, std::vector<Window> windows);

  static const TorqueRecord& record();

  const LastingTorque& torque() const { return torque_; }
  const std::vector<Window>& windows() const { return windows_; }   ///< in the order of time, apart from each other

  bool acts_at(double t) const;
  /// All the way from one time to a later one; the windows' ends count as within.
  bool acts_throughout(double begin, double end) const;

  TorqueTraits traits() const;
  void add(const TorqueInput& in, double* tau_B) const;
  double compute_potential(const TorqueInput& in) const;

 private:
  LastingTorque torque_;
  std::vector<Window> windows_;
};

}  // namespace polhode::torques
