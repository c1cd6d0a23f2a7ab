#include "solve/planned_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "polhode/core/error.hpp"
#include "solve/exact_run.hpp"
#include "solve/measure.hpp"
#include "solve/methods/body_method.hpp"
#include "solve/perturb.hpp"
#include "solve/planning.hpp"

namespace polhode {
namespace {

constexpr int looks = 16;               // at |omega| in a piece, to count its turns
constexpr double loose_rtol = 1e-4;
constexpr long loose_steps = 20'000;    // a piece that needs more is planned by its start

/// The part of |omega| dt that samples tell of [turns].
double count_turns(const Scene& piece, const Motion& motion) {
  double turned = 0.0, t = piece.t0(), rate = piece.omega().norm();
  for (std::size_t i = 0; i < motion.t.size(); ++i) {
    const double* w = motion.omega.data() + 3 * i;
    const double next = std::hypot(w[0], w[1], w[2]);
    turned += 0.5 * (rate + next) * std::abs(motion.t[i] - t);
    t = motion.t[i], rate = next;
  }
  return turned / (2 * std::numbers::pi);
}

/// Plans one piece after another as a loose run meets them.
class Planner {
 public:
  Planner(const Scene& scene, const Pieces& pieces, const SolveOptions& options)
      : scene_(scene), pieces_(pieces), options_(options), sorted_(scene.times()) {
    std::sort(sorted_.begin(), sorted_.end());
  }

  PiecesPlan plan() {
    if (options_.method == "exact") require_closed_forms();
    scout();
    choose_tolerances();
    PiecesPlan made;
    made.plan = {.model = options_.formulation == Formulation::euler ? "pieces" : "lagrangian",
                 .method = main_ == nullptr ? "exact" : std::string(main_->name),
                 .state = carries_attitude(scene_, pieces_, options_) ? "omega, attitude" : "omega",
                 .accuracy = get_accuracy(options_),
                 .certify = options_.certify,
                 .predicted_seconds = 0.0};
    made.facts = sum_facts();
    for (PiecePlan& one : plans_) {
      one.predicted_seconds *= options_.certify ? 2 : 1;
      made.plan.predicted_seconds += one.predicted_seconds;
      made.turns += one.turns;
    }
    if (main_ == nullptr) {
      made.plan.predicted_error = 20 * std::numeric_limits<double>::epsilon() * (1 + made.turns);
    } else {
      const double compared = std::max(coarse_, pair_ratio * main_->least_rtol);
      made.plan.rtol = std::max(coarse_ / pair_ratio, main_->least_rtol);
      made.plan.predicted_error = main_->forecast.compute_error(options_.certify ? compared : made.plan.rtol, turns_);
    }
    std::sort(plans_.begin(), plans_.end(), [](const PiecePlan& a, const PiecePlan& b) { return a.begin < b.begin; });
    made.plan.pieces = std::move(plans_);
    return made;
  }

 private:
  void require_closed_forms() const {
    for (const auto* one_way : {&pieces_.backward, &pieces_.forward}) {
      for (const Piece& piece : *one_way) {
        const Scene one = make_piece_scene(scene_, piece, scene_.start(), {piece.end}, scene_.want());
        const Facts facts = compute_facts(one);
        if (find_closed_form(one, facts)) continue;
        throw InvalidInput("method 'exact'", "used where every piece between the windows' ends has a closed form",
                           exact_models().back().refuse(one, facts) + ", " + describe_span(piece),
                           "no closed form is known for it; leave method out");
      }
    }
  }

