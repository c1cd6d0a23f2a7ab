#pragma once

#include <memory>
#include <string>

#include "batch/lanes/lane_state.hpp"
#include "polhode/ode/method_record.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

class LaneTeam;

/// A body as one of the methods steps it in a lane.
class LaneBody {
 public:
  virtual ~LaneBody() = default;

  /// Bodies of one kind ride together: what the kernels are compiled for, or ask of all lanes alike.
  virtual std::string kind() const = 0;
  virtual std::string describe_state() const = 0;   ///< for the plan
  /// w_B and, where it is carried, q_WB of a sample.
  virtual void unpack(const double* y, double* omega, double* attitude) const = 0;
  /// Lanes for bodies of its kind.
  virtual std::unique_ptr<LaneTeam> make_team(const ode::Tolerances& tolerances) const = 0;
};

/// Eight lanes of one method. Riders take their places in it; who, and what becomes of them, it does not know.
class LaneTeam {
 public:
  static constexpr int width = LaneClock::width;

  virtual ~LaneTeam() = default;

  virtual LaneClock& clock() = 0;
  /// The body's constants and its start; its times are on the clock already.
  virtual void seat(int lane, const LaneBody& body) = 0;
  /// Nothing that could be slow or not finite in a lane without a rider.
  virtual void leave_empty(int lane) = 0;
  /// Steps until one of the riding calls, at most so many times: a sample lies in its last step, it cannot go on, or it
  /// has made its steps. The bits of those that call.
  virtual unsigned advance(int rounds) = 0;
  /// Where a time lies within a lane's last step, as `sample` asks for it.
  virtual double find_place(int lane, double t) const = 0;
  virtual void sample(const double* places, double (*y)[width]) = 0;
};

/// A method that steps bodies side by side.
struct LaneMethod {
  const ode::MethodRecord& record;
  bool (*takes)(const Scene& scene);   ///< what it does not take goes by itself
  /// The scene outlives the body.
  std::unique_ptr<LaneBody> (*make_body)(const Scene& scene);
};

extern const LaneMethod taylor_lanes, rk45_lanes;

}  // namespace polhode
