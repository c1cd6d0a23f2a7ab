#include "solve/certify/certify.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"
#include "solve/plan/candidates.hpp"
#include "solve/certify/runs.hpp"
#include "solve/certify/pair.hpp"
#include "solve/ground/pilot.hpp"
#include "solve/certify/run_pieces.hpp"

namespace polhode {
namespace {

constexpr int pilot_intervals = 48;        // of the span, to count the revolutions
constexpr double chaotic_safety = 2.5;     // after a first run whose error exceeds the accuracy
constexpr double give_up_factor = 30.0;    // times the accuracy: a run with a larger error is abandoned
constexpr double unstable_factor = 1e6;    // the same, for a run at the least tolerance: its series may be unstable
constexpr double near_least = 2.0;         // times the least tolerance: so close to it, a second run gains nothing
constexpr double loosest_implicit = 3e-3;

/// Repeats the run of one scene until its error is known and small enough.
class Certifier {
 public:
  Certifier(const Decision& decision, const SolveOptions& options)
      : decision_(decision), options_(options), runs_(decision, options), accuracy_(decision.plan.accuracy) {
    if (carries_error()) {
      ratio_ = find_carried_ratio(accuracy_);
    } else if (record().implicit || decision_.pieces.size() > 0) {
      ratio_ = wide_pair_ratio;
    }
    // Below these accuracies rounding matters, and the difference of two runs is a less reliable measure.
    if (accuracy_ <= 2e-12) {
      safety_ = carries_error() ? 3.0 : 5.0, ratio_ *= 3;
    } else if (accuracy_ <= 1e-10) {
      safety_ = 2.0;
    }
  }

  Motion solve() {
    const ode::Forecast& forecast = record().forecast;
    const double turns = find_turns();
    // Looser pairs of an implicit method seldom prove enough, and are hardly cheaper.
    const double aimed = record().implicit ? std::min(accuracy_, loosest_implicit) : accuracy_;
    double coarse = forecast.known() ? forecast.find_rtol(aimed, turns) : aimed / 10;
    coarse = std::clamp(coarse, ratio_ * record().least_rtol, 1e-2);
    if (!decision_.plan.certify) return expect(turns);
    if (!carries_error()) return certify_by_pairs(coarse);
    const double least = record().least_rtol, rtol = coarse / ratio_;
    return certify_carried(rtol < near_least * least ? least : rtol);
  }

 private:
  const ode::MethodRecord& record() const { return runs_.method().record; }

  /// A chain of pieces carries its error if each piece does; a closed form does (carry_through.hpp).
  bool carries_error() const {
    const std::vector<const Piece*> pieces = decision_.pieces.all();
    return runs_.method().carries_error && std::all_of(pieces.begin(), pieces.end(), [](const Piece* piece) {
             const std::string& name = piece->plan.method;
             return name == "exact" || find_body_method(name).carries_error;
           });
  }

  /// If a torque may spin the body up, a pilot run counts the revolutions. A method of adaptive order needs no pilot
  /// run, because a smaller tolerance costs it little.
  double find_turns() {
    const double expected = decision_.facts.work();
    if (!decision_.facts.may_spin_up || decision_.facts.piloted || record().adaptive_order) return expected;
    SolveOptions limited;
    limited.max_steps = options_.max_steps;
    limited.progress = options_.progress;
    SceneParts parts = decision_.scene.parts();
    parts.times = spread_times(decision_.scene, decision_.facts, pilot_intervals);
    parts.want = {true, false};
    const Attempt pilot{.motion = runs_.run(Scene(std::move(parts)), limited, pilot_rtol)};
    const Motion& motion = pilot.motion;
    if (!pilot.finished() || motion.t.empty()) return expected;
    const double rate = math::hypot(motion.omega[0], motion.omega[1], motion.omega[2]);
    const double turns = measure_rotation(motion, motion.t[0], rate).revolutions();
    return std::isfinite(turns) ? turns : expected;
  }

  /// Errors above 0.5 are meaningless numbers. Of two such runs the one whose accuracy holds longer is better.
  bool is_better(const Attempt& attempt) const {
    if (!(attempt.error < unknown_error)) return false;
    return attempt.error > 0.5 && best_.error > 0.5 ? attempt.holds_until > best_.holds_until
                                                    : attempt.error < best_.error;
  }

  Motion certify_by_pairs(double coarse) {
    PairCertificate pair(runs_, safety_);
    const double least = record().least_rtol;
    int stalled = 0;
    for (int round = 0;; ++round) {
      Attempt attempt = pair.run(coarse, std::max(coarse / ratio_, least));
      const double error = attempt.error;
      if (decision_.may_cut && !pair.probes().breaks.empty()) {
        best_ = std::move(attempt);
        best_.motion.found_breaks = pair.probes().breaks;
        return finish();
      }
      const bool done = !attempt.finished() || error <= accuracy_;
      const bool lost = error > 0.5 && best_.error > 0.5;
      stalled = round == 0 || error < 0.5 * best_.error || (lost && is_better(attempt)) ? 0 : stalled + 1;
      if (round == 0 || is_better(attempt) || attempt.motion.status == Status::stopped) best_ = std::move(attempt);
      if (done || stalled >= 2 || coarse <= ratio_ * least) break;
      // Errors fall more slowly than tolerances, and a third try costs more than a finer second one.
      coarse = std::max(coarse / std::clamp(math::fast_pow(2 * error / accuracy_, 1.2), 3.0, 1e4), ratio_ * least);
    }
    pair.drop_added_times(best_.motion);
    probes_ = pair.probes();
    return conclude();
  }

