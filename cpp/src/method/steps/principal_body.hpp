#pragma once

#include <array>
#include <cmath>

#include "polhode/math/detail/functions.hpp"
#include "polhode/method/euler_problem.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

/// A body in principal axes P and in scaled units: the largest moment and the step lie in [1, 2). The scales are powers
/// of two, so that they change no bit and no formula overflows.
class PrincipalBody {
 public:
  /// @param ascending  order the principal axes by their moments, if these differ
  PrincipalBody(const Scene& scene, double step, bool ascending = false)
      : torques_(scene.all_torques()), I_B_(scene.inertia_B().matrix()), diagonal_(scene.inertia_B().is_diagonal()),
        driven_(torques_.any()), uses_rates_(scene.torque_sum().uses_rates) {
    const InertiaTensor& inertia = scene.inertia_B();
    const bool as_given = diagonal_ && !(ascending && inertia.moments()[0] < inertia.moments()[1] &&
                                         inertia.moments()[1] < inertia.moments()[2]);
    R_BP_ = as_given ? Matrix3d(Matrix3d::Identity()) : inertia.axes();
    rotated_ = R_BP_ != Matrix3d::Identity();
    q_BP_ = to_quat(R_BP_);
    const Vector3d moments = as_given ? Vector3d(I_B_.diagonal()) : inertia.moments();
    const int e = std::ilogb(moments.maxCoeff()), f = std::ilogb(step);
    mass_ = std::ldexp(1.0, -e);
    time_ = std::ldexp(1.0, -f);
    rate_ = std::ldexp(1.0, f);
    for (int i = 0; i < 3; ++i) I[i] = moments[i] * mass_;
  }

  double I[3];                                  ///< principal moments, scaled

  bool driven() const { return driven_; }
  bool uses_rates() const { return uses_rates_; }
  double to_scaled_time(double t) const { return t * time_; }

  /// w_P, scaled.
  void compute_rates(const double* y, double* w) const {
    for (int i = 0; i < 3; ++i) w[i] = (R_BP_(0, i) * y[0] + R_BP_(1, i) * y[1] + R_BP_(2, i) * y[2]) * rate_;
  }

  /// Converts (w_B, q_WB) of the scene to L_P, scaled, and q_WP.
  void enter(const double* y, double* L, double* q) const {
    double w[3];
    compute_rates(y, w);
    for (int i = 0; i < 3; ++i) L[i] = I[i] * w[i];
    const Quat q_WP = Quat{y[3], y[4], y[5], y[6]} * q_BP_;
    q[0] = q_WP.x, q[1] = q_WP.y, q[2] = q_WP.z, q[3] = q_WP.w;
  }

  void leave(const double* L, const double* q, double* y) const {
    double w[3];
    for (int i = 0; i < 3; ++i) w[i] = L[i] / I[i] * time_;
    if (!rotated_) {
      for (int i = 0; i < 3; ++i) y[i] = w[i];
      for (int i = 0; i < 4; ++i) y[3 + i] = q[i];
      return;
    }
    for (int i = 0; i < 3; ++i) y[i] = R_BP_(i, 0) * w[0] + R_BP_(i, 1) * w[1] + R_BP_(i, 2) * w[2];
    const Quat q_WB = Quat{q[0], q[1], q[2], q[3]} * conjugate(q_BP_);
    y[3] = q_WB.x, y[4] = q_WB.y, y[5] = q_WB.z, y[6] = q_WB.w;
  }

  /// tau_P, scaled, at the time t of the scene.
  void compute_torque(double t, const double* L, const double* q, double* tau) const {
    double y[7], tau_B[3] = {0.0, 0.0, 0.0};
    leave(L, q, y);
    torques_.add(TorqueInput{t, y, y + 3, I_B_, diagonal_}, tau_B);
    for (int i = 0; i < 3; ++i) {
      const double tau_P =
          !rotated_ ? tau_B[i] : R_BP_(0, i) * tau_B[0] + R_BP_(1, i) * tau_B[1] + R_BP_(2, i) * tau_B[2];
      tau[i] = tau_P * mass_ * rate_ * rate_;
    }
  }

