#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>

// Of 120 KB of tables in a module, 104 serve one case of libc++'s std::to_chars: a whole number above 2^53 without an
// exponent. printf is linked anyway and gives the same digits, so it stands in for libc++'s two functions. A libc++
// that names them otherwise links its tables again, and the module is refused as too large.
std::to_chars_result fixed_digits(char* first, char* last, double value, std::uint32_t precision) asm(
    "_ZNSt3__120__d2fixed_buffered_nEPcS0_dj");
std::to_chars_result exponent_digits(char* first, char* last, double value, std::uint32_t precision) asm(
    "_ZNSt3__118__d2exp_buffered_nEPcS0_dj");

namespace {

std::to_chars_result print(char* first, char* last, const char* pattern, double value, std::uint32_t precision) {
  char text[1500];   // the longest double has 1074 digits after its point
  const int n = std::snprintf(text, sizeof text, pattern, static_cast<int>(precision), value);
  if (n < 0 || n >= static_cast<int>(sizeof text) || n > last - first) return {last, std::errc::value_too_large};
  return {std::copy_n(text, n, first), std::errc{}};
}

}  // namespace

std::to_chars_result fixed_digits(char* first, char* last, double value, std::uint32_t precision) {
  return print(first, last, "%.*f", value, precision);
}

std::to_chars_result exponent_digits(char* first, char* last, double value, std::uint32_t precision) {
  return print(first, last, "%.*e", value, precision);
}
