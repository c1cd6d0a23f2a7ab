#include "polhode/inertia/shapes.hpp"

#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

const std::vector<Record>& all() {
  // Never destroyed: threads may still run when the process ends.
  static const auto& records = *new const std::vector<Record>{
#define POLHODE_SHAPE(name, parameters) describe_##name(),
#include "polhode/inertia/shapes.def"
#undef POLHODE_SHAPE
  };
  return records;
}

const Record& find(const std::string& name) {
  std::string names;
  for (const Record& record : all()) {
    if (record.name == name) return record;
    names += (names.empty() ? "" : ", ") + record.name;
  }
  throw InvalidInput("shape", "one of " + names, name);
}

}  // namespace polhode::shapes
