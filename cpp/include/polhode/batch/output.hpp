#pragma once

#include <cstddef>

namespace polhode {

/// Rows of one number type: omega (bodies, times, 3), attitude (bodies, times, 4) and direction (bodies, times, 3).
/// What is null is not wanted.
template <class S>
struct MotionRows {
  S *omega = nullptr, *attitude = nullptr, *direction = nullptr;

  bool any() const { return omega || attitude || direction; }
  /// The same from a later row on.
  MotionRows from(std::size_t row) const {
    return {omega ? omega + 3 * row : nullptr, attitude ? attitude + 4 * row : nullptr,
            direction ? direction + 3 * row : nullptr};
  }
};

/// Where a batch of motions writes.
struct MotionOutput {
  MotionRows<double> rows{};
  MotionRows<float> single{};      ///< the same as float32, within 1e-6 of the largest |omega| and of the attitude
  const double* vector = nullptr;  ///< (bodies, 3): what `direction` follows; its length stays
  bool from_space = false;         ///< the vector is fixed in space, its rows are in body axes; else the reverse

  /// Whether omega and attitude as doubles are all that is wanted.
  bool plain() const { return !rows.direction && !single.any(); }
  bool has_direction() const { return rows.direction || single.direction; }
  /// Whether omega and attitude as floats are all that is wanted.
  bool single_states() const { return !rows.any() && !single.direction && single.any(); }
  MotionOutput from(std::size_t row) const { return {rows.from(row), single.from(row), vector, from_space}; }
};

}  // namespace polhode
