#pragma once

#include "polhode/scene/scene.hpp"

namespace polhode {

/// The properties of a scene that determine its plan. Most are dimensionless, so that no plan depends on units.
struct Facts {
  TorqueSum torques = {};          ///< dependence and conserved quantities of the acting torques
  Vector3d rotor_momentum = Vector3d::Zero();   ///< h_B at the start [N m s]
  Symmetry symmetry = Symmetry::triaxial;
  double gap_low = 0.0;            ///< (I2 - I1) / I3
  double gap_high = 0.0;           ///< (I3 - I2) / I3
  double off_axis = 0.0;           ///< angle between omega and the nearest principal axis [rad]
  double separatrix = 1.0;         ///< distance from L^2 = 2 T I2: see compute_separatrix_distance(); 1 with rotors
  double before = 0.0, after = 0.0;   ///< span before and after the start [s]
  bool only_at_end = false;        ///< all sample times are equal
  double turns = 0.0;              ///< expected revolutions over the whole span, or those of a wheel's nutation
  bool may_spin_up = false;        ///< a torque may increase |omega| without bound, so `turns` is a guess
  double decay = 0.0;              ///< fastest rate at which the torques damp omega [1/s]
  double stiffness = 0.0;          ///< decay x span, which limits the steps of explicit methods
  bool piloted = false;            ///< a pilot run has counted `turns`, `effort` and `stiffness`
  double effort = 0.0;             ///< of a pilot run: the revolutions that take as many steps as this motion
  double foldings = 0.0;           ///< of a pilot run: the e-foldings of |omega| over the span
  double call_seconds = 0.0;       ///< measured time of a call of the user's own torques; 0 without them [s]

  double span() const { return before + after; }
  /// The revolutions that count for steps and for their errors.
  double work() const { return piloted ? effort : turns; }
  bool is_free() const { return torques.acting == 0; }
  /// True if stability limits the steps of a Taylor series, otherwise about an eighth of a revolution.
  bool is_stiff_for_series() const { return stiffness > 2 * turns; }
};

/// Computes all facts of a scene.
Facts compute_facts(const Scene& scene);

/// Sums the torques that act on this body. Gravity's gradient does not act on a body with three equal moments.
TorqueSum find_acting_torques(const Scene& scene);

/// The angle between omega and the nearest principal axis [rad]; 0 for a body at rest.
double compute_off_axis_angle(const Scene& scene);

/// k'^2, the complementary modulus of the free motion from the same start. It is 0 on the separatrix, where omega
/// leaves the intermediate axis for ever. It is 1 far from the separatrix, and for a body with two equal moments.
double compute_separatrix_distance(const Scene& scene);

/// A scale of the torques [N m]: their size at the start, or the largest size of gravity over all attitudes.
double compute_torque_scale(const Scene& scene);

/// The rate at which rotors turn the axis of a body at rest [rad/s]: of nutation, h3 / sqrt(I1 I2) for one on axis 3.
double compute_nutation_rate(const InertiaTensor& inertia_B, const Vector3d& h_B);

/// Revolutions over a time [s], from |omega| at the start, the nutation that rotors cause, and what the torques can
/// add.
double estimate_turns(const Scene& scene, const TorqueSum& torques, double span);

/// True if a torque may increase |omega| without bound: it has no potential and is not pure damping.
bool may_spin_up(const Scene& scene, const TorqueSum& torques);

/// The rates at which torques damp omega [1/s].
struct DecayRates {
  double fastest = 0.0, slowest = 0.0;
};

/// The rates of decay at the start, from the symmetric part of the torques' derivative by omega. They are 0 if no
/// torque depends on the rates.
DecayRates compute_decay_rates(const Scene& scene, const TorqueSum& torques);

}  // namespace polhode
