#pragma once

#include <string>

#include "polhode/ode/method_record.hpp"
#include "solve/run.hpp"

namespace polhode {

/// A method of the list: its record, how it answers a scene, and why it would not.
struct BodyMethod {
  ode::MethodRecord record;
  Motion (*solve)(const Scene& scene, const RunOptions& options);
  std::string (*refuse)(const Scene& scene) = nullptr;   ///< "" when it takes the scene; null: it takes any
  bool of_bodies = true;                                 ///< steps the body itself and no other formulation
  bool carries_error = false;                            ///< fills RunOptions::trace
};

/// @throws InvalidInput for an unknown name, with the names there are.
const BodyMethod& find_body_method(std::string_view name);

#define POLHODE_METHOD(name) extern const BodyMethod name##_method;
#include "polhode/solve/methods.def"
#undef POLHODE_METHOD

}  // namespace polhode
