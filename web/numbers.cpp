#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

// printf and strtod in place of libc++'s conversions of doubles, whose tables are a fifth of a module. This file stands
// first among those that are linked. A libc++ with other names for its two functions brings its tables back, and the
// module is refused as too large.
std::__from_chars_result<double> read_decimal(const char* first, const char* last, std::chars_format format) asm(
    "_ZNSt3__127__from_chars_floating_pointIdEENS_19__from_chars_resultIT_EEPKcS5_NS_12chars_formatE");

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

const char* skip_digits(const char* at, const char* last) {
  while (at != last && is_digit(*at)) ++at;
  return at;
}

}  // namespace

/// A decimal number without a sign: strtod alone would read hexadecimal numbers and names, too.
std::__from_chars_result<double> read_decimal(const char* first, const char* last, std::chars_format) {
  const char* end = skip_digits(first, last);
  if (end != last && *end == '.') end = skip_digits(end + 1, last);
  const std::string mantissa(first, end);
  if (mantissa.find_first_of("0123456789") == std::string::npos) return {0.0, 0, std::errc::invalid_argument};
  if (end != last && (*end == 'e' || *end == 'E')) {
    const char* power = end + 1;
    if (power != last && (*power == '+' || *power == '-')) ++power;
    if (power != last && is_digit(*power)) end = skip_digits(power, last);
  }
  const double value = std::strtod(std::string(first, end).c_str(), nullptr);
  const bool vanished = value == 0.0 && mantissa.find_first_of("123456789") != std::string::npos;
  return {value, end - first, std::isinf(value) || vanished ? std::errc::result_out_of_range : std::errc{}};
}

/// The fewest digits that read back as the value, without an exponent where that is no longer.
std::to_chars_result std::to_chars(char* first, char* last, double value) {
  char shortest[32], fixed[400];   // the largest double has 309 digits before its point
  int digits = 1, length;
  do length = std::snprintf(shortest, sizeof shortest, "%.*e", digits - 1, value);
  while (digits++ < 17 && std::strtod(shortest, nullptr) != value && !std::isnan(value));
  const std::string_view text(shortest, static_cast<std::size_t>(length));
  const char* chosen = shortest;
  if (const std::size_t e = text.find('e'); e != text.npos) {
    const int decimals = digits - 2 - std::atoi(shortest + e + 1);
    const int plain = std::snprintf(fixed, sizeof fixed, "%.*f", decimals > 0 ? decimals : 0, value);
    if (plain <= length) chosen = fixed, length = plain;
  }
  if (length > last - first) return {last, std::errc::value_too_large};
  return {std::copy_n(chosen, length, first), std::errc{}};
}
