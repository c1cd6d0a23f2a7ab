#include "polhode/batch/free_motion.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "batch/free_block.hpp"
#include "batch/parallel.hpp"
#include "batch/rows.hpp"
#include "polhode/core/error.hpp"

namespace polhode {
namespace {

/// A range of bodies, evaluated on one thread.
class Run {
 public:
  Run(const FreeMotionBatch& batch, const exact::TimeGrid& shared, double reach, const MotionOutput& out)
      : b_(batch),
        rows_{batch.t, batch.times, batch.own_times ? nullptr : &shared, !batch.own_times && std::isfinite(reach), out},
        reach_(reach),
        block_(batch) {}

  /// Writes bodies [first, last). Returns the number of failed rows.
  std::size_t operator()(std::size_t first, std::size_t last) {
    std::size_t failed = 0;
    const std::size_t step = is_once() ? free_block : kept_block;
    for (std::size_t begin = first; begin < last; begin += step)
      failed += do_block(begin, std::min(last, begin + step));
    return failed;
  }

 private:
  /// Whether each body has one time of its own, in its given axes. A float has the same bits at one time as among many:
  /// it is never rounded from a double here.
  bool is_once() const {
    return b_.times == 1 && (b_.own_times || b_.bodies == 1) && !rows_.out.single_states() && !block_.rotated();
  }

  double reach_of(std::size_t body) const {
    if (!b_.own_times) return reach_;
    const double* t = rows_.times_of(body);
    if (b_.times == 1 && std::isfinite(*t)) return std::abs(*t);
    return exact::free_kernels().times.reach(t, b_.times);
  }

  std::size_t do_block(std::size_t begin, std::size_t end) {
    check_interrupt();
    block_.take(begin, end, [this](std::size_t body) { return reach_of(body); });
    if (is_once()) {
      rows_.once(begin, end - begin, [&](double* w, double* q) { block_.evaluate_once(b_.t + begin, w, q); });
    } else {
      block_.set_up();
    }
    std::size_t failed = 0;
    for (std::size_t body = begin; body < end; ++body) {
      if (block_.has_failed(body - begin)) {
        failed += rows_.fail(body, 0, b_.times);
      } else if (block_.done(body - begin)) {
        failed += rows_.after_once(body);
      } else {
        const auto at = [&](const exact::TimeGrid& t, double* w, double* q) {
          block_.evaluate(body - begin, t, w, q);
        };
        const auto single_at = [&](const exact::TimeGrid& t, float* w, float* q) {
          block_.evaluate(body - begin, t, w, q);
        };
        failed += block_.takes_floats(body - begin) ? rows_.each_run(body, at, single_at) : rows_.each_run(body, at);
      }
    }
    if (b_.done) *b_.done += (end - begin) * b_.times;
    return failed;
  }

  const FreeMotionBatch& b_;
  Rows rows_;
  double reach_;
  FreeBlock block_;
};

}  // namespace

std::size_t free_motion(const FreeMotionBatch& batch, double* omega, double* attitude, int threads) {
  return free_motion(batch, {.rows = {omega, attitude}}, threads);
}

std::size_t free_motion(const FreeMotionBatch& given, const MotionOutput& out, int threads) {
  if (given.bodies == 0 || given.times == 0) return 0;
  if (given.tensor) FreeMotion(*given.tensor, Vector3d::Zero());  // refuses a body without a moment about some axis
  FreeMotionBatch batch = given;
  batch.own_times = given.own_times && given.bodies > 1;  // the times of a single body are shared times
  std::atomic<std::size_t> failed{0};
  const std::size_t states = batch.bodies * batch.times;
  const std::size_t common = batch.own_times ? 0 : batch.times;
  const SharedTimes shared(exact::free_kernels().times, batch.t, common, batch.bodies > 1);
  if (batch.bodies == 1 && batch.times > 4096) {
    // One body: its times are divided among threads, at blocks of the grid.
    const std::size_t workers = thread_count(threads, states, 20000);
    parallel_for(batch.times, workers, 8 * exact::TimeGrid::block, [&](std::size_t begin, std::size_t end) {
      FreeMotionBatch piece = batch;
      piece.t = batch.t + begin, piece.times = end - begin;
      const exact::TimeGrid times = shared.grid.piece(begin, end - begin);
      failed += Run(piece, times, shared.reach, out.from(begin))(0, 1);
    });
    return failed;
  }
  const std::size_t workers = thread_count(threads, states, 2000);
  parallel_for(batch.bodies, workers, kept_block, [&](std::size_t begin, std::size_t end) {
    failed += Run(batch, shared.grid, shared.reach, out)(begin, end);
  });
  return failed;
}

}  // namespace polhode
