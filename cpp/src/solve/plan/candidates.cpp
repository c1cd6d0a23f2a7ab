#include "solve/plan/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "method/method.hpp"
#include "method/series/switched_series.hpp"
#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"
#include "solve/ground/options.hpp"
#include "solve/ground/pieces.hpp"

namespace polhode {
namespace {

// Decay x span from which an implicit method may be chosen: below, stability limits no explicit step.
constexpr double least_implicit_stiffness = 50.0;

/// Candidates that reach the accuracy are ordered by time, and come before the others, ordered by error. Where the
/// user's own torques are called, they are ordered by these calls, so that no clock decides.
bool is_better(const Candidate& a, const Candidate& b, double accuracy, bool by_calls) {
  const double enough = forecast_slack * accuracy;
  const bool a_reaches = a.predicted_error <= enough, b_reaches = b.predicted_error <= enough;
  if (a_reaches != b_reaches) return a_reaches;
  if (!a_reaches) return a.predicted_error < b.predicted_error;
  return by_calls ? a.predicted_calls < b.predicted_calls : a.predicted_seconds < b.predicted_seconds;
}

}  // namespace

std::string compute_refusal(std::string_view name, const Scene& scene) {
  const BodyMethod& method = find_body_method(name);
  if (!scene.states().empty() && name != "taylor")
    return "a Formula with states of its own (taylor integrates them)";
  if (!method.refuse) return "";
  if (!has_windows(scene)) return method.refuse(scene);
  const Pieces pieces = cut(scene);
  for (const Piece* piece : pieces.all()) {
    const std::string why = method.refuse(make_piece_scene(scene, *piece, scene.start(), {piece->end}, scene.want()));
    if (!why.empty()) return pieces.whole ? why : why + ", " + describe_span(*piece);
  }
  return "";
}

double find_carried_ratio(double accuracy) {
  return accuracy <= 1e-9 ? pair_ratio : pair_ratio * std::clamp(math::fast_pow(accuracy / 1e-9, 0.35), 1.0, 5.0);
}

double count_third_steps(double steps) { return 100 + steps / 4; }

double get_accuracy(const SolveOptions& options) { return options.accuracy.value_or(default_accuracy); }

bool carries_attitude(const Scene& scene, const Facts& facts, const SolveOptions& options) {
  return scene.want().attitude || facts.torques.uses_attitude || !options.events.empty();
}

Candidate evaluate_method(const Scene& scene, const Facts& facts, const SolveOptions& options,
                          const ode::MethodRecord& record) {
  Candidate candidate{.name = std::string(record.name)};
  const ode::Forecast& forecast = record.forecast;
  if (!record.adaptive) {
    candidate.why_not = "takes steps of a fixed length, which do not control the error";
    return candidate;
  }
  if (!forecast.known()) {
    candidate.why_not = "has no forecast of its error";
    return candidate;
  }
  if (options.formulation != Formulation::euler && find_body_method(record.name).of_bodies) {
    candidate.why_not = "integrates Euler's equations only";
    return candidate;
  }
  if (has_switches(scene) && record.name != "taylor") {
    candidate.why_not = "steps over the switches of a Formula";
    return candidate;
  }
  candidate.why_not = compute_refusal(record.name, scene);
  if (!candidate.why_not.empty()) return candidate;
  const double accuracy = get_accuracy(options);
  const double coarse = forecast.find_rtol(accuracy, facts.work());
  const bool carries_error = find_body_method(record.name).carries_error;
  const double ratio = carries_error ? find_carried_ratio(accuracy) : pair_ratio;
  const double fine = options.certify ? coarse / ratio : forecast.find_median_rtol(accuracy / aim, facts.work());
  candidate.rtol = std::max(fine, record.least_rtol);
  // The coarser run of the pair serves for comparison only.
  const double compared = std::max(coarse, pair_ratio * record.least_rtol);
  const double factor = find_factor(options.cost_factors, record.name);
  const double samples = static_cast<double>(scene.times().size());
  candidate.predicted_seconds = factor * solve_seconds;
  const auto count = [&](double rtol) {
    if (!facts.piloted) return forecast.compute_steps(rtol, facts.turns, facts.stiffness);
    const double further = record.implicit ? 0.0 : std::max(0.0, facts.foldings - followed_foldings);
    return forecast.compute_steps_of_radians(rtol, 2 * std::numbers::pi * facts.effort + further, facts.stiffness);
  };
  const auto add_run = [&](double rtol, double share, double share_of_calls) {
    const double calls = share_of_calls * count(rtol) * forecast.calls_per_step;
    candidate.predicted_calls += calls;
    const double own = share * count(rtol) * forecast.compute_step_seconds(rtol) + samples * forecast.sample_seconds;
    candidate.predicted_seconds += factor * own + calls * facts.call_seconds;
  };
  if (!options.certify) {
    add_run(candidate.rtol, 1.0, 1.0);
  } else if (carries_error) {
    const double share = facts.is_stiff_for_series() ? carried_cost_stiff : carried_cost;
    add_run(candidate.rtol, share, share);
  } else {
    const bool alike = count(candidate.rtol) < 1.01 * count(compared);
    const double share = record.implicit ? implicit_pair_cost : alike ? alike_pair_cost : pair_cost;
    const double share_of_calls = record.implicit ? implicit_pair_calls : pair_calls;
    for (const double rtol : {candidate.rtol, compared}) add_run(rtol, share, share_of_calls);
    if (record.implicit) {
      const double third = count_third_steps(count(candidate.rtol));
      const ode::Forecast& other = find_method("dop853").forecast;
      candidate.predicted_calls += third * other.calls_per_step;
      candidate.predicted_seconds +=
          find_factor(options.cost_factors, "dop853") * third * other.compute_step_seconds(candidate.rtol);
    }
  }
  // The certificate will claim the error of the coarser run.
  const double shown = options.certify ? compared : candidate.rtol;
  candidate.predicted_error = forecast.compute_error(shown, facts.work());
  return candidate;
}

Candidate evaluate_closed_form(const Scene& scene, const ClosedForm& form, const Facts& facts,
                               const SolveOptions& options) {
  Candidate candidate{.name = std::string(form.name()), .exact = true};
  candidate.predicted_error = form.measure_error(scene, facts);
  candidate.predicted_seconds =
      find_factor(options.cost_factors, candidate.name) * solve_seconds +
      predict_closed_form(form.record(), 1 + form.record().count_error_set_ups(scene, facts),
                          static_cast<double>(scene.times().size()), options.cost_factors);
  return candidate;
}

double find_atol(const ode::MethodRecord& record, const Scene& scene, double rtol) {
  if (!record.implicit) return 0.0;
  double span = 0.0;
  for (const double t : scene.times()) span = std::max(span, std::abs(t - scene.t0()));
  // At most 1, because the quaternion's components have the same tolerance.
  return rtol * std::min({1.0, scene.omega().norm(), 1.0 / span});
}

double predict_closed_form(const ClosedFormRecord& form, int set_ups, double samples, const CostFactors* factors) {
  return (form.set_up_seconds * set_ups + form.sample_seconds * samples) * find_factor(factors, form.name);
}

double find_factor(const CostFactors* factors, std::string_view name) {
  if (factors == nullptr) return 1.0;
  const auto found = factors->find(name);
  return found == factors->end() ? 1.0 : found->second;
}

Candidate choose_method(const Scene& scene, const Facts& facts, const SolveOptions& options) {
  if (options.method) return evaluate_method(scene, facts, options, find_method(*options.method));
  std::optional<Candidate> best;
  for (const ode::MethodRecord& record : methods()) {
    if (record.implicit && facts.stiffness < least_implicit_stiffness) continue;
    Candidate candidate = evaluate_method(scene, facts, options, record);
    if (!candidate.why_not.empty()) continue;
    if (!best || is_better(candidate, *best, get_accuracy(options), calls_custom(scene))) best = std::move(candidate);
  }
  if (!best) throw InvalidInput("scene", "integrable by at least one method", "one that every method refuses");
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
  const Candidate chosen = evaluate_closed_form(scene, form, facts, options);
  return {.model = chosen.name,
          .method = "exact",
          .state = scene.want().attitude ? "omega, attitude" : "omega",
          .accuracy = get_accuracy(options),
          .certify = options.certify,
          .predicted_error = chosen.predicted_error,
          .predicted_seconds = chosen.predicted_seconds};
}

}  // namespace polhode
