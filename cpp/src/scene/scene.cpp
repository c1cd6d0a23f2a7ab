#include "polhode/scene/scene.hpp"

#include <cmath>

#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "polhode/scene/parameter.hpp"

namespace polhode {
namespace {

/// The inertia without the axial moments of free rotors; null if there are none.
std::shared_ptr<const InertiaTensor> make_carrier(const InertiaTensor& all, const std::vector<Rotor>& rotors) {
  Matrix3d J = all.matrix();
  bool any = false;
  for (std::size_t i = 0; i < rotors.size(); ++i) {
    if (!rotors[i].free() || !rotors[i].inertia()) continue;
    const Vector3d a = rotors[i].axis();
    const double own = *rotors[i].inertia(), whole = all.about_axis(a);
    if (!(own < whole)) {
      throw InvalidInput("scene.rotors[" + std::to_string(i) + "].inertia",
                         "below the body's moment about the rotor's axis, " + to_text(whole), to_text(own),
                         "the body's inertia includes its rotors");
    }
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c <= r; ++c) J(r, c) = J(c, r) = J(r, c) - own * a[r] * a[c];
    any = true;
  }
  if (!any) return nullptr;
  const double least = compute_principal_axes(J).moments[0];
  if (!(least > InertiaTensor::tolerance * all.moments()[2])) {
    throw InvalidInput("scene.rotors", "free rotors that leave the body three positive moments",
                       "a least moment of " + to_text(least),
                       "the body's inertia includes its rotors, and their axial moments are taken from it");
  }
  // What is left is no body of its own, so the triangle inequality need not hold for it.
  return std::make_shared<const InertiaTensor>(InertiaTensor::from_trusted(J, false));
}

/// The gradient of gravity acts on the mass of free rotors, which is not in their carrier.
void require_no_gradient(const std::vector<AnyTorque>& torques) {
  for (const AnyTorque& torque : torques) {
    if (!std::holds_alternative<torques::GravityGradient>(drop_windows(torque))) continue;
    throw InvalidInput("scene.torques", "without GravityGradient beside free rotors with an inertia", "GravityGradient",
                       "it acts on the inertia of all, and omega moves the inertia without these rotors");
  }
}

}  // namespace

Scene::Scene(SceneParts parts) {
  const Vector3d& moments = parts.inertia_B.moments();
  if (!(moments.minCoeff() > 0.0)) {
    throw InvalidInput("scene.inertia", "a tensor with three positive principal moments",
                       "a least moment of " + to_text(moments.minCoeff()),
                       "a rod or a point has a zero moment, so its rate about that axis is undefined");
  }
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(parts.omega[i])) throw InvalidInput("scene.omega", "finite", to_text(parts.omega[i]));
    require_kept(parts.omega[i], "scene.omega");
  }
  parts.attitude = make_attitude(parts.attitude);
  if (!std::isfinite(parts.t0)) throw InvalidInput("scene.t0", "finite", to_text(parts.t0));
  if (parts.times.empty()) {
    throw InvalidInput("scene.times", "at least one time", "none", "give the times of the samples");
  }
  for (std::size_t i = 0; i < parts.times.size(); ++i) {
    if (!std::isfinite(parts.times[i])) {
      throw InvalidInput("scene.times", "finite", to_text(parts.times[i]) + " at index " + std::to_string(i));
    }
  }
  if (!parts.want.omega && !parts.want.attitude) {
    throw InvalidInput("scene.want", "omega, attitude or both", "neither");
  }
  torque_sum_ = summarize(parts.torques);
  states_ = list_states(parts.torques);
  if (!parts.rotors.empty()) {
    carrier_ = make_carrier(parts.inertia_B, parts.rotors);
    if (carrier_) require_no_gradient(parts.torques);
    bool steady = true, any = false;
    for (const Rotor& rotor : parts.rotors) {
      const double momentum = rotor.compute_momentum(parts.omega);
      steady = steady && (!rotor.has_windows() || momentum == 0.0);
      any = any || (momentum != 0.0 && rotor.has_windows());
    }
    parts_ = std::make_shared<const SceneParts>(std::move(parts));
    rotor_momentum_ = rotor_momentum(parts_->t0);
    if (!rotor_momentum_.allFinite()) throw InvalidInput("scene.rotors", "of finite momenta together", "an overflow");
    if (any || !rotor_momentum_.isZero(0.0)) add_rotors(torque_sum_, steady);
    return;
  }
  parts_ = std::make_shared<const SceneParts>(std::move(parts));
}

Vector3d Scene::rotor_momentum(double t) const {
  Vector3d sum = Vector3d::Zero();
  for (const Rotor& rotor : parts_->rotors)
    if (rotor.rotates_at(t)) sum += rotor.compute_momentum(parts_->omega) * rotor.axis();
  return sum;
}

SceneParts Scene::parts() const {
  SceneParts copy = *parts_;
  for (Rotor& rotor : copy.rotors) {
    if (!rotor.free() || rotor.momentum()) continue;
    RotorParts known = rotor.parts();
    known.momentum = rotor.compute_momentum(parts_->omega), known.speed.reset();
    rotor = Rotor(std::move(known));
  }
  return copy;
}

Scene Scene::with_torques(std::vector<AnyTorque> torques) const {
  SceneParts copy = *parts_;
  copy.torques = std::move(torques);
  return Scene(std::move(copy));
}

void compute_rotor_speed(const Scene& scene, std::size_t n, const double* t, const double* omega, double* speed) {
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d w_B{omega[3 * i], omega[3 * i + 1], omega[3 * i + 2]};
    for (const Rotor& rotor : scene.rotors()) {
      const double rotating = rotor.compute_speed(rotor.compute_momentum(scene.omega()), w_B);
      *speed++ = rotor.rotates_at(t[i]) || std::isnan(rotating) ? rotating : 0.0;
    }
  }
}

int Scene::count_states() const {
  std::size_t count = 0;
  for (const formula::Input& state : states_) count += state.values.size();
  return static_cast<int>(count);
}

void set_starts(std::vector<AnyTorque>& torques, const std::vector<double>& starts) {
  const std::vector<formula::Input> states = list_states(torques);
  for (AnyTorque& torque : torques) {
    const torques::Formula* formula = find_formula(torque);
    if (formula == nullptr || formula->states().empty()) continue;
    std::vector<double> own;
    for (const formula::Input& state : formula->states()) {
      const formula::Place place = formula::find_place(states, state.name);
      const auto first = starts.begin() + place.first;
      own.insert(own.end(), first, first + place.count);
    }
    torque = formula->with_starts(own);
  }
}

}  // namespace polhode
