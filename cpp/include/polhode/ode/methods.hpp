#pragma once

#include <tuple>

#include "polhode/ode/dop853.hpp"
#include "polhode/ode/rk4.hpp"
#include "polhode/ode/rk45.hpp"

namespace polhode::ode {

/// The methods for any y' = f(t, y). The conformance tests of `ode` run on each of them.
using Methods = std::tuple<Rk45, Dop853, Rk4>;

}  // namespace polhode::ode
