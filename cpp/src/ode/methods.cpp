#include "polhode/ode/methods.hpp"

#include <array>
#include <string>

#include "polhode/core/error.hpp"

namespace polhode::ode {
namespace {

template <class... M>
constexpr auto collect(std::tuple<M...>*) {
  return std::array<MethodRecord, sizeof...(M)>{M::record...};
}

constexpr auto records = collect(static_cast<Methods*>(nullptr));

}  // namespace

std::span<const MethodRecord> methods() { return records; }

const MethodRecord& find_method(std::string_view name) {
  std::string names;
  for (const MethodRecord& record : records) {
    if (record.name == name) return record;
    names.append(names.empty() ? "" : ", ").append(record.name);
  }
  throw InvalidInput("method", "one of " + names, "'" + std::string(name) + "'");
}

}  // namespace polhode::ode
