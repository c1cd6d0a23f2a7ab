#include "solve/certify.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "polhode/core/error.hpp"
#include "polhode/ode/tracked_taylor.hpp"
#include "solve/measure.hpp"
#include "solve/methods/body_method.hpp"
#include "solve/perturb.hpp"
#include "solve/planned_pieces.hpp"
#include "solve/planning.hpp"

namespace polhode {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t least_samples = 8;   // fewer differences may be small by chance
constexpr int pieces = 48;                 // of the span, to count its turns
constexpr double chaotic_safety = 2.5;     // where a first run has lost more than is asked
constexpr double hopeless = 30.0;          // times the accuracy: a run that has lost as much is not worth its end

Scene with_times(const Scene& scene, std::vector<double> times, const Wanted& want) {
  return Scene(SceneParts{.inertia_B = scene.inertia_B(), .omega = scene.omega(), .attitude = scene.attitude(),
                          .torques = scene.torques(), .times = std::move(times), .want = want, .t0 = scene.t0()});
}

std::vector<double> spread(const Scene& scene, const Facts& facts, int count) {
  std::vector<double> times;
  for (int i = 0; i <= count; ++i) times.push_back(scene.t0() - facts.before + facts.span() * i / count);
  return times;
}

bool arrived(const Motion& motion) { return motion.status == Status::finished || motion.status == Status::event; }

/// One scene on its way to an answer whose error is known.
class Certifier {
 public:
  Certifier(const Scene& scene, const Facts& facts, const SolveOptions& options, const Plan& plan)
      : scene_(scene), facts_(facts), options_(options), plan_(plan), method_(find_body_method(plan.method)) {
    // Rounding is as large as accuracies beyond this one, and differences of two runs are less faithful.
    if (plan.accuracy <= 2e-12) {
      safety_ = carries() ? 4.0 : 5.0, ratio_ = 3 * pair_ratio;
    } else if (plan.accuracy <= 1e-10) {
      safety_ = 2.0;
    }
    quiet_ = options;
    quiet_.dense = false;
    quiet_.events.clear();
  }

  Motion solve() {
    const ode::Forecast& forecast = method_.record.forecast;
    const double least = method_.record.least_rtol, turns = find_turns();
    double coarse = forecast.known() ? forecast.find_rtol(plan_.accuracy, turns) : plan_.accuracy / 10;
    coarse = std::clamp(coarse, ratio_ * least, 1e-2);
    if (!plan_.certify) return expect(coarse / ratio_, turns);
    if (carries()) return track(coarse / ratio_);
    prepare();
    int stalled = 0;
    for (int round = 0;; ++round) {
      Motion motion = run_pair(coarse, std::max(coarse / ratio_, least));
      const double error = motion.error;
      const bool ended = !arrived(motion), done = ended || error <= plan_.accuracy;
      const bool lost = error > 0.5 && best_.error > 0.5;
      stalled = round == 0 || error < 0.5 * best_.error || (lost && is_better(error)) ? 0 : stalled + 1;
      if (round == 0 || is_better(error) || motion.status == Status::stopped) {
        best_ = std::move(motion);
        kept_parting_ = parting_;
      }
      if (done || stalled >= 2 || coarse <= ratio_ * least) return conclude();
      // Errors fall more slowly than tolerances do, and a third try costs more than a finer second one.
      coarse = std::max(coarse / std::clamp(std::pow(2 * error / plan_.accuracy, 1.2), 3.0, 1e4), ratio_ * least);
    }
  }

 private:
  /// A motion in pieces has its whole chain run twice.
  bool carries() const { return method_.carries_error && plan_.pieces.empty(); }

  Motion run(const Scene& scene, const SolveOptions& options, double rtol, bool moved = false,
             ode::ErrorTrace* trace = nullptr) {
    const RunOptions how{options, {rtol, options.atol.value_or(find_atol(method_.record, scene_, rtol))}, trace};
    Motion motion = plan_.pieces.empty() ? method_.solve(scene, how) : run_by_plan(scene, how, plan_, moved);
    stats_ += motion.stats;
    ++runs_;
    return motion;
  }

  /// A torque may have spun the body up: the integral of |omega|, by a loose run. Where a tighter tolerance costs
  /// little, that run would cost more than it saves.
  double find_turns() {
    if (!facts_.may_spin_up || method_.record.adaptive_order) return facts_.turns;
    SolveOptions loose;
    loose.max_steps = options_.max_steps;
    loose.progress = options_.progress;
    const Motion motion = run(with_times(scene_, spread(scene_, facts_, pieces), {true, false}), loose, 1e-4);
    double turned = 0.0;
    for (std::size_t i = 0; i + 1 < motion.t.size(); ++i) {
      const double *a = motion.omega.data() + 3 * i, *b = a + 3;
      turned += 0.5 * (std::hypot(a[0], a[1], a[2]) + std::hypot(b[0], b[1], b[2])) * (motion.t[i + 1] - motion.t[i]);
    }
    return arrived(motion) && std::isfinite(turned) ? turned / 6.283185307179586 : facts_.turns;
  }

