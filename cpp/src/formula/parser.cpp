#include "polhode/formula/parser.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "formula/lexer.hpp"
#include "formula/text_functions.hpp"
#include "polhode/core/error.hpp"

namespace polhode::formula {
namespace {

using Names = std::map<std::string, Value, std::less<>>;
using Orbits = std::vector<std::pair<std::string, Ephemeris>>;

/// One field by recursive descent: comparison, sum, product, sign, power, component, primary.
class FieldParser {
 public:
  FieldParser(Graph& graph, const Names& names, const Orbits& orbits, std::string_view text, std::string_view field)
      : graph_(graph), names_(names), orbits_(orbits), lexer_(check_size(text, field), field) {}

  Value parse() {
    Value value = comparison();
    if (lexer_.token().kind != Token::Kind::end) lexer_.refuse("an operator or the end");
    return value;
  }

 private:
  static std::string_view check_size(std::string_view text, std::string_view field) {
    if (text.size() > most_characters)
      throw InvalidInput(field, "at most 10000 characters", std::to_string(text.size()));
    return text;
  }

  Value comparison() {
    if (++depth_ > most_depth) lexer_.refuse("a depth of at most 100");
    Value left = sum();
    const Token token = lexer_.token();
    if (token.is("<") || token.is(">") || token.is("<=") || token.is(">=")) {
      lexer_.next();
      Value right = sum();
      left = at(token, [&] { return compare(token.text, left, right); });
    }
    --depth_;
    return left;
  }

  Value sum() {
    Value left = product();
    for (Token token = lexer_.token(); token.is("+") || token.is("-"); token = lexer_.token()) {
      lexer_.next();
      const Value right = product();
      left = at(token, [&] { return combine(token.text[0], left, right); });
    }
    return left;
  }

  Value product() {
    Value left = sign();
    for (Token token = lexer_.token(); token.is("*") || token.is("/"); token = lexer_.token()) {
      lexer_.next();
      const Value right = sign();
      left = at(token, [&] { return combine(token.text[0], left, right); });
    }
    return left;
  }

  Value sign() {
    if (++depth_ > most_depth) lexer_.refuse("a depth of at most 100");
    const Token token = lexer_.token();
    Value value;
    if (lexer_.take("-")) {
      const Value positive = sign();
      value = at(token, [&] { return combine('-', Value{{Expr(0.0)}, {}}, positive); });
    } else {
      lexer_.take("+");
      value = power();
    }
    --depth_;
    return value;
  }

  Value power() {
    Value base = component();
    const Token token = lexer_.token();
    if (!lexer_.take("^") && !lexer_.take("**")) return base;
    const std::size_t place = lexer_.token().begin;
    const Value exponent = sign();
    if (!exponent.is_number()) lexer_.refuse("an exponent that is a number", place);
    return at(token, [&] { return raise(base, exponent.items[0].form().constant); });
  }

  Value component() {
    Value value = primary();
    for (;;) {
      if (lexer_.take(".")) {
        const Token token = lexer_.token();
        static constexpr std::string_view letters = "xyzw";
        const std::size_t which = token.text.size() == 1 ? letters.find(token.text) : letters.npos;
        if (token.kind == Token::Kind::name && token.text == "xyz" && value.items.size() >= 3) {
          value.items.resize(3);
        } else if (token.kind == Token::Kind::name && which < value.items.size() && value.items.size() > 1) {
          value.items = {value.items[which]};
        } else {
          lexer_.refuse("a component of a vector (x, y, z, w, xyz)");
        }
        lexer_.next();
      } else if (lexer_.token().is("[")) {
        lexer_.next();
        const Token token = lexer_.token();
        const double size = static_cast<double>(value.items.size());
        if (token.kind != Token::Kind::number || !(token.value < size) ||
            token.text.find_first_not_of("0123456789") != token.text.npos)
          lexer_.refuse("the number of a component, from 0");
        value.items = {value.items[static_cast<std::size_t>(token.value)]};
        lexer_.next();
        lexer_.expect("]");
      } else {
        return value;
      }
    }
  }

  Value primary() {
    const Token token = lexer_.token();
    if (token.kind == Token::Kind::number) {
      lexer_.next();
      return {{Expr(token.value)}, {}};
    }
    if (lexer_.take("(")) {
      Value inner = comparison();
      lexer_.expect(")");
      return inner;
    }
    if (lexer_.take("[")) {
      Value vector;
      for (const Value& item : list("]")) {
        if (item.items.size() != 1) lexer_.refuse("numbers in [...]", token.begin);
        vector.items.push_back(item.items[0]);
      }
      return vector;
    }
    if (token.kind != Token::Kind::name) lexer_.refuse("a number, a name, '(' or '['");
    lexer_.next();
    if (lexer_.take("(")) {
      const std::vector<Value> arguments = list(")");
      return at(token, [&] { return call(graph_, token.text, arguments); });
    }
    const auto orbit = std::find_if(orbits_.begin(), orbits_.end(), [&](const auto& o) { return o.first == token.text; });
    if (orbit != orbits_.end()) return see_orbit(orbit->second);
    const auto known = names_.find(token.text);
    if (known == names_.end()) refuse_name(token);
    return known->second;
  }