  /// The error is proportional to the tolerance until rounding dominates, so the second run has the right tolerance. A
  /// run whose error far exceeds the accuracy is abandoned before its end.
  Motion certify_carried(double rtol) {
    const double least = record().least_rtol;
    bool all_terms = decision_.facts.is_stiff_for_series();
    for (bool first = true;; first = false) {
      const bool finest = rtol <= least, last = finest && (all_terms || !first);
      double given_up = 0.0;
      const bool looped = !decision_.scene.controllers().empty();   // an unstable loop may turn ever faster
      const double most = last ? (looped ? unstable_factor : unknown_error) : finest ? unstable_factor : give_up_factor;
      Attempt attempt = run_carried(runs_, rtol, safety_, all_terms, most, given_up);
      if (given_up > 0 && last && attempt.error < unknown_error) {
        best_ = std::move(attempt);
        best_.motion.message.clear();
        lost_ = true;
        return conclude();
      }
      if (given_up > 0) {
        // The error may grow by the same factor in each further part of the span.
        const double parts = std::min(decision_.facts.span() / given_up, 4.0);
        rtol = std::max(rtol / math::fast_pow(10 * give_up_factor, parts), least);
        safety_ = std::max(safety_, chaotic_safety);
        all_terms = true;   // with fewer, an error may grow only because its own series is unstable
        continue;
      }
      const double error = attempt.error;
      const bool ended = !attempt.finished(), stalled = !first && error > 0.5 * best_.error;
      if (best_.motion.t.empty() || is_better(attempt) || ended) best_ = std::move(attempt);
      if (ended || error <= accuracy_ || finest) return conclude();
      // The run measures how much the motion amplifies errors, but only approximately: the safety factor grows.
      const double wider = std::max(1.0, chaotic_safety / safety_);
      safety_ *= wider;
      all_terms = all_terms || stalled;
      rtol = stalled ? least : std::max(rtol / std::clamp(2 * wider * error / accuracy_, 10.0, 1e8), least);
    }
  }

  /// Half of all scenes have a tenth of the accuracy's error, or less.
  Motion expect(double turns) {
    const ode::Forecast& forecast = record().forecast;
    const double aimed = forecast.known() ? forecast.find_median_rtol(accuracy_ / aim, turns) : accuracy_ / 50;
    const double rtol = std::clamp(aimed, record().least_rtol, 1e-2);
    best_.motion = runs_.run(decision_.scene, options_, rtol);
    best_.motion.rtol_used = rtol;
    if (best_.finished()) {
      best_.motion.error = forecast.known() ? forecast.compute_error(rtol, turns) : accuracy_;
      best_.motion.error_kind = "expected";
      note("the error is expected from the tolerance; no certificate was requested");
    }
    return finish();
  }

  /// What float64 drops of torques and of products of rates below its range, over the whole span.
  double compute_underflow() const {
    constexpr double dropped = 0x1p-1072;   // of an acceleration, and of a torque
    const double least = std::min(1.0, decision_.scene.inertia_B().moments().minCoeff());
    const double span = decision_.facts.span(), rate = best_.motion.omega_scale();
    const double change = dropped / least * span;   // of a rate
    return std::max(rate > 0.0 ? change / rate : 0.0, best_.motion.attitude.empty() ? 0.0 : change * span);
  }

  /// Rates w of a motion whose own rates v are unknown have an error |w - v| / max |v| up to 1 + max |w| / |v(t0)|.
  double compute_worst_rate() const {
    if (best_.motion.omega.empty()) return 0.0;
    const Vector3d& start = decision_.scene.omega();
    return 1.0 + best_.motion.omega_scale() / math::hypot(start[0], start[1], start[2]);
  }

