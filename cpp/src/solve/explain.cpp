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

/// Exact models in the order of their list; of those that hold, the one that is taken.
void evaluate_exact_models(const Scene& scene, const Facts& facts, const SolveOptions& options,
                           const std::optional<ClosedForm>& form, PlanReport& report) {
  for (const ExactModel& model : exact_models()) {
    if (form && model.name == form->model()) {
      report.candidates.push_back(evaluate_closed_form(scene, *form, facts, options));
      continue;
    }
    Candidate candidate{.name = std::string(model.name), .exact = true, .why_not = model.refuse(scene, facts)};
    std::string& why_not = candidate.why_not;
    if (why_not.empty() && form) why_not = "holds too, but " + std::string(form->model()) + " needs less";
    if (why_not.empty()) why_not = "float64 cannot hold its start";
    report.candidates.push_back(std::move(candidate));
  }
}

/// How far half a unit in the last place of the inputs moves a closed form at the end of its span.
double compute_condition(const Scene& scene, const ClosedForm& form) {
  const Scene perturbed = perturb(scene);
  const std::optional<ClosedForm> other = find_closed_form(perturbed, compute_facts(perturbed));
  if (!other) return std::numeric_limits<double>::quiet_NaN();
  double t = 0.0;
  for (const double time : scene.times()) t = std::abs(time - scene.t0()) > std::abs(t) ? time - scene.t0() : t;
  double wa[3], wb[3], qa[4], qb[4];
  form.at(&t, 1, wa, qa);
  other->at(&t, 1, wb, qb);
  return compute_distance(1, wa, qa, wb, qb) / 4;
}

void explain_exact(const Scene& scene, const Facts& facts, const ClosedForm& form, PlanReport& report) {
  auto& reasons = report.reasons;
  const std::string model(form.model());
  if (model == "rest") {
    reasons.push_back("It does not turn and nothing acts on it: the answer is the start.");
  } else if (model == "spherical") {
    reasons.push_back("All moments are equal and nothing acts on it, so omega stays: one turn about one axis.");
  } else if (model == "steady") {
    reasons.push_back(
        "It turns about a principal axis and nothing acts on it, so omega stays, exactly, stable or not.");
  } else if (model == "symmetric") {
    reasons.push_back(
        "Two moments are equal and nothing acts on it: regular precession, two rotations at constant rates.");
  } else if (model == "separatrix") {
    reasons.push_back("It starts exactly on the separatrix: one flip in all time, in hyperbolic functions.");
  } else if (model == "triaxial") {
    reasons.push_back("Nothing acts on it, so every sample is a formula (theta functions), not the end of many steps.");
  } else {
    reasons.push_back(
        "Symmetric, held on its axis, under gravity alone: Lagrange's top, which has a formula for every start.");
  }
  if (facts.turns > 10 && model != "rest") {
    reasons.push_back(
        format("A formula has no drift: the error is the same after %.0f turns as after one.", facts.turns));
  }
  if (model == "triaxial" && facts.separatrix < 1e-3) {
    reasons.push_back(
        format("It starts next to the separatrix (k'^2 = %.1e), where each flip costs a stepper digits it cannot "
               "win back; the formula keeps them.",
               facts.separatrix));
  }
  const double condition = model == "rest" ? 0.0 : compute_condition(scene, form);
  if (condition > 20 * report.plan.predicted_error) {
    reasons.push_back(
        format("Mind the inputs: half a unit in their last place moves the end of the span by %.0e.", condition));
  }
}

