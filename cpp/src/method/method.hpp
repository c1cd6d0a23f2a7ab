#pragma once

#include <string>

#include "method/integrate.hpp"
#include "polhode/ode/method_record.hpp"

namespace polhode {

/// A way to integrate one body over one span. Whoever adds one keeps this contract:
///
/// 1. `steps/<name>.cpp` defines `const BodyMethod <name>_method`, and `polhode/method/methods.def` lists <name>.
/// 2. The record says what is true: order, `keeps`, `needs`, implicit, adaptive. The conformance tests measure it.
/// 3. `integrate` returns a sample for each of the scene's times that was reached, in the scene's order, before and after
///    the start, and the start itself bit for bit as it was given.
/// 4. It goes through `polhode::integrate`, which asks for progress, finds events and obeys `max_steps`.
/// 5. It fills `Trajectory::model` and `Trajectory::state`.
/// 6. `refuse` names in words what the method cannot integrate. A scene that is not refused is integrated.
/// 7. The torque is read through the scene's torques alone; a torque that becomes infinite ends the run with a message.
/// 8. Equal inputs give equal bits on every machine: exact arithmetic and polhode's own functions, no mathematical
///    library of the system.
/// 9. A record with a forecast can be chosen by a plan: `benchmarks/planner/fit.py` measures the forecast.
struct BodyMethod {
  ode::MethodRecord record;
  Trajectory (*integrate)(const Scene& scene, const RunOptions& options);
  std::string (*refuse)(const Scene& scene) = nullptr;   ///< "" when it takes the scene; null: it takes any
  bool of_bodies = true;                                 ///< steps the body itself and no other formulation
  bool carries_error = false;                            ///< fills RunOptions::trace
};

/// @throws InvalidInput for an unknown name, with the names there are.
const BodyMethod& find_body_method(std::string_view name);

#define POLHODE_METHOD(name) extern const BodyMethod name##_method;
#include "polhode/method/methods.def"
#undef POLHODE_METHOD

}  // namespace polhode
