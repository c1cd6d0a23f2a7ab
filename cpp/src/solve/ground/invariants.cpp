#include "polhode/solve/invariants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "polhode/core/interrupt.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

constexpr std::size_t rows_between_checks = 4096;

double compute_kinetic(const Matrix3d& I, const double* w) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += w[i] * (I(i, 0) * w[0] + I(i, 1) * w[1] + I(i, 2) * w[2]);
  return 0.5 * sum;
}

double compute_potential(const Scene& scene, double t, const double* omega, const double* attitude) {
  double sum = 0.0;
  const Matrix3d inertia_B = scene.inertia_B(t);
  const TorqueInput in{t, omega, attitude, inertia_B};
  for (const AnyTorque& torque : scene.torques()) {
    std::visit([&](const auto& acting) { sum += acting.compute_potential(in); }, torque);
  }
  return sum;
}

/// |difference| / scale, and 0 for no difference at any scale.
double relative(double difference, double scale) {
  return difference == 0.0 ? 0.0 : std::abs(difference) / scale;
}

/// Only the friction of rotors acts: the energy never rises.
bool only_loses_energy(const Scene& scene) {
  return scene.is_closed() && scene.has_inner_states() && scene.controllers().empty() &&
         !scene.changes() && std::all_of(scene.rotors().begin(), scene.rotors().end(), [](const Rotor& rotor) {
           return !rotor.parts().law && rotor.parts().torque == 0.0 && !rotor.has_windows();
         });
}

/// The largest rise above the least of earlier values, in the order of time.
double find_rise(const std::vector<double>& t, const std::vector<double>& energy, double start, double start_energy) {
  std::vector<std::size_t> order(t.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return t[a] < t[b]; });
  double least = std::numeric_limits<double>::infinity(), rise = 0.0;
  bool passed = false;
  const auto visit = [&](double value) { rise = std::max(rise, value - least), least = std::min(least, value); };
  for (const std::size_t i : order) {
    if (!passed && t[i] >= start) visit(start_energy), passed = true;
    visit(energy[i]);
  }
  if (!passed) visit(start_energy);
  return rise;
}

}  // namespace

void compute_energy(const Scene& scene, std::size_t n, const double* t, const double* omega, const double* attitude,
                    double* energy, const double* states) {
  const bool driven = scene.has_inner_states();
  const auto width = static_cast<std::size_t>(scene.count_states());
  static constexpr double identity[4] = {0, 0, 0, 1};
  for (std::size_t i = 0; i < n; ++i) {
    if (i % rows_between_checks == 0) check_interrupt();
    const double* q = attitude != nullptr ? attitude + 4 * i : identity;
    energy[i] = compute_kinetic(scene.inertia_B(t[i]), omega + 3 * i);
    if (!scene.torques().empty()) energy[i] += compute_potential(scene, t[i], omega + 3 * i, q);
    if (driven) energy[i] += sum_energies(scene, states + width * i);
  }
}

void compute_angular_momentum(const Scene& scene, std::size_t n, const double* t, const double* omega,
                              const double* attitude, double* L_W, const double* states) {
  const bool rotors = scene.torque_sum().rotors || scene.has_inner_states() || scene.momentum();
  const auto width = static_cast<std::size_t>(scene.count_states());
  for (std::size_t i = 0; i < n; ++i) {
    if (i % rows_between_checks == 0) check_interrupt();
    const double *w = omega + 3 * i, *q = attitude + 4 * i;
    Vector3d L_B = scene.inertia_B(t[i]) * Vector3d{w[0], w[1], w[2]};
    if (rotors) L_B += sum_momenta(scene, t[i], states + width * i);
    const Vector3d L = rotate({q[0], q[1], q[2], q[3]}, L_B);
    std::copy_n(L.data(), 3, L_W + 3 * i);
  }
}

