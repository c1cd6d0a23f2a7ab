#include "solve/plan/plan.hpp"

#include "polhode/core/error.hpp"
#include "solve/plan/leave_out.hpp"
#include "solve/plan/candidates.hpp"
#include "solve/ground/options.hpp"

namespace polhode {
namespace {

[[noreturn]] void throw_no_closed_form(const Scene& scene, const Facts& facts) {
  throw InvalidInput("method 'exact'", "used with a scene that has a closed form", "one without",
                     explain_no_closed_form(scene, facts) + "; leave method out");
}

/// Whether steps may reach an accuracy that the closed form does not: of a heavy body next to rest, whose rates have the
/// rounding of those that its weight may give it.
bool loses_slow_rates(const Decision& decision) {
  return decision.plan.predicted_error > decision.plan.accuracy &&
         decision.form->swing_frequency() > decision.scene.omega().norm();
}

/// Euler's equations, enclosed.
Plan make_proof_plan(const Scene& scene) {
  const bool has_attitude = scene.want().attitude || scene.torque_sum().uses_attitude;
  std::string state = has_attitude ? "omega, attitude" : "omega";
  for (const formula::Input& one : scene.states()) state += ", " + one.name;
  return {.model = "euler",
          .method = "enclosure",
          .state = std::move(state),
          .certify = true,
          .proof = true};
}

}  // namespace

Decision decide(const Scene& scene, const SolveOptions& options) {
  Decision decision{scene};
  if (options.proof) {
    decision.plan = make_proof_plan(scene);
    decision.plan.accuracy = get_accuracy(options);
    decision.facts = compute_facts(scene);
    return decision;
  }
  if (!scene.controllers().empty()) {
    decision.facts = compute_facts(scene);
    if (is_by_tolerance(options)) decision.plan.model = "euler", decision.plan.method = "taylor";
    else decision.plan = make_method_plan(scene, decision.facts, options);
    return decision;
  }
  if (std::optional<Negligible> negligible = find_negligible(scene, options)) {
    SolveOptions rest = options;
    rest.leave_out = false;
    Decision free = decide(scene.with_torques({}), rest);
    free.plan.predicted_error += negligible->error;
    free.left_out = std::move(negligible->torques);
    return free;
  }
  if (has_windows(scene)) {
    Pieces pieces = cut(scene);
    if (pieces.whole) decision.scene = drop_windows(scene);
    else decision.pieces = std::move(pieces);
  }
  const bool is_cut = decision.pieces.size() > 0;
  if (is_by_tolerance(options)) {
    const bool lagrangian = options.formulation == Formulation::lagrangian;
    decision.plan.model = is_cut ? "pieces" : lagrangian ? "lagrangian" : "euler";
    decision.plan.method = options.method.value_or(scene.states().empty() ? "rk45" : "taylor");
    return decision;
  }
  if (is_cut) {
    plan_pieces(decision, options);
    return decision;
  }
  decision.facts = compute_facts(decision.scene);
  if (method_is_free(options) || options.method == "exact") {
    decision.form = find_closed_form(decision.scene, decision.facts);
    if (!decision.form && options.method) throw_no_closed_form(decision.scene, decision.facts);
    if (decision.form) {
      decision.plan = make_exact_plan(decision.scene, *decision.form, decision.facts, options);
      if (options.method || !loses_slow_rates(decision)) return decision;
      decision.form.reset();
    }
  }
  pilot_custom(decision, options);
  if (!decision.probes.breaks.empty()) {
    Decision divided = decide(add_breaks(scene, decision.probes.breaks), options);
    divided.probes = std::move(decision.probes);
    divided.pilot += decision.pilot;
    return divided;
  }
  if (!plan_stiff(decision, options)) decision.plan = make_method_plan(decision.scene, decision.facts, options);
  decision.plan.predicted_seconds += static_cast<double>(decision.pilot.derivatives) * decision.facts.call_seconds;
  return decision;
}

}  // namespace polhode
