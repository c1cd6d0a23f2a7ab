#pragma once

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "polhode/math/detail/functions.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

/// Lagrange's equations d/dt dT/dq' - dT/dq = Q in the textbook's z-x-z angles q = (phi, theta, psi), R_WB = Rz(phi)
/// Rx(theta) Rz(psi). They give the same motion by other equations, for teaching and for tests. With w_B = E(theta,
/// psi) q' the kinetic energy is T = w.I w / 2 and the generalised forces are Q = E^T tau_B, so Q_psi is the torque's
/// component along body z. E is singular where sin(theta) = 0, and so are the equations. State: phi, theta, psi and
/// their rates.
template <class Torque>
class LagrangianProblem {
 public:
  static constexpr int dimension = 6;
  static constexpr double least_sine = 1e-8;   ///< of theta; below it phi' loses half its digits

  LagrangianProblem(const InertiaTensor& inertia_B, const Torque& torque) : I_(inertia_B.matrix()), torque_(torque) {}

  static Matrix3d compute_rate_map(double theta, double psi) {
    const auto [st, ct] = math::sincos(theta);
    const auto [sp, cp] = math::sincos(psi);
    Matrix3d E;
    E << st * sp, cp, 0, st * cp, -sp, 0, ct, 0, 1;
    return E;
  }

  /// The angles (phi, theta, psi) of an attitude, theta in [0, pi].
  static Vector3d compute_angles(const Quat& q) {
    const double sum = 2 * math::atan2(q.z, q.w), difference = 2 * math::atan2(q.y, q.x);
    return {0.5 * (sum + difference), 2 * math::atan2(math::hypot(q.x, q.y), math::hypot(q.z, q.w)),
            0.5 * (sum - difference)};
  }

  static void pack(const State& state, double* y) {
    const Vector3d angles = compute_angles(state.attitude);
    const Vector3d rates = compute_rate_map(angles[1], angles[2]).inverse() * state.omega;
    for (int i = 0; i < 3; ++i) y[i] = angles[i], y[3 + i] = rates[i];
  }

  static void unpack(const double* y, double* omega, double* attitude) {
    const Vector3d w = compute_rate_map(y[1], y[2]) * Vector3d{y[3], y[4], y[5]};
    const auto [s, c] = math::sincos(0.5 * y[1]);
    const math::SinCosPair sum = math::sincos(0.5 * (y[0] + y[2])), difference = math::sincos(0.5 * (y[0] - y[2]));
    for (int i = 0; i < 3; ++i) omega[i] = w[i];
    attitude[0] = s * difference.cos, attitude[1] = s * difference.sin;
    attitude[2] = c * sum.sin, attitude[3] = c * sum.cos;
  }

  void compute_derivative(double t, const double* y, double* f) const {
    const auto [st, ct] = math::sincos(y[1]);
    const auto [sp, cp] = math::sincos(y[2]);
    if (!(std::abs(st) > least_sine)) {
      for (int i = 0; i < 6; ++i) f[i] = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    const Vector3d rates{y[3], y[4], y[5]};
    Matrix3d E, E_theta, E_psi;
    E << st * sp, cp, 0, st * cp, -sp, 0, ct, 0, 1;
    E_theta << ct * sp, 0, 0, ct * cp, 0, 0, -st, 0, 0;
    E_psi << st * cp, -sp, 0, -st * sp, -cp, 0, 0, 0, 0;
    const Matrix3d E_dot = E_theta * rates[1] + E_psi * rates[2];
    const Vector3d omega = E * rates, L = I_ * omega;

    double attitude[4], w[3], tau[3] = {0, 0, 0};
    unpack(y, w, attitude);
    torque_.add(TorqueInput{t, w, attitude, I_}, tau);
    const Vector3d Q = E.transpose() * Vector3d{tau[0], tau[1], tau[2]};
    const Vector3d T_q{0.0, L.dot(E_theta * rates), L.dot(E_psi * rates)};          // dT/dq
    const Vector3d rest = E_dot.transpose() * L + E.transpose() * (I_ * (E_dot * rates));  // d/dt dT/dq' less M q''
    const Matrix3d M = E.transpose() * I_ * E;
    const Vector3d accelerations = M.inverse() * (Q + T_q - rest);
    for (int i = 0; i < 3; ++i) f[i] = rates[i], f[3 + i] = accelerations[i];
  }

  double error_norm(const double* error, const double* y0, const double* y1, double rtol, double atol) const {
    // A step across theta = 0 or pi is rejected, because phi and psi are not defined there.
    if ((math::sin(y0[1]) > 0) != (math::sin(y1[1]) > 0)) return std::numeric_limits<double>::quiet_NaN();
    const auto sum = [](const double* v) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); };
    const double e = sum(error + 3), allowed = rtol * std::max(sum(y0 + 3), sum(y1 + 3)) + atol;
    const double rates = e == 0.0 ? 0.0 : e / allowed, angles = sum(error) / (rtol + atol);
    return rates > angles || rates != rates ? rates : angles;
  }

  void restore(double*, double*) const {}

 private:
  Matrix3d I_;
  const Torque& torque_;
};

}  // namespace polhode
