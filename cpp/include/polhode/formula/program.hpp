#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "polhode/core/quat.hpp"
#include "polhode/formula/graph.hpp"

namespace polhode::formula {

/// A named parameter with its value, or a named state with its start. A vector has several numbers.
struct Input {
  std::string name;
  std::vector<double> values;

  friend bool operator==(const Input&, const Input&) = default;
};

/// The numbers of `name` among those of all inputs: the first and the count; {-1, 0} if there is no such name.
struct Place {
  int first, count;
};
Place find_place(const std::vector<Input>& inputs, std::string_view name);
/// All numbers of the inputs in their order.
std::vector<double> list_values(const std::vector<Input>& inputs);

/// Outputs computed from the time, the states and the parameters.
///
/// A torque's outputs are the components of tau_B, then the rates of its own states. A system's outputs are the rates
/// of all its states.
struct Program {
  Graph graph;
  std::vector<Input> parameters;
  std::vector<Input> states;     ///< those of the formula, from first_extra on
  std::vector<Form> outputs;
  /// w in the axes that vectors of to_body are seen from, where the first three states are other variables than w.
  std::vector<Form> rates = {};
};

/// What a node becomes in the new graph; nothing: the same operation on the changed operands.
using Change = std::function<std::optional<Form>(int node, Graph& to)>;

/// Copies the nodes that the outputs need to a new graph.
class Rewriter {
 public:
  Rewriter(const Graph& from, Graph& to, Change change = {});

  /// The form in the new graph.
  Form operator()(const Form& form);

 private:
  const Form& copy(int node);
  Form make(int node);

  const Graph& from_;
  Graph& to_;
  Change change_;
  std::vector<std::optional<Form>> made_;
};

/// The nodes that forms need, as one flag a node.
/// @param is_leaf  true for nodes whose operands are not needed
std::vector<bool> find_live(const Graph& graph, const std::vector<Form>& forms,
                            const std::function<bool(int node)>& is_leaf = {});

/// The same nodes in the same order, with the same outputs and inputs: the same bits.
bool is_same(const Program& a, const Program& b);

/// A program without dead nodes: the inputs by their numbers first, then the nodes in their old order.
Program rewrite(const Program& program, const Change& change = {});
/// Parameters become numbers: one value for each number of all parameters.
Program bind_parameters(const Program& program, const std::vector<double>& values);
/// The same for `values.size()` numbers from a number on. Other parameters stay, and follow each other.
Program bind_some(const Program& program, int first, const std::vector<double>& values);
/// Whether an output needs a parameter with this number or one behind it.
bool uses_parameters_from(const Program& program, int first);
/// Components of R_WB^T v become polynomials in the attitude.
/// @param but_carried  not those of a vector that a tape carries
Program expand_rotations(const Program& program, bool but_carried = false);

/// Copies a program's nodes into `to`, which gets its outputs as forms. States become other forms: the first seven of
/// `states` are the body's, and the program's own follow.
/// @param rotation  makes a vector seen from the axes of `to` one seen from the program's; null if they are the same
std::vector<Form> embed(const Program& program, Graph& to, const std::vector<Form>& states, const Matrix3d* rotation);

/// The equations of a body with a torque: w' = I^-1 (tau - w x I w), q' = q w / 2, and the rates of its states.
Program make_body_equations(const Program& torque, const Matrix3d& inertia_B);

/// Values of a program's outputs on doubles, for methods that need no series.
class Evaluator {
 public:
  explicit Evaluator(const Program& program);   ///< which must live as long
  explicit Evaluator(Program&&) = delete;

  /// @param y  the states by their numbers, the attitude of unit length
  void operator()(double t, const double* y, const double* parameters, double* outputs) {
    evaluate(t, y, parameters, values_.data(), outputs);
  }
  /// The same with memory of the caller's, so that several threads may use one evaluator.
  /// @param values  one number for each node of the graph
  void evaluate(double t, const double* y, const double* parameters, double* values, double* outputs) const;
  /// The value that a live node had in the last call.
  double value(int node) const { return values_[static_cast<std::size_t>(node)]; }

 private:
  double compute(int node, double t, const double* y, const double* parameters, const double* values) const;
  static double compute(const Form& form, const double* values);

  const Program& program_;
  std::vector<int> live_;
  std::vector<double> values_;
};

}  // namespace polhode::formula
