#include "polhode/solve/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/core/error.hpp"
#include "polhode/solve/closed_form.hpp"
#include "solve/handover.hpp"
#include "solve/methods/body_method.hpp"
#include "solve/planning.hpp"

namespace polhode {

bool leaves_choice(const SolveOptions& options) {
  return !options.method && options.formulation == Formulation::euler;
}

double get_accuracy(const SolveOptions& options) { return options.accuracy.value_or(default_accuracy); }

bool carries_attitude(const Scene& scene, const Facts& facts, const SolveOptions& options) {
  return scene.want().attitude || facts.torques.uses_attitude || !options.events.empty();
}

double find_seconds_per_call(const Scene& scene) {
  double seconds = 0.0;
  for (const AnyTorque& torque : scene.torques()) {
    const auto* during = std::get_if<torques::During>(&torque);
    const bool custom = during != nullptr ? std::holds_alternative<torques::Custom>(during->torque())
                                          : std::holds_alternative<torques::Custom>(torque);
    if (custom) seconds += custom_call_seconds;
  }
  return seconds;
}

Candidate judge_method(const Scene& scene, const Facts& facts, const SolveOptions& options,
                       const ode::MethodRecord& record) {
  Candidate one{.name = std::string(record.name)};
  const ode::Forecast& forecast = record.forecast;
  if (!record.adaptive) {
    one.why_not = "takes steps of one fixed length, whose error is not in hand";
    return one;
  }
  if (!forecast.known()) {
    one.why_not = "nothing is known beforehand about its error";
    return one;
  }
  if (options.formulation != Formulation::euler && find_body_method(record.name).of_bodies) {
    one.why_not = "steps the body itself, not its angles";
    return one;
  }
  one.why_not = compute_refusal(record.name, scene);
  if (!one.why_not.empty()) return one;
  const double accuracy = get_accuracy(options);
  const double coarse = forecast.find_rtol(accuracy, facts.turns);
  one.rtol = std::max(coarse / pair_ratio, record.least_rtol);
  const double per_call = find_seconds_per_call(scene);
  one.predicted_seconds = forecast.compute_seconds(one.rtol, facts.turns, facts.stiffness, per_call);
  // The coarser run of the pair is there only to be compared with.
  const double compared = std::max(coarse, pair_ratio * record.least_rtol);
  if (options.certify && find_body_method(record.name).carries_error) {
    one.predicted_seconds *= facts.is_stiff_for_series() ? 1.9 : 1.35;   // what the error's own series costs
  } else if (options.certify) {
    one.predicted_seconds += forecast.compute_seconds(compared, facts.turns, facts.stiffness, per_call);
  }
  one.predicted_seconds *= find_factor(options.cost_factors, record.name);
  // What the certificate will claim is the error of the coarser run.
  const double shown = options.certify ? compared : one.rtol;
  one.predicted_error = forecast.compute_error(shown, facts.turns);
  return one;
}

Candidate judge_closed_form(const Scene& scene, const ClosedForm& form, const Facts& facts,
                            const SolveOptions& options) {
  Candidate one{.name = std::string(form.model()), .exact = true};
  one.predicted_error = compute_closed_form_error(scene, facts, form);
  one.predicted_seconds =
      predict_closed_form(one.name, static_cast<double>(scene.times().size()), options.cost_factors);
  return one;
}

double find_atol(const ode::MethodRecord& record, const Scene& scene, double rtol) {
  if (!record.implicit) return 0.0;
  double span = 0.0;
  for (const double t : scene.times()) span = std::max(span, std::abs(t - scene.t0()));
  // At most 1: the same number is allowed in the quaternion's components.
  return rtol * std::min({1.0, scene.omega().norm(), 1.0 / span});
}

double predict_closed_form(std::string_view model, double samples, const CostFactors* factors) {
  return (model == "heavy_top" ? 3.6e-6 + 9e-9 * samples : 1.5e-6 + 8e-9 * samples) * find_factor(factors, model);
}

double find_factor(const CostFactors* factors, std::string_view name) {
  if (factors == nullptr) return 1.0;
  const auto found = factors->find(name);
  return found == factors->end() ? 1.0 : found->second;
}

/// Those that reach the accuracy by their time, then the others by their error.
bool is_better(const Candidate& a, const Candidate& b, double accuracy) {
  const double enough = forecast_slack * accuracy;
  const bool a_reaches = a.predicted_error <= enough, b_reaches = b.predicted_error <= enough;
  if (a_reaches != b_reaches) return a_reaches;
  return a_reaches ? a.predicted_seconds < b.predicted_seconds : a.predicted_error < b.predicted_error;
}

Candidate choose_method(const Scene& scene, const Facts& facts, const SolveOptions& options) {
  if (options.method) return judge_method(scene, facts, options, find_method(*options.method));
  std::optional<Candidate> best;
  for (const ode::MethodRecord& record : methods()) {
    Candidate one = judge_method(scene, facts, options, record);
    if (one.why_not.empty() && (!best || is_better(one, *best, get_accuracy(options)))) best = std::move(one);
  }
  if (!best) throw InvalidInput("scene", "one that some method takes", "one that none does");
  return *best;
}

Plan make_method_plan(const Scene& scene, const Facts& facts, const SolveOptions& options) {
  const Candidate chosen = choose_method(scene, facts, options);
  const bool lagrangian = options.formulation == Formulation::lagrangian;
  return {.model = lagrangian ? "lagrangian" : "euler",
          .method = chosen.name,
          .state = lagrangian                                  ? "phi, theta, psi and their rates"
                   : carries_attitude(scene, facts, options) ? "omega, attitude"
                                                             : "omega",
          .accuracy = get_accuracy(options),
          .certify = options.certify,
          .rtol = chosen.rtol,
          .predicted_error = chosen.predicted_error,
          .predicted_seconds = chosen.predicted_seconds};
}

Plan make_exact_plan(const Scene& scene, const ClosedForm& form, const Facts& facts, const SolveOptions& options) {
  const Candidate chosen = judge_closed_form(scene, form, facts, options);
  return {.model = chosen.name,
          .method = "exact",
          .state = scene.want().attitude ? "omega, attitude" : "omega",
          .accuracy = get_accuracy(options),
          .certify = options.certify,
          .predicted_error = chosen.predicted_error,
          .predicted_seconds = chosen.predicted_seconds};
}

Plan make_plan(const Scene& scene, const Facts& facts, const SolveOptions& options) {
  if (has_windows(scene)) {
    if (const Pieces pieces = cut(scene); !pieces.whole) return plan_pieces(scene, pieces, options).plan;
    const Scene plain = drop_windows(scene);
    return make_plan(plain, compute_facts(plain), options);
  }
  if (options.method == "exact" || leaves_choice(options)) {
    const std::optional<ClosedForm> form = find_closed_form(scene, facts);
    if (form) return make_exact_plan(scene, *form, facts, options);
    if (options.method) throw_no_closed_form(scene, facts);
  }
  const std::optional<PiecesPlan> damped = plan_damped(scene, facts, options);
  return damped ? damped->plan : make_method_plan(scene, facts, options);
}

void throw_no_closed_form(const Scene& scene, const Facts& facts) {
  throw InvalidInput("method 'exact'", "used where a closed form holds", exact_models().back().refuse(scene, facts),
                     "no closed form is known for it; leave method out");
}

}  // namespace polhode
