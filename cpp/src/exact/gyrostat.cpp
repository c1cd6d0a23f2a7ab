#include "polhode/exact/gyrostat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "exact/free_frame.hpp"
#include "exact/gyrostat_start.hpp"
#include "exact/time_parts.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "polhode/exact/detail/gyrostat_kernels.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

using exact::GyrostatStart;
using math::DD;

constexpr double largest_angle = 1e25;  // rad: beyond it the phase has no reliable digits

std::string triple(const Vector3d& v) {
  return "(" + to_text(v[0]) + ", " + to_text(v[1]) + ", " + to_text(v[2]) + ")";
}

/// With two equal moments the axes are rotated about the third until h has one component across it. Returns the
/// rotation from working to principal axes.
Matrix3d align(GyrostatStart& s) {
  Matrix3d M = Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (s.J[j] != s.J[k] || s.J[i] == s.J[j] || s.h[j].hi == 0.0 || s.h[k].hi == 0.0) continue;
    const DD size = math::sqrt(s.h[j] * s.h[j] + s.h[k] * s.h[k]), c = s.h[j] / size, d = s.h[k] / size;
    const DD wj = c * s.w[j] + d * s.w[k];
    s.w[k] = c * s.w[k] - d * s.w[j];
    s.w[j] = wj;
    s.h[j] = size, s.h[k] = DD(0.0);
    M(j, j) = M(k, k) = c.hi, M(k, j) = d.hi, M(j, k) = -d.hi;
    break;
  }
  return M;
}

GyrostatKind kind_of(FreeKind kind) {
  switch (kind) {
    case FreeKind::rest: return GyrostatKind::rest;
    case FreeKind::spherical:
    case FreeKind::steady: return GyrostatKind::steady;
    case FreeKind::oblate:
    case FreeKind::prolate: return GyrostatKind::precession;
    case FreeKind::separatrix: return GyrostatKind::separatrix;
    default: return GyrostatKind::paired;
  }
}

Quat start_attitude(const exact::GyrostatSeries& series) {
  const exact::FreeState<double> s = exact::evaluate_gyrostat(series, 0.0);
  return {s.x, s.y, s.z, s.w};
}

}  // namespace

const char* to_text(GyrostatKind kind) {
  constexpr const char* names[] = {"rest", "steady", "precession", "paired", "single", "separatrix"};
  return names[static_cast<int>(kind)];
}

Gyrostat::Gyrostat(const Vector3d& moments, const Vector3d& momentum, const Vector3d& omega, const Quat& attitude)
    : Gyrostat(InertiaTensor::from_moments(moments), momentum, omega, attitude) {}

Gyrostat::Gyrostat(const InertiaTensor& inertia, const Vector3d& momentum, const Vector3d& omega, const Quat& attitude)
    : inertia_(inertia), momentum_(momentum), omega_(omega), attitude_(make_attitude(attitude)) {
  if (!momentum.allFinite()) throw InvalidInput("momentum", "finite", triple(momentum));
  if (momentum.isZero(0.0)) {
    free_.emplace(inertia, omega, attitude);
    kind_ = kind_of(free_->kind());
    return;
  }
  if (!omega.allFinite()) throw InvalidInput("omega", "finite", triple(omega));
  if (!inertia.is_positive_definite()) {
    throw InvalidInput("inertia", "positive about every axis", "principal moments " + triple(inertia.moments()),
                       "a rod or a point has a zero moment, so its rate about that axis is undefined");
  }
  for (int i = 0; i < 3; ++i) require_kept(momentum[i], "momentum"), require_kept(omega[i], "omega");
  set_up();
}

