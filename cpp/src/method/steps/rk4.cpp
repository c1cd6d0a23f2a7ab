#include "polhode/ode/rk4.hpp"

#include "method/equations.hpp"
#include "method/method.hpp"

namespace polhode {

const BodyMethod rk4_method{ode::Rk4::record, &integrate_equations<ode::Rk4>, nullptr, false};

}  // namespace polhode