std::map<std::string, double> compute_drift(const Scene& scene, const Motion& motion) {
  std::map<std::string, double> drift;
  const std::size_t n = motion.t.size();
  if (motion.omega.empty() || n == 0) return drift;
  const TorqueSum& sum = scene.torque_sum();
  const bool free = scene.torques().empty(), closed = scene.is_closed();
  const bool driven = scene.has_inner_states();
  if (driven && motion.states.size() != n * static_cast<std::size_t>(scene.count_states())) return drift;
  const double* states = motion.states.data();
  const std::vector<double> start_states = formula::list_values(scene.states());
  const bool has_attitude = !motion.attitude.empty();
  const bool sees_energy = (free && !scene.changes()) || (sum.has_potential && has_attitude);

  const Quat& q0 = scene.attitude();
  const double start_attitude[4] = {q0.x, q0.y, q0.z, q0.w};
  const double* start_omega = scene.omega().data();

  std::vector<double> L(has_attitude ? 3 * n : 0);
  double L0[3] = {};
  double largest_L = 0.0;
  if (has_attitude) {
    compute_angular_momentum(scene, n, motion.t.data(), motion.omega.data(), motion.attitude.data(), L.data(),
                             states);
    compute_angular_momentum(scene, 1, &motion.start.t, start_omega, start_attitude, L0, start_states.data());
    for (std::size_t i = 0; i < n; ++i)
      largest_L = std::max(largest_L, math::hypot(L[3 * i], L[3 * i + 1], L[3 * i + 2]));
    largest_L = std::max(largest_L, math::hypot(L0[0], L0[1], L0[2]));
  }
  if (closed && has_attitude) {
    double moved = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      moved = std::max(moved, math::hypot(L[3 * i] - L0[0], L[3 * i + 1] - L0[1], L[3 * i + 2] - L0[2]));
    }
    // The momenta of a body and its rotors may nearly cancel.
    const double own = (scene.inertia_B().matrix() * scene.omega()).norm();
    const Vector3d h = sum_momenta(scene, scene.t0(), start_states.data());
    double scale = sum.rotors || driven || scene.momentum() ? own + h.norm() : math::hypot(L0[0], L0[1], L0[2]);
    for (std::size_t i = 0; i < n && scene.momentum(); ++i)   // the start may be at rest
      scale = std::max(scale, 2 * sum_momenta(scene, motion.t[i], states + i * motion.states.size() / n).norm());
    drift["angular_momentum"] = relative(moved, scale);
  }
  if (!closed && sum.keeps_vertical && has_attitude) {
    double moved = 0.0;
    for (std::size_t i = 0; i < n; ++i) moved = std::max(moved, std::abs(L[3 * i + 2] - L0[2]));
    drift["vertical_momentum"] = relative(moved, largest_L);
  }
  if (only_loses_energy(scene)) {
    std::vector<double> energy(n);
    double start_energy = 0.0;
    compute_energy(scene, 1, &motion.start.t, start_omega, nullptr, &start_energy, start_states.data());
    compute_energy(scene, n, motion.t.data(), motion.omega.data(), nullptr, energy.data(), states);
    const double largest = std::max(start_energy, *std::max_element(energy.begin(), energy.end()));
    drift["energy_rise"] = relative(find_rise(motion.t, energy, motion.start.t, start_energy), largest);
  }
  if (sees_energy && (sum.keeps_energy || (sum.keeps_jacobi && has_attitude))) {
    const double rate = sum.keeps_energy ? 0.0 : sum.pattern_rate;
    double start_energy = 0.0, largest_T = compute_kinetic(scene.inertia_B().matrix(), start_omega);
    compute_energy(scene, 1, &motion.start.t, start_omega, start_attitude, &start_energy, start_states.data());
    double largest_V = std::abs(start_energy - largest_T), moved = 0.0;
    std::vector<double> energy(n);
    compute_energy(scene, n, motion.t.data(), motion.omega.data(), has_attitude ? motion.attitude.data() : nullptr,
                   energy.data(), states);
    for (std::size_t i = 0; i < n; ++i) {
      const double T = compute_kinetic(scene.inertia_B().matrix(), motion.omega.data() + 3 * i);
      largest_V = std::max(largest_V, std::abs(energy[i] - T));
      largest_T = std::max(largest_T, T);
      const double orbital = rate == 0.0 ? 0.0 : rate * (L[3 * i + 2] - L0[2]);
      moved = std::max(moved, std::abs(energy[i] - start_energy - orbital));
    }
    drift[sum.keeps_energy ? "energy" : "jacobi"] = relative(moved, largest_T + largest_V);
  }
  return drift;
}

}  // namespace polhode
