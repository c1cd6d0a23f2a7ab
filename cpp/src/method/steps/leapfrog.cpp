#include <string>

#include "method/steps/body_stepper.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

/// weight times arm of gravity with its arm along the axis of symmetry; 0 without a torque, NaN with any other torque or
/// with rotors.
double find_weight_arm(const Scene& scene) {
  if (!scene.rotor_momentum().isZero(0.0)) return NAN;
  if (scene.torques().empty()) return 0.0;
  const auto* gravity = std::get_if<torques::Gravity>(&scene.torques().front());
  if (scene.torques().size() != 1 || !gravity || gravity->arm()[0] != 0.0 || gravity->arm()[1] != 0.0) return NAN;
  return gravity->weight() * gravity->arm()[2];
}

/// Stoermer-Verlet in the textbook's z-x-z angles of a symmetric body. phi and psi are cyclic, so theta moves in an
/// effective potential. The equations divide by sin(theta).
class Leapfrog {
 public:
  static constexpr bool kick_within = true;    // force() includes the torque; BodyStepper's kick is not used
  static constexpr int interior = 0;

  Leapfrog(const PrincipalBody& body, const Scene& scene) : body_(&body) {
    // refuse_leapfrog() has checked the scene, so find_weight_arm is not NaN. It is scaled by the powers of two of the
    // moments.
    const double e = body.I[2] / scene.inertia_B().matrix()(2, 2), unit = body.to_scaled_time(1.0);
    M_ = find_weight_arm(scene) * e / unit / unit;
  }

  bool advance(double h, const double*, double* L, double* q) {
    const double* I = body_->I;
    if (!ready_) start(L, q);
    p_ += 0.5 * h * force(theta_);
    const auto [s, c] = math::sincos(theta_ + 0.5 * h * p_ / I[0]);
    const double r = (p_phi_ - p_psi_ * c) / (I[0] * s * s);
    phi_ += h * r;
    psi_ += h * (p_psi_ / I[2] - r * c);
    theta_ += h * p_ / I[0];
    p_ += 0.5 * h * force(theta_);

    const math::SinCosPair half = math::sincos(0.5 * theta_), sum = math::sincos(0.5 * (phi_ + psi_));
    const math::SinCosPair difference = math::sincos(0.5 * (phi_ - psi_));
    q[0] = half.sin * difference.cos, q[1] = half.sin * difference.sin;
    q[2] = half.cos * sum.sin, q[3] = half.cos * sum.cos;
    const math::SinCosPair theta = math::sincos(theta_), psi = math::sincos(psi_);
    const double across = (p_phi_ - p_psi_ * theta.cos) / theta.sin;   // I1 phi' sin(theta)
    L[0] = across * psi.sin + p_ * psi.cos;
    L[1] = across * psi.cos - p_ * psi.sin;
    L[2] = p_psi_;
    return true;
  }

 private:
  void start(const double* L, const double* q) {
    const double sum = 2 * math::atan2(q[2], q[3]), difference = 2 * math::atan2(q[1], q[0]);
    phi_ = 0.5 * (sum + difference), psi_ = 0.5 * (sum - difference);
    theta_ = 2 * math::atan2(math::hypot(q[0], q[1]), math::hypot(q[2], q[3]));
    p_psi_ = L[2];
    const math::SinCosPair theta = math::sincos(theta_), psi = math::sincos(psi_);
    p_phi_ = (L[0] * psi.sin + L[1] * psi.cos) * theta.sin + p_psi_ * theta.cos;
    p_ = L[0] * psi.cos - L[1] * psi.sin;
    ready_ = true;
  }

  /// p_theta' = -dV/dtheta of the effective potential
  double force(double theta) const {
    const auto [s, c] = math::sincos(theta);
    return -(p_phi_ - p_psi_ * c) * (p_psi_ - p_phi_ * c) / (body_->I[0] * s * s * s) + M_ * s;
  }

  const PrincipalBody* body_;
  bool ready_ = false;
  double M_ = 0.0, phi_ = 0.0, theta_ = 0.0, psi_ = 0.0, p_ = 0.0, p_phi_ = 0.0, p_psi_ = 0.0;
};

std::string refuse_leapfrog(const Scene& scene) {
  const Matrix3d& I = scene.inertia_B().matrix();
  if (!scene.inertia_B().is_diagonal() || I(0, 0) != I(1, 1)) return "a body without I1 = I2 about body z";
  if (!scene.rotor_momentum().isZero(0.0)) return "rotors, whose momentum changes p_phi and p_psi";
  if (std::isnan(find_weight_arm(scene))) return "a torque other than gravity along body z";
  const double s =
      math::hypot(scene.attitude().x, scene.attitude().y) * math::hypot(scene.attitude().z, scene.attitude().w);
  return s > 0.5e-8 ? "" : "a start at theta = 0 or pi";
}

}  // namespace

const BodyMethod leapfrog_method{
    {
        .name = "leapfrog",
        .order = 2,
        .dense_order = 3,
        .adaptive = false,
        .comparison = true,
        .keeps = "L_z",
        .needs = "I1 = I2 about body z, gravity along body z as the only torque, no rotors, and theta away from 0 and "
                 "pi",
        .doc = "Leapfrog in the textbook's z-x-z angles. It conserves p_phi and p_psi, and its energy error stays "
               "bounded away from theta = 0 and pi.",
        .source = "Goldstein, Classical Mechanics, sec. 5.7; Hairer, Lubich & Wanner 2003, Acta Numerica 12, 399",
    },
    &integrate_with<Leapfrog>,
    &refuse_leapfrog,
};

}  // namespace polhode
