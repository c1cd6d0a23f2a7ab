#include "polhode/solve/solve.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "polhode/solve/invariants.hpp"
#include "solve/custom_check.hpp"
#include "solve/decide.hpp"
#include "solve/execute.hpp"
#include "solve/options.hpp"
#include "solve/pieces.hpp"
#include "solve/prove.hpp"

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
  text += " s, where the span was divided; give these times as breaks= of Custom";
  motion.message += (motion.message.empty() ? "" : "; ") + text;
}

Motion solve_planned(const Scene& scene, const SolveOptions& options) {
  Scene divided = scene;
  std::vector<double> breaks;
  ode::Counts before;
  int runs = 0;
  for (int round = 0;; ++round) {
    Decision decision = decide(divided, options);
    decision.may_cut = round < most_divisions;
    breaks.insert(breaks.end(), decision.looks.breaks.begin(), decision.looks.breaks.end());
    Motion motion = execute(decision, options);
    motion.stats += decision.pilot;
    motion.stats += before;
    motion.runs += runs;
    const std::vector<double>& found = motion.found_breaks;
    breaks.insert(breaks.end(), found.begin(), found.end());
    const bool again = decision.may_cut && !found.empty() && motion.status != Status::stopped;
    if (!again) {
      describe_breaks(std::move(breaks), motion);
      return motion;
    }
    before = motion.stats;
    runs = motion.runs;
    divided = add_breaks(divided, found);
  }
}

}  // namespace

Motion solve(const Scene& scene, const SolveOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  check_options(scene, options);
  check_torques(scene);
  Motion motion = options.proof ? prove(scene, options) : solve_planned(scene, options);
  if (!motion.all_finite()) refuse_samples(motion);
  motion.stats.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return motion;
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
