#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "polhode/solve/effect.hpp"
#include "polhode/solve/facts.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

/// One line of a plan: an exact model or a method, with its expected error and cost.
struct Candidate {
  std::string name;
  bool exact = false;
  std::string why_not = {};          ///< the reason why it cannot be used; empty if it can
  double predicted_error = 0.0;      ///< the error it would claim, at the tolerance it would use
  double predicted_seconds = 0.0;    ///< including every run of the certificate
  double predicted_calls = 0.0;      ///< of the torques, including every run of the certificate
  double rtol = 0.0;                 ///< of the run that is returned; 0 for exact models
};

/// A plan with its candidates and its reasons.
struct PlanReport {
  Plan plan;
  Facts facts;
  std::vector<Candidate> candidates = {};   ///< exact models first, then methods, in the order of their lists
  std::vector<std::string> reasons = {};    ///< for this model and this method, and for what is not computed
  std::vector<LeftOut> left_out = {};       ///< torques that are not computed, each with its bound
};

struct Decision;

/// A scene and what was decided for it: the simplest model and the cheapest method that reach the accuracy. It is
/// decided once; run() carries out exactly this, and explain() describes it. Immutable, and cheap to copy.
class PlannedScene {
 public:
  /// @throws InvalidInput for options that contradict each other, or a method that cannot integrate the scene
  PlannedScene(const Scene& given, const SolveOptions& options);

  const Plan& plan() const;
  /// The same plan with every candidate evaluated and the reasons in words.
  PlanReport explain() const;
  /// What planning took: the wall time, and the pilot run of a user's own torque.
  const ode::Counts& cost() const { return cost_; }
  /// Of these options only max_steps, dense, events and progress count.
  Motion run(const SolveOptions& options = {}) const;

 private:
  SolveOptions options_;                              // without events and progress
  std::shared_ptr<const CostFactors> cost_factors_;   // to which the options refer
  std::shared_ptr<const Decision> decision_;
  ode::Counts cost_;
};

/// The plan that solve() would make. @throws InvalidInput as PlannedScene
Plan make_plan(const Scene& scene, const SolveOptions& options);

/// The same with every candidate and the reasons.
PlanReport explain_plan(const Scene& scene, const SolveOptions& options);

/// The reason why a method cannot integrate a scene, or "".
std::string compute_refusal(std::string_view method, const Scene& scene);

}  // namespace polhode
