#pragma once

#include <array>

#include "polhode/math/detail/interval.hpp"
#include "polhode/scene/scene.hpp"

// The constants of a body, enclosed.
namespace polhode::proof {

using math::Interval;
using Vector = std::array<Interval, 3>;
using Matrix = std::array<Vector, 3>;   // by rows

/// h_B of a rotor: relative to the body, or absolute if it is free.
Vector enclose_momentum(const Rotor& rotor, const Vector3d& w_B);

/// The momentum about its axis of a free rotor at the start.
Interval enclose_start_momentum(const Rotor& rotor, const Vector3d& w_B);

/// The axis of a rotor. Its direction may have been rounded to length 1, which moves it by less than 2^-51.
Vector enclose_axis(const Rotor& rotor);

/// The inertia that moves with omega: without the axial moments of free rotors. All is divided by a power of two.
Matrix enclose_inertia(const Scene& scene, double part);

Matrix invert(const Matrix& m);

/// v x I v as sums of v_j v_l, j <= l: one matrix for each component.
std::array<Matrix, 3> enclose_products(const Matrix& I);

/// Calls use(i, j, k, sign) for the six entries of the permutation symbol.
template <class Use>
void for_permutations(Use use) {
  for (int i = 0; i < 3; ++i) {
    use(i, (i + 1) % 3, (i + 2) % 3, 1.0);
    use(i, (i + 2) % 3, (i + 1) % 3, -1.0);
  }
}

}  // namespace polhode::proof
