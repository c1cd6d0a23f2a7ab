#pragma once

#include <atomic>
#include <cstddef>

#include "polhode/batch/output.hpp"
#include "polhode/inertia/inertia_tensor.hpp"

namespace polhode {

/// Many heavy symmetric tops at many times, on plain C-contiguous arrays.
struct HeavyTopBatch {
  std::size_t bodies = 0, times = 0;
  const double* moments = nullptr;     ///< (bodies, 3) about the pivot, two of them equal [kg m^2]
  const double* weight_arm = nullptr;  ///< (bodies) m g r, signed along the symmetry axis [N m]
  const double* omega = nullptr;       ///< (bodies, 3) at t = 0, body axes [rad/s]
  const double* attitude = nullptr;    ///< (bodies, 4) at t = 0, (x, y, z, w)
  const double* t = nullptr;           ///< (times) for all bodies, or (bodies, times) with own_times [s]
  bool own_times = false;
  const InertiaTensor* tensor = nullptr;  ///< of all tops, about the pivot, in any body axes; then `moments` is null
  bool refuse = true;   ///< otherwise the rows of a body that is refused become NaN
  std::atomic<std::size_t>* done = nullptr;  ///< grows by the number of states that are done; may be null
};

/// Writes omega (bodies, times, 3) and attitude (bodies, times, 4); either may be null. The bits of the result do not
/// depend on the number of threads (0: chosen by the machine and the amount of work).
///
/// A row with an input that is not finite becomes NaN; returns the number of such rows. Throws InvalidInput, with the
/// number of the body, for what HeavyTop refuses, unless `refuse` is false.
std::size_t heavy_top(const HeavyTopBatch& batch, double* omega, double* attitude, int threads = 0);
/// The same with directions, or as float32.
std::size_t heavy_top(const HeavyTopBatch& batch, const MotionOutput& out, int threads = 0);

}  // namespace polhode
