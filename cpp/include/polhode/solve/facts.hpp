#pragma once

#include "polhode/scene/scene.hpp"

namespace polhode {

/// What a plan looks at: numbers without units wherever one can be had, so that nothing depends on the choice of units.
struct Facts {
  TorqueSum torques = {};          ///< what those that act depend on and keep
  Symmetry symmetry = Symmetry::triaxial;
  double gap_low = 0.0;            ///< (I2 - I1) / I3
  double gap_high = 0.0;           ///< (I3 - I2) / I3
  double off_axis = 0.0;           ///< angle between omega and the nearest principal axis [rad]
  double separatrix = 1.0;         ///< how close L^2 = 2 T I2 is: see compute_separatrix_distance()
  double before = 0.0, after = 0.0;   ///< span before and after the start [s]
  bool only_at_end = false;        ///< one time is asked for
  double turns = 0.0;              ///< expected over the whole span
  bool may_spin_up = false;        ///< a torque may change |omega| without bound, so that `turns` is a guess
  double decay = 0.0;              ///< fastest rate at which the torques damp omega [1/s]
  double stiffness = 0.0;          ///< decay x span: what explicit methods pay for

  double span() const { return before + after; }
  bool is_free() const { return torques.acting == 0; }
  /// A step of a Taylor series, an eighth of a turn or so, is then short for stability's sake.
  bool is_stiff_for_series() const { return stiffness > 2 * turns; }
};

/// All of them.
Facts compute_facts(const Scene& scene);

/// What the torques that act on this body depend on and keep; gravity's gradient leaves a sphere alone.
TorqueSum find_acting_torques(const Scene& scene);

/// The angle between omega and the nearest principal axis [rad]; 0 for a body at rest.
double compute_off_axis_angle(const Scene& scene);

/// k'^2, the complementary modulus of the free motion from the same start: 0 on the separatrix, where omega leaves the
/// intermediate axis and never returns, 1 far from it or where two moments are equal.
double compute_separatrix_distance(const Scene& scene);

/// The largest size of the torques at the start, over the six directions of a cube's faces for omega and attitude as
/// given: a scale [N m].
double compute_torque_scale(const Scene& scene);

/// Turns over a time [s] from the start's |omega| and what the torques can add to it.
double estimate_turns(const Scene& scene, const TorqueSum& torques, double span);

/// True when a torque may add to |omega| as long as it acts: one without a potential that does not only damp.
bool may_spin_up(const Scene& scene, const TorqueSum& torques);

/// The fastest rate at which the torques damp omega at the start [1/s], from the symmetric part of their derivative by
/// omega; 0 where none sees the rates.
double compute_decay_rate(const Scene& scene, const TorqueSum& torques);

}  // namespace polhode
