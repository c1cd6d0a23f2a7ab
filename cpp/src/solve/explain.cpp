#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "method/method.hpp"
#include "solve/candidates.hpp"
#include "solve/decide.hpp"
#include "solve/distance.hpp"
#include "solve/explain.hpp"
#include "solve/explain_pieces.hpp"
#include "solve/options.hpp"
#include "solve/perturb.hpp"
#include "solve/proof/proof_plan.hpp"
#include "solve/proportional_damping.hpp"

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

/// Adds the exact models in the order of their list. Only the chosen one has a cost.
void evaluate_exact_models(const Scene& scene, const Facts& facts, const SolveOptions& options,
                           const std::optional<ClosedForm>& form, PlanReport& report) {
  for (const ExactModel& model : exact_models()) {
    if (form && model.name == form->model()) {
      report.candidates.push_back(evaluate_closed_form(scene, *form, facts, options));
      continue;
    }
    Candidate candidate{.name = std::string(model.name), .exact = true, .why_not = model.refuse(scene, facts)};
    std::string& why_not = candidate.why_not;
    if (why_not.empty() && form) why_not = "also holds, but " + std::string(form->model()) + " is simpler";
    if (why_not.empty()) why_not = "its start has no exact float64 representation";
    report.candidates.push_back(std::move(candidate));
  }
}

/// The change of a closed form at the end of its span when the inputs change by half a unit in the last place.
double compute_condition(const Scene& scene, const ClosedForm& form) {
  const Scene perturbed = perturb(scene);
  const std::optional<ClosedForm> other = find_closed_form(perturbed, compute_facts(perturbed));
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
  const std::string model(form.model());
  if (model == "rest") {
    reasons.push_back("The body does not rotate and no torque acts: every sample equals the start.");
  } else if (model == "spherical") {
    reasons.push_back("All moments are equal and no torque acts: omega is constant.");
  } else if (model == "steady") {
    reasons.push_back(
        "The body rotates about a principal axis and no torque acts: omega is constant, even if the rotation is "
        "unstable.");
  } else if (model == "symmetric") {
    reasons.push_back(
        "Two moments are equal and no torque acts: the motion is a regular precession, two rotations at constant "
        "rates.");
  } else if (model == "separatrix") {
    reasons.push_back(
        "The start is exactly on the separatrix: the body flips once, described by hyperbolic functions.");
  } else if (model == "triaxial") {
    reasons.push_back("No torque acts: theta functions give each sample directly, without steps.");
  } else if (model == "gyrostat") {
    reasons.push_back(
        "No torque acts, and the rotors' momentum is constant in the body: a free gyrostat. One theta series gives "
        "each sample directly, without steps.");
  } else if (model == "damped_free") {
    const double rate = find_proportional_damping(scene)->rate;
    reasons.push_back(format(
        "The damping is -c I omega with c = %.3g /s. The motion is the free one in slowed time, s = (1 - exp(-c t)) / "
        "c.",
        rate));
  } else if (model == "pendulum") {
    reasons.push_back(
        "Gravity acts alone, and omega is along a horizontal principal axis across the arm: the body is a plane "
        "pendulum. Elliptic functions give each sample.");
  } else if (model == "heavy_gyrostat") {
    reasons.push_back(
        "A symmetric body on a pivot on its axis, with gravity and a rotor on the same axis: Lagrange's top with "
        "omega3 + h / J3, turned back about the axis by h t / J3.");
  } else {
    reasons.push_back(
        "A symmetric body on a pivot on its axis, with gravity alone, is Lagrange's top. It has a closed form.");
  }
  if (facts.turns > 10 && model != "rest") {
    reasons.push_back(
        format("A closed form has no drift: its error after %.0f turns is the same as after one.", facts.turns));
  }
  if (model == "triaxial" && facts.separatrix < 1e-3) {
    reasons.push_back(
        format("The start is close to the separatrix (k'^2 = %.1e). An integration loses digits at each flip, a closed "
               "form does not.",
               facts.separatrix));
  }
  const double condition = model == "rest" ? 0.0 : compute_condition(scene, form);
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

void explain_left_out(const Scene& scene, const Facts& facts, const SolveOptions& options, PlanReport& report) {
  auto& left = report.left_out;
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

}  // namespace

PlanReport explain(const Decision& decision, const SolveOptions& options) {
  if (decision.plan.proof)
    return {.plan = decision.plan, .facts = decision.facts, .reasons = proof::explain(decision.scene)};
  if (decision.pieces.size() > 0 && decision.pieces.method_switches.empty()) return explain_pieces(decision, options);
  PlanReport report{.plan = decision.plan, .facts = decision.facts};
  const Scene& scene = decision.scene;
  const Facts& facts = report.facts;
  const std::optional<ClosedForm> form = decision.form ? decision.form : find_closed_form(scene, facts);
  evaluate_exact_models(scene, facts, options, form, report);
  for (const ode::MethodRecord& record : methods()) {
    if (!record.adaptive) continue;
    report.candidates.push_back(evaluate_method(scene, facts, options, record));
    if (record.name == report.plan.method && report.plan.pieces.empty())
      report.candidates.back().predicted_seconds = report.plan.predicted_seconds;
  }
  if (decision.form) {
    explain_exact(scene, facts, *decision.form, report);
  } else {
    explain_steps(scene, facts, options, form.has_value(), report);
  }
  explain_rotors(scene, report);
  if (facts.only_at_end) report.reasons.push_back("Only one sample time is given, so nothing is interpolated.");
  explain_left_out(scene, facts, options, report);
  return report;
}

PlanReport explain_plan(const Scene& scene, const SolveOptions& options) {
  check_options(scene, options);
  return explain(decide(scene, options), options);
}

}  // namespace polhode
