#pragma once

#include <string>
#include <string_view>

namespace polhode::formula {

/// A word of a formula: a number, a name, an operator, or the end.
struct Token {
  enum class Kind { number, name, symbol, end };
  Kind kind = Kind::end;
  std::string_view text;
  std::size_t begin = 0;
  double value = 0.0;

  bool is(std::string_view symbol) const { return kind == Kind::symbol && text == symbol; }
};

class Lexer {
 public:
  Lexer(std::string_view text, std::string_view field) : text_(text), field_(field) { next(); }

  const Token& token() const { return token_; }
  void next();
  /// Takes a symbol if it is the current token.
  bool take(std::string_view symbol);
  void expect(std::string_view symbol);

  /// "torque, line 1, column 7"
  std::string locate(std::size_t place) const;
  /// @throws InvalidInput "torque, line 1, column 7: ..."
  [[noreturn]] void refuse(std::string_view requirement, std::size_t place) const;
  [[noreturn]] void refuse(std::string_view requirement) const { refuse(requirement, token_.begin); }

 private:
  void read_number();

  std::string_view text_, field_;
  std::size_t next_ = 0;
  Token token_;
};

}  // namespace polhode::formula
