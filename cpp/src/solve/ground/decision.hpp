#pragma once

#include <memory>
#include <string>
#include <vector>

#include "polhode/ode/problem.hpp"
#include "polhode/solve/closed_form.hpp"
#include "polhode/solve/plan.hpp"
#include "solve/ground/custom_probes.hpp"
#include "solve/ground/pieces.hpp"

namespace polhode {

/// How a scene is solved. decide() makes it once; execute() carries it out, and explain() describes it.
struct Decision {
  Scene scene;                             ///< as given; without windows if none begins or ends within the span
  Facts facts = {};                        ///< of pieces: `turns` gives the forecast of all pieces together
  Plan plan = {};
  Pieces pieces = {};                      ///< empty if the span is not cut
  std::shared_ptr<const ClosedForm> form = {};   ///< of the whole span
  std::size_t slow_forms = 0;              ///< pieces whose closed form holds, but takes longer than steps
  double turns = 0.0;                      ///< revolutions of all pieces together
  bool probed = false;                     ///< the pilot run probed the user's own torques over the whole span
  Probes probes = {};                      ///< what it found; the span is divided at its breaks
  bool crosses_switches = false;           ///< the method steps over the switches of a formula
  std::vector<LeftOut> left_out = {};      ///< torques of the scene as given that `scene` is without
  bool may_cut = true;                     ///< a run may end early where a torque of the user's own is found to jump
  std::vector<std::string> recognised = {};   ///< what the formulas are that are torques of the list
  ode::Counts pilot = {};                  ///< what the pilot run of a user's own torque took
};

}  // namespace polhode
