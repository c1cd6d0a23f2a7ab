#include "solve/certify/runs.hpp"

#include <algorithm>

#include "solve/plan/candidates.hpp"
#include "solve/ground/options.hpp"
#include "solve/certify/run_pieces.hpp"

namespace polhode {

Motion CountedRuns::run(const Scene& scene, const SolveOptions& options, double rtol, bool perturb_joins,
                        ode::ErrorTrace* trace) {
  const double atol = options.atol.value_or(find_atol(method_.record, decision_.scene, rtol));
  Motion motion = decision_.pieces.size() == 0
                      ? Motion(method_.integrate(scene, to_run_options(options, {rtol, atol}, trace)))
                      : run_planned(decision_, scene, options, rtol, perturb_joins, trace);
  stats_ += motion.stats;
  ++runs_;
  return motion;
}

Motion CountedRuns::run_by(const BodyMethod& method, const Scene& scene, const SolveOptions& options, double rtol,
                           long most_steps) {
  SolveOptions limited = options;
  limited.max_steps = std::min(options.max_steps, most_steps);
  Motion motion(method.integrate(scene, to_run_options(limited, {std::max(rtol, method.record.least_rtol)})));
  stats_ += motion.stats;
  ++runs_;
  return motion;
}

}  // namespace polhode
