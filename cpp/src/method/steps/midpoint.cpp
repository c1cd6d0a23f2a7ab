#include <Eigen/LU>

#include "method/steps/body_stepper.hpp"

namespace polhode {
namespace {

/// The implicit midpoint rule in L. Newton's method solves I x + x x (I x) = (h/2) L, and the body rotates by the
/// quaternion (x, 1) / norm. L -= (4/h) x x (I x) is exactly the rotated L, so energy and L in space are conserved.
class Midpoint {
 public:
  static constexpr bool kick_within = false;
  static constexpr int interior = 0;

  Midpoint(const PrincipalBody& body, const Scene&) : body_(&body) {}

  bool advance(double h, const double*, double* L, double* q) {
    const double* I = body_->I;
    double w[3], gyro[3], x[3], b[3];
    for (int i = 0; i < 3; ++i) w[i] = L[i] / I[i], b[i] = 0.5 * h * L[i];
    cross(L, w, gyro);
    for (int i = 0; i < 3; ++i) x[i] = 0.5 * h * (w[i] + 0.5 * h * gyro[i] / I[i]);
    const double size = std::abs(b[0] / I[0]) + std::abs(b[1] / I[1]) + std::abs(b[2] / I[2]);
    for (int n = 0;; ++n) {
      if (n == most_steps_) return false;
      const double M[3] = {I[0] * x[0], I[1] * x[1], I[2] * x[2]};
      Matrix3d J;   // I + [x] I - [I x]
      J << I[0], M[2] - x[2] * I[1], x[1] * I[2] - M[1],  //
          x[2] * I[0] - M[2], I[1], M[0] - x[0] * I[2],   //
          M[1] - x[1] * I[0], x[0] * I[1] - M[0], I[2];
      double g[3];
      cross(x, M, g);
      const Vector3d change = J.inverse() * Vector3d{M[0] + g[0] - b[0], M[1] + g[1] - b[1], M[2] + g[2] - b[2]};
      for (int i = 0; i < 3; ++i) x[i] -= change[i];
      const double size_of_change = std::abs(change[0]) + std::abs(change[1]) + std::abs(change[2]);
      if (!std::isfinite(size_of_change))
        return !std::isfinite(L[0] + L[1] + L[2]);   // true: the torque is not finite; false: no solution
      if (size_of_change <= 1e-9 * size) break;      // converges quadratically: the next change is below rounding
    }
    const double M[3] = {I[0] * x[0], I[1] * x[1], I[2] * x[2]}, p[4] = {x[0], x[1], x[2], 1.0};
    double g[3];
    cross(x, M, g);
    for (int i = 0; i < 3; ++i) L[i] -= 4 / h * g[i];
    rotate_by(p, q);
    return true;
  }

 private:
  static constexpr int most_steps_ = 50;
  const PrincipalBody* body_;
};

}  // namespace

const BodyMethod midpoint_method{
    {
        .name = "midpoint",
        .order = 2,
        .dense_order = 3,
        .adaptive = false,
        .implicit = true,
        .keeps = "energy, |L|, L",
        .doc = "The implicit midpoint rule in the angular momentum. It conserves energy and L of a free body; its "
               "phase drifts.",
        .source =
            "Austin, Krishnaprasad & Wang 1993, J. Comput. Phys. 107, 105; Lewis & Simo 1994, J. Nonlinear Sci. 4, 253",
    },
    &integrate_with<Midpoint>,
};

}  // namespace polhode
