#pragma once

#include <algorithm>
#include <cmath>

#include "polhode/core/quat.hpp"
#include "polhode/math/detail/double_double.hpp"

// Three numbers in double-double, or of another type.
namespace polhode {

template <class T>
struct Triple {
  T x, y, z;
};
using DDVector = Triple<math::DD>;

inline DDVector to_dd(const Vector3d& v) { return {math::DD(v[0]), math::DD(v[1]), math::DD(v[2])}; }
inline Triple<double> round(const DDVector& v) { return {v.x.hi, v.y.hi, v.z.hi}; }
inline Vector3d to_vector(const Triple<double>& v) { return {v.x, v.y, v.z}; }

template <class T>
T dot(const Triple<T>& a, const Triple<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Triple<T> scale(const Triple<T>& a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T>
Triple<T> add(const Triple<T>& a, const Triple<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
Triple<T> subtract(const Triple<T>& a, const Triple<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
Triple<T> cross(const Triple<T>& a, const Triple<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Of any length: a power of two keeps the squares finite.
inline DDVector normalize(const DDVector& v) {
  int exponent = 0;
  std::frexp(std::max({std::abs(v.x.hi), std::abs(v.y.hi), std::abs(v.z.hi)}), &exponent);
  const auto near = [exponent](const math::DD& x) {
    return math::DD(std::ldexp(x.hi, -exponent), std::ldexp(x.lo, -exponent));
  };
  const DDVector u{near(v.x), near(v.y), near(v.z)};
  return scale(u, math::DD(1.0) / math::sqrt(dot(u, u)));
}

}  // namespace polhode
