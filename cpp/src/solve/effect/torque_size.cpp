#include "solve/effect/torque_size.hpp"

#include <cmath>
#include <type_traits>

#include "solve/effect/norms.hpp"
#include "solve/effect/orbit_range.hpp"

namespace polhode::effect {
namespace {

TorqueSize refuse(std::string why) { return {.refusal = std::move(why)}; }

TorqueSize size_of(const torques::Constant& torque, const Region&) { return {.fixed = torque.torque().stableNorm()}; }

/// |r x m g e| <= |m g r|
TorqueSize size_of(const torques::Gravity& torque, const Region&) { return {.fixed = torque.moment().stableNorm()}; }

/// Hughes 1986, sec. 8.1: |u x I u| is half the difference of two moments at most, for a unit vector u.
TorqueSize size_of(const torques::GravityGradient& torque, const Region& region) {
  const double fixed = 0.5 * torque.strength() * region.gap;
  if (fixed == 0.0 && region.gap > 0.0) return refuse("the torque is below the range of float64");
  return {.fixed = fixed};
}

#ifndef POLHODE_WITHOUT_ORBITS
/// The same at the least distance.
TorqueSize size_of(const torques::OrbitGradient& torque, const Region& region) {
  const double least = find_range(torque.orbit(), region.begin, region.end).least_distance;
  const double fixed = 1.5 * torque.orbit().mu() / least / least / least * region.gap;
  if (!(fixed < HUGE_VAL)) return refuse("the orbit has no least distance");
  if (fixed == 0.0 && region.gap > 0.0) return refuse("the torque is below the range of float64");
  return {.fixed = fixed};
}
#endif

/// -C w
TorqueSize size_of_linear(const Matrix3d& C) {
  const double largest = C.cwiseAbs().maxCoeff();
  if (largest == 0.0) return refuse("the torque is below the range of float64");
  return {.matrix = C, .per_rate = largest * bound_norm(C / largest)};
}

TorqueSize size_of(const torques::Damping& torque, const Region&) {
  return size_of_linear(torque.matrix());
}

TorqueSize size_of(const torques::AngularDamping& torque, const Region& region) {
  return size_of_linear(torque.compute_matrix(region.inertia_B));
}

TorqueSize size_of(const torques::Custom&, const Region&) {
  return refuse("no bound is known of a function of the user's own; write it as a Formula");
}

/// A law without a size of its own, by its formula.
template <class T>
TorqueSize size_of(const T& torque, const Region& region)
  requires requires { torque.formula(); }
{
  const double fixed = bound_formula(torque.formula(), region);
  if (!(fixed < HUGE_VAL)) return refuse("no bound of its law was found over all attitudes");
  return {.fixed = fixed};
}

TorqueSize size_of(const torques::Formula& torque, const Region& region) {
  if (!torque.states().empty()) return refuse("the formula has states of its own");
  const double fixed = bound_formula(torque, region);
  if (!(fixed < HUGE_VAL)) return refuse("no bound of the formula was found over all attitudes");
  return {.fixed = fixed};
}

TorqueSize size_of(const torques::During& torque, const Region& region) {
  TorqueSize size = std::visit([&](const auto& inner) { return size_of(inner, region); }, torque.torque());
  size.windows = torque.windows();
  return size;
}

}  // namespace

TorqueSize find_size(const AnyTorque& torque, const Region& region) {
  if (traits(torque).vanishes) return {};
  TorqueSize size = std::visit([&](const auto& kind) { return size_of(kind, region); }, torque);
  if (!(size.fixed < HUGE_VAL && size.per_rate < HUGE_VAL)) return refuse("the torque is beyond the range of float64");
  return size;
}

TorqueSize scale(TorqueSize size, int moment_exponent, int rate_exponent) {
  const int by_rate = -(moment_exponent + rate_exponent);
  size.fixed = std::ldexp(size.fixed, by_rate - rate_exponent);
  size.per_rate = std::ldexp(size.per_rate, by_rate);
  for (double& entry : size.matrix.reshaped()) entry = std::ldexp(entry, by_rate);
  for (torques::Window& window : size.windows)
    window = {std::ldexp(window.begin, rate_exponent), std::ldexp(window.end, rate_exponent)};
  return size;
}

double glance_at_size(const AnyTorque& torque, const Scene& scene) {
  const Quat& q = scene.attitude();
  const double attitude[4] = {q.x, q.y, q.z, q.w};
  const Matrix3d& J = scene.inertia_B().matrix();
  const TorqueInput in{scene.t0(), scene.omega().data(), attitude, J};
  const InertiaTensor& tensor = scene.inertia_B();
  return std::visit(
      [&]<class T>(const T& kind) -> double {
        if constexpr (std::is_same_v<T, torques::During>) {
          return glance_at_size(to_any(kind.torque()), scene);
        } else if constexpr (std::is_same_v<T, torques::Custom>) {
          return 0.0;
        } else if constexpr (std::is_same_v<T, torques::GravityGradient>) {
          return 0.5 * kind.strength() * (tensor.moments()[2] - tensor.moments()[0]);
        } else if constexpr (std::is_same_v<T, torques::Gravity>) {
          return kind.moment().norm();
        } else {
          double tau[3] = {0.0, 0.0, 0.0};
          kind.add(in, tau);
          return std::sqrt(tau[0] * tau[0] + tau[1] * tau[1] + tau[2] * tau[2]);
        }
      },
      torque);
}

}  // namespace polhode::effect
