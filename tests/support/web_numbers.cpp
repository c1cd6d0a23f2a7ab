#include <charconv>
#include <string>

// numbers.cpp as a module of its own, for tests/python/web/test_web.py.
#define POLHODE_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace {
std::string text;
double value;
}  // namespace

POLHODE_EXPORT(reserve_text) char* reserve_text(int n) {
  text.assign(static_cast<std::size_t>(n), ' ');
  return text.data();
}

/// Reads the text; the number of characters that belong to the number, or minus the error.
POLHODE_EXPORT(read) int read() {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() ? static_cast<int>(end - text.data()) : -static_cast<int>(error);
}

POLHODE_EXPORT(last) double last() { return value; }

/// Writes a number into the text; the number of characters.
POLHODE_EXPORT(write) int write(double number) {
  text.assign(32, ' ');
  return static_cast<int>(std::to_chars(text.data(), text.data() + text.size(), number).ptr - text.data());
}

POLHODE_EXPORT(written) const char* written() { return text.data(); }
