#include "solve/run/exact_run.hpp"

#include <algorithm>
#include <cmath>

#include "method/integrate.hpp"
#include "polhode/core/error.hpp"
#include "polhode/ode/stepper.hpp"
#include "polhode/solve/closed_form.hpp"
#include "solve/ground/options.hpp"

namespace polhode {
namespace {

constexpr std::size_t chunk = 100'000;   // samples between two calls of the progress callback
constexpr double radians_per_step = 0.25;   // of events: zeros closer than this may be missed, as in any integration

/// A closed form as a stepper, to search for events. Its steps have a length but no error.
class ClosedFormStepper final : public ode::Stepper {
 public:
  ClosedFormStepper(const ClosedForm& form, double t0, const double* y0)
      : Stepper(7, 0, nullptr, t0), form_(form), t0_(t0) { std::copy_n(y0, 7, y_); }

  const double* y() const override { return y_; }
  const double* segment() override { return y_; }

  ode::StepResult advance(double t_end) override {
    const double rate = form_.rate(y_), rest = t_end - t_;
    const double h = rate > 0 ? std::copysign(radians_per_step / rate, rest) : rest;
    t_old_ = t_;
    t_ = std::abs(h) >= std::abs(rest) ? t_end : t_ + h;
    if (t_ == t_old_) return ode::StepResult::underflow;
    interpolate(t_, y_);
    ++counts_.steps;
    return ode::StepResult::accepted;
  }

  void interpolate(double t, double* y) override {
    const double since = t - t0_;
    form_.at(&since, 1, y, y + 3);
  }

 private:
  const ClosedForm& form_;
  double t0_;
  double y_[7];
};

void unpack(const double* y, double* omega, double* attitude) {
  std::copy_n(y, 3, omega);
  std::copy_n(y + 3, 4, attitude);
}

Motion run_with_events(const Scene& scene, const SolveOptions& options, const ClosedForm& form) {
  RunOptions without_dense = to_run_options(options, {});
  without_dense.dense = false;   // the closed form gives dense output itself
  double y0[7];
  const double zero = 0.0;
  form.at(&zero, 1, y0, y0 + 3);
  const auto make = [&](const double* y, double) {
    return std::make_unique<ClosedFormStepper>(form, scene.t0(), y);
  };
  return Motion(integrate(scene, without_dense, y0, by_rows<7>(&unpack), make));
}

/// Evaluates each sample independently, in any order.
Motion evaluate(const Scene& scene, const SolveOptions& options, const ClosedForm& form) {
  Motion motion;
  const std::size_t n = scene.times().size();
  const Wanted want = scene.want();
  motion.t = scene.times();
  if (want.omega) motion.omega.resize(3 * n);
  if (want.attitude) motion.attitude.resize(4 * n);
  motion.start = scene.start();
  std::vector<double> shifted;
  const double* since = motion.t.data();
  if (scene.t0() != 0.0) {
    shifted.resize(n);
    for (std::size_t i = 0; i < n; ++i) shifted[i] = motion.t[i] - scene.t0();
    since = shifted.data();
  }
  for (std::size_t begin = 0; begin < n; begin += chunk) {
    const std::size_t count = std::min(chunk, n - begin);
    form.at(since + begin, count, want.omega ? motion.omega.data() + 3 * begin : nullptr,
            want.attitude ? motion.attitude.data() + 4 * begin : nullptr);
    const std::size_t done = begin + count;
    if (done < n && options.progress && !options.progress(motion.t[done - 1], motion.t[n - 1])) {
      motion.t.resize(done);
      if (want.omega) motion.omega.resize(3 * done);
      if (want.attitude) motion.attitude.resize(4 * done);
      motion.status = Status::stopped;
      motion.message = "stopped by the progress callback after " + std::to_string(done) + " samples";
      break;
    }
  }
  return motion;
}

}  // namespace

Motion run_closed_form(const Scene& scene, const Facts& facts, const SolveOptions& options,
                       std::shared_ptr<const ClosedForm> form, const Plan& plan) {
  const double error = plan.predicted_error;
  Motion motion = options.events.empty() ? evaluate(scene, options, *form) : run_with_events(scene, options, *form);
  motion.plan = plan;
  motion.model = plan.model, motion.state = plan.state;
  motion.asked = plan.accuracy;
  motion.error = error;
  motion.error_kind = error <= motion.asked ? "bounded" : "limit";
  if (options.events.empty()) motion.t_reached = scene.t0() + facts.after;
  motion.t_begin = scene.t0() - facts.before;
  motion.has_dense = options.dense;
  if (options.dense) motion.closed_form = std::move(form);
  if (motion.message.empty())
    motion.message = "evaluated at every time by the closed form; its rounding error is the bound";
  if (error > motion.asked && motion.status == Status::finished) {
    motion.message.append("; float64 allows an error of ").append(to_text(error));
    motion.message.append(", more than the requested ").append(to_text(motion.asked));
  }
  return motion;
}

}  // namespace polhode
