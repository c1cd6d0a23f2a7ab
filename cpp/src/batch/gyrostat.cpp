#include "polhode/batch/gyrostat.hpp"

#include "batch/many_motions.hpp"
#include "polhode/exact/detail/gyrostat_kernels.hpp"
#include "polhode/exact/gyrostat.hpp"

namespace polhode {

std::size_t gyrostat(const GyrostatBatch& b, double* omega, double* attitude, int threads) {
  return gyrostat(b, {.rows = {omega, attitude}}, threads);
}

std::size_t gyrostat(const GyrostatBatch& b, const MotionOutput& out, int threads) {
  const auto finite = [&b](std::size_t body) {
    return (b.tensor || within(b.moments + 3 * body, 3)) && within(b.momentum + 3 * body, 3) &&
           within(b.omega + 3 * body, 3) && within(b.attitude + 4 * body, 4);
  };
  const auto make = [&b](std::size_t body) -> Gyrostat {
    const double *h = b.momentum + 3 * body, *w = b.omega + 3 * body, *q = b.attitude + 4 * body;
    const Vector3d rotors{h[0], h[1], h[2]}, rates{w[0], w[1], w[2]};
    const Quat start{q[0], q[1], q[2], q[3]};
    if (b.tensor) return {*b.tensor, rotors, rates, start};
    const double* I = b.moments + 3 * body;
    return {Vector3d{I[0], I[1], I[2]}, rotors, rates, start};
  };
  return evaluate_motions(b, exact::gyrostat_kernels().times, out, threads, finite, make);
}

}  // namespace polhode
