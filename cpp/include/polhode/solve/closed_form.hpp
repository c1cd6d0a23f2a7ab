#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/heavy_top.hpp"
#include "polhode/solve/facts.hpp"

namespace polhode {

/// The closed form of a scene, whichever it is; its time runs from the scene's start.
class ClosedForm {
 public:
  explicit ClosedForm(FreeMotion motion) : motion_(std::move(motion)) {}
  explicit ClosedForm(HeavyTop motion) : motion_(std::move(motion)) {}

  void at(const double* t, std::size_t n, double* omega, double* attitude) const {
    std::visit([&](const auto& motion) { motion.at(t, n, omega, attitude); }, motion_);
  }
  std::string_view model() const;   ///< the name of its record
  double rate(const double* omega) const;   ///< how fast things change where omega is so [rad/s], for steps of events

 private:
  std::variant<FreeMotion, HeavyTop> motion_;
};

/// What the list of exact models tells about each of them; the planner, the command line and the docs show it.
struct ExactModel {
  std::string_view name;
  std::string_view doc;
  std::string_view source;
  /// Empty where it holds; else why not, in words for a person.
  std::string (*refuse)(const Scene& scene, const Facts& facts);
};

/// From the least model to the one that needs most. The first that holds is taken.
std::span<const ExactModel> exact_models();

/// The closed form of a scene, where one holds.
std::optional<ClosedForm> find_closed_form(const Scene& scene, const Facts& facts);

/// A bound on the error of the closed form over the scene's times, against the exact motion from the same float64
/// input: 20 units of rounding (docs/exact.md; the largest ever measured are 7), and what rounding of the times'
/// distances from the start, of weight times arm, or of the principal axes of a full tensor does to it.
double compute_closed_form_error(const Scene& scene, const Facts& facts, const ClosedForm& form);

}  // namespace polhode
