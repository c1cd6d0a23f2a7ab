#include "polhode/ode/dop853.hpp"

#include "solve/methods/body_method.hpp"
#include "solve/run_general.hpp"

namespace polhode {

const BodyMethod dop853_method{ode::Dop853::record, &run_general<ode::Dop853>, nullptr, false};

}  // namespace polhode
