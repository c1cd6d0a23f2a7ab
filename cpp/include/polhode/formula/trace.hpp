#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/formula/expression.hpp"
#include "polhode/formula/program.hpp"

namespace polhode::formula {

/// What a torque's function gets, with T = Expr while it is traced, and T = double in a test of the function.
template <class T>
class TorqueArguments {
 public:
  T t{};
  Vec<T, 3> omega;      ///< w_B
  Vec<T, 4> attitude;   ///< q_WB, unit length

  TorqueArguments(const std::vector<Input>& parameters, std::vector<T> parameter_values,
                  const std::vector<Input>& states, std::vector<T> state_values)
      : parameters_(parameters), states_(states), parameter_values_(std::move(parameter_values)),
        state_values_(std::move(state_values)) {}

  /// A vector of numbers.
  static Vec<T, 3> vector(double x, double y, double z) { return {{T(x), T(y), T(z)}}; }
  /// A named parameter, and a named vector of parameters.
  T p(std::string_view name) const { return get<1>(parameters_, parameter_values_, name)[0]; }
  template <std::size_t n>
  Vec<T, n> p(std::string_view name) const { return get<n>(parameters_, parameter_values_, name); }
  /// A named state, and a named vector of states.
  T s(std::string_view name) const { return get<1>(states_, state_values_, name)[0]; }
  template <std::size_t n>
  Vec<T, n> s(std::string_view name) const { return get<n>(states_, state_values_, name); }

 private:
  template <std::size_t n>
  static Vec<T, n> get(const std::vector<Input>& inputs, const std::vector<T>& values, std::string_view name) {
    const Place place = find_place(inputs, name);
    if (place.count != static_cast<int>(n)) {
      throw InvalidInput("formula", "a name with " + std::to_string(n) + (n == 1 ? " value" : " values"), name,
                         place.count == 0 ? "no parameter or state of the formula has this name" : "");
    }
    Vec<T, n> found;
    for (std::size_t i = 0; i < n; ++i) found[i] = values[static_cast<std::size_t>(place.first) + i];
    return found;
  }

  std::vector<Input> parameters_, states_;
  std::vector<T> parameter_values_, state_values_;
};

/// What a torque with states of its own returns: tau_B, and the rate of each number of the states, in their order.
template <class T>
struct TorqueResult {
  Vec<T, 3> torque;
  std::vector<T> rates;
};

/// Calls a generic function once on symbols. It takes `const TorqueArguments<T>&`, and returns Vec<T, 3> or
/// TorqueResult<T>.
template <class Callable>
Program trace(const Callable& callable, std::vector<Input> parameters = {}, std::vector<Input> states = {}) {
  Program program;
  Graph& graph = program.graph;
  std::vector<Expr> parameter_values, state_values;
  for (std::size_t i = 0; i < list_values(parameters).size(); ++i)
    parameter_values.emplace_back(graph, graph.parameter(static_cast<int>(i)));
  for (std::size_t i = 0; i < list_values(states).size(); ++i)
    state_values.emplace_back(graph, graph.state(first_extra + static_cast<int>(i)));
  TorqueArguments<Expr> arguments(parameters, std::move(parameter_values), states, state_values);
  arguments.t = Expr(graph, graph.time());
  arguments.omega = list_states<3>(graph, first_rate), arguments.attitude = list_states<4>(graph, first_attitude);
  TorqueResult<Expr> result;
  if constexpr (std::is_convertible_v<decltype(callable(arguments)), Vec<Expr, 3>>) {
    result.torque = callable(arguments);
  } else {
    result = callable(arguments);
  }
  if (result.rates.size() != state_values.size()) {
    throw InvalidInput("formula", std::to_string(state_values.size()) + " rates, one for each number of the states",
                       std::to_string(result.rates.size()));
  }
  for (const Expr& component : result.torque.components) program.outputs.push_back(component.form());
  for (const Expr& rate : result.rates) program.outputs.push_back(rate.form());
  program.parameters = std::move(parameters), program.states = std::move(states);
  return rewrite(program);
}

}  // namespace polhode::formula
