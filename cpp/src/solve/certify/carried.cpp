#include "solve/certify/runs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "polhode/ode/tracked_taylor.hpp"

namespace polhode {

Attempt run_carried(CountedRuns& runs, double rtol, double safety, bool all_terms, double most, double& given_up) {
  const double accuracy = runs.decision().plan.accuracy;
  ode::ErrorTrace trace{.asked = accuracy / safety,
                        .most = most,
                        .hold_margin = limit_safety,
                        .all_terms = all_terms};
  Attempt attempt{.motion = runs.run(runs.decision().scene, runs.options(), rtol, false, &trace)};
  Motion& motion = attempt.motion;
  motion.rtol_used = rtol;
  given_up = trace.given_up;
  const bool lost = trace.given_up > 0.0 && !runs.decision().scene.controllers().empty();
  if ((!attempt.finished() && !lost) || motion.t.empty()) return attempt;
  const double rates =
      motion.omega.empty() || trace.rate_error == 0.0 ? 0.0 : trace.rate_error / motion.omega_scale();
  const double error = std::max({rates, motion.attitude.empty() ? 0.0 : trace.attitude_error, trace.state_error});
  // The carried error can grow without bound, but two attitudes differ by half a turn at most.
  constexpr double floor = 8 * std::numeric_limits<double>::epsilon();   // of samples, for all steps
  attempt.error = safety * std::min(error, std::numbers::pi) + floor;
  attempt.holds_until = attempt.error <= accuracy ? unknown_error : trace.holds_until;
  if (lost) attempt.holds_until = std::min(trace.holds_until, trace.given_up);
  return attempt;
}

}  // namespace polhode
