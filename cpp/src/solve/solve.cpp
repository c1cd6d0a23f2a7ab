#include "polhode/solve/solve.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "method/series/switched_series.hpp"
#include "polhode/core/error.hpp"
#include "polhode/solve/invariants.hpp"
#include "polhode/solve/plan.hpp"
#include "solve/ground/custom_check.hpp"
#include "solve/plan/leave_out.hpp"
#include "solve/plan/plan.hpp"
#include "solve/certify/certify.hpp"
#include "solve/ground/formulas.hpp"
#include "solve/ground/options.hpp"
#include "solve/ground/pieces.hpp"
#include "solve/run/keep_momentum.hpp"

namespace polhode {

namespace {

constexpr int most_divisions = 2;   // of a span whose torque is found to jump
constexpr std::size_t shown_breaks = 4;

/// No error is stated of samples that are not numbers.
void refuse_samples(Motion& motion) {
  motion.status = Status::failed;
  motion.error = std::numeric_limits<double>::quiet_NaN();
  motion.error_kind = "not estimated";
  motion.message = "samples are not finite: the motion is beyond the range of float64";
}

/// Says in the message where the span was divided.
void describe_breaks(std::vector<double> breaks, Motion& motion) {
  std::sort(breaks.begin(), breaks.end());
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  motion.found_breaks = std::move(breaks);
  if (motion.found_breaks.empty()) return;
  std::string text = "your torque jumps or kinks at t = ";
  for (std::size_t i = 0; i < std::min(motion.found_breaks.size(), shown_breaks); ++i) {
    if (i > 0) text += ", ";
    text += to_text(motion.found_breaks[i]);
  }
  if (motion.found_breaks.size() > shown_breaks)
    text += " and " + std::to_string(motion.found_breaks.size() - shown_breaks) + " more times, in";
  text += " s, where the span was divided; give these times as breaks= of Custom, or use np.where in a Formula, "
          "or During";
  motion.message += (motion.message.empty() ? "" : "; ") + text;
}

using Clock = std::chrono::steady_clock;

double find_seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Carries out a decision. Where a torque of the user's own is found to jump, the span is divided there, decided and run
/// again.
Motion run_divided(std::shared_ptr<const Decision> decision, const SolveOptions& options) {
  std::vector<double> breaks;
  ode::Counts before;
  int runs = 0;
  for (int divisions = 0;; ++divisions) {
    breaks.insert(breaks.end(), decision->probes.breaks.begin(), decision->probes.breaks.end());
    Motion motion = execute(*decision, options);
    motion.stats += before;
    motion.runs += runs;
    const std::vector<double>& found = motion.found_breaks;
    breaks.insert(breaks.end(), found.begin(), found.end());
    if (!decision->may_cut || found.empty() || motion.status == Status::stopped) {
      describe_breaks(std::move(breaks), motion);
      return motion;
    }
    Decision divided = decide(add_breaks(decision->scene, found), options);
    divided.may_cut = divisions + 1 < most_divisions;
    before = motion.stats;
    before += divided.pilot;
    runs = motion.runs;
    decision = std::make_shared<const Decision>(std::move(divided));
  }
}

}  // namespace

PlannedScene::PlannedScene(const Scene& given, const SolveOptions& options) : options_(options) {
  const auto begin = Clock::now();
  std::vector<std::string> recognised;
  // Series end their steps at switches; other methods step over them, as over the jumps of a Custom torque.
  const bool by_series = options.formulation == Formulation::euler &&
                         (options.method ? options.method == "taylor" : !is_by_tolerance(options));
  std::vector<AnyTorque> torques = given.torques();
  // A recognised torque may differ from its formula by rounding, and a proof is about exactly the formula's numbers.
  if (options.proof) std::transform(torques.begin(), torques.end(), torques.begin(), as_given);
  const Scene scene = resolve_formulas(options.proof ? given.with_torques(std::move(torques)) : given,
                                       by_series ? AsCustom::no : AsCustom::yes, &recognised);
  check_options(scene, options);
  check_torques(scene);
  Decision decision = decide(scene, options);
  if (!decision.left_out.empty()) number_as_given(given, decision.left_out);
  decision.recognised = std::move(recognised);
  decision.crosses_switches = !by_series && has_switches(given);
  decision_ = std::make_shared<const Decision>(std::move(decision));
  options_.events.clear();
  options_.progress = {};
  if (options.cost_factors != nullptr) {
    cost_factors_ = std::make_shared<const CostFactors>(*options.cost_factors);
    options_.cost_factors = cost_factors_.get();
  }
  cost_ = decision_->pilot;
  cost_.seconds = find_seconds_since(begin);
}

const Plan& PlannedScene::plan() const { return decision_->plan; }

PlanReport PlannedScene::explain() const { return polhode::explain(*decision_, options_); }

Motion PlannedScene::run(const SolveOptions& options) const {
  const auto begin = Clock::now();
  SolveOptions run = options_;
  run.max_steps = options.max_steps, run.dense = options.dense;
  run.events = options.events, run.progress = options.progress;
  check_options(decision_->scene, run);
  Motion motion = run.proof ? prove(*decision_, run) : run_divided(decision_, run);
  if (!motion.all_finite()) refuse_samples(motion);
  else keep_momentum(decision_->scene, motion);
  for (const LeftOut& left : decision_->left_out) motion.message.append("; ").append(describe(left));
  motion.stats.seconds = find_seconds_since(begin);
  return motion;
}

Motion solve(const Scene& scene, const SolveOptions& options) {
  const PlannedScene planned(scene, options);
  Motion motion = planned.run(options);
  motion.stats += planned.cost();
  return motion;
}

Plan make_plan(const Scene& scene, const SolveOptions& options) { return PlannedScene(scene, options).plan(); }

PlanReport explain_plan(const Scene& scene, const SolveOptions& options) {
  return PlannedScene(scene, options).explain();
}

bool succeeded(const Scene& scene, const Motion& motion) {
  if (motion.status != Status::finished && motion.status != Status::event) return false;
  if (!motion.all_finite()) return false;
  if (!std::isnan(motion.error)) return motion.error <= motion.asked;
  for (const auto& [name, drift] : compute_drift(scene, motion)) {
    if (!(drift <= motion.asked)) return false;
  }
  return true;
}

}  // namespace polhode
