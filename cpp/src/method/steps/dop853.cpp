#include "polhode/ode/dop853.hpp"

#include "method/equations.hpp"
#include "method/method.hpp"

namespace polhode {

const BodyMethod dop853_method{ode::Dop853::record, &integrate_equations<ode::Dop853>, nullptr, false};

}  // namespace polhode
