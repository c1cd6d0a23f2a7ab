#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/formula/recognise.hpp"
#include "polhode/torque/detail/law_arguments.hpp"
#include "polhode/torque/detail/law_numbers.hpp"
#include "polhode/torque/formula.hpp"
#include "polhode/torque/record.hpp"

namespace polhode::torques {

// The functions of laws, on every number type: never those of <cmath>.
using formula::abs, formula::atan2, formula::clip, formula::cos, formula::cross, formula::dot, formula::exp,
    formula::log, formula::max, formula::min, formula::norm, formula::pow, formula::sign, formula::sin, formula::sqrt,
    formula::tan, formula::tanh, formula::where;
using formula::Mat, formula::Vec;

/// A torque with recurrences written out in BodySeries. known() names what it is there.
template <class Torque>
concept HasKernel = requires(const Torque& torque) {
  { torque.known() } -> std::same_as<formula::KnownTorque>;
};

/// A torque that is one law. Everything else follows from it: the function, the formula, and from the formula series,
/// derivatives, proofs and lanes.
///
///     template <class T>
///     struct DragNumbers {                                    // of a number type T, in the order of the record
///       T factor;
///       static auto list(auto& of) { return std::tie(of.factor); }
///     };
///     class Drag : public Law<Drag, DragNumbers> {
///      public:
///       using Law::Law;
///       static constexpr TorqueParameter parameters[] = {{"factor", TorqueParameter::Kind::real, "N m s^2", "c"}};
///       static constexpr TorqueRecord about{"Drag", "drag", "tau_B = -c |w| w.", "", parameters};
///       static auto compute(const auto& in, const auto& p) { return -(p.factor * norm(in.omega)) * in.omega; }
///     };
///
/// `in` is LawArguments of the number type. A law may also have
///   static auto potential(in, p)                its potential [J], whose negative gradient it is
///   states                                      a struct of numbers like that of the parameters, named in
///                                               `state_names`, with their start(p); then compute(in, p, s) returns
///                                               LawResult{torque, rates}
///   static void check(numbers)                  throws InvalidInput for numbers that do not fit together
///   formula::KnownTorque known() const          what it is among the torques with kernels
///   TorqueTraits traits() const                 claims beyond what its formula shows
/// The name of the class stands in torque/list.hpp.
template <class Own, template <class> class Numbers>
class Law {
 public:
  /// @param numbers  Numbers<double>, never a list in braces, which may stand for a vector
  /// @throws InvalidInput for a number that is not finite
  template <std::same_as<Numbers<double>> Given>
  explicit Law(const Given& numbers) : numbers_(numbers) {
    detail::require_finite_numbers(Own::about, numbers_);
    if constexpr (requires { Own::check(numbers_); }) Own::check(numbers_);
    if constexpr (!HasKernel<Own>) made_ = std::make_shared<Made>();
  }

  static const TorqueRecord& record() { return Own::about; }
  static Own from_values(std::span<const TorqueValue> values) {
    return Own(detail::read_numbers<Numbers<double>>(Own::about, values));
  }
  TorqueValues values() const { return detail::list_values(Own::about, numbers_); }
  const Numbers<double>& numbers() const { return numbers_; }

  /// The same torque as a formula of its parameters.
  formula::Program law(const Matrix3d& inertia_B) const { return trace(&inertia_B); }
  /// The same as a formula of the inertia too, whose nine numbers are the last parameter if the law has them.
  formula::Program open_law() const { return trace(nullptr); }
  /// The torque as a Formula, made at the first call. A torque with kernels needs none.
  /// Templates, because Clang 14 asks a constraint of a plain member while Own is incomplete, and keeps the answer.
  template <class Complete = Own>
  const Formula& formula() const requires(!HasKernel<Complete>) {
    std::call_once(made_->once, [this] { made_->formula.emplace(Formula::of_law(open_law())); });
    return *made_->formula;
  }

  template <class Complete = Own>
  TorqueTraits traits() const requires(!HasKernel<Complete>) {
    TorqueTraits found = formula().traits();
    found.has_potential = has_potential;
    return found;
  }

  /// tau_B += the law's torque. States are those of the start.
  void add(const TorqueInput& in, double* tau_B) const {
    const Vec<double, 3> tau = compute_torque(detail::see_numbers(in), numbers_);
    for (std::size_t i = 0; i < 3; ++i) tau_B[i] = tau_B[i] + tau[i];
  }

  double compute_potential(const TorqueInput& in) const {   ///< [J]; 0 where the law has none
    if constexpr (has_potential) {
      return Own::potential(detail::see_numbers(in), numbers_);
    } else {
      return 0.0;
    }
  }

  friend bool operator==(const Own& a, const Own& b) { return a.values() == b.values(); }

 private:
  struct Made {
    std::once_flag once;
    std::optional<Formula> formula;
  };

  static constexpr bool has_potential = requires(const LawArguments<double>& in, const Numbers<double>& p) {
    Own::potential(in, p);
  };
  static constexpr bool has_states = requires { Own::state_names; };

  template <class T>
  static Vec<T, 3> compute_torque(const LawArguments<T>& in, const Numbers<T>& p) {
    if constexpr (has_states) {
      return Own::compute(in, p, Own::start(p)).torque;
    } else {
      return Own::compute(in, p);
    }
  }

  formula::Program trace(const Matrix3d* inertia_B) const {
    using formula::Expr;
    formula::Program program;
    formula::Graph& graph = program.graph;
    int next = 0;
    const auto add_parameter = [&](Expr& number) { number = Expr(graph, graph.parameter(next++)); };
    Numbers<Expr> p;
    detail::copy_choices(numbers_, p);
    detail::for_each_number(p, add_parameter);
    program.parameters = detail::list_inputs(Own::about, numbers_);
    const int own = next;
    Mat<Expr> I;
    for (std::size_t i = 0; i < 9; ++i) {
      if (inertia_B != nullptr) I.entries[i] = (*inertia_B)(static_cast<int>(i / 3), static_cast<int>(i % 3));
      else add_parameter(I.entries[i]);
    }
    const LawArguments<Expr> in{Expr(graph, graph.time()), formula::list_states<3>(graph, formula::first_rate),
                                formula::list_states<4>(graph, formula::first_attitude), I};
    const auto put = [&](const auto& v) {
      detail::for_each_number(v, [&](const Expr& number) { program.outputs.push_back(number.form()); });
    };
    if constexpr (has_states) {
      auto starts = Own::start(numbers_);
      typename Own::template states<Expr> s;
      int number = formula::first_extra;
      detail::for_each_number(s, [&](Expr& one) { one = Expr(graph, graph.state(number++)); });
      program.states = detail::list_inputs(Own::state_names, starts);
      const auto result = Own::compute(in, p, s);
      put(result.torque), put(result.rates);
    } else {
      put(Vec<Expr, 3>(Own::compute(in, p)));
    }
    program = formula::rewrite(program);
    if (formula::uses_parameters_from(program, own))
      program.parameters.push_back({std::string(inertia_input), std::vector<double>(9)});
    return program;
  }

  Numbers<double> numbers_;
  std::shared_ptr<Made> made_;
};

}  // namespace polhode::torques
