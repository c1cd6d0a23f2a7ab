#include "solve/plan_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "method/method.hpp"
#include "polhode/core/error.hpp"
#include "solve/candidates.hpp"
#include "solve/custom_pilot.hpp"
#include "solve/exact_run.hpp"
#include "solve/options.hpp"
#include "solve/piece_runner.hpp"
#include "solve/pilot.hpp"

namespace polhode {
namespace {

constexpr int rate_samples = 16;        // samples of |omega| in a piece, to estimate its revolutions
// Steps of the pilot run in one piece, and in all. Pieces that it does not reach are planned from the scene's start.
constexpr long piece_pilot_steps = 20'000, all_pilot_steps = 100'000, custom_pilot_steps = 1000;

/// Plans each piece when a pilot run reaches it.
class PiecePlanner {
 public:
  PiecePlanner(Decision& decision, const SolveOptions& options)
      : decision_(decision),
        scene_(decision.scene),
        options_(options),
        pieces_(decision.pieces.all()),
        sorted_(decision.scene.times()) {
    std::sort(sorted_.begin(), sorted_.end());
  }

  void plan() {
    if (options_.method == "exact") require_closed_forms();
    if (calls_custom(scene_)) call_seconds_ = measure_call_seconds(scene_);
    left_ = calls_custom(scene_) ? custom_pilot_steps : all_pilot_steps;
    run_pilot();
    choose_tolerances();
    Plan& plan = decision_.plan;
    plan = {.model = options_.formulation == Formulation::euler ? "pieces" : "lagrangian",
            .method = main_ == nullptr ? "exact" : std::string(main_->name),
            .state = carries_attitude(scene_, decision_.pieces, options_) ? "omega, attitude" : "omega",
            .accuracy = get_accuracy(options_),
            .certify = options_.certify,
            .predicted_seconds = solve_seconds + piece_seconds * static_cast<double>(pieces_.size())};
    decision_.facts = sum_facts();
    for (Piece* piece : pieces_) {
      piece->plan.predicted_seconds = (piece->plan.predicted_seconds + piece_seconds) * (options_.certify ? 2 : 1);
      plan.predicted_seconds += piece->plan.predicted_seconds;
      decision_.turns += piece->plan.turns;
      plan.pieces.push_back(piece->plan);
    }
    if (main_ == nullptr) {
      plan.predicted_error = 20 * std::numeric_limits<double>::epsilon() * (1 + decision_.turns);
    } else {
      const double compared = std::max(coarse_, pair_ratio * main_->least_rtol);
      plan.rtol = std::max(coarse_ / pair_ratio, main_->least_rtol);
      if (!options_.certify)
        plan.rtol = std::max(main_->forecast.find_median_rtol(get_accuracy(options_) / aim, turns_), main_->least_rtol);
      plan.predicted_error = main_->forecast.compute_error(options_.certify ? compared : plan.rtol, turns_);
    }
    std::sort(plan.pieces.begin(), plan.pieces.end(),
              [](const PiecePlan& a, const PiecePlan& b) { return a.begin < b.begin; });
  }

 private:
  void require_closed_forms() const {
    for (const Piece* piece : pieces_) {
      const Scene part = make_piece_scene(scene_, *piece, scene_.start(), {piece->end}, scene_.want());
      const Facts facts = compute_facts(part);
      if (find_closed_form(part, facts)) continue;
      throw InvalidInput("method 'exact'", "used with pieces that all have a closed form",
                         "one without, " + describe_span(*piece),
                         explain_no_closed_form(part, facts) + "; leave method out");
    }
  }

  /// Pieces that the pilot run did not reach are planned from the scene's start.
  void run_pilot() {
    SceneParts parts = scene_.parts();
    parts.times.clear();
    for (const Piece* piece : pieces_) {
      for (int i = 1; i <= rate_samples; ++i)
        parts.times.push_back(i == rate_samples ? piece->end
                                                : piece->begin + (piece->end - piece->begin) * i / rate_samples);
    }
    parts.want = {true, false};
    SolveOptions options;
    options.formulation = options_.formulation;
    options.progress = options_.progress;
    run_pieces(Scene(std::move(parts)), decision_.pieces, options,
               [this](const Scene& part, const Piece&, const SolveOptions& piece_options) {
                 return run_pilot_piece(part, piece_options);
               });
    while (facts_.size() < pieces_.size()) {
      const Piece& piece = *pieces_[facts_.size()];
      State start = scene_.start();
      start.t = piece.begin;
      plan_piece(make_piece_scene(scene_, piece, start, {piece.end}, scene_.want()));
    }
  }

  /// Pieces are run in the order of pieces_.
  Motion run_pilot_piece(const Scene& part, const SolveOptions& options) {
    PiecePlan& plan = plan_piece(part);
    Facts& facts = facts_.back();
    if (plan.method == "exact") {
      const std::optional<ClosedForm> form = find_closed_form(part, facts);
      return run_closed_form(part, facts, options, *form, make_exact_plan(part, *form, facts, options_));
    }
    SolveOptions limited = options;
    limited.max_steps = std::max(1L, std::min({piece_pilot_steps, left_, options_.max_steps}));
    Motion motion(find_body_method(plan.method).integrate(part, to_run_options(limited, {pilot_rtol})));
    left_ -= motion.stats.steps + motion.stats.rejected;
    if (motion.status == Status::finished)
      plan.turns = facts.turns = measure_rotation(motion, part.t0(), part.omega().norm()).revolutions();
    return motion;
  }

