#pragma once

#include <array>
#include <memory>
#include <vector>

#include "polhode/scene/scene.hpp"
#include "solve/proof/quadratic_system.hpp"
#include "solve/proof/formula_modes.hpp"
#include "solve/proof/taylor_step.hpp"

// A body's motion as a quadratic system, or as formulas where a torque is one. Time runs in units of 1 / pace().
namespace polhode::proof {

/// The variables of a scene: w_B / rate, vectors fixed in space and the radial and tangential vectors of orbits as seen
/// from the body, and the quaternion where it is wanted. They are the same in every piece of the span. Formulas see the
/// attitude alone: it then stands for the vectors. Their own states follow.
class BodyEquations {
 public:
  /// @param scene  one without calls_custom()
  explicit BodyEquations(const Scene& scene);

  int size() const { return first_own() + static_cast<int>(state_units_.size()); }
  int attitude() const { return attitude_; }           ///< index of the quaternion's first component
  int first_own() const { return attitude_ + (has_attitude_ ? 4 : 0); }   ///< index of the first state of a formula
  /// The units of those states, powers of two; their order is that of Scene::states().
  const std::vector<double>& state_units() const { return state_units_; }
  double rate() const { return rate_; }                ///< a power of two [rad/s]
  double pace() const { return pace_; }                ///< a power of two [1/s]; above rate() where damping is fast

  /// The exact start. The attitude is normalised as real numbers are, and the momenta of driven rotors and of a damper
  /// are those of their speeds.
  std::vector<Interval> start() const;

  /// Which rotors rotate from one time to a later one without a break, or at a time.
  std::vector<bool> find_rotating(double begin, double end) const;

  /// Whether formulas with switches are among torques.
  bool has_switches(const std::vector<AnyTorque>& torques) const;
  /// Their modes.
  std::unique_ptr<FormulaModes> make_modes(const std::vector<AnyTorque>& torques, const std::vector<bool>& rotating,
                                           double sign, const StepSettings& settings) const;
  /// Steps of the equations under these torques, none of them with windows, and rotors; `sign` is -1 backwards in time.
  std::unique_ptr<TaylorStep> make_step(const std::vector<AnyTorque>& torques, const std::vector<bool>& rotating,
                                        double sign, const StepSettings& settings) const;

  /// The change of w_B / rate where some rotors stop and others start: J w + h is continuous.
  std::array<Interval, 3> compute_jump(const std::vector<bool>& before, const std::vector<bool>& after) const;

 private:
  struct Orbit {
    double mean_motion, phase;
    friend bool operator==(const Orbit&, const Orbit&) = default;
  };
  class Maker;

  QuadraticSystem make_system(const std::vector<AnyTorque>& torques, const std::vector<bool>& rotating,
                              double sign) const;
  void choose_vectors();
  void choose_units();
  void choose_state_units();
  std::vector<Interval> enclose_states() const;
  int fixed_index(std::size_t vector) const { return 3 + 3 * static_cast<int>(vector); }
  int orbit_index(std::size_t orbit) const { return fixed_index(fixed_.size() + 2 * orbit); }

  Scene scene_;
  std::vector<AnyTorque> torques_ = {};    ///< without their windows
  std::vector<Vector3d> fixed_ = {};       ///< vectors in space
  std::vector<Orbit> orbits_ = {};
  double rate_ = 1.0, pace_ = 1.0;
  std::vector<double> state_units_ = {};
  int attitude_ = 3;
  bool has_attitude_ = false;
  bool by_formulas_ = false;
};

}  // namespace polhode::proof
