#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "inertia/validation.hpp"
#include "polhode/core/error.hpp"
#include "polhode/inertia/shapes.hpp"

namespace polhode::shapes {

#define POLHODE_SHAPE(name, parameters) Record describe_##name();
#include "polhode/inertia/shapes.def"
#undef POLHODE_SHAPE

using inertia::positive;

/// The formulas are evaluated in long double and rounded once.
using Real = long double;

inline constexpr Real pi = std::numbers::pi_v<Real>;

/// A body with principal axes along x, y, z: moments Ix, Iy, Iz about its centre (0, 0, z).
inline MassProperties along_axes(double mass, Real Ix, Real Iy, Real Iz, Real z = 0) {
  const Vector3d moments{static_cast<double>(Ix), static_cast<double>(Iy), static_cast<double>(Iz)};
  return MassProperties(mass, {0, 0, static_cast<double>(z)}, InertiaTensor::from_moments(moments));
}

/// As `positive`. The likely cause of a zero is that the body is meant to be the thin one of this name.
inline double positive(double value, const char* where, const char* thin) {
  if (value != 0) return positive(value, where);
  throw InvalidInput(where, "positive and finite", "0", std::string("a thin body? that is shapes.") + thin);
}

/// Returns the three lengths. Throws InvalidInput unless each is positive and finite.
inline const Vector3d& positive(const Vector3d& lengths, const char* where) {
  for (int i = 0; i < 3; ++i) {
    if (!(lengths[i] > 0 && std::isfinite(lengths[i]))) {
      throw InvalidInput(where, "three positive and finite lengths", inertia::vector_text(lengths));
    }
  }
  return lengths;
}

/// Returns a length for which 0 is a meaningful limit. Throws InvalidInput unless it is finite and not negative.
inline double not_negative(double value, const char* where) {
  if (!(value >= 0 && std::isfinite(value))) throw InvalidInput(where, "zero or positive, and finite", to_text(value));
  return value;
}

/// Reads one parameter from plain numbers and gives its size.
template <class T>
struct Reader;
template <>
struct Reader<double> {
  static std::vector<int> size() { return {}; }
  static double read(const double*& v) { return *v++; }
};
template <>
struct Reader<Vector3d> {
  static std::vector<int> size() { return {3}; }
  static Vector3d read(const double*& v) {
    v += 3;
    return {v[-3], v[-2], v[-1]};
  }
};
template <class Row, std::size_t N>
struct Reader<std::array<Row, N>> {
  static std::vector<int> size() {
    std::vector<int> size{static_cast<int>(N)};
    for (const int n : Reader<Row>::size()) size.push_back(n);
    return size;
  }
  static std::array<Row, N> read(const double*& v) {
    std::array<Row, N> rows;
    for (auto& row : rows) row = Reader<Row>::read(v);
    return rows;
  }
};

template <auto shape, class... P>
MassProperties make_from_numbers(const double* values) {
  // Braces: the parameters are read from left to right.
  const std::tuple<std::decay_t<P>...> parameters{Reader<std::decay_t<P>>::read(values)...};
  return std::apply(shape, parameters);
}

template <auto shape, class... P>
Record make_record(MassProperties (*)(P...), std::string name, std::string doc,
                   const std::array<std::pair<const char*, const char*>, sizeof...(P)>& parameters) {
  Record record{std::move(name), std::move(doc), {}, &make_from_numbers<shape, P...>, nullptr};
  const std::vector<int> sizes[] = {Reader<std::decay_t<P>>::size()...};
  for (std::size_t i = 0; i < sizeof...(P); ++i) {
    record.parameters.push_back({parameters[i].first, sizes[i], parameters[i].second});
  }
  return record;
}

/// The record of a shape: its name, what it is, and a name and a line for each parameter.
template <auto shape, std::size_t N>
Record make_record(std::string name, std::string doc, const std::pair<const char*, const char*> (&parameters)[N]) {
  return make_record<shape>(shape, std::move(name), std::move(doc), std::to_array(parameters));
}

/// Adds the volume, computed from the numbers after the mass, for bodies that have one.
inline Record with_volume(Record record, Real (*volume)(const double* sizes)) {
  record.volume = volume;
  return record;
}

}  // namespace polhode::shapes