  /// A loose run; what it did not reach is planned from the scene's start.
  void scout() {
    std::vector<double> times;
    for (const auto* one_way : {&pieces_.backward, &pieces_.forward}) {
      for (const Piece& piece : *one_way) {
        for (int i = 1; i <= looks; ++i)
          times.push_back(i == looks ? piece.end : piece.begin + (piece.end - piece.begin) * i / looks);
      }
    }
    const Scene loose(SceneParts{.inertia_B = scene_.inertia_B(),
                                 .omega = scene_.omega(),
                                 .attitude = scene_.attitude(),
                                 .torques = scene_.torques(),
                                 .times = std::move(times),
                                 .want = {true, false},
                                 .t0 = scene_.t0()});
    SolveOptions options;
    options.formulation = options_.formulation;
    options.progress = options_.progress;
    run_pieces(loose, pieces_, options,
               [this](const Scene& piece, const SolveOptions& one) { return run_loosely(piece, one); });
    for (const auto* one_way : {&pieces_.backward, &pieces_.forward}) {
      for (const Piece& piece : *one_way) {
        const auto same = [&](const PiecePlan& one) { return one.begin == std::min(piece.begin, piece.end); };
        if (std::any_of(plans_.begin(), plans_.end(), same)) continue;
        State start = scene_.start();
        start.t = piece.begin;
        add(make_piece_scene(scene_, piece, start, {piece.end}, scene_.want()));
      }
    }
  }

  Motion run_loosely(const Scene& piece, const SolveOptions& options) {
    const Facts facts = add(piece);
    PiecePlan& plan = plans_.back();
    if (plan.method == "exact") {
      std::optional<ClosedForm> form = find_closed_form(piece, facts);
      const Plan exact = make_exact_plan(piece, *form, facts, options_);
      return solve_exactly(piece, facts, options, *std::move(form), exact);
    }
    SolveOptions one = options;
    one.max_steps = loose_steps;
    Motion motion = find_body_method(plan.method).solve(piece, RunOptions{one, {loose_rtol}});
    if (motion.status == Status::finished) plan.turns = facts_.back().turns = count_turns(piece, motion);
    return motion;
  }

  Facts add(const Scene& piece) {
    const Facts facts = compute_facts(piece);
    const auto [begin, end] = std::minmax({piece.t0(), piece.times().back()});
    PiecePlan plan{.begin = begin, .end = end, .model = "euler", .turns = facts.turns};
    for (const AnyTorque& torque : piece.torques()) {
      if (!traits(torque).vanishes)
        plan.torques.emplace_back(std::visit([](const auto& one) { return one.record().name; }, torque));
    }
    std::optional<ClosedForm> form;
    if (leaves_choice(options_) || options_.method == "exact") form = find_closed_form(piece, facts);
    if (form) {
      plan.model = form->model(), plan.method = "exact";
      const auto samples = std::upper_bound(sorted_.begin(), sorted_.end(), plan.end) -
                           std::lower_bound(sorted_.begin(), sorted_.end(), plan.begin);
      plan.predicted_seconds = predict_closed_form(plan.model, static_cast<double>(samples), options_.cost_factors);
    } else {
      plan.method = choose_method(piece, facts, options_).name;
      if (options_.formulation == Formulation::lagrangian) plan.model = "lagrangian";
    }
    plans_.push_back(plan);
    facts_.push_back(facts);
    return facts;
  }

  /// The tolerance that the whole chain asks for: an error in the rates of one piece is an error in the phase of all
  /// that follow, so that each counts n (1 + (n + 2 after) / secular) where one alone has n (1 + n / secular).
  void choose_tolerances() {
    double most = -1.0;
    const double accuracy = get_accuracy(options_);
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      if (plans_[i].method == "exact") continue;
      const ode::MethodRecord& record = find_method(plans_[i].method);
      const double seconds = predict(record, record.forecast.find_rtol(accuracy, facts_[i].turns), facts_[i]);
      if (seconds > most || std::isnan(seconds)) most = seconds, main_ = &record;
    }
    if (main_ == nullptr) return;
    double after = 0.0, sum = 0.0;
    const double secular = main_->forecast.secular;
    for (std::size_t i = plans_.size(); i-- > 0;) {
      if (i + 1 == pieces_.backward.size()) after = 0.0;   // the other way from the start
      const double n = plans_[i].turns;
      if (plans_[i].method != "exact") sum += n * (1 + (n + 2 * after) / secular);
      after += n;
    }
    turns_ = secular / 2 * (std::sqrt(1 + 4 * sum / secular) - 1);
    coarse_ = main_->forecast.known() ? main_->forecast.find_rtol(accuracy, turns_) : accuracy / 10;
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      if (plans_[i].method == "exact") continue;
      const ode::MethodRecord& record = find_method(plans_[i].method);
      if (record.forecast.known() && main_->forecast.known())
        plans_[i].rtol_scale = record.forecast.find_rtol(accuracy, turns_) / coarse_;
      plans_[i].predicted_seconds =
          predict(record, plans_[i].rtol_scale * coarse_, facts_[i]) * find_factor(options_.cost_factors, record.name);
    }
  }

