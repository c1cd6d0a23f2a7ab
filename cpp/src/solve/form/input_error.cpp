#include "solve/form/input_error.hpp"

#include "polhode/math/detail/double_double.hpp"
#include "solve/form/parts.hpp"

namespace polhode::form {

bool times_are_rounded(const Scene& scene) {
  if (scene.t0() == 0.0) return false;
  bool rounded = false;
  for (const double t : scene.times()) rounded |= math::two_diff(t, scene.t0()).lo != 0.0;
  return rounded;
}

Vector3d find_lost_momentum(const Scene& scene, const Vector3d& h_B) {
  math::DD sum[3] = {};
  Vector3d lost = Vector3d::Zero();
  for (const Rotor& rotor : scene.rotors()) {
    const double momentum = rotor.compute_momentum(scene.omega());
    const bool skew = rotor.axis().cwiseAbs().maxCoeff() < 1.0;   // its axis was rounded to length 1
    const double roundings = (rotor.momentum() ? 0.0 : rotor.free() ? 4.0 : 1.0) + (skew ? 2.0 : 0.0);
    for (int i = 0; i < 3; ++i) {
      sum[i] = sum[i] + math::DD(math::two_prod(momentum, rotor.axis()[i]));
      lost[i] += roundings * unit_roundoff * std::abs(momentum * rotor.axis()[i]);
    }
  }
  for (int i = 0; i < 3; ++i) lost[i] += std::abs((sum[i] - math::DD(h_B[i])).hi);
  return lost;
}

int count_lost_components(const Scene& scene, const Vector3d& h_B) {
  const Vector3d lost = find_lost_momentum(scene, h_B);
  return (lost[0] != 0.0) + (lost[1] != 0.0) + (lost[2] != 0.0);
}

bool inertia_is_rounded(const Scene& scene) {
  return (!scene.inertia_B().is_diagonal() || has_carrier(scene)) && !scene.omega().isZero(0.0);
}

InertiaTensor nudge_moments(const Scene& scene, double sign) {
  const double largest = scene.given_inertia_B().moments()[2];
  return InertiaTensor::from_moments(scene.inertia_B().principal().moments + sign * nudge * largest * signs, false);
}

}  // namespace polhode::form
