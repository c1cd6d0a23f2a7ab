#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "polhode/exact/damped_free.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/gyrostat.hpp"
#include "polhode/exact/heavy_top.hpp"
#include "polhode/exact/pendulum.hpp"
#include "polhode/solve/facts.hpp"

namespace polhode {

/// The closed form of a scene. Its time counts from the scene's start.
class ClosedForm {
 public:
  explicit ClosedForm(FreeMotion motion) : motion_(std::move(motion)) {}
  explicit ClosedForm(Gyrostat motion) : motion_(std::move(motion)) {}
  explicit ClosedForm(DampedFree motion) : motion_(std::move(motion)) {}
  explicit ClosedForm(Pendulum motion) : motion_(std::move(motion)) {}
  explicit ClosedForm(HeavyTop motion) : motion_(std::move(motion)) {}

  void at(const double* t, std::size_t n, double* omega, double* attitude) const {
    std::visit([&](const auto& motion) { motion.at(t, n, omega, attitude); }, motion_);
  }
  std::string_view model() const;   ///< the name of its record
  double swing_frequency() const;           ///< of small swings of a heavy body [rad/s]; 0 for others
  double rate(const double* omega) const;   ///< a rate of change [rad/s], for the steps of an event search
  const Gyrostat* gyrostat() const { return std::get_if<Gyrostat>(&motion_); }   ///< null for other models
  /// Of a pendulum, whose motion stays in the plane across this body axis.
  std::optional<Vector3d> swing_axis() const;

 private:
  std::variant<FreeMotion, Gyrostat, DampedFree, Pendulum, HeavyTop> motion_;
};

/// The record of an exact model, for the planner, the command line and the docs.
struct ExactModel {
  std::string_view name;
  std::string_view doc;
  std::string_view source;
  /// "" if the model holds for a scene, else the reason in words.
  std::string (*refuse)(const Scene& scene, const Facts& facts);
};

/// The exact models, simplest first. The planner takes the first that holds.
std::span<const ExactModel> exact_models();

/// Why a scene without closed form has none.
std::string explain_no_closed_form(const Scene& scene, const Facts& facts);

/// True if a scene has the closed form of a gyrostat: a free body with rotors that turn.
bool is_gyrostat(const Facts& facts);

/// The closed form of a scene, if one holds.
std::optional<ClosedForm> find_closed_form(const Scene& scene, const Facts& facts);

/// A bound on the error of the closed form at the scene's times, against the exact motion of the same float64 input. It
/// is 20 units of rounding (docs/exact.md; the largest measured error is 7). To this it adds the effect of rounding in
/// times from the start, in weight times arm, in a damping matrix, in the rotors' momentum, in the inertia that free
/// rotors leave, and in the principal axes of a full tensor.
double compute_closed_form_error(const Scene& scene, const Facts& facts, const ClosedForm& form);

/// The closed forms that this bound makes from changed inputs, each as dear as the form itself.
int count_error_set_ups(const Scene& scene, const Facts& facts, std::string_view model);

}  // namespace polhode
