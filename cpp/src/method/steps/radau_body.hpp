#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "method/series/separatrix.hpp"
#include "polhode/attitude/matrix.hpp"
#include "polhode/method/euler_problem.hpp"

namespace polhode::radau {

/// Euler's equations for `radau`. The state is the rates in body axes and q_WB. For a triaxial body it may be (u, v,
/// w2) of series/separatrix.hpp and q_WP. The free motion then acts on u and v directly, and each keeps its relative
/// accuracy.
class Body {
 public:
  static constexpr int N = 7;
  using Plain = EulerProblem<SeveralTorques, false, true>;

  explicit Body(const Scene& scene)
      : I_B_(scene.inertia_B().matrix()), diagonal_(scene.inertia_B().is_diagonal()), all_(scene.all_torques()),
        plain_(scene.inertia_B(), all_) {
    Plain::pack(scene.start(), start_);
    for (const AnyTorque& torque : scene.torques()) add_slopes_of(torque);
    const Vector3d& h = scene.rotor_momentum();
    const Matrix3d C_h = make_cross(-h);   // h x w is linear in w, like damping
    if (!h.isZero(0.0)) C_B_ += C_h;
    const InertiaTensor& inertia = scene.inertia_B();
    const Vector3d& I = inertia.moments();
    for (int i = 0; i < 3; ++i) I_[i] = I[i];
    if (!(I[0] < I[1] && I[1] < I[2])) return;
    const Matrix3d& R_BP = inertia.axes();
    const Separatrix separatrix(I);
    const Vector3d w_P = R_BP.transpose() * scene.omega();
    if (!separatrix.suits(w_P)) return;
    separatrix_ = separatrix;
    R_BP_ = R_BP;
    rotated_ = R_BP != Matrix3d::Identity();
    separatrix.from_rates(w_P.data(), start_, start_carry_);
    Quat q_WP = scene.attitude();
    if (rotated_) {
      const Quat q_BP = quat_from_matrix(R_BP, "inertia.axes");
      q_PB_ = conjugate(q_BP);
      q_WP = q_WP * q_BP;
    }
    start_[3] = q_WP.x, start_[4] = q_WP.y, start_[5] = q_WP.z, start_[6] = q_WP.w;
    for (const AnyTorque& torque : scene.torques()) {
      if (const auto C_B = find_damping(torque, I_B_)) {
        add_damping(R_BP.transpose() * *C_B * R_BP);
      } else {
        linear_ = linear_ && (find_formula(torque) != nullptr || !traits(torque).uses_rates);
      }
    }
    if (!h.isZero(0.0)) add_damping(R_BP.transpose() * C_h * R_BP);
  }

  const double* start() const { return start_; }
  const double* start_carry() const { return start_carry_; }   ///< rounding errors of the rate variables
  bool relative() const { return separatrix_.has_value(); }    ///< u and v need accuracy relative to their own size
  double half_over_k() const { return separatrix_ ? separatrix_->half_over_k().hi : 0.0; }   ///< 0: plain rates

  /// Rates from rate variables.
  static void to_rates(double half_over_k, const double* r, double* w) {
    if (half_over_k == 0.0) {
      std::copy_n(r, 3, w);
    } else {
      w[0] = (r[1] - r[0]) * half_over_k, w[1] = r[2], w[2] = (r[0] + r[1]) * 0.5;
    }
  }

  void unpack(const double* y, double* omega, double* attitude) const {
    if (!separatrix_) return Plain::unpack(y, omega, attitude);
    double w[3];
    separatrix_->to_rates(y, w);
    to_body(w, omega);
    const double n = y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6];
    const double s = std::abs(n - 1.0) < 1e-8 ? 1.5 - 0.5 * n : 1.0 / std::sqrt(n);
    const Quat q{s * y[3], s * y[4], s * y[5], s * y[6]};
    const Quat q_WB = rotated_ ? q * q_PB_ : q;
    attitude[0] = q_WB.x, attitude[1] = q_WB.y, attitude[2] = q_WB.z, attitude[3] = q_WB.w;
  }

  /// The derivative of the rate variables.
  void compute_derivative(double t, const double* y, double* f) const {
    if (!separatrix_) {
      double all[N];
      plain_.compute_derivative(t, y, all);
      std::copy_n(all, 3, f);
      return;
    }
    const double rate = separatrix_->rate().hi, u = y[0], v = y[1], w2 = y[2];
    f[0] = rate * w2 * u, f[1] = -rate * w2 * v, f[2] = separatrix_->middle().hi * ((v - u) * (v + u));
    if (all_.any()) add_torques(t, y, f);
  }

