#pragma once

#include <cstddef>
#include <cstdint>

namespace polhode {

/// Properties that no body's tensor has, one bit each.
enum Flaw : std::uint8_t {
  flaw_not_finite = 1,
  flaw_not_symmetric = 2,
  flaw_not_positive = 4,
  flaw_triangle = 8,  ///< a moment above the sum of the two others
};

/// Applies the checks of InertiaTensor, with its tolerance, to `count` matrices of 9 numbers each. Refuses nothing.
///
/// `margins` (count): the margin of the triangle inequality, (a + b - c) / c for the principal moments a <= b <= c.
/// It is 1 for a sphere, 0 for a flat body or zeros, negative for no body, NaN for a matrix that is not finite.
/// `flaws` (count): the bits of Flaw. Entries that differ across the diagonal are replaced by their mean.
void check_inertia(const double* I_B, std::size_t count, double* margins, std::uint8_t* flaws);

}  // namespace polhode
