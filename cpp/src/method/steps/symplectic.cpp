#include <optional>

#include "method/steps/body_stepper.hpp"
#include "method/steps/free_drift.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

/// The exact motion of the free body over each part of a step. A triaxial body uses its Taylor series. Other bodies,
/// and long steps, use a rotation p of the body, with L_B = R(p)^T L_B.
class ExactDrift {
 public:
  static constexpr bool kick_within = false;
  static constexpr bool ascending = true;
  static constexpr int carried = FreeDrift::numbers;
  static constexpr int interior = 2;
  /// SRKN6b of Blanes & Moan 2002, table 3. It has order 4 if the commutator of a drift with three kicks vanishes. That
  /// holds for a torque that does not depend on the rates and a drift energy quadratic in L.
  static constexpr double a1 = 0.245298957184271, a2 = 0.604872665711080, a3 = 0.5 - (a1 + a2);
  static constexpr double b1 = 0.0829844064174052, b2 = 0.396309801498368, b3 = -0.0390563049223486,
                          b4 = 1.0 - 2 * (b1 + b2 + b3);
  static constexpr double drifts[6] = {a1, a2, a3, a3, a2, a1};
  static constexpr double kicks[7] = {b1, b2, b3, b4, b3, b2, b1};

  ExactDrift(const PrincipalBody& body, const Scene& scene)
      : inertia_(InertiaTensor::from_moments({body.I[0], body.I[1], body.I[2]}, false)) {
    for (int i = 0; i < 3; ++i) {
      I_[i] = body.I[i];
      if (body.I[(i + 1) % 3] == body.I[(i + 2) % 3]) axis_ = i;
    }
    if (axis_ >= 0) return;
    const State start = scene.start();
    double y[7], w[3];
    EulerProblem<NoTorque, true, true>::pack(start, y);
    body.compute_rates(y, w);
    series_.emplace(Vector3d(I_[0], I_[1], I_[2]), Vector3d(w[0], w[1], w[2]));
  }

  void start(const double* w, double* own) const {
    if (series_) series_->start(w, own);
  }
  void kick(const double* kick, double* own) const {
    if (!series_) return;
    const double a[3] = {kick[0] / I_[0], kick[1] / I_[1], kick[2] / I_[2]};
    series_->kick(a, own);
  }

  bool advance(double h, const double*, double* L, double* q) {
    if (!std::isfinite(L[0] + L[1] + L[2])) return true;   // BodyStepper reports it
    double p[4], w[3];
    if (series_ && series_->advance(h, L + 3, q)) {
      series_->to_rates(L + 3, w);
      for (int i = 0; i < 3; ++i) L[i] = I_[i] * w[i];
      return true;
    }
    if (axis_ >= 0) {
      rotate_symmetric(h, L, p);
    } else {
      const State end = FreeMotion(inertia_, {L[0] / I_[0], L[1] / I_[1], L[2] / I_[2]}).at(h);
      p[0] = end.attitude.x, p[1] = end.attitude.y, p[2] = end.attitude.z, p[3] = end.attitude.w;
    }
    rotate_by(p, q);
    rotate_back(p, L);
    if (series_) {
      for (int i = 0; i < 3; ++i) w[i] = L[i] / I_[i];
      series_->start(w, L + 3);
    }
    return true;
  }

 private:
  /// Regular precession: a rotation about L by |L| h / I1, then about the axis by (1 - I3/I1) w3 h.
  void rotate_symmetric(double h, const double* L, double* p) const {
    const double across = I_[(axis_ + 1) % 3];
    double r[3], spin[4] = {0, 0, 0, 1};
    for (int i = 0; i < 3; ++i) r[i] = h * (L[i] / across);
    exponential(r, p);
    const math::SinCosPair half = math::sincos(0.5 * h * (L[axis_] / I_[axis_]) * ((across - I_[axis_]) / across));
    spin[axis_] = half.sin;
    spin[3] = half.cos;
    rotate_by(spin, p);
  }

  InertiaTensor inertia_;
  std::optional<FreeDrift> series_;
  int axis_ = -1;
  double I_[3];
};

std::string refuse_symplectic(const Scene& scene) {
  if (!scene.rotor_momentum().isZero(0.0)) return "rotors, whose torque h x omega depends on the rates";
  return scene.torque_sum().uses_rates ? "a torque that depends on the rates" : "";
}

}  // namespace

const BodyMethod symplectic_method{
    {
        .name = "symplectic",
        .order = 4,
        .dense_order = 4,
        .adaptive = false,
        .keeps = "energy, |L|, L",
        .needs = "no rotors, and torques that do not depend on the rates",
        .doc = "Splitting into the exact free motion and kicks by the torque, at a fixed step. The map is symplectic, "
               "so the energy error stays bounded.",
        .source = "Blanes & Moan 2002, J. Comput. Appl. Math. 142, 313 (SRKN6b)",
    },
    &integrate_with<ExactDrift>,
    &refuse_symplectic,
};

}  // namespace polhode
