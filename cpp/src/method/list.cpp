#include "polhode/method/methods.hpp"

#include <algorithm>
#include <vector>

#include "method/method.hpp"
#include "polhode/core/error.hpp"

namespace polhode {
namespace {

const std::vector<BodyMethod>& all() {
  // Never destroyed: threads may still run when the process ends.
  static const auto& list = *new const std::vector<BodyMethod>([] {
    std::vector<BodyMethod> methods;
#define POLHODE_METHOD(name) methods.push_back(name##_method);
#include "polhode/method/methods.def"
#undef POLHODE_METHOD
    return methods;
  }());
  return list;
}

}  // namespace

const BodyMethod& find_body_method(std::string_view name) {
  for (const BodyMethod& method : all()) {
    if (method.record.name == name) return method;
  }
  std::string names;
  for (const BodyMethod& method : all()) {
    if (!method.record.comparison) names.append(names.empty() ? "" : ", ").append(method.record.name);
  }
  throw InvalidInput("method", "one of " + names, "'" + std::string(name) + "'");
}

std::span<const ode::MethodRecord> methods() {
  static const auto& records = *new const std::vector<ode::MethodRecord>([] {
    std::vector<ode::MethodRecord> copies;
    for (const BodyMethod& method : all()) copies.push_back(method.record);
    return copies;
  }());
  return records;
}

const ode::MethodRecord& find_method(std::string_view name) { return find_body_method(name).record; }

}  // namespace polhode
