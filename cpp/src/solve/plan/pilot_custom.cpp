#include "solve/plan/plan.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "method/method.hpp"
#include "polhode/math/detail/functions.hpp"
#include "solve/plan/candidates.hpp"
#include "solve/ground/options.hpp"
#include "solve/ground/pilot.hpp"

namespace polhode {
namespace {

constexpr double custom_rtol = 1e-3;       // of the pilot run; a tighter one costs too much at loose accuracies
constexpr int intervals = 32;             // of the span, to count the revolutions
constexpr std::size_t pilot_stride = 4;         // samples between two probes at the damping
constexpr long most_pilot_steps = 300;    // some 4000 calls
constexpr double usual_steps = 1.4;       // steps at this tolerance over their forecast, by benchmarks/planner
constexpr double stiff_steps = 100.0;     // explicit steps of stability from which the pilot run is implicit
constexpr double most_foldings = 700.0;   // from one to the least float64
constexpr int timed_calls = 4;            // the first may compile the function, and any may be interrupted

/// Probes the torques along a run whose first rows, `first` of them, are others. Removes the rows of the probes.
void take_probes(Decision& decision, std::size_t first, double accuracy, Trajectory& run) {
  decision.probed = run.status == Status::finished;
  if (decision.probed) decision.probes = probe(decision.scene, run, first, accuracy);
  run.t.resize(first), run.omega.resize(3 * first);
  if (!run.attitude.empty()) run.attitude.resize(4 * first);
}

/// Averages the fastest rate of decay over the times of the run, and keeps the largest. Where the run ended early, its
/// last state stands for the later ones, so that damping which begins late is seen.
/// @return the slowest rate of decay from each time to the next [1/s]
std::vector<double> measure_decay(const Scene& scene, const std::vector<double>& times, const Trajectory& run,
                                  Decision& decision) {
  Facts& facts = decision.facts;
  std::vector<double> slowest;
  double sum = 0.0;
  int probes = 0;
  for (std::size_t i = pilot_stride; i < times.size(); i += pilot_stride, ++probes) {
    const std::size_t row = std::min(i, run.t.size() - 1);
    SceneParts parts = scene.parts();
    parts.t0 = times[i];
    for (int k = 0; k < 3; ++k) parts.omega[k] = run.omega[3 * row + static_cast<std::size_t>(k)];
    if (!run.attitude.empty()) {
      const double* q = run.attitude.data() + 4 * row;
      parts.attitude = {q[0], q[1], q[2], q[3]};
    }
    parts.times = {times[i]};
    if (!parts.omega.allFinite()) break;
    const DecayRates decay = compute_decay_rates(Scene(std::move(parts)), facts.torques);
    decision.pilot.derivatives += 6;
    sum += decay.fastest;
    facts.decay = std::max(facts.decay, decay.fastest);
    slowest.insert(slowest.end(), pilot_stride, decay.slowest);
  }
  facts.stiffness = probes > 0 ? sum / probes * facts.span() : facts.stiffness;
  return slowest;
}

/// The e-foldings of |omega| over the span. The slowest decay stands for those that the run did not reach or resolve.
double count_foldings(const PilotRun& run, double resolved, const std::vector<double>& slowest, double span) {
  double sum = 0.0;
  for (std::size_t i = 0; i < slowest.size(); ++i) {
    const bool measured = i + 1 < run.rate.size() && std::min(run.rate[i], run.rate[i + 1]) > resolved;
    sum += measured ? std::abs(math::fast_log(run.rate[i + 1] / run.rate[i])) : slowest[i] * span / intervals;
  }
  return std::min(sum, most_foldings);
}

}  // namespace

double measure_call_seconds(const Scene& scene) {
  const Quat& q = scene.attitude();
  const double attitude[4] = {q.x, q.y, q.z, q.w};
  double seconds = 0.0;
  for (const AnyTorque& torque : scene.torques()) {
    const auto* during = std::get_if<torques::During>(&torque);
    const torques::Custom* custom = during != nullptr ? std::get_if<torques::Custom>(&during->torque())
                                                      : std::get_if<torques::Custom>(&torque);
    if (custom == nullptr || (during != nullptr && during->windows().empty())) continue;
    // A function is called within its windows alone.
    double t = scene.t0();
    if (during != nullptr) t = std::clamp(t, during->windows().front().begin, during->windows().front().end);
    const TorqueInput in{t, scene.omega().data(), attitude, scene.inertia_B().matrix()};
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < timed_calls; ++i) {
      double tau[3] = {0.0, 0.0, 0.0};
      const auto begin = std::chrono::steady_clock::now();
      custom->add(in, tau);
      least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    seconds += least;
  }
  return seconds;
}

void pilot_custom(Decision& decision, const SolveOptions& options) {
  const Scene& scene = decision.scene;
  Facts& facts = decision.facts;
  if (!calls_custom(scene) || !(facts.span() > 0)) return;
  facts.call_seconds = measure_call_seconds(scene);
  SceneParts parts = scene.parts();
  const std::vector<double> times = spread_times(decision.scene, decision.facts, intervals);
  parts.times = times;
  const std::vector<double> probes = spread_probes(times.front(), times.back());
  parts.times.insert(parts.times.end(), probes.begin(), probes.end());
  parts.want = {true, facts.torques.uses_attitude};
  SolveOptions limited;
  limited.max_steps = std::min(most_pilot_steps, options.max_steps);
  limited.progress = options.progress;
  const bool starts_stiff = facts.stiffness > stiff_steps * dop853_method.record.forecast.stability;
  const BodyMethod& method = starts_stiff ? radau_method : dop853_method;
  const ode::Forecast& forecast = method.record.forecast;
  const double absolute = find_atol(method.record, scene, custom_rtol);
  Trajectory run =
      method.integrate(Scene(std::move(parts)), to_run_options(limited, {.rtol = custom_rtol, .atol = absolute}));
  decision.pilot = run.stats;
  decision.pilot.derivatives += timed_calls;
  std::size_t reached = 0;
  while (reached < std::min(run.t.size(), times.size()) && run.t[reached] == times[reached]) ++reached;
  take_probes(decision, reached, get_accuracy(options), run);
  if (run.t.empty() || run.status == Status::stopped) return;
  const double sampled = static_cast<double>(run.t.size() - 1) / intervals;
  const double share = std::clamp(std::max(sampled, std::abs(run.t_reached - scene.t0()) / facts.span()), 1e-12, 1.0);
  const PilotRun rotation = measure_rotation(run, run.t[0], math::hypot(run.omega[0], run.omega[1], run.omega[2]));
  const double turns = rotation.revolutions();
  if (!std::isfinite(turns)) return;
  if (sampled > 0) facts.turns = turns / std::max(sampled, 1.0 / intervals);
  if (facts.torques.uses_rates) {
    const std::vector<double> slowest = measure_decay(scene, times, run, decision);
    facts.foldings = count_foldings(rotation, 10 * absolute, slowest, facts.span());
  }
  const double steps = static_cast<double>(run.stats.steps + run.stats.rejected) / share;
  const double a_radian = usual_steps * forecast.steps_per_radian * math::fast_pow(custom_rtol, -forecast.power);
  facts.piloted = true;
  // Where damping limits the steps, they tell nothing of those that accuracy needs.
  const bool is_stiff = forecast.stability > 0 && facts.stiffness / forecast.stability > 0.5 * steps;
  // The decay itself makes errors, as much as rotation by one radian for each e-folding that is followed.
  const double stiff = facts.turns + std::min(facts.stiffness, followed_foldings) / (2 * std::numbers::pi);
  const double near_end = std::min(facts.foldings, followed_foldings);
  const double further = starts_stiff ? 0.0 : facts.foldings - near_end;   // e-foldings that the run followed
  const double radians = std::max((steps - 1) / a_radian - further, near_end);
  facts.effort = is_stiff ? stiff : radians / (2 * std::numbers::pi);
}

}  // namespace polhode
