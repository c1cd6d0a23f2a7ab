#pragma once

#include <algorithm>
#include <cmath>

#include "polhode/ode/fixed_step.hpp"
#include "polhode/ode/method_record.hpp"
#include "polhode/ode/problem.hpp"

namespace polhode::ode {

/// The classical method of order 4 at a fixed step.
struct Rk4 {
  static constexpr MethodRecord record{
      .name = "rk4",
      .order = 4,
      .dense_order = 3,
      .adaptive = false,
      .keeps = "nothing",
      .doc = "The classical Runge-Kutta method at a fixed step: a common baseline for comparisons.",
      .source = "Kutta 1901, Z. Math. Phys. 46, 435",
  };

  template <Problem P>
  class Stepper;
};

template <Problem P>
class Rk4::Stepper final : public FixedStepper {
 public:
  static constexpr int N = P::dimension;
  static constexpr int segment_size = 4 * N;

  Stepper(const P& problem, double t0, const double* y0, double, const Tolerances& tolerances)
      : FixedStepper(N, segment_size, &evaluate_segment, t0, tolerances.step), problem_(problem) {
    std::copy_n(y0, N, y_);
    compute(t0, y_, f_);
  }

  const double* y() const override { return y_; }

  void interpolate(double t, double* out) override { evaluate_segment(segment(), fraction(t), out); }

  /// The cubic Hermite polynomial of the step, in nested form.
  const double* segment() override {
    if (segment_ready_) return segment_;
    segment_ready_ = true;
    prepare_derivative();
    const double h = h_taken();
    for (int i = 0; i < N; ++i) {
      const double change = y_[i] - y_old_[i], c2 = h * f_old_[i] - change;
      segment_[i] = y_old_[i];
      segment_[N + i] = change;
      segment_[2 * N + i] = c2;
      segment_[3 * N + i] = change - h * f_[i] - c2;
    }
    return segment_;
  }

  static void evaluate_segment(const double* c, double s, double* out) {
    const double r = 1.0 - s;
    for (int i = 0; i < N; ++i) out[i] = c[i] + s * (c[N + i] + r * (c[2 * N + i] + s * c[3 * N + i]));
  }

 private:
  void compute(double t, const double* y, double* f) {
    problem_.compute_derivative(t, y, f);
    ++counts_.derivatives;
  }

  void prepare_derivative() {
    if (!derivative_ready_) compute(t_, y_, f_);
    derivative_ready_ = true;
  }

  StepResult step(double t, double h) override {
    prepare_derivative();
    if (counts_.steps != 0) problem_.restore(y_, f_);
    double y[N], k2[N], k3[N], k4[N];
    for (int i = 0; i < N; ++i) y[i] = y_[i] + 0.5 * h * f_[i];
    compute(t + 0.5 * h, y, k2);
    for (int i = 0; i < N; ++i) y[i] = y_[i] + 0.5 * h * k2[i];
    compute(t + 0.5 * h, y, k3);
    for (int i = 0; i < N; ++i) y[i] = y_[i] + h * k3[i];
    compute(t + h, y, k4);
    double sum = 0.0;
    for (int i = 0; i < N; ++i) {
      y[i] = y_[i] + h / 6 * (f_[i] + 2 * (k2[i] + k3[i]) + k4[i]);
      sum += std::abs(y[i]);
    }
    if (!std::isfinite(sum)) return StepResult::not_finite;
    std::copy_n(f_, N, f_old_);
    std::copy_n(y_, N, y_old_);
    std::copy_n(y, N, y_);
    derivative_ready_ = segment_ready_ = false;
    return StepResult::accepted;
  }

  const P& problem_;
  bool derivative_ready_ = true, segment_ready_ = false;
  double y_[N] = {}, f_[N] = {}, y_old_[N] = {}, f_old_[N] = {}, segment_[segment_size] = {};
};

}  // namespace polhode::ode
