#pragma once

#include <memory>
#include <string>

#include "batch/lanes/lane_state.hpp"
#include "polhode/ode/method_record.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

class LaneIntegrator;

/// One body, prepared for one lane method.
class LaneProblem {
 public:
  virtual ~LaneProblem() = default;

  /// Problems of one kind can share an integrator. Kernels are compiled for a kind, or need it equal in all lanes.
  virtual std::string kind() const = 0;
  virtual std::string describe_state() const = 0;   ///< for the plan
  /// Writes w_B and, where the attitude is carried, q_WB of a sample.
  virtual void unpack(const double* y, double* omega, double* attitude) const = 0;
  /// An integrator for problems of this kind.
  virtual std::unique_ptr<LaneIntegrator> make_integrator(const ode::Tolerances& tolerances) const = 0;
};

/// Steps eight problems of one kind with one method. It knows neither the samples nor the queue of bodies: see
/// run_in_lanes().
class LaneIntegrator {
 public:
  static constexpr int width = LaneState::width;

  virtual ~LaneIntegrator() = default;

  virtual LaneState& state() = 0;
  /// Puts a problem into a lane: its constants and its start. The lane's times are already in the state.
  virtual void load(int lane, const LaneProblem& problem) = 0;
  /// Empties a lane. What remains in it must be finite and must not slow the others down.
  virtual void clear(int lane) = 0;
  /// Steps all lanes until an active one needs the host, at most `rounds` times. A lane needs the host when a sample
  /// lies in its last step, when it cannot continue, or when it has made max_steps. Returns the bits of these lanes.
  virtual unsigned advance(int rounds) = 0;
  /// Converts a time to the position within a lane's last step that `sample` takes.
  virtual double find_position(int lane, double t) const = 0;
  virtual void sample(const double* positions, double (*y)[width]) = 0;
};

/// A method that steps bodies side by side.
struct LaneMethod {
  const ode::MethodRecord& record;
  bool (*accepts)(const Scene& scene);   ///< other scenes are solved one by one
  /// The scene must outlive the problem.
  /// @param before  the problem of another body, to share what both have in common, or null
  std::unique_ptr<LaneProblem> (*make_problem)(const Scene& scene, const LaneProblem* before);
};

extern const LaneMethod taylor_lanes, rk45_lanes;

}  // namespace polhode
