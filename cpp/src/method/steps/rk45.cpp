#include "polhode/ode/rk45.hpp"

#include "method/equations.hpp"
#include "method/method.hpp"

namespace polhode {

const BodyMethod rk45_method{ode::Rk45::record, &integrate_equations<ode::Rk45>, nullptr, false};

}  // namespace polhode
