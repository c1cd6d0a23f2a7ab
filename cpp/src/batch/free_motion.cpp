#include "polhode/batch/free_motion.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <vector>

#include "batch/parallel.hpp"
#include "batch/rows.hpp"
#include "exact/free_frame.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/free_motion.hpp"

namespace polhode {
namespace {

constexpr std::size_t block = 64;  // bodies that are set up together, so that their constants stay in the cache

bool finite(const double* values, std::size_t n) { return within(values, n); }

/// Whether FreeMotion takes the moments with these rates; any positive ones are checked elsewhere.
bool carries(const double* I, const double* omega) {
  const bool turns = omega[0] != 0.0 || omega[1] != 0.0 || omega[2] != 0.0;
  return !(std::min({I[0], I[1], I[2]}) > 0.0) || !turns || (exact::carries_moments(I) && exact::carries_rates(omega));
}

void check_moments(const double* I, std::size_t body) {
  const double largest = std::max({I[0], I[1], I[2]}), smallest = std::min({I[0], I[1], I[2]});
  if (!(smallest > 0.0)) {
    throw InvalidInput(row_name("inertia", body), "positive about every axis", to_text(smallest),
                       "a rod or a point has a zero moment, so its rate about that axis is undefined");
  }
  const double deficit = 2.0 * largest - (I[0] + I[1] + I[2]);
  if (deficit > InertiaTensor::tolerance * largest) {
    throw InvalidInput(row_name("inertia", body),
                       "within the triangle inequality: no moment above the sum of the two others",
                       "(" + to_text(I[0]) + ", " + to_text(I[1]) + ", " + to_text(I[2]) + ")");
  }
}

/// Checks one body, whose numbers are finite. Returns its largest |omega_i|.
double check_body(const FreeMotionBatch& b, std::size_t body) {
  if (!b.tensor) check_moments(b.moments + 3 * body, body);
  const double *w = b.omega + 3 * body, *q = b.attitude + 4 * body;
  const double norm2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  // As make_attitude, whose square root only the edge of the tolerance needs.
  if (!(std::abs(norm2 - 1.0) <= 1.9e-6 || std::abs(norm({q[0], q[1], q[2], q[3]}) - 1.0) <= 1e-6)) {
    throw InvalidInput(row_name("attitude", body), "a unit quaternion (x, y, z, w)",
                       "norm " + to_text(std::sqrt(norm2)), "normalise it first, if it is meant to be an attitude");
  }
  return std::max({std::abs(w[0]), std::abs(w[1]), std::abs(w[2])});
}

void check_times(const double* t, std::size_t n, double reach, double speed, std::size_t body) {
  if (reach * speed <= 1e25) return;
  double longest = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    longest = std::abs(t[i]) > longest && !std::isinf(t[i]) ? std::abs(t[i]) : longest;
  if (longest * speed > 1e25) {
    throw InvalidInput(row_name("t", body), "such that |omega t| <= 1e25 rad", to_text(longest) + " s",
                       "beyond this the phase has no reliable digits");
  }
}

/// Starts of a block of bodies with one tensor, in its principal axes P.
class PrincipalStarts {
 public:
  explicit PrincipalStarts(const InertiaTensor& tensor)
      : rotated(!tensor.is_diagonal()), R_BP_(rotated ? tensor.axes() : Matrix3d(Matrix3d::Identity())) {
    const Vector3d I = rotated ? tensor.moments() : Vector3d(tensor.matrix().diagonal());
    for (std::size_t i = 0; i < block; ++i) Eigen::Map<Vector3d>(moments_ + 3 * i) = I;
  }

  /// The starts of n bodies; the attitudes stay in body axes.
  exact::FreeStarts operator()(const double* omega, const double* attitude, std::size_t n) {
    if (!rotated) return {moments_, omega, attitude};
    for (std::size_t i = 0; i < n; ++i) {
      // Scaled as FreeMotion does, so that the bits are its.
      const Vector3d w_B = Eigen::Map<const Vector3d>(omega + 3 * i);
      exponents_[i] = w_B.allFinite() && !w_B.isZero(0.0) ? exact::exponent_of(w_B) : 0;
      Eigen::Map<Vector3d>(rates_ + 3 * i) = R_BP_.transpose() * exact::ldexp(w_B, -exponents_[i]);
    }
    return {moments_, rates_, attitude};
  }

  /// The frame of body i of the block in body axes, from one of the same motion in principal axes.
  exact::FreeFrame to_body_axes(std::size_t i, const exact::FreeTrig<double>& trig, const exact::FreeFrame& principal,
                                const Quat& attitude) const {
    Matrix3d M;
    for (int c = 0; c < 3; ++c)
      for (int a = 0; a < 3; ++a) M(c, a) = principal.omega[3 * c + a] / principal.time_scale;
    return exact::make_free_frame(R_BP_, M, std::ldexp(principal.time_scale, exponents_[i]),
                                  exact::first_attitude(trig), make_attitude(attitude));
  }

  const bool rotated;

