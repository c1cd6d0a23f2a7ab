#pragma once

#include <string>
#include <string_view>
#include <vector>

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
  std::vector<std::string> reasons = {};    ///< for this model and this method
  std::vector<std::string> left_out = {};   ///< what is not computed, and why that is safe
};

/// The simplest model and the cheapest method that reach the accuracy, as solve() would choose them.
/// @throws InvalidInput for options that contradict each other, or a method that cannot integrate the scene
Plan make_plan(const Scene& scene, const SolveOptions& options);

/// The same plan with every candidate evaluated and the reasons in words.
PlanReport explain_plan(const Scene& scene, const SolveOptions& options);

/// The reason why a method cannot integrate a scene, or "".
std::string compute_refusal(std::string_view method, const Scene& scene);

}  // namespace polhode