  PiecePlan& plan_piece(const Scene& part) {
    PiecePlan& plan = pieces_[facts_.size()]->plan;
    const Facts facts = compute_facts(part);
    const auto [begin, end] = std::minmax({part.t0(), part.times().back()});
    plan = {.begin = begin, .end = end, .model = "euler", .turns = facts.turns};
    for (const AnyTorque& torque : part.torques()) {
      if (!traits(torque).vanishes) plan.torques.emplace_back(torque_name(torque));
    }
    if (!part.rotor_momentum().isZero(0.0)) plan.torques.emplace_back("rotors");
    std::optional<ClosedForm> form;
    if (method_is_free(options_) || options_.method == "exact") form = find_closed_form(part, facts);
    if (form) {
      plan.model = form->model(), plan.method = "exact";
      const auto samples = std::upper_bound(sorted_.begin(), sorted_.end(), plan.end) -
                           std::lower_bound(sorted_.begin(), sorted_.end(), plan.begin);
      plan.predicted_seconds = predict_closed_form(plan.model, static_cast<double>(samples), options_.cost_factors);
    } else {
      plan.method = choose_piece_method(part, facts);
      if (options_.formulation == Formulation::lagrangian) plan.model = "lagrangian";
    }
    facts_.push_back(facts);
    return plan;
  }

  /// A chain is certified by one run if every piece carries its error, so such a method comes before one that is faster
  /// for the piece alone. Stiff pieces keep their method.
  std::string choose_piece_method(const Scene& part, const Facts& facts) const {
    std::string name = choose_method(part, facts, options_).name;
    const BodyMethod& method = find_body_method(name);
    const bool keeps = options_.method || !options_.certify || method.carries_error || method.record.implicit;
    const bool may = options_.formulation == Formulation::euler && compute_refusal("taylor", part).empty();
    return keeps || !may ? name : "taylor";
  }

  /// The tolerance for all pieces together. An error in the rates of one piece is an error in the phase of all later
  /// pieces. A piece with n revolutions, and `after` revolutions after it, has the error
  /// n (1 + (n + 2 after) / secular). Alone it would have n (1 + n / secular).
  void choose_tolerances() {
    double most = -1.0;
    const double accuracy = get_accuracy(options_);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const PiecePlan& plan = pieces_[i]->plan;
      if (plan.method == "exact") continue;
      const ode::MethodRecord& record = find_method(plan.method);
      const double seconds = predict(record, record.forecast.find_rtol(accuracy, facts_[i].turns), facts_[i]);
      if (seconds > most || std::isnan(seconds)) most = seconds, main_ = &record;
    }
    if (main_ == nullptr) return;
    double after = 0.0, sum = 0.0;
    const double secular = main_->forecast.secular;
    for (std::size_t i = pieces_.size(); i-- > 0;) {
      if (i + 1 == decision_.pieces.backward.size()) after = 0.0;   // the other direction begins at the start
      const double n = pieces_[i]->plan.turns;
      if (pieces_[i]->plan.method != "exact") sum += n * (1 + (n + 2 * after) / secular);
      after += n;
    }
    turns_ = secular / 2 * (std::sqrt(1 + 4 * sum / secular) - 1);
    coarse_ = main_->forecast.known() ? main_->forecast.find_rtol(accuracy, turns_) : accuracy / 10;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      PiecePlan& plan = pieces_[i]->plan;
      if (plan.method == "exact") continue;
      const ode::MethodRecord& record = find_method(plan.method);
      if (record.forecast.known() && main_->forecast.known())
        plan.rtol_scale = record.forecast.find_rtol(accuracy, turns_) / coarse_;
      plan.predicted_seconds =
          predict(record, plan.rtol_scale * coarse_, facts_[i]) * find_factor(options_.cost_factors, record.name);
    }
  }

  double predict(const ode::MethodRecord& record, double rtol, const Facts& facts) const {
    const double least = std::max(rtol, record.least_rtol);
    return record.forecast.compute_seconds(least, facts.turns, facts.stiffness, call_seconds_);
  }

  /// The facts of the whole span, from those of the pieces.
  Facts sum_facts() const {
    Facts all = compute_facts(scene_);
    std::vector<AnyTorque> acting;
    for (const AnyTorque& torque : scene_.torques()) {
      const auto* during = std::get_if<torques::During>(&torque);
      const double first = scene_.t0() - all.before, last = scene_.t0() + all.after;
      const auto meets = [=](const torques::Window& window) { return window.begin < last && window.end > first; };
      if (during == nullptr || std::any_of(during->windows().begin(), during->windows().end(), meets))
        acting.push_back(torque);
    }
    all.torques = summarize(acting);
    if (scene_.torque_sum().rotors) add_rotors(all.torques, scene_.torque_sum().steady_rotors);
    all.turns = turns_, all.stiffness = 0.0, all.decay = 0.0, all.may_spin_up = false, all.call_seconds = call_seconds_;
    for (const Facts& facts : facts_) {
      all.stiffness += facts.stiffness;
      all.decay = std::max(all.decay, facts.decay);
    }
    return all;
  }

  Decision& decision_;
  const Scene& scene_;
  const SolveOptions& options_;
  const std::vector<Piece*> pieces_;   // in the order of the run, backward pieces first
  std::vector<double> sorted_;
  std::vector<Facts> facts_;           // of the pieces that have been planned
  const ode::MethodRecord* main_ = nullptr;
  double turns_ = 0.0, coarse_ = 0.0, call_seconds_ = 0.0;
  long left_ = 0;                      // steps of the pilot run
};

}  // namespace

void plan_pieces(Decision& decision, const SolveOptions& options) { PiecePlanner(decision, options).plan(); }

}  // namespace polhode
