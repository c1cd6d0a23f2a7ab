#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "polhode/math/detail/functions.hpp"

namespace math = polhode::math;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

double compute(const std::string& name, const std::vector<double>& x) {
  if (name == "atan2") return math::atan2(x[0], x[1]);
  if (name == "hypot") return math::hypot(x[0], x[1]);
  if (name == "hypot3") return math::hypot(x[0], x[1], x[2]);
  if (name == "pow") return math::pow(x[0], x[1]);
  static const std::map<std::string, double (*)(double)> functions = {
      {"sin", [](double v) { return math::sin(v); }},   {"cos", [](double v) { return math::cos(v); }},
      {"atan", [](double v) { return math::atan(v); }}, {"asin", [](double v) { return math::asin(v); }},
      {"acos", [](double v) { return math::acos(v); }}, {"exp", [](double v) { return math::exp(v); }},
      {"log", [](double v) { return math::log(v); }},   {"expm1", [](double v) { return math::expm1(v); }},
      {"cbrt", [](double v) { return math::cbrt(v); }}, {"asinh", [](double v) { return math::asinh(v); }}};
  return functions.at(name)(x[0]);
}

/// The distance of two neighbouring numbers at x.
double ulp(double x) { return std::abs(x) - std::nextafter(std::abs(x), 0.0); }

/// The line's fields: a name, the arguments, the nearest number to the value, and the rest in ulp.
struct Truth {
  std::string name;
  std::vector<double> numbers;
};

std::vector<Truth> read_table() {
  std::ifstream file(POLHODE_REFERENCE "/functions.csv");
  std::vector<Truth> found;
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    Truth truth;
    std::getline(fields, truth.name, ',');
    for (std::string field; std::getline(fields, field, ',');) {
      truth.numbers.push_back(std::strtod(field.c_str(), nullptr));
    }
    found.push_back(truth);
  }
  return found;
}

}  // namespace

TEST_CASE("elementary functions are within 0.55 ulp of 40-digit values") {
  std::map<std::string, double> worst;
  std::map<std::string, int> count;
  for (const Truth& truth : read_table()) {
    const std::size_t n = truth.numbers.size() - 2;
    const std::vector<double> x(truth.numbers.begin(), truth.numbers.end() - 2);
    const double nearest = truth.numbers[n], beyond = truth.numbers[n + 1], found = compute(truth.name, x);
    const double off = found == nearest ? 0.0 : (found - nearest) / ulp(nearest), error = std::abs(off - beyond);
    CAPTURE(truth.name);
    CAPTURE(x[0]);
    CAPTURE(x.back());
    CHECK(error <= 0.55);   // 0.516 was the most in millions of arguments
    worst[truth.name] = std::max(worst[truth.name], error);
    ++count[truth.name];
  }
  CHECK(count.size() == 14);
  for (const auto& function : count) {
    CAPTURE(function.first);
    CHECK(function.second > 100);
    CHECK(worst[function.first] > 0.4);   // the table has hard cases
  }
}

TEST_CASE("sincos has the bits of sin and of cos") {
  for (const double x : {0.0, -0.0, 0.3, -0.7, 1.0, 2.0, -3.0, 4.0, 5.5, -1e3, 1e5, 1e6, -1e22, 1.7e308, 1e-9}) {
    const math::SinCosPair both = math::sincos(x);
    CHECK(both.sin == math::sin(x));
    CHECK(both.cos == math::cos(x));
  }
}

TEST_CASE("special values are those of C") {
  const auto same = [](double a, double b) {
    return std::isnan(a) ? std::isnan(b) : a == b && std::signbit(a) == std::signbit(b);
  };
  const double values[] = {0.0, -0.0, 1.0, -1.0, 0.5, -2.0, 3.0, infinity, -infinity, not_a_number};
  for (const double y : values) {
    for (const double x : values) {
      CAPTURE(x);
      CAPTURE(y);
      CHECK(same(math::atan2(y, x), std::atan2(y, x)));
      CHECK(same(math::pow(x, y), std::pow(x, y)));
      if (std::isinf(x) || std::isinf(y) || x == 0.0) CHECK(same(math::hypot(x, y), std::hypot(x, y)));
      CHECK(same(math::hypot(x, y, -infinity), infinity));
    }
  }
  for (const double x : {0.0, -0.0, infinity, -infinity, not_a_number}) {
    CAPTURE(x);
    CHECK(same(math::sin(x), std::sin(x)));
    CHECK(same(math::cos(x), std::cos(x)));
    CHECK(same(math::sincos(x).sin, std::sin(x)));
    CHECK(same(math::atan(x), std::atan(x)));
    CHECK(same(math::asin(x), std::asin(x)));
    CHECK(same(math::acos(x), std::acos(x)));
    CHECK(same(math::exp(x), std::exp(x)));
    CHECK(same(math::expm1(x), std::expm1(x)));
    CHECK(same(math::log(x), std::log(x)));
    CHECK(same(math::asinh(x), std::asinh(x)));
    CHECK(same(math::cbrt(x), std::cbrt(x)));
    CHECK(same(math::fast_log2(x), std::log2(x)));
    CHECK(same(math::fast_exp2(x), std::exp2(x)));
  }
  CHECK(std::isnan(math::hypot(not_a_number, 1.0)));
  CHECK(std::isnan(math::hypot(0.0, 0.0, not_a_number)));
  CHECK(std::isnan(math::log(-1.0)));
  CHECK(std::isnan(math::asin(1.0000000000000002)));
  CHECK(math::exp(709.79) == infinity);
  CHECK(math::exp(-745.2) == 0.0);
  CHECK(math::hypot(1.5e308, 1.5e308) == infinity);
  CHECK(math::log(1.0) == 0.0);
}

TEST_CASE("the fast functions keep their 1e-15") {
  for (const double x : {1e-300, 3e-20, 1e-5, 0.1, 0.70710678, 0.999, 1.0000001, 1.5, 7.0, 1e10, 1e305}) {
    CAPTURE(x);
    CHECK(std::abs(math::fast_log(x) - math::log(x)) <= 3e-15 * std::abs(math::log(x)));
    for (const double y : {-1.0, -0.3, 1e-3, 0.02, 1.0 / 7, 0.9}) {
      CAPTURE(y);
      const double expected = math::pow(x, y);
      CHECK(std::abs(math::fast_pow(x, y) - expected) <= 3e-15 * (1 + std::abs(y * math::fast_log2(x))) * expected);
    }
  }
  CHECK(math::fast_exp2(-3.0) == 0.125);
  CHECK(math::fast_exp2(-1074.0) == 5e-324);
  CHECK(math::fast_log2(5e-324) == -1074.0);
  CHECK(math::power(3.0, 5) == 243.0);
  CHECK(math::power(2.0, -3) == 0.125);
  CHECK(math::power(0.0, 0) == 1.0);
}
