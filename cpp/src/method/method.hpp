#pragma once

#include <string>

#include "method/integrate.hpp"
#include "polhode/ode/method_record.hpp"

namespace polhode {

/// A method to integrate one body over one span. A new method must keep this contract:
///
/// 1. `steps/<name>.cpp` defines `const BodyMethod <name>_method`, and `polhode/method/methods.def` lists <name>.
/// 2. The record says what is true: order, `keeps`, `needs`, implicit, adaptive. The conformance tests measure it.
/// 3. `integrate` returns a sample for each of the scene's times that was reached, in the scene's order. The times may
///    lie before and after the start. A sample at the start equals the given start bit for bit.
/// 4. It calls `polhode::integrate`, which reports progress, finds events and obeys `max_steps`.
/// 5. It fills `Trajectory::model` and `Trajectory::state`.
/// 6. `refuse` says in words what the method cannot integrate. A scene that is not refused is integrated.
/// 7. The torque comes from the scene's torques alone. A torque that becomes infinite ends the run with a message.
/// 8. Equal inputs give equal bits on every machine. So it uses IEEE arithmetic and polhode's own functions, and no
///    mathematical library of the system.
/// 9. A plan can choose a method whose record has a forecast. `benchmarks/planner/fit.py` measures the forecast.
struct BodyMethod {
  ode::MethodRecord record;
  Trajectory (*integrate)(const Scene& scene, const RunOptions& options);
  std::string (*refuse)(const Scene& scene) = nullptr;   ///< "" if it can integrate the scene; null: any scene
  bool of_bodies = true;                                 ///< has its own equations, and no other formulation
  bool carries_error = false;                            ///< fills RunOptions::trace
};

/// @throws InvalidInput for an unknown name, listing the known names.
const BodyMethod& find_body_method(std::string_view name);

#define POLHODE_METHOD(name) extern const BodyMethod name##_method;
#include "polhode/method/methods.def"
#undef POLHODE_METHOD

}  // namespace polhode
