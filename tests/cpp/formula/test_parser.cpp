#include <doctest/doctest.h>

#include <string>

#include "polhode/core/error.hpp"
#include "polhode/formula/parser.hpp"

using namespace polhode;
using namespace polhode::formula;

namespace {

std::string refusal(const std::string& torque) {
  try {
    parse({torque, {{"kp", {0.2}}, {"kd", {0.5}}}, {}, {}, {}});
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "taken";
}

}  // namespace

TEST_CASE("formula: a refusal names line, column, what was found and the known names") {
  CHECK(refusal("-kp * k") ==
        "torque, line 1, column 7: must be a known name (attitude, kd, kp, omega, pi, t), got 'k'");
  CHECK(refusal("omega +\n  omega.q") ==
        "torque, line 2, column 9: must be a component of a vector (x, y, z, w, xyz), got 'q'");
  CHECK(refusal("omega + attitude") ==
        "torque, line 1, column 7: operands: must be vectors of one length, got 3 and 4 components");
  CHECK(refusal("sqrt(-1) * omega") ==
        "torque, line 1, column 1: formula: must be the root of a number that is not negative, got -1");
  CHECK(refusal("omega^t") == "torque, line 1, column 7: must be an exponent that is a number, got 't'");
  CHECK(refusal("[1, 2, 3") == "torque, line 1, column 9: must be ']', got the end");
  CHECK(refusal("kp") == "torque: must be 3 components, got 1");
  CHECK(refusal("omega / (1 - 1)").find("a divisor that is not 0") != std::string::npos);
  CHECK(refusal("1e999 * omega").find("float64's range") != std::string::npos);
  CHECK(refusal("1e200 * (1e200 * omega)").find("finite") != std::string::npos);
  CHECK(refusal("mean(omega)").find("a known function (abs, atan2") != std::string::npos);
  CHECK(refusal("where(kp, omega, omega)").find("a comparison of numbers first") != std::string::npos);
  CHECK(refusal("3 $ 4").find("column 3: must be an operator, a name or a number, got '$'") != std::string::npos);
}

TEST_CASE("formula: limits of a text") {
  CHECK(refusal(std::string(200, '(') + "omega" + std::string(200, ')')).find("a depth of at most 100") !=
        std::string::npos);
  CHECK(refusal(std::string(200, '-') + "omega").find("a depth of at most 100") != std::string::npos);
  CHECK(refusal("omega" + std::string(10'000, ' ')) == "torque: must be at most 10000 characters, got 10005");
  CHECK(refusal(std::string(40, '(') + "omega" + std::string(40, ')')) == "taken");
  Text large{"x", {}, {}, {}, {{"x", "omega"}}};
  std::string last = "x";
  for (int i = 0; i < 4000; ++i) {
    std::string name = "x";
    name += std::to_string(i);
    large.let.emplace_back(name, last + " * omega");
    last = name;
  }
  large.torque = "x3999";
  CHECK_THROWS_AS(parse(large), InvalidInput);
}

TEST_CASE("formula: operators bind as in algebra") {
  const auto constant = [](const std::string& number) {
    return parse({"[" + number + ", 0, 0]", {}, {}, {}, {}}).outputs[0].constant;
  };
  CHECK(constant("-2^2") == -4.0);
  CHECK(constant("2^3^2") == 512.0);
  CHECK(constant("2^-1") == 0.5);
  CHECK(constant("8 / 4 / 2 - 3 - 4") == -6.0);
  CHECK(constant("2 * (3 + 4)") == 14.0);
  CHECK(constant("[1, 2, 3].z + [4, 5][1]") == 8.0);
  CHECK(constant("dot([1, 2, 3], cross([0, 0, 1], [0, 1, 0]))") == -1.0);
  CHECK(constant("norm([3, 4, 12]) + norm([3, 0, 0], 4)") == 18.0);
  CHECK(constant("where(1 < 2, 10, 20) + min(3, 4) + max(3, 4) + clip(9, 0, 5) + abs(-2) + sign(-3)") == 23.0);
}
