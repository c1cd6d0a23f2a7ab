#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "polhode/formula/expression.hpp"

namespace polhode::formula {

/// What a part of a text is: a number (one item), a vector, or a comparison of numbers.
struct Value {
  std::vector<Expr> items;
  std::optional<Condition> condition;

  bool is_number() const { return items.size() == 1 && items[0].form().is_constant(); }
};

/// a op b with op one of + - * /, elementwise; a number goes with each component.
Value combine(char op, const Value& a, const Value& b);
Value compare(std::string_view op, const Value& a, const Value& b);
Value raise(const Value& base, double exponent);

bool is_function(std::string_view name);
/// @throws InvalidInput that says what the function takes
Value call(Graph& graph, std::string_view name, const std::vector<Value>& arguments);

}  // namespace polhode::formula
