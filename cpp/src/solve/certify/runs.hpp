#pragma once

#include <limits>

#include "method/method.hpp"
#include "solve/ground/decision.hpp"

namespace polhode {

inline constexpr double unknown_error = std::numeric_limits<double>::infinity();
inline constexpr double limit_safety = 3.0;   // of a refused run's error, and of how long the accuracy holds

/// One run, or one pair of runs, and the error that it proves.
struct Attempt {
  Motion motion;
  double error = unknown_error;          ///< bound on the error of all samples
  double holds_until = unknown_error;    ///< time from the start for which the accuracy holds [s]; infinity: to the end

  bool finished() const {
    return motion.status == Status::finished || motion.status == Status::event || motion.status == Status::sliding;
  }
};

/// Runs a decision's method and sums the counts of all runs.
class CountedRuns {
 public:
  CountedRuns(const Decision& decision, const SolveOptions& options)
      : decision_(decision), options_(options), method_(find_body_method(decision.plan.method)) {}

  const Decision& decision() const { return decision_; }
  const SolveOptions& options() const { return options_; }
  const BodyMethod& method() const { return method_; }
  const ode::Counts& stats() const { return stats_; }
  int runs() const { return runs_; }

  Motion run(const Scene& scene, const SolveOptions& options, double rtol, bool perturb_joins = false,
             ode::ErrorTrace* trace = nullptr);
  /// A run by another method, of a scene without pieces. It ends after `most_steps`.
  Motion run_by(const BodyMethod& method, const Scene& scene, const SolveOptions& options, double rtol,
                long most_steps);

 private:
  const Decision& decision_;
  const SolveOptions& options_;
  const BodyMethod& method_;
  ode::Counts stats_;
  int runs_ = 0;
};

/// A run that propagates its own error. Each step adds its truncation and rounding errors, and the linearised motion
/// propagates their sum to the next step.
/// @param safety  the factor between the propagated error and the claimed error
/// @param all_terms  the error gets all terms of the series
/// @param most    the run is abandoned when its error exceeds this multiple of the accuracy
/// @return an attempt without motion if the run was abandoned; `given_up` is then the time from the start [s]
Attempt run_carried(CountedRuns& runs, double rtol, double safety, bool all_terms, double most, double& given_up);

}  // namespace polhode
