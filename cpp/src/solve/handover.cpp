#include "solve/handover.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solve/methods/body_method.hpp"
#include "solve/planning.hpp"

namespace polhode {
namespace {

constexpr double least_stiffness = 300.0;   // decay x span below which no implicit step has ever paid
constexpr double clearly = 0.7;             // of the cost of the better method alone
constexpr double loose_rtol = 1e-4;
constexpr int scales = 80, per_decade = 8;  // of time from the start: a fast transient is seen whatever the span

/// How far a body has turned and slowed down at some times of its span, both in radians and e-foldings.
struct Story {
  std::vector<double> t, work;
  double turned = 0.0;   ///< [rad]
  double steps = 0.0;    ///< that the loose run took
};

std::optional<Story> scout(const Scene& scene, const Facts& facts, const SolveOptions& options, long most_steps) {
  std::vector<double> times;
  for (int i = scales; i > 0; --i)
    times.push_back(scene.t0() + facts.after * std::pow(10.0, -static_cast<double>(i) / per_decade));
  for (int i = 1; i <= 24; ++i) times.push_back(scene.t0() + facts.after * i / 24);
  std::sort(times.begin(), times.end());
  const Scene loose(SceneParts{.inertia_B = scene.inertia_B(),
                               .omega = scene.omega(),
                               .attitude = scene.attitude(),
                               .torques = scene.torques(),
                               .times = std::move(times),
                               .want = {true, carries_attitude(scene, facts, options)},
                               .t0 = scene.t0()});
  SolveOptions quiet;
  quiet.max_steps = most_steps;
  quiet.progress = options.progress;
  const double absolute = find_atol(radau_method.record, scene, loose_rtol);
  const Motion motion = radau_method.solve(loose, RunOptions{quiet, {loose_rtol, absolute}});
  if (motion.status != Status::finished) return std::nullopt;
  Story story;
  story.steps = static_cast<double>(motion.stats.steps);
  double t = scene.t0(), rate = scene.omega().norm(), work = 0.0;
  const double least = 1e-3 * get_accuracy(options) * std::min(rate, 1 / facts.after);
  for (std::size_t i = 0; i < motion.t.size(); ++i) {
    const double* w = motion.omega.data() + 3 * i;
    const double next = std::hypot(w[0], w[1], w[2]);
    if (!(next > least)) break;   // it has stopped: nothing is left to do
    const double turned = 0.5 * (rate + next) * (motion.t[i] - t);
    story.turned += turned;
    work += turned + std::abs(std::log(next / rate));
    story.t.push_back(motion.t[i]), story.work.push_back(work);
    t = motion.t[i], rate = next;
  }
  return story;
}

}  // namespace

std::optional<PiecesPlan> plan_damped(const Scene& scene, const Facts& facts, const SolveOptions& options) {
  if (!leaves_choice(options) || facts.before > 0 || facts.stiffness < least_stiffness) return std::nullopt;
  if (!compute_refusal("taylor", scene).empty()) return std::nullopt;
  const ode::MethodRecord &first = taylor_method.record, &second = radau_method.record;
  const ode::Forecast &explicitly = first.forecast, &implicitly = second.forecast;
  const std::optional<Story> story =
      scout(scene, facts, options, static_cast<long>(0.2 * facts.stiffness / explicitly.stability));
  if (!story || story->t.empty()) return std::nullopt;

  const double accuracy = get_accuracy(options), turns = story->turned / (2 * std::numbers::pi);
  const double coarse = explicitly.find_rtol(accuracy, turns), scale = implicitly.find_rtol(accuracy, turns) / coarse;
  // Steps of one radian, and of a radian or an e-folding; a run of both is two runs where the error is certified.
  const auto price = [&](const ode::MethodRecord& record, double rtol) {
    const ode::Forecast& forecast = record.forecast;
    double seconds = 0.0;
    for (const double one : {rtol, rtol / pair_ratio}) {
      if (one == rtol && !options.certify) continue;
      const double fine = std::max(one, record.least_rtol);
      seconds += forecast.compute_seconds(fine, 1e6 / (2 * std::numbers::pi), 0.0, 0.0) / 1e6;
    }
    return seconds * find_factor(options.cost_factors, record.name);
  };
  const double radian = price(first, coarse), implicit_radian = price(second, coarse * scale);
  const double stable =
      radian / (explicitly.steps_per_radian * std::pow(coarse, -explicitly.power)) * facts.decay / explicitly.stability;
  const double step = implicit_radian / (implicitly.steps_per_radian * std::pow(coarse * scale, -implicitly.power));
  const double start_up = 30 * step;
  const double all = story->work.back(), end = scene.t0() + facts.after;

  double best = std::numeric_limits<double>::infinity(), when = end, spent = 0.0, t = scene.t0(), work = 0.0,
         before = 0.0;
  for (std::size_t i = 0; i < story->t.size(); ++i) {
    spent += std::max((story->work[i] - work) * radian, (story->t[i] - t) * stable);
    t = story->t[i], work = story->work[i];
    const double total = spent + (all - work) * implicit_radian + start_up;
    if (t < end && total < best) best = total, when = t, before = spent;
  }
  // Turns about a principal axis cost Radau's rates no steps: the loose run has counted those that are needed.
  const double counted = step * story->steps * std::pow(coarse * scale / loose_rtol, -implicitly.power);
  const double taylor_alone = spent + (end - t) * stable,
               radau_alone = std::min(all * implicit_radian + start_up, counted);
  PiecesPlan made;
  made.facts = facts;
  made.facts.turns = made.turns = turns;
  made.plan = make_method_plan(scene, made.facts, options);
  if (radau_alone < clearly * taylor_alone && made.plan.method != second.name) {
    SolveOptions asked = options;
    asked.method = std::string(second.name);
    made.plan = make_method_plan(scene, made.facts, asked);
    made.plan.predicted_seconds = radau_alone;
  }
  if (!(best < clearly * std::min(taylor_alone, radau_alone))) return made;

  const bool mostly_first = before >= 0.5 * best;
  made.plan.method = mostly_first ? first.name : second.name;
  made.plan.predicted_seconds = best;
  const double main_coarse = mostly_first ? coarse : coarse * scale;
  const ode::MethodRecord& main = mostly_first ? first : second;
  made.plan.rtol = std::max(main_coarse / pair_ratio, main.least_rtol);
  made.plan.predicted_error = main.forecast.compute_error(
      options.certify ? std::max(main_coarse, pair_ratio * main.least_rtol) : made.plan.rtol, turns);
  std::vector<std::string> names;
  for (const AnyTorque& torque : scene.torques())
    names.emplace_back(std::visit([](const auto& one) { return one.record().name; }, torque));
  double turned = 0.0;
  for (std::size_t i = 0; i < story->t.size() && story->t[i] <= when; ++i) turned = story->work[i] / all * turns;
  made.plan.pieces = {{.begin = scene.t0(),
                       .end = when,
                       .torques = names,
                       .model = "euler",
                       .method = std::string(first.name),
                       .turns = turned,
                       .predicted_seconds = before,
                       .rtol_scale = mostly_first ? 1.0 : 1 / scale},
                      {.begin = when,
                       .end = end,
                       .torques = names,
                       .model = "euler",
                       .method = std::string(second.name),
                       .turns = turns - turned,
                       .predicted_seconds = best - before,
                       .rtol_scale = mostly_first ? scale : 1.0,
                       .handed_over = true}};
  return made;
}

}  // namespace polhode
