#include "solve/certify/certify.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"
#include "solve/plan/plan.hpp"
#include "solve/proof/enclose.hpp"

namespace polhode {
namespace {

using math::Interval;
using proof::Enclosure;

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// At least |value - x| for every x between the bounds.
double find_distance(double value, double lower, double upper) {
  return Interval::raise(std::max(value - lower, upper - value));
}

/// Makes a Motion from enclosures.
class Proof {
 public:
  Proof(const Decision& decision, const SolveOptions& options)
      : scene_(decision.scene), options_(options), decision_(decision), accuracy_(decision_.plan.accuracy) {}

  Motion prove() {
    // First with steps that suffice for most motions, then with the finest that double-doubles carry.
    const proof::StepSettings settings[] = {
        {.tolerance = std::clamp(1e-10 * accuracy_, 1e-24, 1e-14)},
        {.tolerance = 1e-26, .derivative_tolerance = 1e-14}};
    for (const proof::StepSettings& step : settings) {
      enclose(step, &step == &settings[1]);
      ++motion_.runs;
      if (error_ <= accuracy_ || was_ended()) break;
    }
    return finish();
  }

 private:
  bool was_ended() const {
    return enclosure_.status == Status::stopped || enclosure_.status == Status::max_steps;
  }

  void enclose(const proof::StepSettings& step, bool is_last) {
    using Clock = std::chrono::steady_clock;
    Clock::time_point last_call = Clock::now();
    const double last = find_last();
    proof::EncloseOptions enclose_options;
    enclose_options.step = step;
    enclose_options.max_steps = options_.max_steps;
    // A first try ends where its bounds are wider than the accuracy.
    if (!is_last) enclose_options.widest = std::min(enclose_options.widest, 4 * accuracy_);
    if (options_.progress) {
      enclose_options.go_on = [&](double reached) {
        if (Clock::now() - last_call < std::chrono::milliseconds(50)) return true;
        last_call = Clock::now();
        return options_.progress(reached, last);
      };
    }
    enclosure_ = proof::enclose(scene_, cut(scene_), enclose_options);
    motion_.stats.steps += enclosure_.steps;
    motion_.stats.rejected += enclosure_.rejected;
    measure();
  }

  /// The time farthest from the start.
  double find_last() const {
    double last = scene_.t0();
    for (const double t : scene_.times()) last = std::abs(t - scene_.t0()) > std::abs(last - scene_.t0()) ? t : last;
    return last;
  }

  /// Where a run that goes backward first ends.
  double find_final() const {
    const auto [least, most] = std::minmax_element(scene_.times().begin(), scene_.times().end());
    return *most >= scene_.t0() ? enclosure_.end : enclosure_.begin;
  }

  std::size_t count() const { return scene_.times().size(); }
  std::size_t own() const { return static_cast<std::size_t>(scene_.count_states()); }
  bool is_enclosed(std::size_t i) const {
    const auto bounded = [&](const std::vector<Interval>& rows, std::size_t width) {
      for (std::size_t k = width * i; k < width * (i + 1) && !rows.empty(); ++k)
        if (!rows[k].is_bounded()) return false;
      return true;
    };
    return bounded(enclosure_.omega, 3) && bounded(enclosure_.attitude, 4) && bounded(enclosure_.states, own());
  }

  /// The error of each sample: its value is the middle of its bounds.
  void measure() {
    const Vector3d& start = scene_.omega();
    double scale = math::hypot(start[0], start[1], start[2]);
    for (std::size_t i = 0; i < count() && !enclosure_.omega.empty(); ++i) {
      const Interval* w = &enclosure_.omega[3 * i];
      if (is_enclosed(i)) scale = std::max(scale, math::hypot(w[0].middle.hi, w[1].middle.hi, w[2].middle.hi));
    }
    // A body at rest has no rate to compare with: a radian over the span stands for it.
    scale = scale > 0.0 ? scale * (1.0 - 0x1p-48) : 1.0 / std::max(std::abs(find_last() - scene_.t0()), 1.0);
    errors_.assign(count(), unbounded);
    error_ = 0.0;
    for (std::size_t i = 0; i < count(); ++i) {
      if (is_enclosed(i)) errors_[i] = std::max(measure_rates(i) / scale * (1.0 + 0x1p-48), measure_angle(i));
    }
    measure_states();
    for (const double error : errors_) error_ = std::max(error_, error);
  }

  /// Those of a state are relative to its largest size, or to 1 where it stays 0.
  void measure_states() {
    std::size_t first = 0;
    for (const formula::Input& state : scene_.states()) {
      const std::size_t width = state.values.size();
      double largest = 0.0;
      for (const double start : state.values) largest = math::hypot(largest, start);
      const auto visit = [&](auto use) {
        for (std::size_t i = 0; i < count(); ++i)
          if (is_enclosed(i)) use(i, own() * i + first);
      };
      visit([&](std::size_t, std::size_t at) {
        double size = 0.0;
        for (std::size_t k = at; k < at + width; ++k) size = math::hypot(size, enclosure_.states[k].middle.hi);
        largest = std::max(largest, size);
      });
      const double scale = largest > 0.0 ? largest * (1.0 - 0x1p-48) : 1.0;
      visit([&](std::size_t i, std::size_t at) {
        errors_[i] = std::max(errors_[i], measure(enclosure_.states, at, width) / scale * (1.0 + 0x1p-48));
      });
      first += width;
    }
  }

