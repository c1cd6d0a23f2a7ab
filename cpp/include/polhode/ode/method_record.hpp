#pragma once

#include <limits>
#include <string_view>

#include "polhode/ode/detail/forecast.hpp"

namespace polhode::ode {

/// The properties of a method. ph.methods(), the command line, the docs and the conformance tests read them.
struct MethodRecord {
  std::string_view name;
  int order;                        ///< of the solution that is continued, without torques
  int driven_order = 0;             ///< of the same with a torque; 0: equal
  int dense_order;                  ///< of the continuous extension
  bool adaptive;                    ///< chooses its steps by rtol and atol; otherwise step= is required
  bool adaptive_order = false;      ///< also chooses its order by the tolerance, up to `order`
  double least_rtol = 4 * std::numeric_limits<double>::epsilon();   ///< a finer tolerance gains nothing in float64
  bool implicit = false;            ///< solves equations within a step: stable where rates are stiff
  bool comparison = false;          ///< a game engine's step, for comparison: charts run it, and no plan chooses it
  std::string_view keeps;           ///< without torques, to rounding: "nothing" or some of "energy, |L|, L, L_z"
  std::string_view needs = "";      ///< what it requires of a scene; "" if nothing
  std::string_view doc;
  std::string_view source;
  Forecast forecast = {};           ///< expected error and cost; without them no plan chooses the method

  int order_with_torque() const { return driven_order == 0 ? order : driven_order; }
};

}  // namespace polhode::ode
