#pragma once

#include <cstddef>
#include <cstdint>

namespace polhode {

/// What no body's tensor has, one bit each.
enum Flaw : std::uint8_t {
  flaw_not_finite = 1,
  flaw_not_symmetric = 2,
  flaw_not_positive = 4,
  flaw_triangle = 8,  ///< a moment above the sum of the two others
};

/// Judges `count` matrices of 9 numbers each as InertiaTensor's door does, by the same tolerance, but refuses nothing.
///
/// `margins` (count): what is left to the triangle inequality, (a + b - c) / c for the principal moments a <= b <= c:
/// 1 for a sphere, 0 for a flat body, negative for no body; NaN for a matrix that is not finite, 0 for zeros.
/// `flaws` (count): the bits of Flaw. The mean of the entries across the diagonal is taken, also where they differ.
void check_inertia(const double* I_B, std::size_t count, double* margins, std::uint8_t* flaws);

}  // namespace polhode
