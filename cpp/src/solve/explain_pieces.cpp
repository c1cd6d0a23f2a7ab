#include "solve/explain_pieces.hpp"

#include "solve/candidates.hpp"

namespace polhode {
namespace {

std::string count(std::size_t n, const char* what) {
  return std::to_string(n).append(" ").append(what).append(n == 1 ? "" : "s");
}

/// A method for all pieces that no closed form takes.
Candidate evaluate_for_pieces(const Scene& scene, const Facts& facts, const SolveOptions& options,
                              const ode::MethodRecord& record, const Plan& plan) {
  Candidate candidate = evaluate_method(scene, facts, options, record);
  if (!candidate.why_not.empty()) return candidate;
  double stepped = 0.0, formulas = 0.0;
  for (const PiecePlan& piece : plan.pieces)
    (piece.method == "exact" ? formulas : stepped) += piece.method == "exact" ? piece.predicted_seconds : piece.turns;
  const double per_call = find_seconds_per_call(scene);
  const auto predict = [&](double rtol) {
    return record.forecast.compute_seconds(rtol, stepped, facts.stiffness, per_call);
  };
  const double compared = options.certify ? predict(pair_ratio * candidate.rtol) : 0.0;
  candidate.predicted_seconds =
      (predict(candidate.rtol) + compared) * find_factor(options.cost_factors, record.name) + formulas;
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
  for (const ExactModel& model : exact_models()) {
    std::size_t held = 0;
    for (const PiecePlan& piece : parts) held += piece.model == model.name;
    if (held == 0) continue;
    report.candidates.push_back(
        {.name = std::string(model.name),
         .exact = true,
         .why_not = "taken in " + std::to_string(held) + " of " + count(parts.size(), "piece")});
  }
  if (formulas < parts.size()) {
    for (const ode::MethodRecord& record : methods()) {
      if (!record.adaptive) continue;
      report.candidates.push_back(evaluate_for_pieces(scene, decision.facts, options, record, decision.plan));
    }
  }

  report.reasons.push_back("Torques begin or cease to act within the span: it is cut there into " +
                           count(parts.size(), "piece") + ", each with the torques that act in it.");
  if (formulas == parts.size()) {
    report.reasons.push_back("Every piece has a closed form: nothing is stepped.");
  } else if (formulas > 0) {
    report.reasons.push_back(count(formulas, "piece") +
                             (formulas == 1 ? " has a closed form, which costs" : " have closed forms, which cost") +
                             " the same however long they last; the others are stepped.");
  } else if (options.method) {
    report.reasons.push_back(report.plan.method + " was asked for, and steps every piece.");
  } else {
    report.reasons.push_back("No piece has a closed form: each is stepped, no step goes over a jump.");
  }
  report.reasons.push_back("Each piece starts where the last ended; where that is a loose run has told.");
  if (!report.plan.certify && formulas < parts.size()) {
    report.reasons.push_back("Its error is only expected: no certificate was wanted.");
  } else {
    report.reasons.push_back(
        "The error of the whole chain is bounded by a second one, with every input, the windows' ends and each "
        "piece's start moved by units of rounding.");
  }
  for (const AnyTorque& torque : scene.torques()) {
    if (traits(torque).vanishes) {
      report.left_out.push_back(std::string(torque_name(torque)) +
                                ": zero wherever the body goes.");
    }
  }
  if (!scene.want().attitude && report.plan.state == "omega") {
    report.left_out.push_back("The attitude: nobody asked for it and no torque looks at it.");
  }
  return report;
}

}  // namespace polhode
