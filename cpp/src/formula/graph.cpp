#include "polhode/formula/graph.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "polhode/core/error.hpp"
#include "polhode/formula/detail/functions.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/number.hpp"

namespace polhode::formula {
namespace {

class Hash {
 public:
  void add(std::uint64_t x) {
    value_ = (value_ ^ x) * 0x9e3779b97f4a7c15u;
    value_ ^= value_ >> 29;
  }
  void add(double x) { add(std::bit_cast<std::uint64_t>(x)); }
  void add(int x) { add(static_cast<std::uint64_t>(static_cast<std::int64_t>(x))); }
  std::size_t value() const { return static_cast<std::size_t>(value_); }

 private:
  std::uint64_t value_ = 0x2545f4914f6cdd1du;
};

bool is_finite(double x) { return std::abs(x) <= 1.7976931348623157e308; }

/// A factor made of others, which may leave float64's range.
double require_normal(double factor) {
  if (std::abs(factor) >= 0x1p-1022 && is_finite(factor)) return factor;
  throw InvalidInput("formula", "products of constants within float64's range", to_text(factor));
}

double power_of_two_of(double x) {
  const double size = std::abs(x);
  return size >= 0x1p-1022 && is_finite(size) ? math::power_of_two_below(size) : 1.0;
}

}  // namespace

void require_finite(const Form& form) {
  bool finite = is_finite(form.constant);
  for (const Term& term : form.terms) finite = finite && is_finite(term.factor);
  if (!finite) throw InvalidInput("formula", "constants that are finite", "one that is not");
}

int Graph::intern(const Node& node) {
  Hash hash;
  hash.add(static_cast<int>(node.op)), hash.add(node.index), hash.add(node.constant);
  for (const int operand : node.operands) hash.add(operand);
  const auto [begin, end] = found_.equal_range(hash.value());
  for (auto it = begin; it != end; ++it)
    if ((*this)[it->second] == node) return it->second;
  if (size() >= most_nodes) throw InvalidInput("formula", "at most 10000 operations", "more");
  nodes_.push_back(node);
  found_.emplace(hash.value(), size() - 1);
  return size() - 1;
}

int Graph::find_linear(const Form& form) {
  Hash hash;
  hash.add(form.constant);
  for (const Term& term : form.terms) hash.add(term.factor), hash.add(term.node);
  const auto [begin, end] = found_.equal_range(hash.value());
  for (auto it = begin; it != end; ++it)
    if ((*this)[it->second].op == Op::linear && linear(it->second) == form) return it->second;
  if (size() >= most_nodes) throw InvalidInput("formula", "at most 10000 operations", "more");
  forms_.push_back(form);
  nodes_.push_back({.op = Op::linear, .index = static_cast<int>(forms_.size()) - 1});
  found_.emplace(hash.value(), size() - 1);
  return size() - 1;
}

int Graph::node_of(const Form& form) {
  require_finite(form);
  if (form.is_constant()) return intern({.op = Op::constant, .constant = form.constant});
  if (form.terms.size() == 1 && form.constant == 0.0 && form.terms[0].factor == 1.0) return form.terms[0].node;
  return find_linear(form);
}

Term Graph::take_factor(const Form& form, bool all) {
  if (form.is_constant()) return {1.0, node_of(form)};
  const Term& first = form.terms[0];
  const bool single = form.terms.size() == 1 && form.constant == 0.0;
  if (single && all) return first;
  double largest = std::abs(form.constant);
  for (const Term& term : form.terms) largest = std::max(largest, std::abs(term.factor));
  const double factor = std::copysign(power_of_two_of(largest), first.factor);
  return {factor, node_of(form / factor)};
}

Form Graph::time() { return Form::of(intern({.op = Op::time})); }
Form Graph::state(int number) { return Form::of(intern({.op = Op::state, .index = number})); }
Form Graph::parameter(int number) { return Form::of(intern({.op = Op::parameter, .index = number})); }

Form Graph::ephemeris(const Ephemeris& ephemeris, int number) {
  const auto known = std::find(ephemerides_.begin(), ephemerides_.end(), ephemeris);
  const auto which = static_cast<int>(known - ephemerides_.begin());
  if (known == ephemerides_.end()) {
    if (which == most_ephemerides) throw InvalidInput("formula", "at most 16 orbits", "more");
    ephemerides_.push_back(ephemeris);
  }
  return Form::of(intern({.op = Op::ephemeris, .index = Ephemeris::size * which + number}));
}

Form Graph::apply(Op op, const Form& a, double constant) {
  return Form::of(intern({.op = op, .operands = {node_of(a), -1, -1}, .constant = constant}));
}

Form Graph::multiply(const Form& a, const Form& b) {
  if (a.is_constant()) return b * a.constant;
  if (b.is_constant()) return a * b.constant;
  Term left = take_factor(a, true), right = take_factor(b, true);
  const double factor = require_normal(left.factor * right.factor);
  if (left.node > right.node) std::swap(left, right);
  return Form::of(intern({.op = Op::multiply, .operands = {left.node, right.node, -1}})) * factor;
}

Form Graph::divide(const Form& a, const Form& b) {
  if (b.is_constant()) {
    if (b.constant == 0.0) throw InvalidInput("formula", "a divisor that is not 0", "0");
    return a / b.constant;
  }
  if (a.is_zero()) return {};
  const Term above = take_factor(a, true), below = take_factor(b, false);
  const double factor = require_normal(above.factor / below.factor);
  if (above.node == below.node) return factor;
  return Form::of(intern({.op = Op::divide, .operands = {above.node, below.node, -1}})) * factor;
}

Form Graph::root(const Form& a) {
  if (a.is_constant()) {
    if (!(a.constant >= 0.0)) throw InvalidInput("formula", "the root of a number that is not negative",
                                                 to_text(a.constant));
    return std::sqrt(a.constant);
  }
  double largest = std::abs(a.constant);
  for (const Term& term : a.terms) largest = std::max(largest, std::abs(term.factor));
  // a power of four, so that its root is exact
  const double factor = power_of_two_of(largest), exponent = math::exponent_of_power(factor);
  const double half = math::power_of_two(std::floor(0.5 * exponent));
  return apply(Op::root, a / (half * half)) * half;
}

Form Graph::raise(const Form& a, int exponent) {
  if (exponent == 0) return 1.0;
  const Form half = raise(a, exponent / 2), square = multiply(half, half);
  return exponent % 2 == 0 ? square : exponent == 1 ? a : multiply(square, a);
}

Form Graph::power(const Form& a, double exponent) {
  if (!is_finite(exponent)) throw InvalidInput("formula", "a finite exponent", to_text(exponent));
  if (a.is_constant()) {
    const double value = math::pow(a.constant, exponent);
    if (!is_finite(value)) throw InvalidInput("formula", "a power of constants that is finite", to_text(value));
    return value;
  }
  const double size = std::abs(exponent), whole = std::floor(size);
  if (size <= 16.5 && (size == whole || size == whole + 0.5)) {
    Form value = raise(a, static_cast<int>(whole));
    if (size != whole) value = multiply(value, root(a));
    return exponent < 0.0 ? divide(1.0, value) : value;
  }
  return apply(Op::power, a, exponent);
}

Form Graph::exponential(const Form& a) {
  return a.is_constant() ? Form(math::exp(a.constant)) : apply(Op::exponential, a);
}

Form Graph::logarithm(const Form& a) {
  if (!a.is_constant()) return apply(Op::logarithm, a);
  if (!(a.constant > 0.0)) throw InvalidInput("formula", "the logarithm of a number above 0", to_text(a.constant));
  return math::log(a.constant);
}

Form Graph::sine(const Form& a) {
  if (a.is_constant()) return math::sin(a.constant);
  return a.terms[0].factor < 0.0 ? -apply(Op::sine, -a) : apply(Op::sine, a);
}

Form Graph::cosine(const Form& a) {
  if (a.is_constant()) return math::cos(a.constant);
  return apply(Op::cosine, a.terms[0].factor < 0.0 ? -a : a);
}

Form Graph::tanh(const Form& a) {
  if (a.is_constant()) return compute_tanh(a.constant).value;
  return a.terms[0].factor < 0.0 ? -apply(Op::tanh, -a) : apply(Op::tanh, a);
}

Form Graph::angle(const Form& y, const Form& x) {
  if (y.is_constant() && x.is_constant()) return math::atan2(y.constant, x.constant);
  return Form::of(intern({.op = Op::angle, .operands = {node_of(y), node_of(x), -1}}));
}

Form Graph::choose(const Form& guard, const Form& yes, const Form& no) {
  if (guard.is_constant()) return guard.constant > 0.0 ? yes : no;
  if (yes == no) return yes;
  double largest = std::abs(guard.constant);
  for (const Term& term : guard.terms) largest = std::max(largest, std::abs(term.factor));
  const int sign = node_of(guard / power_of_two_of(largest)), first = node_of(yes), second = node_of(no);
  return Form::of(intern({.op = Op::choose, .operands = {sign, first, second}}));
}

Form Graph::slip(const Form& rate) {
  if (rate.is_constant()) return rate.constant > 0.0 ? 1.0 : -1.0;
  double largest = std::abs(rate.constant);
  for (const Term& term : rate.terms) largest = std::max(largest, std::abs(term.factor));
  const int sign = node_of(rate / power_of_two_of(largest)), first = node_of(1.0), second = node_of(-1.0);
  return Form::of(intern({.op = Op::choose, .index = 1, .operands = {sign, first, second}}));
}

std::array<Form, 3> Graph::to_body(const std::array<Form, 3>& v) {
  if (v[0].is_zero() && v[1].is_zero() && v[2].is_zero()) return {};
  for (int i = 0; i < 4; ++i) state(first_attitude + i);   // its operands, though they are not named
  const std::array<int, 3> operands{node_of(v[0]), node_of(v[1]), node_of(v[2])};
  std::array<Form, 3> seen;
  for (int i = 0; i < 3; ++i)
    seen[static_cast<std::size_t>(i)] = Form::of(intern({.op = Op::to_body, .index = i, .operands = operands}));
  return seen;
}

}  // namespace polhode::formula
