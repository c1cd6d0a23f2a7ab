#include "solve/certify_pair.hpp"

#include <cmath>

#include "solve/distance.hpp"
#include "solve/perturb.hpp"

namespace polhode {
namespace {

constexpr std::size_t least_samples = 8;   // fewer differences may be small by chance

const double* data(const std::vector<double>& values) { return values.empty() ? nullptr : values.data(); }

Scene with_times(const Scene& scene, std::vector<double> times) {
  SceneParts parts = scene.parts();
  parts.times = std::move(times);
  return Scene(std::move(parts));
}

}  // namespace

std::vector<double> spread_times(const Decision& decision, int count) {
  const Facts& facts = decision.facts;
  std::vector<double> times;
  for (int i = 0; i <= count; ++i) times.push_back(decision.scene.t0() - facts.before + facts.span() * i / count);
  return times;
}

PairCertificate::PairCertificate(CountedRuns& runs, double safety)
    : runs_(runs), safety_(safety), comparison_options_(runs.options()) {
  comparison_options_.dense = false;
  comparison_options_.events.clear();
  const Scene& scene = runs.decision().scene;
  if (scene.times().size() < least_samples && runs.decision().facts.span() > 0) {
    std::vector<double> times = scene.times();
    const std::vector<double> more = spread_times(runs.decision(), static_cast<int>(least_samples));
    times.insert(times.end(), more.begin(), more.end());
    longer_ = with_times(scene, std::move(times));
  }
  perturbed_ = perturb(longer_ ? *longer_ : scene);
}

Attempt PairCertificate::run(double coarse, double fine) {
  const Scene& scene = runs_.decision().scene;
  const double accuracy = runs_.decision().plan.accuracy;
  Attempt attempt{.motion = runs_.run(longer_ ? *longer_ : scene, runs_.options(), fine)};
  Motion& motion = attempt.motion;
  motion.rtol_used = fine;
  const double formulas = std::isnan(motion.error) ? 0.0 : motion.error;   // of the pieces with closed forms
  if (!attempt.finished() || motion.t.empty()) return attempt;
  // After a terminal event the remaining times have no samples: they are not compared.
  const bool whole = motion.t.size() == perturbed_->times().size();
  const Motion other =
      runs_.run(whole ? *perturbed_ : with_times(*perturbed_, motion.t), comparison_options_, coarse, true);
  if (other.status == Status::stopped) {
    motion.status = Status::stopped;
    motion.message = "stopped by the progress callback before the error was certified";
  } else if (other.status == Status::finished) {
    const double difference = compute_distance(motion.t.size(), scene.omega().norm(), data(motion.omega),
                                               data(motion.attitude), data(other.omega), data(other.attitude));
    if (difference < unknown_error) attempt.error = safety_ * difference + formulas;
    if (!(attempt.error <= accuracy)) {
      attempt.holds_until =
          find_divergence_time(motion.t.size(), motion.t.data(), scene.t0(), scene.omega().norm(), data(motion.omega),
                               data(motion.attitude), data(other.omega), data(other.attitude), accuracy / safety_);
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