  /// What follows the name of an orbit.
  Value see_orbit(const Ephemeris& ephemeris) {
    lexer_.expect(".");
    const Token token = lexer_.token();
    const bool vector = token.text == "r" || token.text == "v";
    const int first = token.text == "r"                  ? Ephemeris::position
                      : token.text == "v"                ? Ephemeris::velocity
                      : token.text == "distance"         ? Ephemeris::distance
                      : token.text == "inverse_distance" ? Ephemeris::inverse_distance
                                                         : -1;
    if (token.kind != Token::Kind::name || first < 0) lexer_.refuse("r, v, distance or inverse_distance of an orbit");
    lexer_.next();
    Value value;
    for (int i = first; i < first + (vector ? 3 : 1); ++i) value.items.emplace_back(graph_, graph_.ephemeris(ephemeris, i));
    return value;
  }

  std::vector<Value> list(std::string_view end) {
    std::vector<Value> items{comparison()};
    while (lexer_.take(",")) items.push_back(comparison());
    lexer_.expect(end);
    return items;
  }

  [[noreturn]] void refuse_name(const Token& token) const {
    std::string known = "a known name (";
    for (const auto& [name, value] : names_) known += name + ", ";
    for (const auto& [name, value] : orbits_) known += name + ".r, " + name + ".v, ";
    known.resize(known.size() - 2);
    lexer_.refuse(known + ")", token.begin);
  }

  /// Work whose refusal gets the place of a token.
  template <class Work>
  Value at(const Token& token, const Work& work) const {
    try {
      return work();
    } catch (const InvalidInput& refusal) {
      throw InvalidInput(lexer_.locate(token.begin) + ": " + refusal.what());
    }
  }

  Graph& graph_;
  const Names& names_;
  const Orbits& orbits_;
  Lexer lexer_;
  int depth_ = 0;
};

Value list_inputs(Graph& graph, int first, std::size_t count, Form (Graph::*make)(int)) {
  Value value;
  for (std::size_t i = 0; i < count; ++i)
    value.items.emplace_back(graph, (graph.*make)(first + static_cast<int>(i)));
  return value;
}

void add_name(Names& names, const std::string& name, Value value) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto fits = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); };
  if (name.empty() || !is_letter(name[0]) || !std::all_of(name.begin(), name.end(), fits))
    throw InvalidInput("formula", "names of letters, digits and _", "another one");
  if (is_function(name)) throw InvalidInput("formula", "names that are no functions", name);
  if (!names.emplace(name, std::move(value)).second) throw InvalidInput("formula", "each name once", name);
}

void add_outputs(Program& program, const Value& value, std::size_t count, std::string_view field) {
  if (value.condition || value.items.size() != count)
    throw InvalidInput(field, std::to_string(count) + (count == 1 ? " number" : " components"),
                       value.condition ? "a comparison" : std::to_string(value.items.size()));
  for (const Expr& item : value.items) program.outputs.push_back(item.form());
}

}  // namespace

Program parse(const Text& text) {
  Program program;
  program.parameters = text.parameters, program.states = text.states;
  if (text.rates.size() != text.states.size())
    throw InvalidInput("formula", "a rate for each state", std::to_string(text.rates.size()));
  Graph& graph = program.graph;
  Names names;
  add_name(names, "t", {{Expr(graph, graph.time())}, {}});
  add_name(names, "pi", {{Expr(3.141592653589793)}, {}});
  add_name(names, "omega", list_inputs(graph, first_rate, 3, &Graph::state));
  add_name(names, "attitude", list_inputs(graph, first_attitude, 4, &Graph::state));
  int next = first_extra;
  for (const Input& state : text.states) {
    add_name(names, state.name, list_inputs(graph, next, state.values.size(), &Graph::state));
    next += static_cast<int>(state.values.size());
  }
  next = 0;
  for (const Input& parameter : text.parameters) {
    add_name(names, parameter.name, list_inputs(graph, next, parameter.values.size(), &Graph::parameter));
    next += static_cast<int>(parameter.values.size());
  }
  Orbits orbits;
  for (const auto& [name, ephemeris] : text.orbits) {
    add_name(names, name, {});   // refuses what is no name, or another's
    names.erase(name);
    orbits.emplace_back(name, Ephemeris(ephemeris.path(), name));
    graph.ephemeris(orbits.back().second, 0);   // in their order
  }
  for (const auto& [name, definition] : text.let) {
    Value value = FieldParser(graph, names, orbits, definition, "let." + name).parse();
    add_name(names, name, std::move(value));
  }
  if (!text.potential.empty()) {
    if (!text.torque.empty() || !text.states.empty())
      throw InvalidInput("formula", "a potential alone", "a torque or states beside it",
                         "the torque follows from the potential: add another Formula for the rest");
    add_outputs(program, FieldParser(graph, names, orbits, text.potential, "potential").parse(), 1, "potential");
    return rewrite(program);
  }
  add_outputs(program, FieldParser(graph, names, orbits, text.torque, "torque").parse(), 3, "torque");
  for (std::size_t i = 0; i < text.rates.size(); ++i) {
    const std::string field = "states." + text.states[i].name + ".rate";
    add_outputs(program, FieldParser(graph, names, orbits, text.rates[i], field).parse(), text.states[i].values.size(), field);
  }
  return rewrite(program);
}

}  // namespace polhode::formula
