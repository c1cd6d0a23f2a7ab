#pragma once

#include <limits>
#include <string_view>

#include "polhode/ode/forecast.hpp"

namespace polhode::ode {

/// What the list of methods tells about each of them; ph.methods(), the command line, the docs and the suite of tests
/// that every method must pass read it.
struct MethodRecord {
  std::string_view name;
  int order;                        ///< of the solution that is carried on, without torques
  int driven_order = 0;             ///< of the same when a torque acts; 0: the same
  int dense_order;                  ///< of the continuous extension
  bool adaptive;                    ///< chooses its own steps by rtol and atol; else step= is asked for
  bool adaptive_order = false;      ///< chooses its order too, by the tolerance, up to `order`
  double least_rtol = 4 * std::numeric_limits<double>::epsilon();   ///< a finer tolerance gains nothing in float64
  bool implicit = false;            ///< solves equations within a step: stable where rates are stiff
  bool cheap = false;               ///< a game engine's step, here to be compared with: never chosen by a plan
  std::string_view keeps;           ///< without torques, to rounding: "nothing" or some of "energy, |L|, L, L_z"
  std::string_view needs = "";      ///< what it asks of a scene; "" when it takes any
  std::string_view doc;
  std::string_view source;
  Forecast forecast = {};           ///< what a plan may expect of it; without it no plan takes it

  int order_with_torque() const { return driven_order == 0 ? order : driven_order; }
};

}  // namespace polhode::ode
