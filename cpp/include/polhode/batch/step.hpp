#pragma once

#include <cstddef>

namespace polhode {

/// Driven free steps of many bodies in lanes: kicks by a torque, and the exact free motion between them (step.hpp).
/// Rows of three and four numbers of type T, float or double.
template <class T>
struct StepBatch {
  std::size_t bodies = 0;
  const T* moments = nullptr;    ///< principal moments (bodies, 3), or (3) with one_inertia
  bool one_inertia = false;
  const T* torque = nullptr;     ///< (bodies, 3), or (3) with one_torque; null: free
  bool one_torque = false;
  bool space = true;             ///< momentum and torque are in space, else in principal axes
  T step = 0;                    ///< [s]
  long count = 1;
  double first = 0.5, last = 0.5;   ///< parts of a step that the first and the last kick last; those between: one
  T* momentum = nullptr;         ///< (bodies, 3), changed in place
  T* attitude = nullptr;         ///< (bodies, 4), principal axes to space, (x, y, z, w), changed in place
};

/// The Hamilton products q_AB q_BC of `n` quaternions, as they are rounded: the cross product is added last.
/// @param step_BC  4, or 0 where all have the same q_BC
void multiply_attitudes(std::size_t n, const float* q_AB, const float* q_BC, std::size_t step_BC, float* q_AC);
void multiply_attitudes(std::size_t n, const double* q_AB, const double* q_BC, std::size_t step_BC, double* q_AC);

/// Steps all bodies. The bits do not depend on the threads, nor on whether the machine has AVX2 or AVX-512.
/// A body whose momentum, attitude or torque is not finite comes out as NaN, and no other.
/// @param threads  at most; 0: as many as the machine has
/// @throws InvalidInput for a moment that is not positive and finite, a body that violates the triangle inequality, an
/// attitude that is not unit, a step that is not finite, or one in which a body may rotate by more than 1e25 rad (1e10
/// rad for floats); nothing is changed then.
void step_bodies(const StepBatch<float>& batch, int threads = 0);
void step_bodies(const StepBatch<double>& batch, int threads = 0);

}  // namespace polhode