  /// The derivative of f by the rate variables, approximate, as Newton's method allows.
  /// @param f       the derivative at (t, y)
  /// @param change  a small change of the rate variables
  /// @return the number of right-hand sides evaluated
  int compute_jacobian(double t, const double* y, const double* f, double change, double (&J)[3][3]) const {
    if (separatrix_ && linear_) {
      const double rate = separatrix_->rate().hi, twice = 2 * separatrix_->middle().hi;
      const double free[3][3] = {
          {rate * y[2], 0, rate * y[0]}, {0, -rate * y[2], -rate * y[1]}, {-twice * y[0], twice * y[1], 0}};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) J[i][j] = free[i][j] + damping_[i][j];
      if (!formulas_.empty()) add_linear(-(R_BP_.transpose() * compute_slopes(t, y) * R_BP_), J);
      return 0;
    }
    if (!separatrix_ && differentiable_ && !formulas_.empty()) {   // J w' = tau - w x (J w)
      const Vector3d w(y[0], y[1], y[2]);
      const Matrix3d all = compute_slopes(t, y) - C_B_ + make_cross(I_B_ * w) - make_cross(w) * I_B_;
      const Matrix3d found = I_B_.inverse() * all;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) J[i][j] = found(i, j);
      return 0;
    }
    for (int j = 0; j < 3; ++j) {
      double shifted[N], f_shifted[3];
      std::copy_n(y, N, shifted);
      shifted[j] += change;
      const double exact = shifted[j] - y[j];
      compute_derivative(t, shifted, f_shifted);
      for (int i = 0; i < 3; ++i) J[i][j] = (f_shifted[i] - f[i]) / exact;
    }
    return 3;
  }

  /// The sizes by which errors of u and v are measured in a step of length h: their own, or the change by a torque.
  void compute_sizes(double h, const double* y, const double* f, double* size) const {
    if (!separatrix_) {
      size[0] = size[1] = size[2] = std::abs(y[0]) + std::abs(y[1]) + std::abs(y[2]);
      return;
    }
    const double all = size[2] = std::max(std::abs(y[0]), std::abs(y[1])) + std::abs(y[2]);
    const double least = 0x1p-200 * all, speed = separatrix_->rate().hi * y[2];
    for (int i = 0; i < 2; ++i) {
      const double driven = std::abs(f[i] - (i == 0 ? speed : -speed) * y[i]);
      const double damped =
          std::abs(damping_[i][0] * y[0]) + std::abs(damping_[i][1] * y[1]) + std::abs(damping_[i][2] * y[2]);
      size[i] = std::clamp(std::abs(h) * std::max(driven, damped), std::max(std::abs(y[i]), least), all);
    }
  }

 private:
  void to_body(const double* w, double* w_B) const {
    if (!rotated_) {
      std::copy_n(w, 3, w_B);
      return;
    }
    for (int i = 0; i < 3; ++i) w_B[i] = R_BP_(i, 0) * w[0] + R_BP_(i, 1) * w[1] + R_BP_(i, 2) * w[2];
  }

  static Matrix3d make_cross(const Vector3d& v) {
    Matrix3d matrix;
    matrix << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
    return matrix;
  }

  /// What the torque's derivative by w_B is, or that it is unknown.
  void add_slopes_of(const AnyTorque& torque) {
    if (!traits(torque).uses_rates) return;
    if (const auto C_B = find_damping(torque, I_B_)) {
      C_B_ += *C_B;
    } else if (const torques::Formula* formula = find_formula(torque)) {
      formulas_.push_back(*formula);
    } else {
      differentiable_ = false;
    }
  }

  /// d tau_B / d w_B of the formulas.
  Matrix3d compute_slopes(double t, const double* y) const {
    Matrix3d slopes = Matrix3d::Zero();
    const Seen seen = see(y);
    for (const torques::Formula& formula : formulas_)
      formula.add_rate_slopes({t, seen.w_B, seen.q_WB, I_B_, diagonal_}, slopes);
    return slopes;
  }

  void add_damping(const Matrix3d& C_P) { add_linear(C_P, damping_); }

  /// w' = -C_P w / I, converted from the rates to (u, v, w2).
  void add_linear(const Matrix3d& C_P, double (&J)[3][3]) const {
    double column[3][3];
    for (int j = 0; j < 3; ++j) {
      const double a[3] = {-C_P(0, j) / I_[0], -C_P(1, j) / I_[1], -C_P(2, j) / I_[2]};
      separatrix_->from_vector(a, column[j]);
    }
    for (int i = 0; i < 3; ++i) {
      const double across = column[0][i] * separatrix_->half_over_k().hi, along = 0.5 * column[2][i];
      J[i][0] += along - across, J[i][1] += along + across, J[i][2] += column[1][i];
    }
  }

  struct Seen {
    double w_B[3], q_WB[4];
  };
  /// What torques see of a state.
  Seen see(const double* y) const {
    Seen seen;
    std::copy_n(y, 3, seen.w_B), std::copy_n(y + 3, 4, seen.q_WB);
    if (!separatrix_) return seen;
    double w[3];
    separatrix_->to_rates(y, w);
    to_body(w, seen.w_B);
    if (rotated_) {
      const Quat q = Quat{y[3], y[4], y[5], y[6]} * q_PB_;
      seen.q_WB[0] = q.x, seen.q_WB[1] = q.y, seen.q_WB[2] = q.z, seen.q_WB[3] = q.w;
    }
    return seen;
  }

  void add_torques(double t, const double* y, double* f) const {
    double tau_B[3] = {0, 0, 0}, a[3], change[3];
    const Seen seen = see(y);
    all_.add({t, seen.w_B, seen.q_WB, I_B_, diagonal_}, tau_B);
    for (int i = 0; i < 3; ++i) {
      const double tau = rotated_ ? R_BP_(0, i) * tau_B[0] + R_BP_(1, i) * tau_B[1] + R_BP_(2, i) * tau_B[2] : tau_B[i];
      a[i] = tau / I_[i];
    }
    separatrix_->from_vector(a, change);
    for (int i = 0; i < 3; ++i) f[i] += change[i];
  }

  Matrix3d I_B_, R_BP_ = Matrix3d::Identity();
  bool diagonal_, rotated_ = false;
  bool linear_ = true;          ///< in the rates, apart from the free motion and formulas
  bool differentiable_ = true;  ///< no torque's derivative by the rates is unknown
  Matrix3d C_B_ = Matrix3d::Zero();          ///< of what is linear in the rates: tau_B = -C_B w_B
  std::vector<torques::Formula> formulas_;   ///< that depend on the rates
  double I_[3];
  Quat q_PB_ = {};
  std::optional<Separatrix> separatrix_;
  double damping_[3][3] = {};   ///< of (u, v, w2), approximate
  SeveralTorques all_;
  Plain plain_;
  double start_[N], start_carry_[3] = {};
};

}  // namespace polhode::radau
