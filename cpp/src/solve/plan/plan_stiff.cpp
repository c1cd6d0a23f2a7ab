#include "solve/plan/plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "method/method.hpp"
#include "method/series/switched_series.hpp"
#include "polhode/math/detail/functions.hpp"
#include "solve/plan/candidates.hpp"
#include "solve/ground/options.hpp"
#include "solve/ground/pilot.hpp"

namespace polhode {
namespace {

constexpr double least_stiffness = 300.0;   // decay x span; below it implicit steps never paid in the measurements
constexpr double required_gain = 0.7;       // the switch must cost less than this part of the better method alone
constexpr double required_lead = 0.9;       // Radau alone must cost less than this part of Taylor alone
constexpr double switch_rtol = 1e-3;         // of the pilot run
constexpr double pilot_share = 0.2;         // the pilot run may take this part of the steps of an explicit run,
constexpr double switch_pilot_steps = 2e4;    // and no more than these: some 10 ms
constexpr double start_up_steps = 30.0;     // steps of Radau until its step has grown to its final length
constexpr int log_samples = 80, per_decade = 8;   // logarithmic in time, to resolve a fast transient in any span
constexpr int even_samples = 24;

/// The pilot run of a damped body until it is at rest. Work is the sum of radians and e-foldings of |omega|.
struct DampedRun {
  std::vector<double> t, work;
  double angle = 0.0;    ///< total rotation [rad]
  double steps = 0.0;    ///< of the pilot run
};

std::optional<DampedRun> run_pilot(const Decision& decision, const SolveOptions& options, long most_steps) {
  const Scene& scene = decision.scene;
  const Facts& facts = decision.facts;
  SceneParts parts = scene.parts();
  parts.times.clear(), parts.name.clear();
  for (int i = log_samples; i > 0; --i)
    parts.times.push_back(scene.t0() + facts.after * math::fast_pow(10.0, -static_cast<double>(i) / per_decade));
  for (int i = 1; i <= even_samples; ++i) parts.times.push_back(scene.t0() + facts.after * i / even_samples);
  std::sort(parts.times.begin(), parts.times.end());
  parts.want = {true, carries_attitude(scene, facts, options)};
  SolveOptions limited;
  limited.max_steps = most_steps;
  limited.progress = options.progress;
  const double absolute = find_atol(radau_method.record, scene, switch_rtol);
  const Trajectory trajectory =
      radau_method.integrate(Scene(std::move(parts)), to_run_options(limited, {switch_rtol, absolute}));
  if (trajectory.status != Status::finished) return std::nullopt;
  const double start_rate = scene.omega().norm();
  const PilotRun pilot = measure_rotation(trajectory, scene.t0(), start_rate);
  DampedRun run;
  run.steps = static_cast<double>(trajectory.stats.steps);
  const double least = 1e-3 * get_accuracy(options) * std::min(start_rate, 1 / facts.after);
  double t = scene.t0(), rate = start_rate, work = 0.0;
  for (std::size_t i = 0; i < pilot.t.size() && pilot.rate[i] > least; ++i) {
    const double angle = 0.5 * (rate + pilot.rate[i]) * (pilot.t[i] - t);
    run.angle += angle;
    work += angle + std::abs(math::fast_log(pilot.rate[i] / rate));
    t = pilot.t[i], rate = pilot.rate[i];
    run.t.push_back(t), run.work.push_back(work);
  }
  return run;
}

}  // namespace

bool plan_stiff(Decision& decision, const SolveOptions& options) {
  const Scene& scene = decision.scene;
  const Facts& facts = decision.facts;
  if (!method_is_free(options) || facts.before > 0 || !(facts.stiffness >= least_stiffness)) return false;
  if (!compute_refusal("taylor", scene).empty() || has_switches(scene)) return false;
  const ode::MethodRecord &first = taylor_method.record, &second = radau_method.record;
  const ode::Forecast &explicitly = first.forecast, &implicitly = second.forecast;
  // Where accuracy limits explicit steps from the start to the end, there is nothing to choose.
  const double tightest = explicitly.find_rtol(get_accuracy(options), facts.turns);
  const double accurate = explicitly.compute_steps(tightest, facts.turns, 0.0);
  if (!facts.may_spin_up && facts.stiffness / explicitly.stability < 0.5 * accurate) return false;
  const double most = std::min(pilot_share * facts.stiffness / explicitly.stability, switch_pilot_steps);
  const std::optional<DampedRun> run =
      run_pilot(decision, options, std::min(static_cast<long>(most), options.max_steps));
  if (!run || run->t.empty()) return false;

  const double accuracy = get_accuracy(options), turns = run->angle / (2 * std::numbers::pi);
  const double coarse = explicitly.find_rtol(accuracy, turns), scale = implicitly.find_rtol(accuracy, turns) / coarse;
  // Seconds for a unit of work. The certificate of pieces, and of Radau, takes two runs.
  const auto cost_per_radian = [&](const ode::MethodRecord& record, double rtol) {
    const ode::Forecast& forecast = record.forecast;
    double seconds = 0.0;
    for (const double tolerance : {rtol, rtol / pair_ratio}) {
      if (tolerance == rtol && !options.certify) continue;
      const double raised = std::max(tolerance, record.least_rtol);
      seconds += forecast.compute_seconds(raised, 1e6 / (2 * std::numbers::pi), 0.0, 0.0) / 1e6;
    }
    return seconds * find_factor(options.cost_factors, record.name);
  };
  const double radian = cost_per_radian(first, coarse), implicit_radian = cost_per_radian(second, coarse * scale);
  const auto steps_per_radian = [](const ode::Forecast& forecast, double rtol) {
    return forecast.steps_per_radian * math::fast_pow(rtol, -forecast.power);
  };
  const double stable = radian / steps_per_radian(explicitly, coarse) * facts.decay / explicitly.stability;
  const double step = implicit_radian / steps_per_radian(implicitly, coarse * scale);
  const double start_up = start_up_steps * step;
  const double all = run->work.back(), end = scene.t0() + facts.after;

  double best = std::numeric_limits<double>::infinity(), when = end, spent = 0.0, t = scene.t0(), work = 0.0,
         before = 0.0;
  for (std::size_t i = 0; i < run->t.size(); ++i) {
    spent += std::max((run->work[i] - work) * radian, (run->t[i] - t) * stable);
    t = run->t[i], work = run->work[i];
    const double total = spent + (all - work) * implicit_radian + start_up;
    if (t < end && total < best) best = total, when = t, before = spent;
  }
  // Rotation about a principal axis costs Radau no steps. The pilot run has counted the steps that are needed.
  const double counted = step * run->steps * math::fast_pow(coarse * scale / switch_rtol, -implicitly.power);
  // Taylor alone carries its error, in one run.
  const double carried = options.certify ? 0.5 * carried_cost_stiff : 1.0;
  const double taylor_alone = carried * (spent + (end - t) * stable);
  const ode::Forecast& third = find_method("dop853").forecast;
  const double third_seconds = count_third_steps(run->steps) * third.compute_step_seconds(coarse * scale);
  const double radau_once = std::min(all * implicit_radian + start_up, counted);
  const double radau_alone = options.certify ? implicit_pair_cost * radau_once + third_seconds : radau_once;
  Plan& plan = decision.plan;
  decision.facts.turns = decision.turns = turns;
  plan = make_method_plan(scene, facts, options);
  const double pilot_seconds = run->steps * implicitly.step_seconds;
  if (radau_alone < required_lead * taylor_alone && plan.method != second.name) {
    SolveOptions by_radau = options;
    by_radau.method = std::string(second.name);
    plan = make_method_plan(scene, facts, by_radau);
    plan.predicted_seconds = solve_seconds + radau_alone;
  }
  plan.predicted_seconds += pilot_seconds;
  if (!(best < required_gain * std::min(taylor_alone, radau_alone))) return true;
  double turns_before = 0.0;
  for (std::size_t i = 0; i < run->t.size() && run->t[i] <= when; ++i) turns_before = run->work[i] / all * turns;
  // The comparison run has so much more than the least tolerance. Tighter bounds are left to Taylor's own.
  const double least_bound =
      most_stiff_factor * implicitly.compute_error(wide_pair_ratio * second.least_rtol, turns - turns_before);
  if (options.certify && accuracy < least_bound) return true;

  const bool mostly_first = before >= 0.5 * best;
  plan.method = mostly_first ? first.name : second.name;
  plan.predicted_seconds = solve_seconds + pilot_seconds + best;
  const double main_coarse = mostly_first ? coarse : coarse * scale;
  const ode::MethodRecord& main = mostly_first ? first : second;
  plan.rtol = std::max(main_coarse / pair_ratio, main.least_rtol);
  plan.predicted_error = main.forecast.compute_error(
      options.certify ? std::max(main_coarse, pair_ratio * main.least_rtol) : plan.rtol, turns);
  std::vector<std::string> names;
  for (const AnyTorque& torque : scene.torques()) names.emplace_back(torque_name(torque));
  if (!scene.rotor_momentum().isZero(0.0)) names.emplace_back("rotors");
  plan.pieces = {{.begin = scene.t0(),
                  .end = when,
                  .torques = names,
                  .model = "euler",
                  .method = std::string(first.name),
                  .turns = turns_before,
                  .predicted_seconds = before,
                  .rtol_scale = mostly_first ? 1.0 : 1 / scale},
                 {.begin = when,
                  .end = end,
                  .torques = names,
                  .model = "euler",
                  .method = std::string(second.name),
                  .turns = turns - turns_before,
                  .predicted_seconds = best - before,
                  .rtol_scale = mostly_first ? scale : 1.0}};
  decision.pieces = cut(scene, {when});
  for (std::size_t i = 0; i < 2; ++i) decision.pieces.forward[i].plan = plan.pieces[i];
  return true;
}

}  // namespace polhode
