#include "solve/plan/plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "method/method.hpp"
#include "polhode/core/error.hpp"
#include "solve/plan/candidates.hpp"
#include "solve/run/exact_run.hpp"
#include "solve/ground/options.hpp"
#include "solve/run/join_pieces.hpp"
#include "solve/ground/pilot.hpp"

namespace polhode {
namespace {

constexpr int rate_samples = 16;        // samples of |omega| in a piece, to estimate its revolutions
// Steps of the pilot run in one piece, and in all. Pieces that it does not reach are planned from the scene's start.
constexpr long piece_pilot_steps = 20'000, all_pilot_steps = 100'000, custom_pilot_steps = 1000;

// The error that the finest run of taylor states is below this, times one more than the revolutions.
constexpr double carried_rounding = 4e-13;

/// What decides between a closed form and steps.
struct PieceWork {
  double turns = 0.0;
  const ClosedFormRecord* form = nullptr;   ///< the closed form that holds
  int error_set_ups = 0;   ///< that a bound of the closed form's error takes

  /// Steps may take less time than the closed form.
  bool may_be_stepped() const { return form != nullptr && form->slow_set_up; }
};

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
    if (may_step_slow_forms()) step_slow_forms_ = expect_cheaper_steps();
    run_pilot();
    if (may_step_slow_forms()) reconsider_slow_forms();
    choose_tolerances();
    predict_closed_forms();
    Plan& plan = decision_.plan;
    plan = {.model = options_.formulation == Formulation::euler ? "pieces" : "lagrangian",
            .method = main_ == nullptr ? "exact" : std::string(main_->name),
            .state = carries_attitude(scene_, decision_.pieces, options_) ? "omega, attitude" : "omega",
            .accuracy = get_accuracy(options_),
            .certify = options_.certify,
            .predicted_seconds = solve_seconds + piece_seconds * static_cast<double>(pieces_.size())};
    decision_.facts = sum_facts();
    for (Piece* piece : pieces_) {
      plan.predicted_seconds += piece->plan.predicted_seconds;
      decision_.turns += piece->plan.turns;
      plan.pieces.push_back(piece->plan);
    }
    if (main_ == nullptr) {
      plan.predicted_error = 20 * std::numeric_limits<double>::epsilon() * (1 + decision_.turns);
    } else {
      const double compared = std::max(coarse_, pair_ratio * main_->least_rtol);
      const bool carried = find_body_method(main_->name).carries_error;
      const double ratio = carried ? find_carried_ratio(get_accuracy(options_)) : pair_ratio;
      plan.rtol = std::max(coarse_ / ratio, main_->least_rtol);
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
      if (find_closed_form_record(part, facts) != nullptr) continue;
      throw InvalidInput("method 'exact'", "used with pieces that all have a closed form",
                         "one without, " + describe_span(*piece),
                         explain_no_closed_form(part, facts) + "; leave method out");
    }
  }

  /// The scene of a piece, if it began with the scene's rates and attitude.
  Scene make_part(const Piece& piece) const {
    State start = scene_.start();
    start.t = piece.begin;
    return make_piece_scene(scene_, piece, start, {piece.end}, scene_.want());
  }

  bool may_step_slow_forms() const {
    // A closed form keeps the angular momentum, and so do those of all constant pieces of a body that changes.
    return method_is_free(options_) && options_.formulation == Formulation::euler && !scene_.changes() &&
           std::any_of(pieces_.begin(), pieces_.end(), [](const Piece* piece) {
             return !piece->rotors.empty() && summarize(piece->torques).acting == 0;
           });
  }

  /// Before the pilot run: from the rates of the scene's start.
  bool expect_cheaper_steps() const {
    std::vector<PieceWork> work;
    for (const Piece* piece : pieces_) {
      const double span = std::abs(piece->end - piece->begin);
      PieceWork one{.turns = scene_.omega().norm() * span / (2 * std::numbers::pi)};
      if (summarize(piece->torques).acting == 0) {
        const Scene part = make_part(*piece);
        const Facts facts = compute_facts(part);
        one.form = find_closed_form_record(part, facts);
        if (one.may_be_stepped()) one.turns = facts.turns, one.error_set_ups = one.form->count_error_set_ups(part, facts);
      }
      work.push_back(one);
    }
    return are_steps_cheaper(work);
  }

