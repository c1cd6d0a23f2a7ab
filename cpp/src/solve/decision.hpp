#pragma once

#include <optional>

#include "polhode/solve/closed_form.hpp"
#include "polhode/solve/plan.hpp"
#include "solve/pieces.hpp"

namespace polhode {

/// How a scene is answered: made once by decide(), then carried out by execute() or put into words by explain().
struct Decision {
  Scene scene;                             ///< as given, or without windows where none ends within the span
  Facts facts = {};                        ///< of pieces: `turns` are those whose forecast is that of the whole chain
  Plan plan = {};
  Pieces pieces = {};                      ///< empty where the span is not cut
  std::optional<ClosedForm> form = {};     ///< of the whole span
  double turns = 0.0;                      ///< of all pieces together, as a person counts revolutions
};

}  // namespace polhode