  static double measure(const std::vector<Interval>& rows, std::size_t first, std::size_t width) {
    double length = 0.0;
    for (std::size_t k = first; k < first + width; ++k)
      length = math::hypot(length, find_distance(rows[k].middle.hi, rows[k].lower(), rows[k].upper()));
    return Interval::raise(length);
  }
  double measure_rates(std::size_t i) const {
    return enclosure_.omega.empty() ? 0.0 : measure(enclosure_.omega, 3 * i, 3);
  }
  /// Of the rotation between the returned quaternion, normalised, and the exact one: with e their distance, its half is
  /// at most asin e.
  double measure_angle(std::size_t i) const {
    if (enclosure_.attitude.empty()) return 0.0;
    const double e = measure(enclosure_.attitude, 4 * i, 4);
    return e < 0.9 ? Interval::raise(2 * e * (1 + e * e)) : std::numbers::pi;
  }

  /// The times around the start between which every sample has the accuracy.
  void find_span() {
    double first = -unbounded, last = unbounded;
    for (std::size_t i = 0; i < count(); ++i) {
      const double t = scene_.times()[i];
      if (errors_[i] <= accuracy_) continue;
      (t < scene_.t0() ? first : last) = t < scene_.t0() ? std::max(first, t) : std::min(last, t);
    }
    const bool ends_before = first > -unbounded, ends_after = last < unbounded;
    motion_.proved_begin = ends_before ? scene_.t0() : enclosure_.begin;
    motion_.proved_end = ends_after ? scene_.t0() : enclosure_.end;
    for (const double t : scene_.times()) {
      if (ends_before && t > first) motion_.proved_begin = std::min(motion_.proved_begin, t);
      if (ends_after && t < last) motion_.proved_end = std::max(motion_.proved_end, t);
    }
  }

  Motion finish() {
    motion_.start = scene_.start();
    motion_.extra.count = scene_.count_states();
    motion_.plan = decision_.plan;
    motion_.asked = accuracy_;
    motion_.model = decision_.plan.model, motion_.state = decision_.plan.state;
    motion_.rtol_used = 0.0;
    --motion_.runs;   // the first counts as well
    motion_.status = enclosure_.status == Status::failed ? Status::finished : enclosure_.status;
    find_span();
    bool is_complete = true;
    for (std::size_t i = 0; i < count(); ++i) is_complete &= is_enclosed(i);
    if (!is_complete && !was_ended()) run_plainly();
    for (std::size_t i = 0, row = 0; i < count(); ++i) {
      const bool has_plain = row < plain_.t.size() && plain_.t[row] == scene_.times()[i];
      if (is_enclosed(i) || has_plain) add_sample(i, has_plain ? row : none);
      row += has_plain ? 1 : 0;
    }
    motion_.t_reached = was_ended() ? enclosure_.ended_at : find_final();
    motion_.error = error_;
    motion_.error_kind = error_ <= accuracy_ ? "proved" : "limit";
    motion_.message = describe();
    return std::move(motion_);
  }

  void run_plainly() {
    SolveOptions plain = options_;
    plain.proof = false;
    plain_ = execute(decide(scene_, plain), plain);
    motion_.status = plain_.status;
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  void add_sample(std::size_t i, std::size_t plain_row) {
    motion_.t.push_back(scene_.times()[i]);
    const bool enclosed = is_enclosed(i);
    const auto add = [&](const std::vector<Interval>& rows, const std::vector<double>& plain, std::size_t width,
                         std::vector<double>& value, std::vector<double>& lower, std::vector<double>& upper) {
      for (std::size_t k = 0; k < width && !rows.empty(); ++k) {
        const Interval& found = rows[width * i + k];
        value.push_back(enclosed ? found.middle.hi : plain[width * plain_row + k]);
        lower.push_back(enclosed ? found.lower() : -unbounded);
        upper.push_back(enclosed ? found.upper() : unbounded);
      }
    };
    add(enclosure_.omega, plain_.omega, 3, motion_.omega, motion_.omega_lower, motion_.omega_upper);
    add(enclosure_.attitude, plain_.attitude, 4, motion_.attitude, motion_.attitude_lower, motion_.attitude_upper);
    add(enclosure_.states, plain_.states, own(), motion_.states, motion_.states_lower, motion_.states_upper);
  }

  std::string describe() const {
    if (was_ended()) {
      return "the proof ended at t = " + to_text(enclosure_.ended_at) + " s: " + enclosure_.ended +
             "; the bounds of the samples so far hold";
    }
    if (error_ <= accuracy_)
      return "proved: the exact motion of these float64 inputs lies between the lower and the upper bounds";
    std::string text = "the accuracy of " + to_text(accuracy_) + " is proved from t = " +
                       to_text(motion_.proved_begin) + " to " + to_text(motion_.proved_end) +
                       " s; beyond, bounds are wider";
    if (!plain_.t.empty()) {
      text += " or infinite, because " + enclosure_.ended + ". Samples without bounds are those of a run by " +
              plain_.plan.method + " (" + plain_.error_kind + " error " + to_text(plain_.error) + ")";
    }
    return text + ". The end of a proof is no failure of the motion";
  }

  const Scene& scene_;
  const SolveOptions& options_;
  const Decision& decision_;
  const double accuracy_;
  Enclosure enclosure_;
  std::vector<double> errors_;
  double error_ = unbounded;
  Motion motion_, plain_;
};

}  // namespace

Motion prove(const Decision& decision, const SolveOptions& options) { return Proof(decision, options).prove(); }

}  // namespace polhode
