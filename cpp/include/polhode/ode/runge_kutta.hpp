#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "polhode/ode/detail/first_step.hpp"
#include "polhode/ode/problem.hpp"
#include "polhode/ode/detail/step_control.hpp"
#include "polhode/ode/stepper.hpp"

namespace polhode::ode {

/// Any embedded explicit Runge-Kutta pair whose last stage is the first of the next step. The tableau is data. The
/// continuous extension is the cubic Hermite polynomial and one more term for each dense row of the tableau, which may
/// use further stages.
template <class Tableau, Problem P>
class RungeKuttaStepper final : public Stepper {
 public:
  static constexpr int N = P::dimension;
  static constexpr int M = (N + 1) / 2 * 2;       ///< padded to whole vectors of two; the pad stays zero
  static constexpr int terms = 4 + Tableau::dense_rows;
  static constexpr int segment_size = terms * M;

  RungeKuttaStepper(const P& problem, double t0, const double* y0, double t_end, const Tolerances& tolerances)
      : Stepper(N, segment_size, &evaluate_segment, t0),
        problem_(problem),
        control_(Tableau::error_order),
        tolerances_(tolerances) {
    std::copy_n(y0, N, y_);
    compute(t0, y_, k_[0]);
    h_ = choose_first_step(problem_, tolerances_, Tableau::order, t0, y_, k_[0], t_end,
                           [this](double t, const double* y1, double* f1) { compute(t, y1, f1); });
  }

  const double* y() const override { return y_; }

  StepResult advance(double t_end) override {
    const double direction = t_end < t_ ? -1.0 : 1.0;
    if (fresh_) {
      fresh_ = false;
    } else {
      std::copy_n(k_[Tableau::stages - 1], M, k_[0]);
      problem_.restore(y_, k_[0]);
    }
    bool finite = true;
    for (;;) {
      const double rest = t_end - t_;
      const bool last = std::abs(h_) * 1.01 >= std::abs(rest);
      const double h = last ? rest : representable_step(t_, h_);
      if (!(std::abs(h) > 8 * std::numeric_limits<double>::epsilon() * std::abs(t_)) && !last) {
        return finite ? StepResult::underflow : StepResult::not_finite;
      }
      if (std::abs(h) < std::numeric_limits<double>::min())
        return finite ? StepResult::underflow : StepResult::not_finite;
      compute_stages(h, std::make_integer_sequence<int, Tableau::stages - 1>{});
      const double error = estimate_error(h);
      if (error <= 1.0) {
        t_old_ = t_;
        t_ = last ? t_end : t_ + h;
        h_taken_ = h;
        const double next = h * control_.accepted(error);
        // A step shortened by t_end says little about the next one; keep the longer of the two.
        h_ = last ? direction * std::max(std::abs(next), std::abs(h_)) : next;
        std::copy_n(y_, M, y_old_);
        std::copy_n(y_new_, M, y_);
        segment_ready_ = false;
        ++counts_.steps;
        return StepResult::accepted;
      }
      finite = std::isfinite(error);
      ++counts_.rejected;
      h_ = h * control_.rejected(error);
    }
  }

  void interpolate(double t, double* out) override {
    prepare_segment();
    evaluate_segment(segment_, (t - t_old_) / h_taken_, out);
  }

  const double* segment() override {
    prepare_segment();
    return segment_;
  }

  /// The continuous extension at the fraction s of a step, in nested form: c0 + s (c1 + r (c2 + s (c3 + r (...)))),
  /// r = 1 - s.
  static void evaluate_segment(const double* segment, double s, double* out) {
    const double r = 1.0 - s;
    double y[M];
    std::copy_n(segment + (terms - 1) * M, M, y);
    for (int k = terms - 1; k-- > 0;) {
      const double factor = k % 2 == 0 ? s : r;
      for (int i = 0; i < M; ++i) y[i] = segment[k * M + i] + factor * y[i];
    }
    std::copy_n(y, N, out);
  }

