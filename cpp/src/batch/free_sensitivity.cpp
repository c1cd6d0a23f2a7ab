#include "polhode/batch/free_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "batch/free_block.hpp"
#include "batch/parallel.hpp"
#include "batch/rows.hpp"
#include "exact/free_frame.hpp"
#include "exact/sensitivity/body.hpp"

namespace polhode {
namespace {

constexpr std::size_t columns_block = 64;  // bodies that are set up together

/// A range of bodies on one thread. The states are there already.
class ColumnsRun {
 public:
  ColumnsRun(const FreeMotionBatch& batch, const exact::ColumnLayout& layout, const double* omega,
             const double* attitude, double* d_omega, double* d_attitude)
      : b_(batch), layout_(layout), omega_(omega), attitude_(attitude), d_omega_(d_omega), d_attitude_(d_attitude) {}

  void operator()(std::size_t first, std::size_t last) {
    for (std::size_t begin = first; begin < last; begin += columns_block)
      do_block(begin, std::min(last, begin + columns_block));
  }

  /// One body's times [first, last).
  void times(const exact::MotionColumns& columns, std::size_t first, std::size_t last) const {
    evaluate(columns, 0, first, last);
  }

  FreeMotion motion(std::size_t body) const { return make_motion(b_, body); }

  /// Whether free_motion computed the body: it leaves NaN in all rows of one that it cannot.
  bool is_good(std::size_t body) const {
    const double *w = b_.omega + 3 * body, *q = b_.attitude + 4 * body;
    if (!within(w, 3) || !within(q, 4) || (b_.moments && !within(b_.moments + 3 * body, 3))) return false;
    return (w[0] == 0.0 && w[1] == 0.0 && w[2] == 0.0) ||
           exact::carries_moments(b_.tensor ? b_.tensor->moments().data() : b_.moments + 3 * body);
  }

  void fail(std::size_t body) const {
    const std::size_t size = 3 * layout_.width * b_.times;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::fill_n(d_omega_ + body * size, size, nan), std::fill_n(d_attitude_ + body * size, size, nan);
  }

 private:
  void do_block(std::size_t begin, std::size_t end) {
    check_interrupt();
    const std::size_t n = end - begin;
    std::size_t left[columns_block], remaining = 0, next = 0;
    const bool lanes = !b_.tensor;
    if (lanes) {
      trig_.resize(n), frames_.resize(n), columns_.resize(n), rates_.resize(3 * n);
      remaining = exact::free_columns_kernels().set_up(
          {b_.moments + 3 * begin, b_.omega + 3 * begin, b_.attitude + 4 * begin}, n, trig_.data(), frames_.data(),
          columns_.data(), rates_.data(), left);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t body = begin + i;
      const bool singly = !lanes || (next < remaining && left[next] == i);
      if (lanes && singly) ++next;
      if (!is_good(body)) {
        fail(body);
      } else if (singly) {
        evaluate(exact::MotionColumns(motion(body)), body, 0, b_.times);
      } else {
        const exact::ColumnsBody columns(start(body), exact::ColumnsForm::trig, columns_[i], rates_.data() + 3 * i,
                                         &trig_[i], nullptr, frames_[i]);
        evaluate(columns, body, 0, b_.times);
      }
    }
  }

  exact::ColumnsStart start(std::size_t body) const {
    exact::ColumnsStart s;
    const double *w = b_.omega + 3 * body, *q = b_.attitude + 4 * body, *I = b_.moments + 3 * body;
    s.omega = {w[0], w[1], w[2]};
    s.attitude = make_attitude({q[0], q[1], q[2], q[3]});
    const Vector3d moments(I[0], I[1], I[2]);
    s.time_exponent = exact::exponent_of(s.omega), s.moment_exponent = exact::exponent_of(moments);
    s.w = exact::ldexp(s.omega, -s.time_exponent), s.I = exact::ldexp(moments, -s.moment_exponent);
    return s;
  }

  template <class Columns>
  void evaluate(const Columns& columns, std::size_t body, std::size_t first, std::size_t last) const {
    constexpr std::size_t chunk = 1024;
    const double* t = b_.t + (b_.own_times ? body * b_.times : 0);
    const std::size_t size = 3 * layout_.width;
    for (std::size_t begin = first; begin < last; begin += chunk) {
      const std::size_t count = std::min(chunk, last - begin), row = body * b_.times + begin;
      columns.at(layout_, t + begin, count, omega_ + 3 * row, attitude_ + 4 * row, d_omega_ + size * row,
                 d_attitude_ + size * row);
      if (within(t + begin, count)) continue;
      for (std::size_t i = 0; i < count; ++i) {
        if (std::isfinite(t[begin + i])) continue;
        const double nan = std::numeric_limits<double>::quiet_NaN();
        std::fill_n(d_omega_ + size * (row + i), size, nan), std::fill_n(d_attitude_ + size * (row + i), size, nan);
      }
    }
  }

  const FreeMotionBatch& b_;
  const exact::ColumnLayout& layout_;
  const double *omega_, *attitude_;
  double *d_omega_, *d_attitude_;
  std::vector<exact::FreeTrig<double>> trig_;
  std::vector<exact::FreeFrame> frames_;
  std::vector<exact::FreeColumns<double>> columns_;
  std::vector<double> rates_;
};

}  // namespace

std::size_t free_sensitivity(const FreeMotionBatch& given, std::vector<SensitivityTo> wrt, RotationSide side,
                             double* omega, double* attitude, double* d_omega, double* d_attitude, int threads) {
  exact::check_wrt(wrt);
  if (given.bodies == 0 || given.times == 0) return 0;
  FreeMotionBatch batch = given;
  batch.own_times = given.own_times && given.bodies > 1;
  const std::size_t states = batch.bodies * batch.times, wanted = exact::ColumnLayout(wrt, side).width;
  std::vector<double> own_omega(omega ? 0 : 3 * states), own_attitude(attitude ? 0 : 4 * states), own_columns;
  if (!omega) omega = own_omega.data();
  if (!attitude) attitude = own_attitude.data();
  const std::size_t failed = free_motion(batch, omega, attitude, threads);

  // The columns of the axes are made of those of omega(0).
  const exact::ColumnLayout layout(exact::with_needed(wrt), side);
  double *to_omega = d_omega, *to_attitude = d_attitude;
  if (layout.width != wanted) {
    own_columns.resize(6 * layout.width * states);
    to_omega = own_columns.data(), to_attitude = to_omega + 3 * layout.width * states;
  }
  const ColumnsRun all(batch, layout, omega, attitude, to_omega, to_attitude);
  if (batch.bodies == 1) {
    if (!all.is_good(0)) {
      all.fail(0);
    } else {
      const exact::MotionColumns columns(all.motion(0));
      parallel_for(batch.times, thread_count(threads, states, 5000), exact::TimeGrid::block,
                   [&](std::size_t begin, std::size_t end) { all.times(columns, begin, end); });
    }
  } else {
    const std::size_t workers = thread_count(threads, states, 500);
    parallel_for(batch.bodies, workers, columns_block, [&](std::size_t begin, std::size_t end) {
      ColumnsRun own = all;  // with room of its own for constants
      own(begin, end);
    });
  }
  for (std::size_t row = 0; layout.width != wanted && row < 3 * states; ++row) {
    std::copy_n(to_omega + layout.width * row, wanted, d_omega + wanted * row);
    std::copy_n(to_attitude + layout.width * row, wanted, d_attitude + wanted * row);
  }
  return failed;
}

}  // namespace polhode
