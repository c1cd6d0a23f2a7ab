#include <doctest/doctest.h>

#include "polhode/core/error.hpp"
#include "polhode/method/methods.hpp"

using namespace polhode;

TEST_CASE("the list of methods: unique names, sources, and an unknown name refused with the known ones") {
  for (const ode::MethodRecord& record : methods()) {
    CHECK(!record.doc.empty());
    CHECK(!record.source.empty());
    int same = 0;
    for (const ode::MethodRecord& other : methods()) same += other.name == record.name;
    CHECK(same == 1);
  }
  CHECK_THROWS_WITH_AS(find_method("rk54"), doctest::Contains("rk45"), InvalidInput);
}
