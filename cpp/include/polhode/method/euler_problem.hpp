#pragma once

#include <algorithm>
#include <cmath>

#include "polhode/method/euler_formulas.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

/// No torque. The compiler removes the empty function.
struct NoTorque {
  void add(const TorqueInput&, double*) const {}
};

/// Euler's equations I w' = tau + (I w) x w, and q' = q (w, 0) / 2 if the attitude is integrated.
/// State: w_B [rad/s] and, `with_attitude`, q_WB. `diagonal`: the body axes are principal axes.
template <class Torque, bool diagonal, bool with_attitude>
class EulerProblem {
 public:
  static constexpr int dimension = with_attitude ? 7 : 3;

  EulerProblem(const InertiaTensor& inertia_B, const Torque& torque) : I_(inertia_B.matrix()), torque_(torque) {
    if constexpr (diagonal) {
      for (int i = 0; i < 3; ++i) {
        difference_[i] = I_((i + 1) % 3, (i + 1) % 3) - I_((i + 2) % 3, (i + 2) % 3);
        inverse_moment_[i] = 1.0 / I_(i, i);
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

  /// omega and the unit attitude of a state. The attitude is not written if it is not integrated.
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
      compute_rate_change(difference_, inverse_moment_, w, tau, f);
    } else {
      compute_rate_change_skew(I_.data(), inverse_.data(), w, tau, f);
    }
    if constexpr (with_attitude) compute_attitude_rate(q, w, f + 3);
  }

  double error_norm(const double* error, const double* y0, const double* y1, double rtol, double atol) const {
    return compute_error_norm<with_attitude>(error, y0, y1, rtol, atol);
  }

  /// Restores |q| = 1. The derivative f is linear in q, and torques depend on the direction of q alone, so both scale.
  void restore(double* y, double* f) const {
    if constexpr (with_attitude) {
      const double s = compute_unit_scale(y + 3);
      for (int i = 3; i < 7; ++i) y[i] *= s, f[i] *= s;
    }
  }

  const double* difference() const { return difference_; }           ///< (I2 - I3, I3 - I1, I1 - I2) of principal axes
  const double* inverse_moment() const { return inverse_moment_; }
  const Matrix3d& inverse() const { return inverse_; }               ///< of the tensor in other axes

 private:
  Matrix3d I_;
  const Torque& torque_;
  double difference_[3] = {}, inverse_moment_[3] = {};
  Matrix3d inverse_ = Matrix3d::Zero();
};

}  // namespace polhode