  Motion conclude() {
    Motion& motion = best_.motion;
    if (best_.finished() && !motion.t.empty()) {
      underflow_ = compute_underflow();
      if (underflow_ > 1e-17) best_.error = std::min(best_.error + underflow_, std::numeric_limits<double>::max());
    }
    motion.error = best_.error;
    if ((!best_.finished() && !lost_) || motion.t.empty() || !(best_.error < unknown_error)) {
      motion.error = std::numeric_limits<double>::quiet_NaN();
      if (motion.t.empty()) {
        note("no sample was reached, so no error could be bounded");
      } else if (best_.finished()) {
        motion.status = Status::failed;
        note("the comparison run failed, so the error is unknown");
      }
      return finish();
    }
    if (best_.error <= accuracy_ && !lost_) {
      motion.error_kind = jumps_within_steps() ? "estimated" : "bounded";
      if (motion.error_kind == "estimated") {
        note(describe_jump());
        return finish();
      }
      note(carries_error() ? "certified: the truncation and rounding errors of all steps, propagated to the end, stay "
                             "within the bound"
                           : "certified: a coarser run, with inputs changed by eight units in the last place, stays "
                             "within the bound");
    } else {
      motion.error_kind = "limit";
      best_.error *= limit_safety;
      // So large an error grows by no linear rule any more: it is no bound below the largest angle and rate.
      if (best_.error > 0.5) best_.error = std::max({best_.error, std::numbers::pi, compute_worst_rate()});
      motion.error = best_.error;
      note(describe_limit());
    }
    return finish();
  }

  bool jumps_within_steps() const {
    return decision_.crosses_switches || calls_functions() || !std::isnan(probes_.state_jump) || probes_.too_many || !probes_.breaks.empty();
  }

  /// A controller's law is a function of the user's own, whose derivative and branches are not known.
  bool calls_functions() const {
    const auto& controllers = decision_.scene.controllers();
    return std::any_of(controllers.begin(), controllers.end(), [](const Controller& one) { return !one.is_traced(); });
  }

  std::string describe_jump() const {
    if (calls_functions())
      return "the error is estimated: the derivative and the branches of a controller's function are not known";
    if (decision_.crosses_switches)
      return "a coarser run estimates the error, because " + decision_.plan.method + " steps over the switches of your "
             "formula; taylor ends its steps there and bounds it";
    const std::string end = ": a coarser run estimates the error, and no step ends at a jump; it would "
                            "with np.where in a Formula, or with During";
    if (std::isnan(probes_.state_jump)) return "your torque jumps or kinks at many times" + end;
    return "your torque jumps with the state, as near t = " + to_text(probes_.state_jump) + " s" + end;
  }

  std::string describe_limit() const {
    char text[320];
    int n = 0;
    if (underflow_ > 0.1 * accuracy_) {
      n = std::snprintf(text, sizeof text,
                        "the accuracy of %.3g was not reached: torques or products of rates are below float64's range "
                        "over so long a span; another unit of time helps",
                        accuracy_);
    } else if (best_.error > 0.5) {
      n = std::snprintf(text, sizeof text,
                        "the accuracy of %.3g was not reached: rounding errors, including those of the inputs, grow "
                        "over this span until no digit is certain",
                        accuracy_);
    } else {
      n = std::snprintf(text, sizeof text,
                        "the accuracy of %.3g was not reached: rounding errors, including those of the inputs, grow "
                        "to %.2g over this span with %s",
                        accuracy_, best_.error, decision_.plan.method.c_str());
    }
    const bool holds_for_a_while = best_.holds_until > 0 && best_.holds_until < unknown_error;
    if (holds_for_a_while && n > 0 && static_cast<std::size_t>(n) < sizeof text) {
      std::snprintf(text + n, sizeof text - static_cast<std::size_t>(n), "; it holds for the first %.4g s",
                    best_.holds_until);
    }
    return text + describe_lost_tick();
  }

  /// The first tick after the last sample that has the accuracy.
  std::string describe_lost_tick() const {
    const double from = decision_.scene.t0() + (best_.holds_until < unknown_error ? best_.holds_until : 0.0);
    std::size_t lost = 0, tick = 0;
    double t = unknown_error;
    for (std::size_t i = 0; i < best_.motion.ticks.size(); ++i) {
      const std::vector<double>& times = best_.motion.ticks[i].t;
      const auto at = std::lower_bound(times.begin(), times.end(), from);
      if (at != times.end() && *at < t) lost = i, tick = static_cast<std::size_t>(at - times.begin()), t = *at;
    }
    if (!(t < unknown_error)) return "";
    return "; lost by tick " + std::to_string(tick) + " of controller " + std::to_string(lost) + ", t = " + to_text(t) + " s";
  }

  void note(const std::string& text) {
    std::string& message = best_.motion.message;
    message += message.empty() ? text : "; " + text;
  }

  Motion finish() {
    Motion& motion = best_.motion;
    motion.plan = describe_run(decision_, motion);
    motion.asked = accuracy_;
    motion.stats = runs_.stats();
    motion.runs = runs_.runs();
    return std::move(motion);
  }

  const Decision& decision_;
  const SolveOptions& options_;
  CountedRuns runs_;
  const double accuracy_;
  double safety_ = 1.5, ratio_ = pair_ratio;
  double underflow_ = 0.0;   ///< a part of the error
  bool lost_ = false;        ///< the run was given up at the least tolerance; its samples are those before
  Attempt best_;
  Probes probes_;
};

}  // namespace

Motion certify(const Decision& decision, const SolveOptions& options) { return Certifier(decision, options).solve(); }

}  // namespace polhode
