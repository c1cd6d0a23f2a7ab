#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "polhode/solve/plan.hpp"
#include "polhode/solve/solve.hpp"
#include "polhode/torque/formula.hpp"
#include "polhode/torque/gravity.hpp"

// Any heavy body with a rotor and a torque as text, by the plan or by a method of choice, for a page.
#define POLHODE_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace {
std::vector<double> room;
std::string text, torque;
std::optional<polhode::Motion> motion;
}  // namespace

/// A place for n numbers; the one before is no longer valid.
POLHODE_EXPORT(reserve) double* reserve(int n) {
  room.resize(static_cast<std::size_t>(n));
  return room.data();
}

/// A place for n characters.
POLHODE_EXPORT(reserve_text) char* reserve_text(int n) {
  text.assign(static_cast<std::size_t>(n), ' ');
  return text.data();
}

/// A place for n characters of a torque in body axes, as in a scene file. Without characters there is none.
POLHODE_EXPORT(reserve_formula) char* reserve_formula(int n) {
  torque.assign(static_cast<std::size_t>(n), ' ');
  return torque.data();
}

/// Solves a scene at n times. `start`: moments (3), omega (3), attitude (4), weight, arm (3), rotor's axis (3) and
/// momentum. The text names a method, or is empty for the plan. A step of 0 leaves it to the accuracy.
POLHODE_EXPORT(solve_scene)
int solve_scene(const double* start, const double* t, int n, double accuracy, double step, double* omega,
                double* attitude) {
  using namespace polhode;
  const double* s = start;
  SceneParts parts{.inertia_B = InertiaTensor::from_moments({s[0], s[1], s[2]}),
                   .omega = {s[3], s[4], s[5]},
                   .attitude = {s[6], s[7], s[8], s[9]},
                   .times = std::vector<double>(t, t + n)};
  if (s[10] != 0.0) parts.torques.emplace_back(torques::Gravity(s[10], {s[11], s[12], s[13]}));
  if (!torque.empty()) parts.torques.emplace_back(torques::Formula(polhode::formula::Text{.torque = torque}));
  if (s[17] != 0.0) parts.rotors.emplace_back(RotorParts{.axis = {s[14], s[15], s[16]}, .momentum = s[17]});
  SolveOptions options;
  if (!text.empty()) options.method = text;
  if (step > 0.0) {
    options.step = step;
  } else {
    options.accuracy = accuracy;
  }
  motion.emplace(solve(Scene(std::move(parts)), options));
  std::ranges::copy(motion->omega, omega);
  std::ranges::copy(motion->attitude, attitude);
  return static_cast<int>(motion->status);
}

POLHODE_EXPORT(solve_error) double solve_error() { return motion->error; }
POLHODE_EXPORT(solve_steps) double solve_steps() { return static_cast<double>(motion->stats.steps); }

/// The method of the plan, as text of the length that is returned.
POLHODE_EXPORT(solve_method) const char* solve_method() { return motion->plan.method.c_str(); }