 private:
  void compute(double t, const double* y, double* dydt) {
    problem_.compute_derivative(t, y, dydt);
    ++counts_.derivatives;
  }

  template <int... S>
  void compute_stages(double h, std::integer_sequence<int, S...>) {
    (compute_stage<S + 1>(h, std::make_integer_sequence<int, S + 1>{}), ...);
  }

  template <int S, int... J>
  void compute_stage(double h, std::integer_sequence<int, J...>) {
    for (int i = 0; i < M; ++i) {
      double sum = 0.0;
      ((Tableau::a[S][J] != 0.0 ? void(sum += Tableau::a[S][J] * k_[J][i]) : void()), ...);
      y_new_[i] = y_[i] + h * sum;
    }
    compute(t_ + Tableau::c[S] * h, y_new_, k_[S]);
  }

  double norm_of(const double (&weights)[Tableau::stages], double h) {
    for (int i = 0; i < M; ++i) {
      double sum = 0.0;
      for (int s = 0; s < Tableau::stages; ++s) sum += weights[s] * k_[s][i];
      error_[i] = h * sum;
    }
    return problem_.error_norm(error_, y_, y_new_, tolerances_.rtol, tolerances_.atol);
  }

  /// One estimate, or two combined as in DOP853 (Hairer, Norsett & Wanner): e^2 / sqrt(e^2 + low^2 / 100).
  double estimate_error(double h) {
    const double error = norm_of(Tableau::error, h);
    if constexpr (requires { Tableau::error_low; }) {
      const double ratio = 0.1 * norm_of(Tableau::error_low, h) / error;
      return error == 0.0 ? 0.0 : error / std::sqrt(1.0 + ratio * ratio);
    } else {
      return error;
    }
  }

  /// The further stages of the continuous extension.
  template <int... E>
  void compute_dense_stages([[maybe_unused]] double h, std::integer_sequence<int, E...>) {
    (compute_dense_stage<Tableau::stages + E>(h, std::make_integer_sequence<int, Tableau::stages + E>{}), ...);
  }

  template <int S, int... J>
  void compute_dense_stage(double h, std::integer_sequence<int, J...>) {
    double y[M];
    for (int i = 0; i < M; ++i) {
      double sum = 0.0;
      ((Tableau::a[S][J] != 0.0 ? void(sum += Tableau::a[S][J] * k_[J][i]) : void()), ...);
      y[i] = y_old_[i] + h * sum;
    }
    compute(t_old_ + Tableau::c[S] * h, y, k_[S]);
  }

  void prepare_segment() {
    if (segment_ready_) return;
    segment_ready_ = true;
    const double h = h_taken_;
    compute_dense_stages(h, std::make_integer_sequence<int, Tableau::all_stages - Tableau::stages>{});
    double *c0 = segment_, *c1 = c0 + M, *c2 = c1 + M, *c3 = c2 + M;
    for (int i = 0; i < M; ++i) {
      c0[i] = y_old_[i];
      c1[i] = y_[i] - y_old_[i];
      c2[i] = h * k_[0][i] - c1[i];
      c3[i] = c1[i] - h * k_[Tableau::stages - 1][i] - c2[i];
    }
    for (int row = 0; row < Tableau::dense_rows; ++row) {
      for (int i = 0; i < M; ++i) {
        double sum = 0.0;
        for (int s = 0; s < Tableau::all_stages; ++s) sum += Tableau::dense[row][s] * k_[s][i];
        segment_[(4 + row) * M + i] = h * sum;
      }
    }
  }

  const P& problem_;
  StepControl control_;
  Tolerances tolerances_;
  double h_ = 0.0, h_taken_ = 0.0;
  bool fresh_ = true, segment_ready_ = false;
  alignas(16) double y_[M] = {}, y_old_[M] = {}, y_new_[M] = {}, error_[M] = {};
  alignas(16) double k_[Tableau::all_stages][M] = {};
  alignas(16) double segment_[segment_size] = {};
};

}  // namespace polhode::ode
