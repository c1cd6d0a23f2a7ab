#include "batch/free_block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "batch/rows.hpp"
#include "core/all_finite.hpp"
#include "polhode/core/error.hpp"

namespace polhode {
namespace {

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

}  // namespace

FreeBlock::FreeBlock(const FreeMotionBatch& batch) : b_(batch) {
  if (batch.tensor) principal_.emplace(*batch.tensor, std::min(batch.bodies, free_block));
}

void FreeBlock::find_starts() {
  const double *omega = b_.omega + 3 * begin_, *attitude = b_.attitude + 4 * begin_;
  once_ = false;
  starts_ = principal_ ? (*principal_)(omega, attitude, n_)
                       : exact::FreeStarts{b_.moments + 3 * begin_, omega, attitude};
}

bool FreeBlock::is_finite(std::size_t body, std::size_t count) const {
  return (b_.tensor || all_finite(b_.moments + 3 * body, 3 * count)) && all_finite(b_.omega + 3 * body, 3 * count) &&
         all_finite(b_.attitude + 4 * body, 4 * count);
}

bool FreeBlock::is_carried(std::size_t i) const { return carries(starts_.moments + 3 * i, starts_.omega + 3 * i); }

bool FreeBlock::passes(std::size_t i) const {
  const std::size_t body = begin_ + i;
  try {
    check_times(b_.t + (b_.own_times ? body * b_.times : 0), b_.times, reach_[i], check_body(b_, body), body);
  } catch (const InvalidInput&) {
    if (b_.refuse) throw;
    return false;
  }
  return true;
}

void FreeBlock::set_up() {
  trig_.resize(kept_block), frames_.resize(kept_block);
  const std::size_t count = exact::free_batch_kernels().set_up(starts_, n_, trig_.data(), frames_.data(), left_);
  add_singles(count);
  for (std::size_t i = 0, next = 0; rotated() && i < n_; ++i) {
    const bool singly = next < count && left_[next] == i;
    next += singly;
    const double* q = b_.attitude + 4 * (begin_ + i);
    if (!singly && !failed_[i]) frames_[i] = principal_->to_body_axes(i, trig_[i], frames_[i], {q[0], q[1], q[2], q[3]});
  }
}

void FreeBlock::evaluate_once(const double* t, double* omega, double* attitude) {
  once_ = true;
  add_singles(exact::free_batch_kernels().once(starts_, t, n_, omega, attitude, left_));
}

void FreeBlock::add_singles(std::size_t count) {
  singles_.clear();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = left_[k];
    if (failed_[i]) continue;
    try {
      singles_.emplace_back(i, make_motion(b_, begin_ + i));
      // At the edge of the range: what evaluate() would refuse.
      if (!b_.refuse && std::isfinite(reach_[i])) singles_.back().second.at(reach_[i]);
    } catch (const InvalidInput&) {
      if (b_.refuse) throw;
      failed_[i] = true;   // what stands in singles_ is not used
    }
  }
}

void FreeBlock::evaluate(std::size_t i, const exact::TimeGrid& t, double* omega, double* attitude) {
  const auto found = std::ranges::lower_bound(singles_, i, {}, &Single::first);
  if (found == singles_.end() || found->first != i) {
    if (!once_) exact::free_kernels().trig(trig_[i], frames_[i], t, omega, attitude);
    return;
  }
  found->second.at(t, omega, attitude);
}

void FreeBlock::evaluate(std::size_t i, const exact::TimeGrid& t, float* omega, float* attitude) {
  exact::free_batch_kernels().trig_single(trig_[i], frames_[i], t.t, t.n, omega, attitude);
}

bool FreeBlock::is_single(std::size_t i) const {
  return std::ranges::binary_search(singles_, i, {}, &Single::first);
}

FreeMotion make_motion(const FreeMotionBatch& batch, std::size_t body) {
  const double *w = batch.omega + 3 * body, *q = batch.attitude + 4 * body;
  const Vector3d omega{w[0], w[1], w[2]};
  const Quat attitude{q[0], q[1], q[2], q[3]};
  if (batch.tensor) return {*batch.tensor, omega, attitude};
  const double* I = batch.moments + 3 * body;
  return {InertiaTensor::from_moments({I[0], I[1], I[2]}), omega, attitude};
}

}  // namespace polhode