 private:
  Matrix3d R_BP_;
  double moments_[3 * block], rates_[3 * block];
  int exponents_[block];
};

/// A range of bodies, evaluated on one thread.
class Run {
 public:
  Run(const FreeMotionBatch& batch, const exact::TimeGrid& shared, double reach, double* omega, double* attitude)
      : b_(batch),
        rows_{batch.t, batch.times, batch.own_times ? nullptr : &shared, !batch.own_times && std::isfinite(reach),
              omega,   attitude},
        reach_(reach) {
    if (batch.tensor) principal_.emplace(*batch.tensor);
  }

  /// Writes bodies [first, last). Returns the number of poisoned rows.
  std::size_t operator()(std::size_t first, std::size_t last) {
    std::size_t poisoned = 0;
    for (std::size_t begin = first; begin < last; begin += block)
      poisoned += do_block(begin, std::min(last, begin + block));
    return poisoned;
  }

 private:
  std::size_t do_block(std::size_t begin, std::size_t end) {
    check_interrupt();
    const exact::FreeKernels& kernels = exact::free_kernels();
    const std::size_t n = end - begin;
    const double *omega = b_.omega + 3 * begin, *attitude = b_.attitude + 4 * begin;
    const bool rotated = principal_ && principal_->rotated;
    const exact::FreeStarts starts = principal_ ? (*principal_)(omega, attitude, n)
                                                : exact::FreeStarts{b_.moments + 3 * begin, omega, attitude};
    bool all_finite[block];
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t body = begin + i;
      all_finite[i] = (b_.tensor || finite(b_.moments + 3 * body, 3)) && finite(b_.omega + 3 * body, 3) &&
                      finite(b_.attitude + 4 * body, 4);
      if (!all_finite[i]) continue;
      if (!carries(starts.moments + 3 * i, starts.omega + 3 * i)) {
        all_finite[i] = false;
        continue;
      }
      const double* t = rows_.times_of(body);
      check_times(t, b_.times, b_.own_times ? kernels.times.reach(t, b_.times) : reach_, check_body(b_, body), body);
    }
    std::size_t left[block], remaining = 0;
    const bool once = !rotated && b_.times == 1 && (b_.own_times || b_.bodies == 1);
    if (once) {
      remaining = kernels.once(starts, b_.t + begin, n, rows_.omega_of(begin), rows_.attitude_of(begin), left);
    } else {
      trig_.resize(block), frames_.resize(block);
      remaining = kernels.set_up(starts, n, trig_.data(), frames_.data(), left);
    }
    std::size_t poisoned = 0, next = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t body = begin + i;
      const bool singly = next < remaining && left[next] == i;
      if (singly) ++next;
      if (!all_finite[i]) {
        poisoned += rows_.poison(body, 0, b_.times);
      } else if (singly) {
        const FreeMotion motion = single(body);
        poisoned += rows_.each_run(body, [&](const exact::TimeGrid& t, double* w, double* q) { motion.at(t, w, q); });
      } else {
        if (rotated) {
          const double* q = attitude + 4 * i;
          frames_[i] = principal_->to_body_axes(i, trig_[i], frames_[i], {q[0], q[1], q[2], q[3]});
        }
        poisoned += rows_.each_run(body, [&](const exact::TimeGrid& t, double* w, double* q) {
          if (!once) kernels.trig(trig_[i], frames_[i], t, w, q);
        });
      }
    }
    return poisoned;
  }

  FreeMotion single(std::size_t body) const {
    const double *w = b_.omega + 3 * body, *q = b_.attitude + 4 * body;
    const Vector3d omega{w[0], w[1], w[2]};
    const Quat attitude{q[0], q[1], q[2], q[3]};
    if (b_.tensor) return {*b_.tensor, omega, attitude};
    const double* I = b_.moments + 3 * body;
    return {InertiaTensor::from_moments({I[0], I[1], I[2]}), omega, attitude};
  }

  const FreeMotionBatch& b_;
  Rows rows_;
  double reach_;
  std::optional<PrincipalStarts> principal_;  ///< with a tensor
  std::vector<exact::FreeTrig<double>> trig_;
  std::vector<exact::FreeFrame> frames_;
};

}  // namespace

std::size_t free_motion(const FreeMotionBatch& given, double* omega, double* attitude, int threads) {
  if (given.bodies == 0 || given.times == 0) return 0;
  if (given.tensor) FreeMotion(*given.tensor, Vector3d::Zero());  // refuses a body without a moment about some axis
  FreeMotionBatch batch = given;
  batch.own_times = given.own_times && given.bodies > 1;  // the times of a single body are shared times
  std::atomic<std::size_t> poisoned{0};
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
      double *w = omega ? omega + 3 * begin : nullptr, *q = attitude ? attitude + 4 * begin : nullptr;
      poisoned += Run(piece, times, shared.reach, w, q)(0, 1);
    });
    return poisoned;
  }
  const std::size_t workers = thread_count(threads, states, 2000);
  parallel_for(batch.bodies, workers, block, [&](std::size_t begin, std::size_t end) {
    poisoned += Run(batch, shared.grid, shared.reach, omega, attitude)(begin, end);
  });
  return poisoned;
}

}  // namespace polhode
