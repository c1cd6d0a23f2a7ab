#include "polhode/batch/heavy_top.hpp"

#include <atomic>

#include "batch/parallel.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/heavy_top.hpp"
#include "polhode/exact/detail/heavy_top_kernels.hpp"
#include "batch/rows.hpp"

namespace polhode {
namespace {

HeavyTop make_top(const HeavyTopBatch& b, std::size_t body) {
  const double *w = b.omega + 3 * body, *q = b.attitude + 4 * body;
  const double arm = b.weight_arm[body];
  const Vector3d omega{w[0], w[1], w[2]};
  const Quat attitude{q[0], q[1], q[2], q[3]};
  try {
    if (b.tensor) return {*b.tensor, arm, omega, attitude};
    const double* I = b.moments + 3 * body;
    return {Vector3d{I[0], I[1], I[2]}, arm, omega, attitude};
  } catch (const InvalidInput& error) {
    throw InvalidInput(row_name("body", body) + ": " + error.what());
  }
}

/// Writes tops [first, last). Returns the number of poisoned rows.
std::size_t run(const HeavyTopBatch& b, const Rows& rows, std::size_t first, std::size_t last) {
  std::size_t poisoned = 0;
  for (std::size_t body = first; body < last; ++body) {
    check_interrupt();
    const bool finite = (b.tensor || within(b.moments + 3 * body, 3)) && within(b.weight_arm + body, 1) &&
                        within(b.omega + 3 * body, 3) && within(b.attitude + 4 * body, 4);
    if (!finite) {
      poisoned += rows.poison(body, 0, rows.times);
      continue;
    }
    const HeavyTop top = make_top(b, body);
    poisoned += rows.each_run(
        body, [&](const exact::TimeGrid& t, double* omega, double* attitude) { top.at(t, omega, attitude); });
  }
  return poisoned;
}

}  // namespace

std::size_t heavy_top(const HeavyTopBatch& given, double* omega, double* attitude, int threads) {
  if (given.bodies == 0 || given.times == 0) return 0;
  HeavyTopBatch batch = given;
  batch.own_times = given.own_times && given.bodies > 1;  // the times of a single top are shared times
  std::atomic<std::size_t> poisoned{0};
  const std::size_t common = batch.own_times ? 0 : batch.times;
  const SharedTimes shared(exact::heavy_top_kernels().times, batch.t, common, batch.bodies > 1);
  const bool finite = !batch.own_times && std::isfinite(shared.reach);
  if (batch.bodies == 1 && batch.times > 4096) {
    // One top: its times are divided among threads, at blocks of the grid.
    parallel_for(batch.times, thread_count(threads, batch.times, 20000), 8 * exact::TimeGrid::block,
                 [&](std::size_t begin, std::size_t end) {
                   const exact::TimeGrid piece = shared.grid.piece(begin, end - begin);
                   const Rows rows{batch.t + begin,
                                   end - begin,
                                   &piece,
                                   finite,
                                   omega ? omega + 3 * begin : nullptr,
                                   attitude ? attitude + 4 * begin : nullptr};
                   poisoned += run(batch, rows, 0, 1);
                 });
    return poisoned;
  }
  const Rows rows{batch.t, batch.times, batch.own_times ? nullptr : &shared.grid, finite, omega, attitude};
  parallel_for(batch.bodies, thread_count(threads, batch.bodies * batch.times + 100 * batch.bodies, 5000), 16,
               [&](std::size_t begin, std::size_t end) { poisoned += run(batch, rows, begin, end); });
  return poisoned;
}

}  // namespace polhode
