#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "exact/free_frame.hpp"
#include "polhode/batch/free_motion.hpp"
#include "polhode/exact/free_motion.hpp"

namespace polhode {

constexpr std::size_t kept_block = 64;   ///< bodies that are set up together, so that their constants stay in the cache
constexpr std::size_t free_block = 512;  ///< bodies at one time each, so that the few near the separatrix fill lanes

/// The motion of one body of a batch.
FreeMotion make_motion(const FreeMotionBatch& batch, std::size_t body);

/// Starts of a block of bodies with one tensor, in its principal axes P.
class PrincipalStarts {
 public:
  /// For up to `most` bodies at once.
  PrincipalStarts(const InertiaTensor& tensor, std::size_t most)
      : rotated(!tensor.is_diagonal()), R_BP_(rotated ? tensor.axes() : Matrix3d(Matrix3d::Identity())) {
    const Vector3d I = rotated ? tensor.moments() : Vector3d(tensor.matrix().diagonal());
    for (std::size_t i = 0; i < most; ++i) Eigen::Map<Vector3d>(moments_ + 3 * i) = I;
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
  double moments_[3 * free_block], rates_[3 * free_block];
  int exponents_[free_block];
};

/// Up to `free_block` bodies of a batch, checked and set up. Each is then evaluated at any times, also in parts that
/// are whole blocks of a grid. A body that is not finite, or beyond float64, fails: its states are NaN. So is a
/// refused one, if the batch does not ask for the exception.
class FreeBlock {
 public:
  explicit FreeBlock(const FreeMotionBatch& batch);

  /// Takes bodies [begin, end). reach(body) is the largest |t| of a body, or infinity.
  template <class Reach>
  void take(std::size_t begin, std::size_t end, const Reach& reach) {
    begin_ = begin, n_ = end - begin;
    find_starts();
    const bool finite = is_finite(begin, n_);
    for (std::size_t i = 0; i < n_; ++i) {
      failed_[i] = !((finite || is_finite(begin + i, 1)) && is_carried(i));
      if (!failed_[i]) reach_[i] = reach(begin + i), failed_[i] = !passes(i);
    }
  }

  /// Sets the bodies up.
  void set_up();
  /// Instead of set_up(): each body at one time of its own.
  void evaluate_once(const double* t, double* omega, double* attitude);

  bool has_failed(std::size_t i) const { return failed_[i]; }
  bool rotated() const { return principal_ && principal_->rotated; }

  /// Body i of the block at these times; nothing where `evaluate_once` did it.
  void evaluate(std::size_t i, const exact::TimeGrid& t, double* omega, double* attitude);
  /// Whether `evaluate_once` did body i.
  bool done(std::size_t i) const { return once_ && !is_single(i); }
  /// Whether body i can be evaluated in floats.
  bool takes_floats(std::size_t i) const { return !once_ && !is_single(i) && exact::suits_single(frames_[i]); }
  void evaluate(std::size_t i, const exact::TimeGrid& t, float* omega, float* attitude);

 private:
  bool is_single(std::size_t i) const;
  void find_starts();
  bool is_finite(std::size_t body, std::size_t count) const;
  bool is_carried(std::size_t i) const;
  bool passes(std::size_t i) const;
  void add_singles(std::size_t count);

  const FreeMotionBatch& b_;
  std::size_t begin_ = 0, n_ = 0;
  bool once_ = false;
  exact::FreeStarts starts_{};
  std::optional<PrincipalStarts> principal_;  ///< with a tensor
  bool failed_[free_block];
  double reach_[free_block];                  ///< the largest |t|
  std::size_t left_[free_block];
  std::vector<exact::FreeTrig<double>> trig_;
  std::vector<exact::FreeFrame> frames_;
  using Single = std::pair<std::size_t, FreeMotion>;
  std::vector<Single> singles_;  ///< bodies that the lanes left, in order
};

}  // namespace polhode