void explain_steps(const Scene& scene, const Facts& facts, const SolveOptions& options, PlanReport& report) {
  auto& reasons = report.reasons;
  const Plan& plan = report.plan;
  if (facts.is_free() || options.formulation == Formulation::lagrangian) {
    if (options.formulation == Formulation::lagrangian)
      reasons.push_back("Lagrange's equations were asked for: they are stepped.");
  } else if (has(scene, "Gravity") && facts.torques.acting == 1) {
    reasons.push_back("Gravity acts, and " + exact_models().back().refuse(scene, facts) + ": no closed form is known.");
  } else {
    reasons.push_back("A torque acts for which no closed form is known: it is stepped.");
  }
  if (facts.torques.acting > 0 && !facts.torques.uses_attitude) {
    reasons.push_back(
        scene.want().attitude
            ? "The torque does not look at the attitude, so the attitude follows the rates and nothing comes back."
            : "The torque does not look at the attitude, so the rates are solved alone.");
  }
  const ode::MethodRecord& record = find_method(plan.method);
  if (plan.pieces.size() == 2) {
    reasons.push_back(format(
        "Damping decays at up to %.3g /s over %.3g s. At first it spins so fast that accuracy bounds the steps, later "
        "stability would: taylor hands the state to radau at t = %.3g s, as a loose run foresees.",
        facts.decay, facts.span(), plan.pieces[1].begin));
  } else if (facts.stiffness > 100) {
    reasons.push_back(
        format("Damping decays at up to %.3g /s over %.3g s (their product is %.0e): ", facts.decay, facts.span(),
               facts.stiffness) +
        (record.implicit
             ? "stiff, which an implicit method steps over."
             : "explicit steps are short for stability's sake, and still cheaper than an implicit method."));
  }
  if (facts.may_spin_up) {
    reasons.push_back("The torque may spin it up: the number of turns is a guess, and the certificate decides.");
  }
  if (facts.separatrix < 1e-3) {
    reasons.push_back(
        format("It starts next to the separatrix (k'^2 = %.1e): errors grow at each flip, and the certificate "
               "will see it.",
               facts.separatrix));
  }
  int others = 0;
  for (const Candidate& candidate : report.candidates)
    others += !candidate.exact && candidate.why_not.empty() && candidate.name != plan.method;
  if (options.method) {
    reasons.push_back(plan.method + " was asked for.");
  } else if (others > 0 && plan.pieces.empty()) {
    reasons.push_back(format("%s is the cheapest of %d methods at this accuracy over %.3g turns.", plan.method.c_str(),
                             others + 1, facts.turns));
  }
  if (!plan.certify) {
    reasons.push_back("Its error is only expected: no certificate was wanted.");
  } else if (find_body_method(plan.method).carries_error && plan.pieces.empty()) {
    reasons.push_back("Its error is certified in the same run: what each step loses is carried along to the end.");
  } else {
    reasons.push_back(
        "Its error is certified by a second, coarser run with every input moved by two units in the last place.");
  }
  if (plan.predicted_error > forecast_slack * plan.accuracy) {
    reasons.push_back(format("Rounding over so many turns is expected to leave %.0e: the result may say \"limit\".",
                             plan.predicted_error));
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
  if (!names.empty()) left.push_back(names + ": zero wherever the body goes.");
  if (scene.torque_sum().acting > facts.torques.acting) {
    left.push_back("GravityGradient: it turns no body of three equal moments.");
  }
  if (!carries_attitude(scene, facts, options)) {
    left.push_back("The attitude: nobody asked for it and no torque looks at it.");
  } else if (!scene.want().attitude && report.plan.method != "exact") {
    left.push_back("Nothing: the attitude was not asked for, but a torque or an event looks at it.");
  }
  if (!scene.want().omega) left.push_back("The rates are carried but not returned.");
}

}  // namespace

PlanReport explain(const Decision& decision, const SolveOptions& options) {
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
    explain_steps(scene, facts, options, report);
  }
  if (facts.only_at_end) report.reasons.push_back("Only one time is asked for: nothing is interpolated.");
  explain_left_out(scene, facts, options, report);
  return report;
}

PlanReport explain_plan(const Scene& scene, const SolveOptions& options) {
  check_options(scene, options);
  return explain(decide(scene, options), options);
}

}  // namespace polhode
