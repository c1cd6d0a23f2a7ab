#pragma once

#include <span>
#include <string_view>

#include "polhode/ode/method_record.hpp"

namespace polhode {

/// The records of all methods, in the order of methods.def.
std::span<const ode::MethodRecord> methods();

/// The record of one method. @throws InvalidInput for an unknown name, listing the known names.
const ode::MethodRecord& find_method(std::string_view name);

}  // namespace polhode
