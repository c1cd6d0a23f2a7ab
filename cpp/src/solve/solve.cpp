#include "polhode/solve/solve.hpp"

#include <chrono>
#include <cmath>
#include <limits>

#include "polhode/solve/invariants.hpp"
#include "solve/custom_check.hpp"
#include "solve/decide.hpp"
#include "solve/execute.hpp"
#include "solve/options.hpp"
#include "solve/prove.hpp"

namespace polhode {

namespace {

/// No error is stated of samples that are not numbers.
void refuse_samples(Motion& motion) {
  motion.status = Status::failed;
  motion.error = std::numeric_limits<double>::quiet_NaN();
  motion.error_kind = "not estimated";
  motion.message = "samples are not finite: the motion is beyond the range of float64";
}

Motion solve_planned(const Scene& scene, const SolveOptions& options) {
  const Decision decision = decide(scene, options);
  Motion motion = execute(decision, options);
  motion.stats += decision.pilot;
  return motion;
}

}  // namespace

Motion solve(const Scene& scene, const SolveOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  check_options(scene, options);
  check_torques(scene);
  Motion motion = options.proof ? prove(scene, options) : solve_planned(scene, options);
  if (!motion.all_finite()) refuse_samples(motion);
  motion.stats.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return motion;
}

bool succeeded(const Scene& scene, const Motion& motion) {
  if (motion.status != Status::finished && motion.status != Status::event) return false;
  if (!motion.all_finite()) return false;
  if (!std::isnan(motion.error)) return motion.error <= motion.asked;
  for (const auto& [name, drift] : compute_drift(scene, motion)) {
    if (!(drift <= motion.asked)) return false;
  }
  return true;
}

}  // namespace polhode
