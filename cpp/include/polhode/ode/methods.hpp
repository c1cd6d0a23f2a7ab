#pragma once

#include <span>
#include <string_view>
#include <tuple>

#include "polhode/ode/method_record.hpp"
#include "polhode/ode/rk45.hpp"

namespace polhode::ode {

/// The list of methods. A new one is a file of its own and a name here; ph.methods(), the command line, the charts,
/// the docs and the conformance tests follow.
using Methods = std::tuple<Rk45>;

/// The records of all methods, in the order of the list.
std::span<const MethodRecord> methods();

/// The record of one method. @throws InvalidInput for an unknown name, with the names there are.
const MethodRecord& find_method(std::string_view name);

/// Calls `action.template operator()<Method>()` for the method of that name.
template <class Action>
auto with_method(std::string_view name, Action&& action) {
  find_method(name);
  const auto pick = [&]<class First, class... Rest>(auto& self, std::tuple<First, Rest...>*) {
    if constexpr (sizeof...(Rest) == 0) {
      return action.template operator()<First>();
    } else {
      if (name == First::record.name) return action.template operator()<First>();
      return self(self, static_cast<std::tuple<Rest...>*>(nullptr));
    }
  };
  return pick(pick, static_cast<Methods*>(nullptr));
}

}  // namespace polhode::ode
