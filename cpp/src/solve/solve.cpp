#include "polhode/solve/solve.hpp"

#include <chrono>
#include <cmath>

#include "polhode/solve/invariants.hpp"
#include "solve/custom_check.hpp"
#include "solve/decide.hpp"
#include "solve/execute.hpp"
#include "solve/options.hpp"

namespace polhode {

Motion solve(const Scene& scene, const SolveOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  check_options(scene, options);
  check_torques(scene);
  Motion motion = execute(decide(scene, options), options);
  motion.stats.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return motion;
}

bool succeeded(const Scene& scene, const Motion& motion) {
  if (motion.status != Status::finished && motion.status != Status::event) return false;
  if (!std::isnan(motion.error)) return motion.error <= motion.asked;
  for (const auto& [name, drift] : compute_drift(scene, motion)) {
    if (!(drift <= motion.asked)) return false;
  }
  return true;
}

}  // namespace polhode
