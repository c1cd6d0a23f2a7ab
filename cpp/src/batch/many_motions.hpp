#pragma once

#include <atomic>
#include <cmath>

#include "batch/parallel.hpp"
#include "batch/rows.hpp"
#include "polhode/core/error.hpp"

namespace polhode {

/// Many motions in closed form, each set up once: what Lagrange's tops and gyrostats share. finite(body) says whether
/// the input is; make(body) gives the motion. Its InvalidInput comes out with the number of the body. Returns the number
/// of rows that are NaN. The bits do not depend on the number of threads.
template <class Batch, class Finite, class Make>
std::size_t evaluate_motions(const Batch& given, const exact::TimeKernels& kernels, const MotionOutput& out,
                             int threads, const Finite& is_finite, const Make& make) {
  if (given.bodies == 0 || given.times == 0) return 0;
  Batch batch = given;
  batch.own_times = given.own_times && given.bodies > 1;  // the times of a single body are shared times
  std::atomic<std::size_t> failed{0};
  const auto run = [&](const Rows& rows, std::size_t first, std::size_t last) {
    for (std::size_t body = first; body < last; ++body) {
      check_interrupt();
      if (!is_finite(body)) {
        failed += rows.fail(body, 0, rows.times);
        if (batch.done) *batch.done += rows.times;
        continue;
      }
      try {
        const auto motion = make(body);
        failed += rows.each_run(body, [&](const exact::TimeGrid& t, double* w, double* q) { motion.at(t, w, q); });
      } catch (const InvalidInput& error) {
        if (batch.refuse) throw InvalidInput(row_name("body", body) + ": " + error.what());
        failed += rows.fail(body, 0, rows.times);
      }
      if (batch.done) *batch.done += rows.times;
    }
  };
  const std::size_t common = batch.own_times ? 0 : batch.times;
  const SharedTimes shared(kernels, batch.t, common, batch.bodies > 1);
  const bool finite = !batch.own_times && std::isfinite(shared.reach);
  if (batch.bodies == 1 && batch.times > 4096) {
    // One body: its times are divided among threads, at blocks of the grid.
    parallel_for(batch.times, thread_count(threads, batch.times, 20000), 8 * exact::TimeGrid::block,
                 [&](std::size_t begin, std::size_t end) {
                   const exact::TimeGrid piece = shared.grid.piece(begin, end - begin);
                   run(Rows{batch.t + begin, end - begin, &piece, finite, out.from(begin)}, 0, 1);
                 });
    return failed;
  }
  const Rows rows{batch.t, batch.times, batch.own_times ? nullptr : &shared.grid, finite, out};
  parallel_for(batch.bodies, thread_count(threads, batch.bodies * batch.times + 100 * batch.bodies, 5000), 16,
               [&](std::size_t begin, std::size_t end) { run(rows, begin, end); });
  return failed;
}

}  // namespace polhode
