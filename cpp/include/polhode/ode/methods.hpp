#pragma once

#include <tuple>

#include "polhode/ode/dop853.hpp"
#include "polhode/ode/rk4.hpp"
#include "polhode/ode/rk45.hpp"

namespace polhode::ode {

/// The methods for any y' = f(t, y). A new one is a file of its own and a name here; ph.methods(), the command line, the
/// charts, the docs and the conformance tests follow. Methods that know what a body is: solve/methods.hpp.
using Methods = std::tuple<Rk45, Dop853, Rk4>;

}  // namespace polhode::ode
