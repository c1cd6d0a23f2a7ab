#include "polhode/ode/rk45.hpp"

#include "solve/methods/body_method.hpp"
#include "solve/run_general.hpp"

namespace polhode {

const BodyMethod rk45_method{ode::Rk45::record, &run_general<ode::Rk45>, nullptr, false};

}  // namespace polhode
