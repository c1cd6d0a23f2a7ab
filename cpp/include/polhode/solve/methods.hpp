#pragma once

#include <span>
#include <string>
#include <string_view>

#include "polhode/ode/method_record.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

/// The records of all methods, in the order of methods.def.
std::span<const ode::MethodRecord> methods();

/// The record of one method. @throws InvalidInput for an unknown name, with the names there are.
const ode::MethodRecord& find_method(std::string_view name);

/// Why a method does not take a scene, or "" when it does.
std::string compute_refusal(std::string_view method, const Scene& scene);

}  // namespace polhode
