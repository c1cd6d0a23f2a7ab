#pragma once

#include <optional>
#include <vector>

#include "polhode/scene/parameter.hpp"

namespace polhode {

/// The axis after i, in cyclic order.
constexpr int next_axis(int i) { return (i + 1) % 3; }

/// What a column of the variational equations changes in a body while it moves; body axes.
struct ColumnCause {
  Matrix3d inertia = Matrix3d::Zero();               ///< dJ
  Vector3d rotor_momentum = Vector3d::Zero();        ///< dh
  std::optional<LastingTorque> torque = {};          ///< one that acts, and its number that changes ...
  int field = 0, component = 0;                      ///< ... as in SceneParameter
};

/// The series by which a column is forced. Each stands for three components, but `one`.
enum class ForceSource {
  one,                ///< 1
  rates,              ///< w
  derivatives,        ///< w'
  rate_squares,       ///< w1^2, w2^2, w3^2
  rate_pairs,         ///< w2 w3, w3 w1, w1 w2
  space_x, space_y, space_z,   ///< the axes of space, seen in the body
  radius_squares,     ///< of the radial direction u of an orbit
  radius_pairs,       ///< u2 u3, u3 u1, u1 u2
  tangent_pairs,      ///< with the tangent t: u2 t3 + u3 t2, u3 t1 + u1 t3, u1 t2 + u2 t1
  timed_pairs,        ///< the same times the time
  count
};

/// The constants of the variational equations of one body under lasting torques, in principal axes P:
///
///   J d' = dN - d x (J w + h) - w x J d - w x (dJ w) - w x dh - dJ w',   theta' = d - w x theta
///
/// for the columns d = d omega and theta, the small rotation R -> R exp([theta]x).
struct ColumnTerms {
  struct Force {
    int column, component;
    ForceSource source;
    int part;        ///< component of the source
    double factor;
  };

  double product[3] = {};               ///< (J2 - J3) / J1 and so on
  double inverse[3] = {};               ///< 1 / J
  double linear[9] = {};                ///< constant part of the derivative of w' by omega, row by row
  Vector3d moment = Vector3d::Zero();   ///< weight times arm
  Vector3d space = Vector3d::Zero();    ///< sum of the torques that are constant in space; space axes
  double tidal[3] = {};                 ///< strength (J3 - J2) and so on
  double orbit_rate = 0.0;
  bool pulled = false;                  ///< a torque depends on the attitude
  std::vector<Force> forces = {};

  bool uses(ForceSource source) const;
};

/// @param piece  a scene whose torques and rotors have no windows, and none is Custom
/// @param R_BP, J  its principal axes and moments
ColumnTerms make_column_terms(const Scene& piece, const Matrix3d& R_BP, const Vector3d& J,
                              const std::vector<ColumnCause>& causes);

}  // namespace polhode
