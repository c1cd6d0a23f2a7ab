#pragma once

#include <optional>

#include "polhode/ode/problem.hpp"
#include "polhode/solve/closed_form.hpp"
#include "polhode/solve/plan.hpp"
#include "solve/pieces.hpp"

namespace polhode {

/// How a scene is solved. decide() makes it once; execute() carries it out, and explain() describes it.
struct Decision {
  Scene scene;                             ///< as given; without windows if none begins or ends within the span
  Facts facts = {};                        ///< of pieces: `turns` gives the forecast of all pieces together
  Plan plan = {};
  Pieces pieces = {};                      ///< empty if the span is not cut
  std::optional<ClosedForm> form = {};     ///< of the whole span
  std::size_t slow_forms = 0;              ///< pieces whose closed form holds, but takes longer than steps
  double turns = 0.0;                      ///< revolutions of all pieces together
  ode::Counts pilot = {};                  ///< what the pilot run of a user's own torque took
};

}  // namespace polhode
