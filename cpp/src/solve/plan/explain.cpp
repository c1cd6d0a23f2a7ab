#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "method/method.hpp"
#include "solve/plan/candidates.hpp"
#include "solve/plan/leave_out.hpp"
#include "solve/ground/distance.hpp"
#include "solve/plan/plan.hpp"
#include "solve/ground/options.hpp"
#include "solve/run/perturb.hpp"

namespace polhode {
namespace {

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[320];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

bool has(const Scene& scene, const char* name) {
  for (const AnyTorque& torque : scene.torques()) {
    if (torque_name(torque) == name) return true;
  }
  return false;
}

/// Adds the closed forms in the order of their list. Only the chosen one has a cost.
void evaluate_closed_forms(const Scene& scene, const Facts& facts, const SolveOptions& options,
                           const ClosedForm* form, PlanReport& report) {
  for (const ClosedFormRecord* record : closed_forms()) {
    if (form && record == &form->record()) {
      report.candidates.push_back(evaluate_closed_form(scene, *form, facts, options));
      continue;
    }
    Candidate candidate{.name = std::string(record->name), .exact = true,
                        .why_not = record->refuse(scene, facts, Words::yes).why};
    std::string& why_not = candidate.why_not;
    if (why_not.empty() && form) why_not = "also holds, but " + std::string(form->name()) + " is simpler";
    if (why_not.empty()) why_not = "its start has no exact float64 representation";
    report.candidates.push_back(std::move(candidate));
  }
}

/// The change of a closed form at the end of its span when the inputs change by half a unit in the last place.
double compute_condition(const Scene& scene, const ClosedForm& form) {
  const Scene perturbed = perturb(scene);
  const std::shared_ptr<const ClosedForm> other = find_closed_form(perturbed, compute_facts(perturbed));
  if (!other) return std::numeric_limits<double>::quiet_NaN();
  double t = 0.0;
  for (const double time : scene.times()) t = std::abs(time - scene.t0()) > std::abs(t) ? time - scene.t0() : t;
  double wa[3], wb[3], qa[4], qb[4];
  form.at(&t, 1, wa, qa);
  other->at(&t, 1, wb, qb);
  return compute_distance(1, scene.omega().norm(), wa, qa, wb, qb) / 4;
}

void explain_exact(const Scene& scene, const Facts& facts, const ClosedForm& form, PlanReport& report) {
  auto& reasons = report.reasons;
  reasons.push_back(form.record().explain(scene, facts));
  if (facts.turns > 10) {
    reasons.push_back(
        format("A closed form has no drift: its error after %.0f turns is the same as after one.", facts.turns));
  }
  const double condition = compute_condition(scene, form);
  if (condition > 20 * report.plan.predicted_error) {
    reasons.push_back(
        format("The motion is sensitive: changing the inputs by half a unit in the last place changes the last sample "
               "by %.0e.",
               condition));
  }
}

/// @param has_form  a closed form holds, but another method was requested
void explain_steps(const Scene& scene, const Facts& facts, const SolveOptions& options, bool has_form,
                   PlanReport& report) {
  auto& reasons = report.reasons;
  const Plan& plan = report.plan;
  if (has_form || options.formulation == Formulation::lagrangian) {
    if (options.formulation == Formulation::lagrangian)
      reasons.push_back("Lagrange's equations were requested, so they are integrated.");
    else if (method_is_free(options))
      reasons.push_back("The closed form states a larger error: next to rest its rates have the rounding of faster ones.");
  } else if (has(scene, "Gravity") && facts.torques.acting == 1 + facts.torques.rotors) {
    reasons.push_back("Gravity acts, but no closed form is known: " + explain_no_closed_form(scene, facts) + ".");
  } else if ((has(scene, "Damping") || has(scene, "AngularDamping")) &&
             facts.torques.acting == 1 + facts.torques.rotors) {
    reasons.push_back("Damping acts, but no closed form is known: " + explain_no_closed_form(scene, facts) + ".");
  } else {
    reasons.push_back("No closed form is known with these torques, so the equations are integrated.");
  }
  if (facts.torques.acting > 0 && !facts.torques.uses_attitude) {
    reasons.push_back(
        scene.want().attitude
            ? "No torque depends on the attitude, so the rates do not depend on it either."
            : "No torque depends on the attitude, so the rates are integrated alone.");
  }
  const ode::MethodRecord& record = find_method(plan.method);
  if (plan.pieces.size() == 2) {
    reasons.push_back(format(
        "Damping decays at up to %.3g /s over %.3g s. At first accuracy limits the steps, later stability does. A "
        "pilot run placed the switch from taylor to radau at t = %.3g s.",
        facts.decay, facts.span(), plan.pieces[1].begin));
  } else if (facts.stiffness > 100) {
    reasons.push_back(
        format("Damping decays at up to %.3g /s over %.3g s (their product is %.0e). ", facts.decay, facts.span(),
               facts.stiffness) +
        (record.implicit
             ? "The problem is stiff, so an implicit method takes longer steps."
             : "Stability limits explicit steps, which still cost less than an implicit method."));
  }
  if (facts.piloted) {
    reasons.push_back(format("A pilot run at a low accuracy counted %.3g turns.", facts.turns));
  } else if (facts.may_spin_up) {
    reasons.push_back("The torque may spin the body up, so the number of turns is a guess.");
  }
  if (facts.separatrix < 1e-3) {
    reasons.push_back(
        format("The start is close to the separatrix (k'^2 = %.1e), so errors grow at each flip.", facts.separatrix));
  }
  int others = 0;
  for (const Candidate& candidate : report.candidates)
    others += !candidate.exact && candidate.why_not.empty() && candidate.name != plan.method;
  if (options.method) {
    reasons.push_back("Method " + plan.method + " was requested.");
  } else if (others > 0 && plan.pieces.empty()) {
    reasons.push_back(format(calls_custom(scene)
                                 ? "%s calls your torque least of %d methods at this accuracy over %.3g turns."
                                 : "%s is the cheapest of %d methods at this accuracy over %.3g turns.",
                             plan.method.c_str(), others + 1, facts.turns));
  }
  if (!plan.certify) {
    reasons.push_back("The error is expected, not bounded, because no certificate was requested.");
  } else if (find_body_method(plan.method).carries_error && plan.pieces.empty()) {
    reasons.push_back("The error is certified in the same run, which propagates the error of each step to the end.");
  } else {
    reasons.push_back(
        "A second, coarser run certifies the error. Each of its inputs is changed by eight units in the last place.");
  }
  if (plan.predicted_error > forecast_slack * plan.accuracy) {
    reasons.push_back(format("Rounding over so many turns may cause an error of %.0e. The result then says \"limit\".",
                             plan.predicted_error));
  }
}

void explain_rotors(const Scene& scene, PlanReport& report) {
  for (std::size_t i = 0; i < scene.rotors().size(); ++i) {
    if (!scene.rotors()[i].axis_was_scaled()) continue;
    report.reasons.push_back(format("The axis of rotor %d was not a unit vector. Only its direction counts.",
                                    static_cast<int>(i)));
  }
}

void explain_controllers(const Scene& scene, PlanReport& report) {
  for (std::size_t i = 0; i < scene.controllers().size(); ++i) {
    const Controller& controller = scene.controllers()[i];
    const int number = static_cast<int>(i);
    report.reasons.push_back(format("Controller %d samples the motion every %.6g s. Steps end at its ticks, and where its "
                                    "commands begin and end.", number, controller.parts().period));
    if (!controller.is_traced())
      report.reasons.push_back(format("Controller %d calls Python at each tick, which is slower. The error is estimated, "
                                      "because derivative and branches of its function are not known.", number));
  }
}

/// What is not computed, and why that is safe.
void explain_savings(const Scene& scene, const Facts& facts, const SolveOptions& options, PlanReport& report) {
  auto& left = report.reasons;
  std::string names;
  for (const AnyTorque& torque : scene.torques()) {
    if (!traits(torque).vanishes) continue;
    if (!names.empty()) names += ", ";
    names += torque_name(torque);
  }
  if (!names.empty()) left.push_back(names + ": always zero.");
  if (scene.torque_sum().acting > facts.torques.acting) {
    left.push_back("GravityGradient: it is zero for a body with three equal moments.");
  }
  if (!carries_attitude(scene, facts, options)) {
    left.push_back("The attitude: it was not requested and no torque depends on it.");
  } else if (!scene.want().attitude && report.plan.method != "exact") {
    left.push_back("Nothing: the attitude was not requested, but a torque or an event depends on it.");
  }
  if (!scene.want().omega) left.push_back("The rates: they are computed but not returned.");
}

std::vector<std::string> explain_proof(const Scene& scene) {
  std::vector<std::string> reasons = {
      "A proof was requested: Taylor series with a rigorous remainder enclose the exact motion."};
  if (scene.torque_sum().acting == 0)
    reasons.push_back("The body is free, but the proof steps its equations and does not use its closed form.");
  reasons.push_back("How long the bounds stay narrow is known only after the run.");
  return reasons;
}

PlanReport explain_decision(const Decision& decision, const SolveOptions& options) {
  if (is_by_tolerance(options)) {
    return {.plan = decision.plan, .facts = compute_facts(decision.scene),
            .reasons = {"Tolerances or a fixed step were given with method " + decision.plan.method +
                        ", so nothing was planned."}};
  }
  if (decision.plan.proof)
    return {.plan = decision.plan, .facts = decision.facts, .reasons = explain_proof(decision.scene)};
  if (decision.pieces.size() > 0 && decision.pieces.method_switches.empty()) return explain_pieces(decision, options);
  PlanReport report{.plan = decision.plan, .facts = decision.facts};
  const Scene& scene = decision.scene;
  const Facts& facts = report.facts;
  const std::shared_ptr<const ClosedForm> form = decision.form ? decision.form : find_closed_form(scene, facts);
  evaluate_closed_forms(scene, facts, options, form.get(), report);
  for (const ode::MethodRecord& record : methods()) {
    if (!record.adaptive) continue;
    report.candidates.push_back(evaluate_method(scene, facts, options, record));
    if (record.name == report.plan.method && report.plan.pieces.empty())
      report.candidates.back().predicted_seconds = report.plan.predicted_seconds;
  }
  if (decision.form) {
    explain_exact(scene, facts, *decision.form, report);
  } else {
    explain_steps(scene, facts, options, form != nullptr, report);
  }
  explain_rotors(scene, report);
  explain_controllers(scene, report);
  if (facts.only_at_end) report.reasons.push_back("Only one sample time is given, so nothing is interpolated.");
  explain_savings(scene, facts, options, report);
  return report;
}

}  // namespace

PlanReport explain(const Decision& decision, const SolveOptions& options) {
  PlanReport report = explain_decision(decision, options);
  std::vector<std::string> first = decision.recognised;
  for (const LeftOut& left : decision.left_out) first.push_back(describe(left));
  report.reasons.insert(report.reasons.begin(), first.begin(), first.end());
  report.left_out = decision.left_out;
  return report;
}

}  // namespace polhode
