#include "formula/text_functions.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "polhode/core/error.hpp"

namespace polhode::formula {
namespace {

using Arguments = std::vector<Value>;

template <class Function>
Value map(const Value& a, const Value& b, Function function) {
  if (a.condition || b.condition) throw InvalidInput("operands", "numbers or vectors", "a comparison");
  const std::size_t n = std::max(a.items.size(), b.items.size());
  if ((a.items.size() != n && a.items.size() != 1) || (b.items.size() != n && b.items.size() != 1))
    throw InvalidInput("operands", "vectors of one length", std::to_string(a.items.size()) + " and " +
                                                                std::to_string(b.items.size()) + " components");
  Value out;
  for (std::size_t i = 0; i < n; ++i)
    out.items.push_back(function(a.items[a.items.size() == 1 ? 0 : i], b.items[b.items.size() == 1 ? 0 : i]));
  return out;
}

template <Expr (*function)(const Expr&)>
Value each(Graph&, const Arguments& a) {
  return map(a[0], a[0], [](const Expr& x, const Expr&) { return function(x); });
}
template <Expr (*function)(const Expr&, const Expr&)>
Value pairs(Graph&, const Arguments& a) {
  return map(a[0], a[1], [](const Expr& x, const Expr& y) { return function(x, y); });
}

template <std::size_t n>
Vec<Expr, n> vector(const Value& value) {
  if (value.items.size() != n)
    throw InvalidInput("argument", std::to_string(n) + " components", std::to_string(value.items.size()));
  Vec<Expr, n> out;
  std::copy(value.items.begin(), value.items.end(), out.components.begin());
  return out;
}
Value value_of(const Vec<Expr, 3>& v) { return {{v[0], v[1], v[2]}, {}}; }

Value sum_items(Graph&, const Arguments& a) {
  Expr sum;
  for (const Expr& item : a[0].items) sum = sum + item;
  return {{sum}, {}};
}
Value dot_items(Graph& graph, const Arguments& a) {
  if (a[0].items.size() != a[1].items.size())
    throw InvalidInput("operands", "vectors of one length", std::to_string(a[1].items.size()) + " components");
  return sum_items(graph, {combine('*', a[0], a[1])});
}
Value norm_items(Graph& graph, const Arguments& a) {
  Expr square = dot_items(graph, {a[0], a[0]}).items[0];
  if (a.size() > 1) {
    if (!a[1].is_number()) throw InvalidInput("smooth", "a number", "an expression");
    square = square + a[1].items[0] * a[1].items[0];
  }
  return {{sqrt(square)}, {}};
}
Value cross_items(Graph&, const Arguments& a) { return value_of(cross(vector<3>(a[0]), vector<3>(a[1]))); }
Value to_body_items(Graph& graph, const Arguments& a) {
  return value_of(to_body(list_states<4>(graph, first_attitude), vector<3>(a[0])));
}
Value to_space_items(Graph& graph, const Arguments& a) {
  return value_of(to_space(list_states<4>(graph, first_attitude), vector<3>(a[0])));
}
Expr hypot_of(const Expr& a, const Expr& b) { return sqrt(a * a + b * b); }
Value clip_items(Graph& graph, const Arguments& a) {
  return pairs<min<Expr>>(graph, {pairs<max<Expr>>(graph, {a[0], a[1]}), a[2]});
}
Value where_items(Graph&, const Arguments& a) {
  if (!a[0].condition) throw InvalidInput("where", "a comparison of numbers first", "a number or a vector");
  return map(a[1], a[2], [&](const Expr& x, const Expr& y) { return where(*a[0].condition, x, y); });
}

struct Function {
  std::string_view name;
  std::size_t least, most;   // arguments
  Value (*apply)(Graph&, const Arguments&);
};

constexpr Function functions[] = {
    {"abs", 1, 1, &each<abs<Expr>>},        {"atan2", 2, 2, &pairs<atan2>},      {"clip", 3, 3, &clip_items},
    {"cos", 1, 1, &each<cos>},              {"cross", 2, 2, &cross_items},       {"dot", 2, 2, &dot_items},
    {"exp", 1, 1, &each<exp>},              {"friction", 2, 2, &pairs<friction>}, {"hypot", 2, 2, &pairs<hypot_of>},
    {"log", 1, 1, &each<log>},              {"max", 2, 2, &pairs<max<Expr>>},    {"min", 2, 2, &pairs<min<Expr>>},
    {"norm", 1, 2, &norm_items},            {"sign", 1, 1, &each<sign<Expr>>},   {"sin", 1, 1, &each<sin>},
    {"sqrt", 1, 1, &each<sqrt>},            {"sum", 1, 1, &sum_items},           {"tan", 1, 1, &each<tan>},
    {"tanh", 1, 1, &each<tanh>},            {"to_body", 1, 1, &to_body_items},   {"to_space", 1, 1, &to_space_items},
    {"where", 3, 3, &where_items}};

const Function* find_function(std::string_view name) {
  for (const Function& function : functions)
    if (function.name == name) return &function;
  return nullptr;
}

}  // namespace

Value combine(char op, const Value& a, const Value& b) {
  switch (op) {
    case '+': return map(a, b, [](const Expr& x, const Expr& y) { return x + y; });
    case '-': return map(a, b, [](const Expr& x, const Expr& y) { return x - y; });
    case '*': return map(a, b, [](const Expr& x, const Expr& y) { return x * y; });
    default: return map(a, b, [](const Expr& x, const Expr& y) { return x / y; });
  }
}

Value compare(std::string_view op, const Value& a, const Value& b) {
  if (a.condition || b.condition || a.items.size() != 1 || b.items.size() != 1)
    throw InvalidInput("comparison", "two numbers", "another value");
  const Expr &x = a.items[0], &y = b.items[0];
  return {{}, op == "<" ? x < y : op == ">" ? x > y : op == "<=" ? x <= y : x >= y};
}

Value raise(const Value& base, double exponent) {
  return map(base, base, [=](const Expr& x, const Expr&) { return pow(x, exponent); });
}

bool is_function(std::string_view name) { return find_function(name) != nullptr; }

Value call(Graph& graph, std::string_view name, const std::vector<Value>& arguments) {
  const Function* function = find_function(name);
  if (function == nullptr) {
    std::string known = "a known function (";
    for (const Function& each_one : functions) known += std::string(each_one.name) + ", ";
    known.resize(known.size() - 2);
    throw InvalidInput("call", known + ")", name);
  }
  const std::size_t n = arguments.size();
  if (n < function->least || n > function->most)
    throw InvalidInput(name, std::to_string(function->least) + " arguments", std::to_string(n));
  for (std::size_t i = name == "where" ? 1 : 0; i < n; ++i)
    if (arguments[i].condition) throw InvalidInput(name, "numbers or vectors", "a comparison");
  return function->apply(graph, arguments);
}

}  // namespace polhode::formula
