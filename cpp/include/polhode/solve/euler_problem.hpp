#pragma once

#include <algorithm>
#include <cmath>

#include "polhode/scene/scene.hpp"

namespace polhode {

/// No torque at all: the compiler sees it and leaves nothing of it.
struct NoTorque {
  void add(const TorqueInput&, double*) const {}
};

/// Several torques acting together.
struct SeveralTorques {
  const std::vector<AnyTorque>& torques;
  void add(const TorqueInput& in, double* tau_B) const {
    for (const AnyTorque& torque : torques) std::visit([&](const auto& one) { one.add(in, tau_B); }, torque);
  }
};

/// Euler's equations I w' = tau + (I w) x w, and q' = q (w, 0) / 2 when the attitude is carried along.
/// State: w_B [rad/s] and, `with_attitude`, q_WB. `diagonal`: the body axes are principal axes.
template <class Torque, bool diagonal, bool with_attitude>
class EulerProblem {
 public:
  static constexpr int dimension = with_attitude ? 7 : 3;

  EulerProblem(const InertiaTensor& inertia_B, const Torque& torque) : I_(inertia_B.matrix()), torque_(torque) {
    if constexpr (diagonal) {
      for (int i = 0; i < 3; ++i) {
        moment_[i] = I_(i, i);
        difference_[i] = I_((i + 1) % 3, (i + 1) % 3) - I_((i + 2) % 3, (i + 2) % 3);
        inverse_moment_[i] = 1.0 / moment_[i];
      }
    } else {
      const Matrix3d& R_BP = inertia_B.axes();
      const Vector3d& moments = inertia_B.moments();
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          double sum = 0.0;
          for (int k = 0; k < 3; ++k) sum += R_BP(i, k) * R_BP(j, k) / moments[k];
          inverse_(i, j) = sum;
        }
    }
  }

  /// omega and the unit attitude of a state; the attitude is left alone when it is not carried along.
  static void unpack(const double* y, double* omega, double* attitude) {
    std::copy_n(y, 3, omega);
    if constexpr (with_attitude) {
      const double s = compute_unit_scale(y + 3);
      for (int i = 0; i < 4; ++i) attitude[i] = s * y[3 + i];
    }
  }

  static void pack(const State& state, double* y) {
    std::copy_n(state.omega.data(), 3, y);
    const Quat& q = state.attitude;
    if constexpr (with_attitude) y[3] = q.x, y[4] = q.y, y[5] = q.z, y[6] = q.w;
  }

  void compute_derivative(double t, const double* y, double* f) const {
    static constexpr double identity[4] = {0.0, 0.0, 0.0, 1.0};
    const double *w = y, *q = with_attitude ? y + 3 : identity;
    double tau[3] = {0.0, 0.0, 0.0};
    torque_.add(TorqueInput{t, w, q, I_, diagonal}, tau);
    if constexpr (diagonal) {
      f[0] = (difference_[0] * w[1] * w[2] + tau[0]) * inverse_moment_[0];
      f[1] = (difference_[1] * w[2] * w[0] + tau[1]) * inverse_moment_[1];
      f[2] = (difference_[2] * w[0] * w[1] + tau[2]) * inverse_moment_[2];
    } else {
      double L[3];
      for (int i = 0; i < 3; ++i) L[i] = I_(i, 0) * w[0] + I_(i, 1) * w[1] + I_(i, 2) * w[2];
      tau[0] += L[1] * w[2] - L[2] * w[1];
      tau[1] += L[2] * w[0] - L[0] * w[2];
      tau[2] += L[0] * w[1] - L[1] * w[0];
      for (int i = 0; i < 3; ++i) f[i] = inverse_(i, 0) * tau[0] + inverse_(i, 1) * tau[1] + inverse_(i, 2) * tau[2];
    }
    if constexpr (with_attitude) {
      const double a = 0.5 * w[0], b = 0.5 * w[1], c = 0.5 * w[2];
      f[3] = q[3] * a + q[1] * c - q[2] * b;
      f[4] = q[3] * b + q[2] * a - q[0] * c;
      f[5] = q[3] * c + q[0] * b - q[1] * a;
      f[6] = -(q[0] * a + q[1] * b + q[2] * c);
    }
  }

  /// Two blocks, since rates have a unit and a quaternion has none; sums of magnitudes carry a NaN through.
  double error_norm(const double* error, const double* y0, const double* y1, double rtol, double atol) const {
    const double size = std::max(sum(y0, 3), sum(y1, 3));
    const double e = sum(error, 3), allowed = rtol * size + atol;
    const double rates = e == 0.0 ? 0.0 : e / allowed;
    if constexpr (with_attitude) {
      const double turn = (sum(error + 3, 3) + std::abs(error[6])) / (rtol + atol);
      return rates > turn || rates != rates ? rates : turn;
    } else {
      return rates;
    }
  }

  /// |q| = 1 again. The derivative of q is linear in q and the torques see only its direction, so both scale alike.
  void restore(double* y, double* f) const {
    if constexpr (with_attitude) {
      const double s = compute_unit_scale(y + 3);
      for (int i = 3; i < 7; ++i) y[i] *= s, f[i] *= s;
    }
  }

 private:
  /// 1/|q|; within 1e-8 of unity its tangent is exact to rounding.
  static double compute_unit_scale(const double* q) {
    const double n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    return std::abs(n - 1.0) < 1e-8 ? 1.5 - 0.5 * n : 1.0 / std::sqrt(n);
  }

  static double sum(const double* v, int n) {
    double total = 0.0;
    for (int i = 0; i < n; ++i) total += std::abs(v[i]);
    return total;
  }

  Matrix3d I_;
  const Torque& torque_;
  double moment_[3] = {}, difference_[3] = {}, inverse_moment_[3] = {};
  Matrix3d inverse_ = Matrix3d::Zero();
};

}  // namespace polhode
