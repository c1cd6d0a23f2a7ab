#pragma once

#include <string_view>
#include <vector>

#include "polhode/torque/list.hpp"

namespace polhode::torques {

/// An interval of time; either end may be infinite [s].
struct Window {
  double begin, end;
  friend bool operator==(const Window&, const Window&) = default;
};

/// Sorts windows by time and merges windows that touch. @throws InvalidInput at `where`, as During does
std::vector<Window> arrange(std::vector<Window> windows, std::string_view where);

/// Another torque that acts within windows of time only: the firings of a thruster, a brake that is released.
///
/// solve() divides the span at the ends of the windows. Each piece has the torques that act there, so that no method
/// steps over a jump. A piece without torque is evaluated by its closed form.
class During {
 public:
  /// @param windows  [begin, end) each, in any order; windows that touch are merged
  /// @throws InvalidInput for a window that is empty, reversed or not a number, and for two that overlap
  During(LastingTorque torque, std::vector<Window> windows);

  static const TorqueRecord& record();

  const LastingTorque& torque() const { return torque_; }
  const std::vector<Window>& windows() const { return windows_; }   ///< sorted by time, separate

  bool acts_at(double t) const;
  /// Whether it acts from one time to a later one without a break; the ends of a window count as inside.
  bool acts_throughout(double begin, double end) const;

  TorqueTraits traits() const;
  void add(const TorqueInput& in, double* tau_B) const;
  double compute_potential(const TorqueInput& in) const;

 private:
  LastingTorque torque_;
  std::vector<Window> windows_;
};

}  // namespace polhode::torques
