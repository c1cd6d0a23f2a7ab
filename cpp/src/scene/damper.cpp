#include "polhode/scene/damper.hpp"

#include <cmath>
#include <utility>

#include "polhode/core/error.hpp"

namespace polhode {

Damper::Damper(double inertia, double viscous, const Vector3d& rates)
    : inertia_(inertia), viscous_(viscous), rates_(rates) {
  if (!(inertia > 0.0 && std::isfinite(inertia)))
    throw InvalidInput("Damper.inertia", "positive and finite", to_text(inertia));
  if (!(viscous >= 0.0 && std::isfinite(viscous)))
    throw InvalidInput("Damper.viscous", "zero or positive, and finite", to_text(viscous));
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(rates[i])) throw InvalidInput("Damper.rates", "finite", to_text(rates[i]));
}

Damper Damper::with_state(std::string name) const {
  Damper other = *this;
  other.state_ = std::move(name);
  return other;
}

torques::Formula make_torque(const Damper& damper, const Vector3d& momentum) {
  const std::string& p = damper.state();
  formula::Text text;
  text.states = {{p, {momentum[0], momentum[1], momentum[2]}}};
  text.parameters = {{"inertia", {damper.inertia()}}, {"viscous", {damper.viscous()}}};
  text.let = {{"friction_on_body", "viscous * (" + p + " / inertia - omega)"}};
  text.torque = "friction_on_body";
  text.rates = {"-friction_on_body - cross(omega, " + p + ")"};
  return torques::Formula(text, false);
}

}  // namespace polhode
