#include "polhode/batch/heavy_top.hpp"

#include "batch/many_motions.hpp"
#include "polhode/exact/detail/heavy_top_kernels.hpp"
#include "polhode/exact/heavy_top.hpp"

namespace polhode {

std::size_t heavy_top(const HeavyTopBatch& b, double* omega, double* attitude, int threads) {
  return heavy_top(b, {.rows = {omega, attitude}}, threads);
}

std::size_t heavy_top(const HeavyTopBatch& b, const MotionOutput& out, int threads) {
  const auto finite = [&b](std::size_t body) {
    return (b.tensor || within(b.moments + 3 * body, 3)) && within(b.weight_arm + body, 1) &&
           within(b.omega + 3 * body, 3) && within(b.attitude + 4 * body, 4);
  };
  const auto make = [&b](std::size_t body) -> HeavyTop {
    const double *w = b.omega + 3 * body, *q = b.attitude + 4 * body;
    const Vector3d rates{w[0], w[1], w[2]};
    const Quat start{q[0], q[1], q[2], q[3]};
    if (b.tensor) return {*b.tensor, b.weight_arm[body], rates, start};
    const double* I = b.moments + 3 * body;
    return {Vector3d{I[0], I[1], I[2]}, b.weight_arm[body], rates, start};
  };
  return evaluate_motions(b, exact::heavy_top_kernels().times, out, threads, finite, make);
}

}  // namespace polhode
