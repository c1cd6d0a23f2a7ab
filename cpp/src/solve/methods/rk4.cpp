#include "polhode/ode/rk4.hpp"

#include "solve/methods/body_method.hpp"
#include "solve/run_general.hpp"

namespace polhode {

const BodyMethod rk4_method{ode::Rk4::record, &run_general<ode::Rk4>, nullptr, false};

}  // namespace polhode