  /// The scene that is solved and the one it is compared with; behind few times stand more, for the comparison alone.
  void prepare() {
    asked_ = scene_.times().size();
    if (asked_ < least_samples && facts_.span() > 0) {
      std::vector<double> times = scene_.times();
      const std::vector<double> more = spread(scene_, facts_, static_cast<int>(least_samples));
      times.insert(times.end(), more.begin(), more.end());
      longer_ = with_times(scene_, std::move(times), scene_.want());
    }
    moved_ = perturb(longer_ ? *longer_ : scene_);
  }

  /// Where all is lost by the end, its size says nothing: then the run counts that is good for longest.
  bool is_better(double error) const {
    return error > 0.5 && best_.error > 0.5 ? parting_ > kept_parting_ : error < best_.error;
  }

  /// Runs that carry their error along. It is proportional to the tolerance until it is rounding, so that the second
  /// run is at the right one; and where much more than asked is lost on the way, the run need not be ended to know.
  Motion track(double rtol) {
    const double least = method_.record.least_rtol;
    for (bool first = true;; first = false) {
      const bool last = rtol <= least;
      ode::ErrorTrace trace{.asked = plan_.accuracy / safety_, .most = last ? infinity : hopeless,
                            .all_terms = facts_.is_stiff_for_series()};
      Motion motion = run_tracked(rtol, trace);
      if (trace.given_up > 0) {
        // What grew so much in a part of the span may grow as much again in each other part of its length.
        const double parts = std::min(facts_.span() / trace.given_up, 4.0);
        rtol = std::max(rtol / std::pow(10 * hopeless, parts), least);
        safety_ = std::max(safety_, chaotic_safety);
        continue;
      }
      const double error = motion.error;
      const bool ended = !arrived(motion), stalled = !first && error > 0.5 * best_.error;
      if (best_.t.empty() || is_better(error) || ended) {
        best_ = std::move(motion);
        kept_parting_ = parting_;
      }
      if (ended || error <= plan_.accuracy || last) return conclude();
      // A motion that multiplies its errors shows how much in a run at its own tolerance, not to the last digit.
      const double wider = std::max(1.0, chaotic_safety / safety_);
      safety_ *= wider;
      rtol = stalled ? least : std::max(rtol / std::clamp(2 * wider * error / plan_.accuracy, 10.0, 1e8), least);
    }
  }

  Motion run_tracked(double rtol, ode::ErrorTrace& trace) {
    Motion motion = run(scene_, options_, rtol, false, &trace);
    motion.plan.rtol = rtol;
    motion.error = infinity;
    if (!arrived(motion) || motion.t.empty()) return motion;
    double size = 0.0;
    for (std::size_t i = 0; i + 2 < motion.omega.size(); i += 3) {
      size = std::max(size, std::hypot(motion.omega[i], motion.omega[i + 1], motion.omega[i + 2]));
    }
    const double rates = motion.omega.empty() || trace.moved == 0.0 ? 0.0 : trace.moved / size;
    const double error = std::max(rates, motion.attitude.empty() ? 0.0 : trace.turned);
    // What is carried along grows without end; two attitudes are no farther apart than half a turn.
    motion.error = safety_ * std::min(error, 3.141592653589793);
    parting_ = motion.error <= plan_.accuracy ? infinity : trace.parting;
    return motion;
  }

  Motion run_pair(double coarse, double fine) {
    Motion motion = run(longer_ ? *longer_ : scene_, options_, fine);
    motion.plan.rtol = fine;
    const double formulas = std::isnan(motion.error) ? 0.0 : motion.error;   // of closed forms between the steps
    motion.error = infinity;
    if (!arrived(motion) || motion.t.empty()) return motion;
    // A terminal event leaves the rest of the times unanswered: they are not compared either.
    const bool whole = motion.t.size() == moved_->times().size();
    const Motion other = run(whole ? *moved_ : with_times(*moved_, motion.t, scene_.want()), quiet_, coarse, true);
    if (other.status == Status::stopped) {
      motion.status = Status::stopped;
      motion.message = "stopped by the progress callback before the error was certified";
    } else if (other.status == Status::finished) {
      const auto data = [](const std::vector<double>& v) { return v.empty() ? nullptr : v.data(); };
      const double difference = compute_distance(motion.t.size(), data(motion.omega), data(motion.attitude),
                                                 data(other.omega), data(other.attitude));
      if (difference < infinity) motion.error = safety_ * difference + formulas;
      parting_ =
          motion.error <= plan_.accuracy
              ? infinity
              : find_parting(motion.t.size(), motion.t.data(), scene_.t0(), data(motion.omega), data(motion.attitude),
                             data(other.omega), data(other.attitude), plan_.accuracy / safety_);
    }
    return motion;
  }

