#include "solve/plan/plan.hpp"

#include "solve/plan/candidates.hpp"

namespace polhode {
namespace {

std::string count(std::size_t n, const char* what) {
  return std::to_string(n).append(" ").append(what).append(n == 1 ? "" : "s");
}

/// A method for all pieces that have no closed form.
Candidate evaluate_for_pieces(const Scene& scene, const Facts& facts, const SolveOptions& options,
                              const ode::MethodRecord& record, const Plan& plan) {
  Candidate candidate = evaluate_method(scene, facts, options, record);
  if (!candidate.why_not.empty()) return candidate;
  double stepped = 0.0, formulas = 0.0;
  for (const PiecePlan& piece : plan.pieces)
    (piece.method == "exact" ? formulas : stepped) += piece.method == "exact" ? piece.predicted_seconds : piece.turns;
  const auto predict = [&](double rtol) {
    return record.forecast.compute_seconds(rtol, stepped, facts.stiffness, facts.call_seconds);
  };
  const double compared = options.certify ? predict(pair_ratio * candidate.rtol) : 0.0;
  candidate.predicted_seconds =
      (predict(candidate.rtol) + compared) * find_factor(options.cost_factors, record.name) + formulas +
      solve_seconds + piece_seconds * static_cast<double>(plan.pieces.size()) * (options.certify ? 3 : 2);
  return candidate;
}

}  // namespace

PlanReport explain_pieces(const Decision& decision, const SolveOptions& options) {
  const Scene& scene = decision.scene;
  PlanReport report{.plan = decision.plan, .facts = decision.facts};
  report.facts.turns = decision.turns;
  const std::vector<PiecePlan>& parts = report.plan.pieces;
  std::size_t formulas = 0;
  for (const PiecePlan& piece : parts) formulas += piece.method == "exact";
  for (const ClosedFormRecord* record : closed_forms()) {
    std::size_t held = 0;
    for (const PiecePlan& piece : parts) held += piece.model == record->name;
    const bool is_slow = record->slow_set_up && decision.slow_forms > 0;
    if (held == 0 && !is_slow) continue;
    const std::size_t pieces = is_slow ? decision.slow_forms : held;
    report.candidates.push_back({.name = std::string(record->name),
                                 .exact = true,
                                 .why_not = (is_slow ? "takes longer than steps in " : "used in ") +
                                            std::to_string(pieces) + " of " + count(parts.size(), "piece")});
  }
  if (formulas < parts.size()) {
    for (const ode::MethodRecord& record : methods()) {
      if (!record.adaptive) continue;
      report.candidates.push_back(evaluate_for_pieces(scene, decision.facts, options, record, decision.plan));
    }
  }

  report.reasons.push_back("Torques start or stop within the span, which is cut there into " +
                           count(parts.size(), "piece") + ".");
  if (formulas == parts.size()) {
    report.reasons.push_back("Every piece has a closed form, so nothing is integrated.");
  } else if (formulas > 0) {
    report.reasons.push_back(count(formulas, "piece") +
                             (formulas == 1 ? " has a closed form" : " have closed forms") +
                             ", at a cost that does not depend on the span. The others are integrated.");
  } else if (options.method) {
    report.reasons.push_back("Method " + report.plan.method + " was requested and integrates every piece.");
  } else if (decision.slow_forms < parts.size()) {
    report.reasons.push_back(decision.slow_forms > 0
                                 ? "Each piece is integrated. No step crosses a jump of the torque."
                                 : "No piece has a closed form, so each is integrated. No step crosses a jump of the "
                                   "torque.");
  }
  if (decision.slow_forms > 0) {
    report.reasons.push_back(count(decision.slow_forms, "piece") +
                             (decision.slow_forms == 1 ? " is a free gyrostat" : " are free gyrostats") +
                             ". Steps take less time there than the set-up of closed forms.");
  }
  if (has_rotor_windows(scene)) {
    report.reasons.push_back("The rates jump where a rotor starts or stops: J omega + h is continuous.");
  }
  report.reasons.push_back("A pilot run estimated the start states of the pieces.");
  if (!report.plan.certify && formulas < parts.size()) {
    report.reasons.push_back("The error is expected, not bounded, because no certificate was requested.");
  } else {
    report.reasons.push_back(
        "A second run of all pieces bounds the error. Its inputs, window ends and start states are changed by units of "
        "rounding.");
  }
  for (const AnyTorque& torque : scene.torques()) {
    if (traits(torque).vanishes) {
      report.reasons.push_back(std::string(torque_name(torque)) + ": always zero.");
    }
  }
  if (!scene.want().attitude && report.plan.state == "omega") {
    report.reasons.push_back("The attitude: it was not requested and no torque depends on it.");
  }
  return report;
}

}  // namespace polhode