  double predict(const ode::MethodRecord& record, double rtol, const Facts& facts) const {
    const double least = std::max(rtol, record.least_rtol);
    return record.forecast.compute_seconds(least, facts.turns, facts.stiffness, find_seconds_per_call(scene_));
  }

  Facts sum_facts() const {
    Facts all = compute_facts(scene_);
    std::vector<AnyTorque> acting;
    for (const AnyTorque& torque : scene_.torques()) {
      const auto* during = std::get_if<torques::During>(&torque);
      const double first = scene_.t0() - all.before, last = scene_.t0() + all.after;
      const auto meets = [=](const torques::Window& one) { return one.begin < last && one.end > first; };
      if (during == nullptr || std::any_of(during->windows().begin(), during->windows().end(), meets))
        acting.push_back(torque);
    }
    all.torques = summarize(acting);
    all.turns = turns_, all.stiffness = 0.0, all.decay = 0.0, all.may_spin_up = false;
    for (const Facts& one : facts_) all.stiffness += one.stiffness, all.decay = std::max(all.decay, one.decay);
    return all;
  }

  const Scene& scene_;
  const Pieces& pieces_;
  const SolveOptions& options_;
  std::vector<double> sorted_;
  std::vector<PiecePlan> plans_;   // in the order of the run, backward pieces first
  std::vector<Facts> facts_;
  const ode::MethodRecord* main_ = nullptr;
  double turns_ = 0.0, coarse_ = 0.0;
};

const PiecePlan& find_plan(const Plan& plan, const Scene& piece) {
  const double middle = piece.t0() + 0.5 * (piece.times().back() - piece.t0());
  for (const PiecePlan& one : plan.pieces) {
    if (middle <= one.end) return one;
  }
  return plan.pieces.back();
}

/// A piece that begins with rates of which no sample tells begins at rest: a torque that acts anew would take its first
/// step by their own size, far below the spacing of the times.
std::optional<Scene> stop(const Scene& piece, const Scene& whole, double rtol) {
  double span = 0.0;
  for (const double t : whole.times()) span = std::max(span, std::abs(t - whole.t0()));
  const double rate = piece.omega().norm();
  if (piece.t0() == whole.t0() || rate == 0.0 || !(rate < 0.01 * rtol * std::min(whole.omega().norm(), 1 / span)))
    return std::nullopt;
  return Scene(SceneParts{.inertia_B = piece.inertia_B(), .attitude = piece.attitude(), .torques = piece.torques(),
                          .times = piece.times(), .want = piece.want(), .t0 = piece.t0(), .name = piece.name()});
}

}  // namespace

PiecesPlan plan_pieces(const Scene& scene, const Pieces& pieces, const SolveOptions& options) {
  return Planner(scene, pieces, options).plan();
}

