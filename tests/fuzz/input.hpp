#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/core/quat.hpp"

// What the fuzz targets share: numbers from bytes, and what counts as a fault.
namespace polhode::fuzz {

/// The bytes of one input, taken from the front. Beyond the end all are 0.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool is_empty() const { return size_ == 0; }

  template <class T>
  T take() {
    T value = 0;
    const std::size_t n = size_ < sizeof(T) ? size_ : sizeof(T);
    std::memcpy(&value, data_, n);
    data_ += n, size_ -= n;
    return value;
  }

  std::size_t below(std::size_t n) { return take<std::uint8_t>() % n; }
  bool coin() { return below(2) == 1; }

  /// A double: an ordinary one, a corner of the format, or any 64 bits.
  double number() {
    using Limits = std::numeric_limits<double>;
    static constexpr double corners[] = {0.0, -0.0, 1.0, -1.0, 2.0, 0.5, 1e-3, 1e3, 1e-160, 1e160, 1e-300, 1e300,
                                         Limits::min(), Limits::denorm_min(), Limits::max(), Limits::epsilon(),
                                         1.0 + Limits::epsilon(), Limits::infinity(), -Limits::infinity(),
                                         Limits::quiet_NaN()};
    const std::uint8_t kind = take<std::uint8_t>();
    if (kind < 150) return take<std::int16_t>() / 1024.0;
    if (kind < 210) return corners[kind % std::size(corners)];
    return take<double>();
  }
  std::vector<double> numbers(std::size_t count) {
    std::vector<double> all(count);
    for (double& x : all) x = number();
    return all;
  }

  /// A number from 0 up to 1, for targets that keep to ordinary bodies.
  double fraction() { return take<std::uint16_t>() / 65536.0; }

  Vector3d vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }

  /// A unit quaternion as a rule.
  Quat attitude() {
    const Quat q{number(), number(), number(), number()};
    const double size = norm(q);
    if (coin() || !(size > 0)) return coin() ? Quat{} : q;
    return {q.x / size, q.y / size, q.z / size, q.w / size};
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

/// Ends the process, as libFuzzer expects of a fault.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

/// Runs work() and tells whether it was done. A refusal must be one line; any other exception is a fault.
template <class Work>
bool is_done(const Work& work) {
  try {
    work();
    return true;
  } catch (const InvalidInput& refusal) {
    require(std::string(refusal.what()).find('\n') == std::string::npos, "a refusal is one line");
    return false;
  }
}

/// Equal bits, or both NaN.
inline bool is_same(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0 || (a != a && b != b); }
inline bool is_same(const double* a, const double* b, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    if (!is_same(a[i], b[i])) return false;
  return true;
}

}  // namespace polhode::fuzz
