#include "solve/certify/pair.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/math/detail/functions.hpp"
#include "solve/plan/candidates.hpp"
#include "solve/ground/distance.hpp"
#include "solve/ground/options.hpp"
#include "solve/ground/pilot.hpp"
#include "solve/run/perturb.hpp"

namespace polhode {
namespace {

constexpr std::size_t least_samples = 8;   // fewer differences may be small by chance
constexpr int perturbed_units = 8;         // in the last place: more than the rounding of the finer run
constexpr int stiff_order = 2;             // of an implicit method in a stiff body: below its stage order, 3
constexpr double rounding_floor = 8.0;     // units of rounding that two runs may share, and the root of their steps
constexpr double claimed_part = 8.0;       // times the error that the numbers of steps give
constexpr double chance = 1.0 / 128;       // of the finer tolerance: two runs may agree better by chance
constexpr double most_factor = 30.0;       // of runs with the same steps
constexpr double alike_factor = 10.0;      // of runs with almost the same steps: their errors may be alike, too
constexpr double another_part = 0.7;       // of the coarse tolerance: another sample of the error
constexpr long few_steps = 30;             // errors do not yet fall by the order of the method
constexpr long most_steps_of_another = 20'000;
constexpr double rounding_rtol = 1e-13;    // below it, rounding is a part of each run's error: no factor shows it
constexpr double failed_look_rtol = 1e-4;
constexpr double jump_factor = 4.0;        // of runs whose torque jumps within steps
constexpr double rounding_factor = 4.0;    // measured: the error is up to 3.7 differences there

double find_difference(double start_rate, const Motion& a, const Motion& b) {
  return compute_distance(a.t.size(), start_rate, get_data(a.omega), get_data(a.attitude), get_data(b.omega),
                          get_data(b.attitude));
}

Scene with_times(const Scene& scene, std::vector<double> times) {
  SceneParts parts = scene.parts();
  parts.times = std::move(times);
  return Scene(std::move(parts));
}

}  // namespace

PairCertificate::PairCertificate(CountedRuns& runs, double safety)
    : runs_(runs), safety_(safety), comparison_options_(runs.options()) {
  comparison_options_.dense = false;
  comparison_options_.events.clear();
  const Scene& scene = runs.decision().scene;
  if (scene.times().size() < least_samples && runs.decision().facts.span() > 0) {
    std::vector<double> times = scene.times();
    const std::vector<double> more = spread_times(scene, runs.decision().facts, static_cast<int>(least_samples));
    times.insert(times.end(), more.begin(), more.end());
    longer_ = with_times(scene, std::move(times));
  }
  must_probe_ = calls_custom(scene) && runs.decision().facts.span() > 0 && !runs.decision().probed;
  if (runs.decision().probed) probes_ = runs.decision().probes;
  perturbed_ = perturb(longer_ ? *longer_ : scene, perturbed_units);
}

Scene PairCertificate::add_probes(const Scene& scene) const {
  SceneParts parts = scene.parts();
  const auto [least, most] = std::minmax_element(parts.times.begin(), parts.times.end());
  const std::vector<double> probes = spread_probes(std::min(*least, scene.t0()), std::max(*most, scene.t0()));
  parts.times.insert(parts.times.end(), probes.begin(), probes.end());
  parts.want = {true, parts.want.attitude || runs_.decision().facts.torques.uses_attitude};
  return Scene(std::move(parts));
}

/// A torque that jumps may have ended the run. A coarse run passes most jumps.
void PairCertificate::probe_after_failure() {
  const Scene scene = add_probes(runs_.decision().scene);
  const Motion motion = runs_.run(scene, comparison_options_, failed_look_rtol);
  must_probe_ = false;
  if (motion.status != Status::finished) return;
  probes_ = probe(runs_.decision().scene, motion, runs_.decision().scene.times().size(), 1.0);
}

/// The factor between a difference and the error of the finer run. If the error falls by r from one run to the other,
/// it is r / (1 - r) of the difference; eight times that is claimed. r follows from the numbers of steps.
double PairCertificate::find_factor(const Motion& fine, const Motion& coarse) const {
  const ode::MethodRecord& record = runs_.method().record;
  const std::vector<const Piece*> pieces = runs_.decision().pieces.all();
  const bool stiff = std::any_of(pieces.begin(), pieces.end(), [](const Piece* piece) {
    return piece->plan.method != "exact" && find_method(piece->plan.method).implicit;
  });
  if (!stiff && (record.adaptive_order || !pieces.empty())) return safety_;
  const double steps = static_cast<double>(coarse.stats.steps) / static_cast<double>(std::max(fine.stats.steps, 1L));
  const double r = math::power(std::min(steps, 1.0), stiff || record.implicit ? stiff_order : record.order);
  return std::clamp(claimed_part * r / (1 - r), safety_, stiff ? most_stiff_factor : most_factor);
}

Attempt PairCertificate::run(double coarse, double fine) {
  const Scene& scene = runs_.decision().scene;
  const double accuracy = runs_.decision().plan.accuracy;
  Attempt attempt{.motion = runs_.run(longer_ ? *longer_ : scene, runs_.options(), fine)};
  Motion& motion = attempt.motion;
  motion.rtol_used = fine;
  const double formulas = std::isnan(motion.error) ? 0.0 : motion.error;   // of the pieces with closed forms
  if (must_probe_ && motion.status == Status::failed) probe_after_failure();
  if (!attempt.finished() || motion.t.empty()) return attempt;
  // After a terminal event the remaining times have no samples: they are not compared.
  const bool whole = motion.t.size() == perturbed_->times().size();
  const Scene compared = whole ? *perturbed_ : with_times(*perturbed_, motion.t);
  const Motion other =
      runs_.run(must_probe_ ? add_probes(compared) : compared, comparison_options_, coarse, true);
  if (other.status == Status::stopped) {
    motion.status = Status::stopped;
    motion.message = "stopped by the progress callback before the error was certified";
  } else if (other.status == Status::finished) {
    if (must_probe_) probes_ = probe(scene, other, motion.t.size(), accuracy);
    must_probe_ = false;
    double factor = find_factor(motion, other);
    if (!std::isnan(probes_.state_jump) || probes_.too_many) factor = std::max(factor, jump_factor);
    if (fine < rounding_rtol) factor = std::max(factor, rounding_factor);
    double difference = find_difference(scene.omega().norm(), motion, other);
    // Two samples of an error that follows no law may agree by chance: of rounding that grows, and of few steps.
    // Calls of the user's own torque cost too much for that.
    const bool erratic = !runs_.method().record.adaptive_order && other.stats.steps < few_steps;
    if ((fine < rounding_rtol || erratic) && !calls_custom(scene)) {
      const Motion another = runs_.run(compared, comparison_options_, another_part * coarse, true);
      if (another.status == Status::finished)
        difference = std::max(difference, find_difference(scene.omega().norm(), motion, another));
    }
    // Runs with the same steps share their error, and so may stiff ones. A run by another method does not.
    const bool alike = factor >= alike_factor, stiff = runs_.method().record.implicit;
    if ((alike || stiff) && runs_.decision().pieces.size() == 0) {
      const BodyMethod& method = find_body_method(runs_.decision().plan.method == "dop853" ? "rk45" : "dop853");
      const long most_steps =
          alike ? most_steps_of_another : static_cast<long>(count_third_steps(static_cast<double>(motion.stats.steps)));
      const Motion third = runs_.run_by(method, whole ? *perturbed_ : with_times(*perturbed_, motion.t),
                                        comparison_options_, fine, most_steps);
      if (third.status == Status::finished) {
        difference = std::max(difference, find_difference(scene.omega().norm(), motion, third));
        factor = safety_;
      }
    }
    // Runs that settle to the same path may share their rounding, which walks at random.
    const double units = rounding_floor + std::sqrt(static_cast<double>(motion.stats.steps));
    const double least = units * std::numeric_limits<double>::epsilon() + chance * fine;
    if (difference < unknown_error) attempt.error = factor * difference + least + formulas;
    if (!(attempt.error <= accuracy)) {
      attempt.holds_until =
          find_divergence_time(motion.t.size(), motion.t.data(), scene.t0(), scene.omega().norm(),
                               get_data(motion.omega), get_data(motion.attitude), get_data(other.omega),
                               get_data(other.attitude), accuracy / (limit_safety * factor));
    }
  }
  return attempt;
}

void PairCertificate::drop_added_times(Motion& motion) const {
  if (!longer_) return;
  const std::size_t asked = runs_.decision().scene.times().size();
  const std::vector<double>& times = longer_->times();
  std::size_t kept = 0, row = 0;
  for (std::size_t i = 0; i < asked && row < motion.t.size(); ++i) {
    if (times[i] == motion.t[row]) ++row, ++kept;
  }
  motion.t.resize(kept);
  if (!motion.omega.empty()) motion.omega.resize(3 * kept);
  if (!motion.attitude.empty()) motion.attitude.resize(4 * kept);
}

}  // namespace polhode
