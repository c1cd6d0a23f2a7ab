#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "polhode/scene/scene.hpp"
#include "polhode/solve/facts.hpp"
#include "solve/ground/distance.hpp"

// How far a closed form moves when its inputs do: what its error bound is made of.
namespace polhode::form {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr double unit_roundoff = epsilon / 2;
inline constexpr double evaluation_error = 20 * epsilon;   // of every closed form; the largest measured is 7 units
inline constexpr double nudge = 0x1p-46;                   // relative change of an input, to measure its effect
inline constexpr std::size_t most_compared = 16;           // times at which two motions are compared
inline const Vector3d signs{1, -1, 1};

/// The largest distance of two motions at sixteen of the scene's times.
template <class A, class B>
double compare(const Scene& scene, const A& a, const B& b) {
  const std::vector<double>& times = scene.times();
  const std::size_t n = std::min(most_compared, times.size());
  double t[most_compared] = {}, wa[3 * most_compared], wb[3 * most_compared], qa[4 * most_compared], qb[4 * most_compared];
  // The last time, and evenly spread times before it.
  for (std::size_t i = 0; i < n; ++i) t[i] = times[times.size() - 1 - i * ((times.size() - 1) / n)] - scene.t0();
  a.at(t, n, wa, qa);
  b.at(t, n, wb, qb);
  return compute_distance(n, scene.omega().norm(), wa, qa, wb, qb);
}

/// The largest rate of the start and of some samples.
template <class Motion>
double find_largest_rate(const Scene& scene, const Motion& motion) {
  const std::vector<double>& times = scene.times();
  double largest = scene.omega().norm();
  for (std::size_t i = 0; i < times.size(); i += 1 + times.size() / most_compared) {
    const double t = times[i] - scene.t0();
    Vector3d w;
    motion.at(&t, 1, w.data(), nullptr);
    largest = std::max(largest, w.norm());
  }
  return largest;
}

/// True if a time from the start, which is a difference, is rounded.
bool times_are_rounded(const Scene& scene);

/// Of rounded times: half a unit of the angle of rotation.
inline double measure_times(const Scene& scene, const Facts& facts) {
  return times_are_rounded(scene) ? unit_roundoff * (2 * std::numbers::pi * facts.turns) : 0.0;
}

/// Of the rates of a heavy body next to rest. They have the rounding of the largest that its weight may give it, where
/// the centre of mass is lowest. Measured: 0.4 units of that.
template <class Motion>
double measure_slow_rates(const Scene& scene, const torques::Gravity& gravity, double swing_frequency,
                          const Motion& motion) {
  const Vector3d& arm = gravity.arm();
  const double height = (to_matrix(scene.attitude()) * arm)[2] / arm.norm();
  const double fall = std::max(0.0, 1.0 + (gravity.weight() < 0.0 ? -height : height));
  const double start = scene.omega().norm();
  const double reached = math::hypot(start, swing_frequency * std::sqrt(2.0 * fall));
  if (!(reached > 2.0 * start)) return 0.0;
  const double largest = find_largest_rate(scene, motion);
  return largest > 0.0 && largest < reached ? 4 * epsilon * (reached / largest - 1) : 0.0;
}

/// The most that rounding takes from the sum of the rotors' momenta, h_B.
Vector3d find_lost_momentum(const Scene& scene, const Vector3d& h_B);

/// How many components of the rotors' momentum are rounded: each makes a closed form of measure_rotors().
int count_lost_components(const Scene& scene, const Vector3d& h_B);

/// Of the sum of the rotors' momenta. @param make  the motion with another momentum
template <class Motion, class Make>
double measure_rotors(const Scene& scene, const Vector3d& h_B, const Motion& motion, const Make& make) {
  const Vector3d lost = find_lost_momentum(scene, h_B);
  const double part = lost.maxCoeff() / h_B.cwiseAbs().maxCoeff();
  if (part == 0.0) return 0.0;
  double error = 0.0;   // one component may undo what another does: each is changed alone
  for (int i = 0; i < 3; ++i) {
    if (lost[i] == 0.0) continue;
    Vector3d h = h_B;
    h[i] += (nudge / part) * lost[i];
    error += 2 * (part / nudge) * compare(scene, motion, make(h));
  }
  return error;
}

/// True if the inertia is not exactly the scene's: the principal moments and axes of a full tensor have errors of a few
/// units of rounding of the largest moment, and so has the inertia that free rotors leave.
bool inertia_is_rounded(const Scene& scene);

/// Of the inertia. @param make  the motion with another inertia, from a sign
template <class Make>
double measure_inertia(const Scene& scene, const Make& make) {
  return inertia_is_rounded(scene) ? 8 * (epsilon / nudge) * compare(scene, make(1.0), make(-1.0)) : 0.0;
}

/// The inertia in principal axes, with its moments changed by +-sign parts of the largest.
InertiaTensor nudge_moments(const Scene& scene, double sign);

/// A vector in those principal axes.
inline Vector3d to_principal(const Scene& scene, const Vector3d& v_B) {
  return scene.inertia_B().principal().axes.transpose() * v_B;
}

}  // namespace polhode::form