Motion run_by_plan(const Scene& scene, const RunOptions& options, const Plan& plan, bool shaken) {
  std::vector<double> handovers;
  for (const PiecePlan& one : plan.pieces) {
    if (one.handed_over) handovers.push_back(one.begin);
  }
  return run_pieces(
      scene, cut(scene, std::move(handovers)), options.asked,
      [&](const Scene& piece, const SolveOptions& asked) {
        const PiecePlan& one = find_plan(plan, piece);
        std::string name = one.method;
        if (one.method == "exact") {
          const Facts facts = compute_facts(piece);
          if (std::optional<ClosedForm> form = find_closed_form(piece, facts)) {
            const Plan exact = make_exact_plan(piece, *form, facts, asked);
            return solve_exactly(piece, facts, asked, *std::move(form), exact);
          }
          name = choose_method(piece, facts, asked).name;   // moved inputs may have lost what the closed form asks for
        }
        const BodyMethod& method = find_body_method(name);
        const double rtol = std::max(options.tolerances.rtol * one.rtol_scale, method.record.least_rtol);
        const std::optional<Scene> stopped = stop(piece, scene, rtol);
        const Scene& begun = stopped ? *stopped : piece;
        Motion motion = method.solve(begun, RunOptions{asked, {rtol, find_atol(method.record, scene, rtol)}});
        const bool stuck =
            motion.status == Status::failed && motion.stats.steps == 0;   // its first step was below the times' spacing
        if (!stuck || name == "taylor" || !compute_refusal("taylor", begun).empty()) return motion;
        return taylor_method.solve(
            begun, RunOptions{asked, {std::max(options.tolerances.rtol, taylor_method.record.least_rtol)}});
      },
      shaken);
}

Motion solve_exact_pieces(const Scene& scene, const SolveOptions& options, const Plan& plan) {
  Motion motion = run_by_plan(scene, RunOptions{options, {}}, plan, false);
  motion.plan = plan;
  motion.asked = plan.accuracy;
  constexpr std::size_t most = 256;   // samples that are compared: the error grows along the span
  const std::size_t n = motion.t.size(), stride = std::max<std::size_t>(1, n / most);
  std::vector<double> times, omega, attitude;
  for (std::size_t i = (n - 1) % stride; i < n; i += stride) {
    times.push_back(motion.t[i]);
    if (!motion.omega.empty())
      omega.insert(omega.end(), motion.omega.begin() + static_cast<std::ptrdiff_t>(3 * i),
                   motion.omega.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
    if (!motion.attitude.empty())
      attitude.insert(attitude.end(), motion.attitude.begin() + static_cast<std::ptrdiff_t>(4 * i),
                      motion.attitude.begin() + static_cast<std::ptrdiff_t>(4 * i + 4));
  }
  if (!times.empty()) {
    SolveOptions quiet = options;
    quiet.dense = false, quiet.events.clear(), quiet.progress = {};
    const Scene moved = perturb(Scene(SceneParts{.inertia_B = scene.inertia_B(),
                                                 .omega = scene.omega(),
                                                 .attitude = scene.attitude(),
                                                 .torques = scene.torques(),
                                                 .times = std::move(times),
                                                 .want = scene.want(),
                                                 .t0 = scene.t0()}));
    const Motion other = run_by_plan(moved, RunOptions{quiet, {}}, plan, true);
    const auto data = [](const std::vector<double>& v) { return v.empty() ? nullptr : v.data(); };
    motion.error +=
        1.5 * compute_distance(other.t.size(), data(omega), data(attitude), data(other.omega), data(other.attitude));
  }
  ++motion.runs;
  motion.error_kind = motion.error <= motion.asked ? "bounded" : "limit";
  if (motion.message.empty()) {
    motion.message = "evaluated at every time by the closed forms of " + std::to_string(plan.pieces.size()) +
                     " pieces; what rounding at their ends does bounds the error";
  }
  if (motion.error > motion.asked && motion.status == Status::finished) {
    motion.message.append("; float64 allows ")
        .append(to_text(motion.error))
        .append(", not the ")
        .append(to_text(motion.asked));
    motion.message += " asked";
  }
  return motion;
}

}  // namespace polhode
