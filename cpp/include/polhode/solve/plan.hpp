#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "polhode/solve/facts.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

/// One line of a plan: an exact model or a method, and what is expected of it.
struct Candidate {
  std::string name;
  bool exact = false;
  std::string why_not = {};          ///< empty: it could do it
  double predicted_error = 0.0;      ///< what it would claim, at the tolerance it would take
  double predicted_seconds = 0.0;    ///< with every run of the certificate
  double rtol = 0.0;                 ///< of the run that is returned; 0 for exact models
};

/// A plan with its reasons, for a person to read.
struct PlanReport {
  Plan plan;
  Facts facts;
  std::vector<Candidate> candidates = {};   ///< exact models first, then methods, in the order of their lists
  std::vector<std::string> reasons = {};    ///< why this model and this method
  std::vector<std::string> left_out = {};   ///< what is not modelled, and why that is safe
};

/// The least model and the cheapest method that reach the accuracy: what solve() would carry out.
/// @throws InvalidInput for options that contradict each other, or a method that does not take the scene
Plan make_plan(const Scene& scene, const SolveOptions& options);

/// The same with every candidate evaluated and the reasons in words.
PlanReport explain_plan(const Scene& scene, const SolveOptions& options);

/// Why a method does not take a scene, or "" when it does.
std::string compute_refusal(std::string_view method, const Scene& scene);

}  // namespace polhode
