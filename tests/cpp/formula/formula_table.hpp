#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "polhode/formula/parser.hpp"

namespace polhode::formula {

/// One formula of tests/reference/formula.txt with its truth.
struct TableCase {
  Text text;
  double t = 0.0;
  std::vector<double> y;
  std::vector<double> values, errors;          ///< of the outputs; errors in units of 2^-53
  std::vector<std::vector<double>> slopes;     ///< by each state, then each parameter
  bool diagonal = false;
  std::vector<std::vector<double>> rows;       ///< Taylor coefficients of the states
};

inline std::vector<TableCase> read_formulas() {
  std::ifstream file(POLHODE_REFERENCE "/formula.txt");
  std::vector<TableCase> cases;
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    std::string key;
    fields >> key;
    std::vector<double> numbers;
    if (key != "torque" && key != "rate")
      for (double x; fields >> x;) numbers.push_back(x);
    const std::string rest = key.size() < line.size() ? line.substr(key.size() + 1) : "";
    if (key == "case") {
      cases.emplace_back();
      cases.back().text.parameters = {{"kp", {0.375}}, {"kd", {-1.25}}};
    }
    if (cases.empty()) continue;
    TableCase& c = cases.back();
    if (key == "torque") c.text.torque = rest;
    if (key == "rate") c.text.rates = {rest};
    if (key == "y") {
      c.t = numbers[0], c.y.assign(numbers.begin() + 1, numbers.end());
      c.text.states = {{"h", {c.y[7], c.y[8]}}};
    }
    if (key == "values") c.values = numbers;
    if (key == "errors") c.errors = numbers;
    if (key == "slopes") c.slopes.push_back(numbers);
    if (key == "inertia") c.diagonal = numbers[0] == 1.0;
    if (key == "row") c.rows.push_back(numbers);
  }
  return cases;
}

/// The inertia of the table's bodies.
inline Matrix3d make_inertia(bool diagonal) {
  Matrix3d I;
  I << 2.0, 0.25, -0.125, 0.25, 3.0, 0.5, -0.125, 0.5, 4.0;
  return diagonal ? Matrix3d(I.diagonal().asDiagonal()) : I;
}

}  // namespace polhode::formula
