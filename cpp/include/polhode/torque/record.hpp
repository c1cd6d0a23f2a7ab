#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "polhode/core/quat.hpp"
#include "polhode/formula/ephemeris.hpp"

namespace polhode {

namespace formula {
struct Program;
}

/// What a torque depends on and what it conserves. The planner and the tests read this.
struct TorqueTraits {
  bool uses_time = false;
  bool uses_attitude = false;
  bool uses_rates = false;
  bool has_potential = false;        ///< tau is minus the gradient of compute_potential() on the rotations
  bool keeps_vertical = false;       ///< no torque about the space z axis: L_z is constant
  double pattern_rate = 0.0;         ///< the potential rotates about space z at this rate [rad/s]; 0: it is fixed
  bool vanishes = false;             ///< zero in every state
};

/// The inputs of a torque. `attitude` is any positive multiple of a unit quaternion (x, y, z, w).
struct TorqueInput {
  double t;                          ///< [s]
  const double* omega;               ///< w_B, 3 numbers [rad/s]
  const double* attitude;            ///< q_WB, 4 numbers
  const Matrix3d& inertia_B;         ///< [kg m^2]
  bool principal = false;            ///< inertia_B is diagonal
};

/// One parameter of a torque, as shown in Python, scene files and docs.
struct TorqueParameter {
  enum class Kind { real, vector, matrix, choice, orbit };
  std::string_view name;
  Kind kind;
  std::string_view unit;
  std::string_view doc;
  std::optional<std::string_view> fallback = std::nullopt;   ///< default, as text: a number, or one of `choices`
  std::string_view choices = {};                             ///< for Kind::choice, separated by '|'
};

using TorqueValue = std::variant<double, Vector3d, Matrix3d, std::string, formula::Ephemeris>;
using TorqueValues = std::vector<TorqueValue>;

/// The name, doc and parameters of a torque.
struct TorqueRecord {
  std::string_view name;             ///< the class, as in ph.torques.GravityGradient
  std::string_view key;              ///< the scene file's kind, as in kind = "gravity_gradient"
  std::string_view doc;              ///< one sentence, with the formula
  std::string_view source;
  std::span<const TorqueParameter> parameters;
};

}  // namespace polhode