  /// After the pilot run, with the revolutions that it found.
  void reconsider_slow_forms() {
    const bool before = step_slow_forms_;
    step_slow_forms_ = are_steps_cheaper(work_);
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (!work_[i].may_be_stepped()) continue;
      decision_.slow_forms += step_slow_forms_;
      if (step_slow_forms_ == before) continue;
      PiecePlan& plan = pieces_[i]->plan;
      pieces_[i]->form = step_slow_forms_ ? nullptr : work_[i].form;
      plan.model = step_slow_forms_ ? "euler" : work_[i].form->name;
      plan.method = step_slow_forms_ ? choose_piece_method(make_part(*pieces_[i]), facts_[i]) : "exact";
    }
  }

  /// Some closed forms take long to set up, and several set-ups bound the error. Where the pieces are short, steps take
  /// less. The decision holds for all pieces with such forms, because a chain without steps loses fewer digits.
  bool are_steps_cheaper(const std::vector<PieceWork>& work) const {
    const ode::MethodRecord& record = find_method("taylor");
    double turns = 0.0, forms = 0.0, steps = 0.0;
    for (const PieceWork& one : work) turns += one.turns;
    const double accuracy = get_accuracy(options_);
    if (carried_rounding * (1 + turns) * (1 + turns / record.forecast.secular) > accuracy) return false;
    const double rtol = record.forecast.find_rtol(accuracy, turns) / find_carried_ratio(accuracy);
    const bool all_forms = std::all_of(work.begin(), work.end(), [](const PieceWork& one) { return one.form != nullptr; });
    for (const PieceWork& one : work) {
      if (!one.may_be_stepped()) continue;
      forms += predict_closed_form(*one.form, count_set_ups(one, all_forms), 0.0, options_.cost_factors);
      const auto step = [&](double tolerance) {
        return record.forecast.compute_seconds(std::max(tolerance, record.least_rtol), one.turns, 0.0, 0.0);
      };
      steps += step(rtol) * (options_.certify ? carried_cost : 1.0) + step(pilot_rtol);
    }
    return steps * find_factor(options_.cost_factors, "taylor") < forms;
  }

  /// The closed forms that are made for a piece by the pilot run, by the run, and by the second run that bounds the
  /// error. A carried error takes two changed starts. Where all pieces have closed forms, both runs state a bound.
  int count_set_ups(const PieceWork& work, bool all_forms) const {
    const int bounded = 1 + work.error_set_ups;
    if (all_forms) return 1 + 2 * bounded + 2;
    return 1 + bounded + (options_.certify ? 2 : 0);
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
      plan_piece(make_part(*pieces_[facts_.size()]));
    }
  }

  /// Pieces are run in the order of pieces_.
  Motion run_pilot_piece(const Scene& part, const SolveOptions& options) {
    PiecePlan& plan = plan_piece(part);
    Facts& facts = facts_.back();
    if (plan.method == "exact") {
      Plan unbounded;   // a pilot run needs no error
      unbounded.model = plan.model, unbounded.method = plan.method;
      return run_closed_form(part, facts, options, std::move(form_), unbounded);
    }
    SolveOptions limited = options;
    limited.max_steps = std::max(1L, std::min({piece_pilot_steps, left_, options_.max_steps}));
    Motion motion(find_body_method(plan.method).integrate(part, to_run_options(limited, {pilot_rtol})));
    left_ -= motion.stats.steps + motion.stats.rejected;
    if (motion.status == Status::finished)
      plan.turns = facts.turns = work_.back().turns =
          measure_rotation(motion, part.t0(), part.omega().norm()).revolutions();
    return motion;
  }

  PiecePlan& plan_piece(const Scene& part) {
    Piece& piece = *pieces_[facts_.size()];
    PiecePlan& plan = piece.plan;
    const Facts facts = compute_facts(part);
    const auto [begin, end] = std::minmax({part.t0(), part.times().back()});
    plan = {.begin = begin, .end = end, .model = "euler", .turns = facts.turns};
    plan.torques = piece.names;
    for (const AnyTorque& torque : part.torques()) {
      if (!piece.changes && !traits(torque).vanishes) plan.torques.emplace_back(torque_name(torque));
    }
    const Momentum momentum = find_momentum(scene_, piece, piece.begin);
    const bool moves = piece.body.momentum && !Changing::compute_vector(*piece.body.momentum, piece.begin).isZero(0.0);
    if (moves) plan.torques.emplace_back("momentum");
    if (!momentum.h.isZero(0.0) && !scene_.rotors().empty()) plan.torques.emplace_back("rotors");
    form_.reset();
    const ClosedFormRecord* record =
        method_is_free(options_) || options_.method == "exact" ? find_closed_form_record(part, facts) : nullptr;
    PieceWork work{.turns = facts.turns, .form = record};
    if (record != nullptr && !(step_slow_forms_ && record->slow_set_up)) form_ = record->make(part, facts);
    piece.form = form_ ? &form_->record() : nullptr;
    if (form_) {
      plan.model = form_->name(), plan.method = "exact";
    } else {
      plan.method = choose_piece_method(part, facts);
      if (options_.formulation == Formulation::lagrangian) plan.model = "lagrangian";
      else if (piece.changes) plan.model = "changing";
    }
    if (record != nullptr) work.error_set_ups = record->count_error_set_ups(part, facts);
    facts_.push_back(facts);
    work_.push_back(work);
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
      const double seconds =
          predict(record, plan.rtol_scale * coarse_, facts_[i]) * find_factor(options_.cost_factors, record.name);
      plan.predicted_seconds = (seconds + piece_seconds) * (options_.certify ? 2 : 1);
    }
  }

  /// The runs of the pieces that have closed forms, with those that bound the error.
  void predict_closed_forms() {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      PiecePlan& plan = pieces_[i]->plan;
      if (plan.method != "exact") continue;
      const auto samples = std::upper_bound(sorted_.begin(), sorted_.end(), std::max(plan.begin, plan.end)) -
                           std::lower_bound(sorted_.begin(), sorted_.end(), std::min(plan.begin, plan.end));
      plan.predicted_seconds =
          predict_closed_form(*pieces_[i]->form, count_set_ups(work_[i], main_ == nullptr), static_cast<double>(samples),
                              options_.cost_factors) +
          piece_seconds * (main_ == nullptr || options_.certify ? 2 : 1);
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
  std::vector<PieceWork> work_;        // of the same pieces
  std::shared_ptr<const ClosedForm> form_;     // of the piece that was planned last
  bool step_slow_forms_ = false;
  const ode::MethodRecord* main_ = nullptr;
  double turns_ = 0.0, coarse_ = 0.0, call_seconds_ = 0.0;
  long left_ = 0;                      // steps of the pilot run
};

}  // namespace

void plan_pieces(Decision& decision, const SolveOptions& options) { PiecePlanner(decision, options).plan(); }

}  // namespace polhode
