#include "formula/lexer.hpp"

#include <algorithm>
#include <charconv>

#include "polhode/core/error.hpp"

namespace polhode::formula {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

}  // namespace

std::string Lexer::locate(std::size_t place) const {
  const std::string_view before = text_.substr(0, place);
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const std::size_t column = place - (lines > 0 ? before.rfind('\n') + 1 : 0) + 1;
  return std::string(field_) + ", line " + std::to_string(lines + 1) + ", column " + std::to_string(column);
}

void Lexer::refuse(std::string_view requirement, std::size_t place) const {
  place = std::min(place, text_.size());
  std::size_t length = 0;   // a whole name or number, or one character
  while (place + length < text_.size() && length < 30 &&
         (is_letter(text_[place + length]) || is_digit(text_[place + length]))) ++length;
  const std::string_view rest = text_.substr(place, std::max<std::size_t>(length, 1));
  std::string found = rest.empty() ? "the end" : "'";
  for (const char c : rest) found += c >= ' ' && c <= '~' ? c : '?';
  if (!rest.empty()) found += "'";
  throw InvalidInput(locate(place), requirement, found);
}

void Lexer::next() {
  while (next_ < text_.size() && (text_[next_] == ' ' || text_[next_] == '\t' || text_[next_] == '\n' ||
                                  text_[next_] == '\r')) ++next_;
  token_ = Token();
  token_.begin = next_;
  if (next_ == text_.size()) return;
  const char c = text_[next_];
  if (is_digit(c) || (c == '.' && next_ + 1 < text_.size() && is_digit(text_[next_ + 1]))) return read_number();
  std::size_t end = next_ + 1;
  if (is_letter(c)) {
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    token_.kind = Token::Kind::name;
  } else {
    if (std::string_view("+-*/^()[],.<>").find(c) == std::string_view::npos) refuse("an operator, a name or a number");
    const char second = end < text_.size() ? text_[end] : ' ';
    const bool two = ((c == '<' || c == '>') && second == '=') || (c == '*' && second == '*');
    if (two) ++end;
    token_.kind = Token::Kind::symbol;
  }
  token_.text = text_.substr(next_, end - next_);
  next_ = end;
}

void Lexer::read_number() {
  const char *begin = text_.data() + next_, *end = text_.data() + text_.size();
  token_.kind = Token::Kind::number;
  const auto [rest, error] = std::from_chars(begin, end, token_.value);
  if (error != std::errc()) refuse("a number within float64's range");
  token_.text = text_.substr(next_, static_cast<std::size_t>(rest - begin));
  next_ += token_.text.size();
}

bool Lexer::take(std::string_view symbol) {
  if (!token_.is(symbol)) return false;
  next();
  return true;
}

void Lexer::expect(std::string_view symbol) {
  if (take(symbol)) return;
  std::string quoted = "'";
  quoted += symbol;
  refuse(quoted += '\'');
}

}  // namespace polhode::formula