void Gyrostat::set_up() {
  const bool exact_axes = inertia_.is_diagonal();
  const Vector3d moments = exact_axes ? Vector3d(inertia_.matrix().diagonal()) : inertia_.moments();
  const Matrix3d R_BP = exact_axes ? Matrix3d::Identity() : inertia_.axes();
  if (!exact::carries_moments(moments.data())) {
    throw InvalidInput("inertia", "moments within the range of float64", triple(moments),
                       "the least is below 1.5e-154 of the largest");
  }
  // Powers of two: the largest moment, and the largest of |omega| and |h| / moment, become near 1.
  const int e_J = exact::exponent_of(moments);
  const int e_h = exact::exponent_of(momentum_) - e_J;
  const int e = omega_.isZero(0.0) ? e_h : std::max(e_h, exact::exponent_of(omega_));
  if (e > 1000 || e < -1000) {
    throw InvalidInput("momentum", "such that rates are representable in float64",
                       "rates near 2^" + std::to_string(e) + " rad/s", "choose other units of time");
  }
  const Vector3d w = R_BP.transpose() * exact::ldexp(omega_, -e);
  const Vector3d h = R_BP.transpose() * exact::ldexp(exact::ldexp(momentum_, -e_J), -e);
  const Vector3d J = exact::ldexp(moments, -e_J);
  GyrostatStart start{};
  for (int a = 0; a < 3; ++a) {
    start.J[a] = J[a], start.w[a] = w[a];
    // A smaller part rotates nothing by an ulp within 1e25 rad; its square would leave the range.
    start.h[a] = std::abs(h[a]) < 0x1p-200 ? 0.0 : h[a];
  }
  if (start.h[0].hi == 0.0 && start.h[1].hi == 0.0 && start.h[2].hi == 0.0) {
    free_.emplace(inertia_, omega_, attitude_);
    kind_ = kind_of(free_->kind());
    return;
  }
  const Matrix3d M = align(start);
  exact::GyrostatMotion motion;
  exact::gyrostat_kernels().set_up(start, series_, motion);
  kind_ = motion.kind;
  period_ = std::ldexp(motion.period, -e);
  longest_ = std::ldexp(largest_angle, -e) /
             std::max({1.0, std::abs(h[0] / J[0]), std::abs(h[1] / J[1]), std::abs(h[2] / J[2])});
  frame_ = exact::make_free_frame(R_BP, M, std::ldexp(1.0, e), start_attitude(series_), attitude_);
}

void Gyrostat::check_time(double t) const {
  if (!std::isfinite(t)) throw InvalidInput("t", "finite", to_text(t));
  if (kind_ != GyrostatKind::rest && !(std::abs(t) <= longest_)) {
    throw InvalidInput("t", "such that |omega t| <= 1e25 rad", to_text(t) + " s",
                       "beyond this the phase has no reliable digits");
  }
}

State Gyrostat::at(double t) const { return exact::find_state(*this, t); }

void Gyrostat::at(const double* t, std::size_t n, double* omega, double* attitude) const {
  exact::each_part(exact::TimeGrid(t, n), [&](const exact::TimeGrid& part, std::size_t begin) {
    at(part, omega ? omega + 3 * begin : nullptr, attitude ? attitude + 4 * begin : nullptr);
  });
}

void Gyrostat::at(const exact::TimeGrid& times, double* omega, double* attitude) const {
  if (free_) return free_->at(times, omega, attitude);
  const exact::GyrostatKernels& kernels = exact::gyrostat_kernels();
  if (!(kernels.times.reach(times.t, times.n) <= longest_)) {
    for (std::size_t i = 0; i < times.n; ++i) check_time(times.t[i]);
  }
  kernels.at(series_, frame_, times, omega, attitude);
}

double Gyrostat::period() const { return free_ ? free_->period() : period_; }

Vector3d Gyrostat::momentum_of(const Vector3d& omega) const {
  if (inertia_.is_diagonal()) return inertia_.matrix().diagonal().cwiseProduct(omega);
  return inertia_.matrix() * omega;
}

double Gyrostat::energy() const { return free_ ? free_->energy() : 0.5 * omega_.dot(momentum_of(omega_)); }

Vector3d Gyrostat::angular_momentum() const {
  return free_ ? free_->angular_momentum() : rotate(attitude_, Vector3d(momentum_of(omega_) + momentum_));
}

Vector3d Gyrostat::euler_angles(double t) const {
  const Vector3d M = momentum_of(omega_) + momentum_;
  if (M.isZero(0.0)) throw InvalidInput("momentum", "such that the total is not zero, for angles about it", "0");
  return exact::euler_angles_about(rotate(attitude_, M * (1.0 / M.cwiseAbs().maxCoeff())), at(t).attitude);
}

Vector3d Gyrostat::polhode(double t) const { return momentum_of(at(t).omega) + momentum_; }

}  // namespace polhode