  Motion expect(double rtol, double turns) {
    const ode::Forecast& forecast = method_.record.forecast;
    rtol = std::max(rtol, method_.record.least_rtol);
    best_ = run(scene_, options_, rtol);
    best_.plan.rtol = rtol;
    if (arrived(best_)) {
      best_.error = forecast.known() ? forecast.compute_error(rtol, turns) : plan_.accuracy;
      best_.error_kind = "expected";
      note("the error is what such scenes have at this tolerance, not certified");
    }
    return finish();
  }

  Motion conclude() {
    if (longer_) drop_added_times();
    if (!arrived(best_) || best_.t.empty() || !(best_.error < infinity)) {
      best_.error = std::numeric_limits<double>::quiet_NaN();
      if (best_.t.empty()) {
        note("no sample was reached whose error could be bounded");
      } else if (arrived(best_)) {
        best_.status = Status::failed;
        note("the run it was compared with failed, so that nothing is known of its error");
      }
      return finish();
    }
    if (best_.error <= plan_.accuracy) {
      best_.error_kind = "bounded";
      note(carries() ? "certified: what each step loses and what rounding takes, carried along to the end, stays "
                       "within the bound"
                     : "certified: with the inputs moved by two units in the last place, a coarser run stays within "
                       "the bound");
    } else {
      best_.error_kind = "limit";
      note(describe_limit());
    }
    return finish();
  }

  std::string describe_limit() const {
    char text[320];
    int n = 0;
    if (best_.error > 0.5) {
      n = std::snprintf(text, sizeof text,
                        "the accuracy of %.3g was not reached: over this span rounding and the inputs' last digits "
                        "grow until nothing is certain",
                        plan_.accuracy);
    } else {
      n = std::snprintf(text, sizeof text,
                        "the accuracy of %.3g was not reached: rounding and the inputs' last digits grow to %.2g "
                        "over this span, by %s in float64",
                        plan_.accuracy, best_.error, plan_.method.c_str());
    }
    if (kept_parting_ > 0 && kept_parting_ < infinity && n > 0 && static_cast<std::size_t>(n) < sizeof text) {
      std::snprintf(text + n, sizeof text - static_cast<std::size_t>(n), "; it holds for the first %.4g s",
                    kept_parting_);
    }
    return text;
  }

  void note(const std::string& text) { best_.message += best_.message.empty() ? text : "; " + text; }

  Motion finish() {
    best_.plan.method = plan_.method;
    best_.plan.pieces = plan_.pieces;
    best_.plan.accuracy = plan_.accuracy;
    best_.plan.certify = plan_.certify;
    best_.plan.predicted_error = plan_.predicted_error;
    best_.plan.predicted_seconds = plan_.predicted_seconds;
    best_.asked = plan_.accuracy;
    best_.stats = stats_;
    best_.runs = runs_;
    return std::move(best_);
  }

  /// The rows of the added times, which stand behind those asked for. Rows that were not reached are not there.
  void drop_added_times() {
    const std::vector<double>& times = longer_->times();
    std::size_t kept = 0, row = 0;
    for (std::size_t i = 0; i < asked_ && row < best_.t.size(); ++i) {
      if (times[i] == best_.t[row]) ++row, ++kept;
    }
    best_.t.resize(kept);
    if (!best_.omega.empty()) best_.omega.resize(3 * kept);
    if (!best_.attitude.empty()) best_.attitude.resize(4 * kept);
  }

  const Scene& scene_;
  const Facts& facts_;
  const SolveOptions& options_;
  const Plan& plan_;
  const BodyMethod& method_;
  SolveOptions quiet_;
  double safety_ = 1.5, ratio_ = pair_ratio;
  std::optional<Scene> longer_, moved_;
  std::size_t asked_ = 0;
  double parting_ = infinity;   // how far from the start the last pair stayed within what is asked
  double kept_parting_ = infinity;   // and that of the motion that is returned
  Motion best_;
  ode::Counts stats_;
  int runs_ = 0;
};

}  // namespace

Motion solve_certified(const Scene& scene, const Facts& facts, const SolveOptions& options, const Plan& plan) {
  return Certifier(scene, facts, options, plan).solve();
}

}  // namespace polhode
