#include "solve/proof/proof_plan.hpp"

#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "solve/proof/body_equations.hpp"

namespace polhode::proof {
namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& found, const std::string& cause) {
  throw InvalidInput(where, "left out with certify='proof'", found, cause);
}

}  // namespace

void require_provable(const Scene& scene, const SolveOptions& options) {
  if (!options.proof) return;
  if (!options.certify) throw InvalidInput("certify", "true with proof", "false");
  const std::pair<const char*, const std::optional<double>&> tolerances[] = {
      {"rtol", options.rtol}, {"atol", options.atol}, {"step", options.step}};
  for (const auto& [where, value] : tolerances)
    if (value) refuse(where, to_text(*value), "a proof is made for an accuracy and chooses its own steps");
  if (options.method)
    refuse("method", "'" + *options.method + "'", "a proof has one method: Taylor series with a rigorous remainder");
  if (options.formulation != Formulation::euler)
    refuse("formulation", "'lagrangian'", "a proof encloses Euler's equations");
  if (options.dense) refuse("dense", "True", "bounds are given at the scene's times: add the times that are needed");
  if (!options.events.empty())
    refuse("events", std::to_string(options.events.size()), "a function of the user's own has no known bounds");
  if (!rounds_to_nearest()) {
    throw InvalidInput("certify='proof'", "used where the processor rounds to nearest", "another rounding mode",
                       "the bounds on rounding hold for that mode alone: a library or fesetround() changed it");
  }
  if (has_custom(scene)) {
    throw InvalidInput("certify='proof'", "left out with torques of the user's own", "a Custom torque",
                       "its function gives numbers, and a proof needs bounds on them at every state nearby");
  }
}

Plan make_plan(const Scene& scene) {
  const bool has_attitude = scene.want().attitude || scene.torque_sum().uses_attitude;
  return {.model = "euler",
          .method = "enclosure",
          .state = has_attitude ? "omega, attitude" : "omega",
          .certify = true,
          .proof = true};
}

std::vector<std::string> explain(const Scene& scene) {
  std::vector<std::string> reasons = {
      "A proof was requested: Taylor series with a rigorous remainder enclose the exact motion."};
  if (scene.torque_sum().acting == 0)
    reasons.push_back("The body is free, but the proof steps its equations and does not use its closed form.");
  reasons.push_back("How long the bounds stay narrow is known only after the run.");
  return reasons;
}

}  // namespace polhode::proof