 private:
  static Quat to_quat(const Matrix3d& R) {   // of a proper rotation: the largest component first (Shepperd 1978)
    const double t = R.trace(), x = R(0, 0), y = R(1, 1), z = R(2, 2);
    Quat q;
    if (t >= x && t >= y && t >= z) {
      q = {R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1), 1 + t};
    } else if (x >= y && x >= z) {
      q = {1 + 2 * x - t, R(0, 1) + R(1, 0), R(0, 2) + R(2, 0), R(2, 1) - R(1, 2)};
    } else if (y >= z) {
      q = {R(0, 1) + R(1, 0), 1 + 2 * y - t, R(1, 2) + R(2, 1), R(0, 2) - R(2, 0)};
    } else {
      q = {R(0, 2) + R(2, 0), R(1, 2) + R(2, 1), 1 + 2 * z - t, R(1, 0) - R(0, 1)};
    }
    return normalized(q);
  }

  SeveralTorques torques_;
  Matrix3d I_B_, R_BP_;
  Quat q_BP_;
  bool diagonal_, driven_, uses_rates_, rotated_ = false;
  double mass_ = 1.0, time_ = 1.0, rate_ = 1.0;
};

// ---- vectors and quaternions as plain numbers

inline void cross(const double* a, const double* b, double* c) {
  const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
  c[0] = x, c[1] = y, c[2] = z;
}

/// q = q p, normalised.
inline void rotate_by(const double* p, double* q) {
  const double x = q[3] * p[0] + q[0] * p[3] + q[1] * p[2] - q[2] * p[1];
  const double y = q[3] * p[1] - q[0] * p[2] + q[1] * p[3] + q[2] * p[0];
  const double z = q[3] * p[2] + q[0] * p[1] - q[1] * p[0] + q[2] * p[3];
  const double w = q[3] * p[3] - q[0] * p[0] - q[1] * p[1] - q[2] * p[2];
  const double n = x * x + y * y + z * z + w * w;
  const double s = std::abs(n - 1.0) < 1e-8 ? 1.5 - 0.5 * n : 1.0 / std::sqrt(n);
  q[0] = s * x, q[1] = s * y, q[2] = s * z, q[3] = s * w;
}

/// The unit quaternion of the rotation vector r, exp(r / 2).
inline void exponential(const double* r, double* p) {
  const double x = 0.25 * (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);   // the half angle, squared
  double s;
  if (x < 0.25) {   // sin and cos by their series, to rounding
    s = 0.5 *
        (1 - x * (1.0 / 6) *
                 (1 - x * (1.0 / 20) *
                          (1 - x * (1.0 / 42) *
                                   (1 - x * (1.0 / 72) *
                                            (1 - x * (1.0 / 110) * (1 - x * (1.0 / 156) * (1 - x * (1.0 / 210))))))));
    p[3] = 1 - x * (1.0 / 2) *
                   (1 - x * (1.0 / 12) *
                            (1 - x * (1.0 / 30) *
                                     (1 - x * (1.0 / 56) *
                                              (1 - x * (1.0 / 90) * (1 - x * (1.0 / 132) * (1 - x * (1.0 / 182)))))));
  } else {
    const double half = std::sqrt(x);
    const math::SinCosPair unit = math::sincos(half);
    s = 0.5 * unit.sin / half;
    p[3] = unit.cos;
  }
  for (int i = 0; i < 3; ++i) p[i] = s * r[i];
}

inline void rotate_by_vector(const double* r, double* q) {
  double p[4];
  exponential(r, p);
  rotate_by(p, q);
}

/// v = R(p)^T v for a unit quaternion p: a vector fixed in space, in the axes of a body that has rotated by p.
inline void rotate_back(const double* p, double* v) {
  double t[3], u[3];
  cross(v, p, t);
  for (int i = 0; i < 3; ++i) t[i] *= 2;
  cross(t, p, u);
  for (int i = 0; i < 3; ++i) v[i] += p[3] * t[i] + u[i];
}

}  // namespace polhode
