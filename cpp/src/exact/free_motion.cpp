#include "polhode/exact/free_motion.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <string>

#include "exact/free_frame.hpp"
#include "exact/time_parts.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "polhode/math/detail/double_double.hpp"

namespace polhode {
namespace {

using exact::exponent_of;
using exact::ldexp;
using math::DD;

constexpr double most_radians = 1e25;  // beyond it even 106 bits leave fewer than 7 digits of the phase
constexpr double hyper_from = 0.97;    // k^2; either form is good to 1e-15 on both sides of it

std::string vector_text(const Vector3d& v) {
  return "(" + to_text(v[0]) + ", " + to_text(v[1]) + ", " + to_text(v[2]) + ")";
}

/// Converts a scaled quantity to SI. Throws InvalidInput if float64 cannot represent it.
double representable(double scaled, int exponent, const char* name) {
  const double value = std::ldexp(scaled, exponent);
  if (!std::isfinite(value) || (scaled != 0.0 && std::abs(value) < std::numeric_limits<double>::min())) {
    throw InvalidInput(name, "within the range of float64", to_text(scaled) + " * 2^" + std::to_string(exponent),
                       "omega or the moments are too large or too small for it; choose other units");
  }
  return value;
}

}  // namespace

const char* to_text(FreeKind kind) {
  constexpr const char* names[] = {"rest",    "spherical",   "steady",         "oblate",
                                   "prolate", "about_least", "about_greatest", "separatrix"};
  return names[static_cast<int>(kind)];
}

FreeMotion::FreeMotion(const Vector3d& moments, const Vector3d& omega, const Quat& attitude)
    : FreeMotion(InertiaTensor::from_moments(moments), omega, attitude) {}

FreeMotion::FreeMotion(const InertiaTensor& inertia, const Vector3d& omega, const Quat& attitude)
    : inertia_(inertia), omega_(omega), attitude_(make_attitude(attitude)) {
  if (!omega.allFinite()) throw InvalidInput("omega", "finite", vector_text(omega));
  for (const double rate : omega) require_kept(rate, "omega");
  if (!inertia.is_positive_definite()) {
    throw InvalidInput("inertia", "positive about every axis", "principal moments " + vector_text(inertia.moments()),
                       "a rod or a point has a zero moment, so its rate about that axis is undefined");
  }
  const bool exact_axes = inertia.is_diagonal();
  if (exact_axes) {
    set_up(inertia.matrix().diagonal(), Matrix3d::Identity(), true);
  } else {
    set_up(inertia.moments(), inertia.axes(), false);
  }
}

void FreeMotion::classify(const Vector3d& I, const Vector3d& w, bool exact_axes) {
  Symmetry symmetry = Symmetry::triaxial;
  const double gap = exact_axes ? 0.0 : symmetry_gap * I[2];
  if (I[2] - I[0] <= gap) {
    symmetry = Symmetry::spherical;
  } else if (I[1] - I[0] <= gap) {
    symmetry = Symmetry::oblate;
  } else if (I[2] - I[1] <= gap) {
    symmetry = Symmetry::prolate;
  }
  // With a full tensor, rounding leaves components of this size instead of zeros.
  const double nothing = exact_axes ? 0.0 : 4 * symmetry_gap * w.cwiseAbs().maxCoeff();
  const bool zero[] = {std::abs(w[0]) <= nothing, std::abs(w[1]) <= nothing, std::abs(w[2]) <= nothing};
  const int zeros = zero[0] + zero[1] + zero[2];
  if (symmetry == Symmetry::spherical) {
    kind_ = FreeKind::spherical;
  } else if (zeros == 2 || (symmetry == Symmetry::oblate && zero[2]) || (symmetry == Symmetry::prolate && zero[0])) {
    kind_ = FreeKind::steady;
  } else if (symmetry != Symmetry::triaxial) {
    kind_ = symmetry == Symmetry::oblate ? FreeKind::oblate : FreeKind::prolate;
  } else if (form_ == Form::hyper && hyper_.homoclinic > 0.0) {
    kind_ = FreeKind::separatrix;
  }
}

void FreeMotion::set_up(const Vector3d& moments, const Matrix3d& R_BP, bool exact_axes) {
  frame_.time_scale = 1.0;
  if (omega_.isZero(0.0)) {
    const double q[] = {attitude_.x, attitude_.y, attitude_.z, attitude_.w};
    for (std::size_t c = 0; c < 4; ++c) frame_.attitude[4 * c + 3] = q[c];
    return;
  }
  if (!exact::carries_moments(moments.data())) {
    throw InvalidInput("inertia", "moments within the range of float64", vector_text(moments),
                       "the least is below 1.5e-154 of the largest");
  }
  time_exponent_ = exponent_of(omega_);
  moment_exponent_ = exponent_of(moments);
  frame_.time_scale = std::ldexp(1.0, time_exponent_);
  const Vector3d w = R_BP.transpose() * ldexp(omega_, -time_exponent_), I = ldexp(moments, -moment_exponent_);
  if (!exact::carries_rates(exact_axes ? omega_.data() : w.data())) {   // as given: scaled, it may have become 0
    throw InvalidInput("omega", "of rates within the range of float64", vector_text(omega_),
                       "the least is below 1e-286 of the largest, and not 0");
  }

  exact::FreeStart<double> start{};
  for (int a = 0; a < 3; ++a) start.I[a] = I[a], start.w[a] = w[a], start.M[a][a] = 1.0;
  exact::FreeConstants<double> constants;
  exact::free_kernels().prepare(start, constants, trig_, hyper_);
  twice_T_ = constants.twice_T.hi;
  L_ = constants.L.hi;
  longest_ = most_radians / w.norm();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const exact::FreeStart<double>& s = constants.start;

  double precession_cycles = nan;
  if (s.w[0] == 0.0 && s.w[2] == 0.0 && s.I[0] != s.I[1] && s.I[1] != s.I[2]) {
    // Exactly on the unstable axis: omega is constant, the half angle in cycles is w2 t / (4 pi).
    form_ = Form::intermediate;
    const DD half = DD(s.w[1]) * DD(0.15915494309189535, -9.839338337591243e-18) * DD(0.5);
    trig_.kappa_hi = half.hi, trig_.kappa_lo = half.lo;
    precession_cycles = std::abs(2.0 * half.hi);
  } else if (constants.k.hi * constants.k.hi > hyper_from) {
    form_ = Form::hyper;
    precession_cycles = 2.0 * hyper_.kappa_hi + 0.5 * hyper_.rate_hi;
    if (hyper_.homoclinic > 0.0) precession_cycles = L_ / s.I[1] / (2.0 * std::numbers::pi);
  } else {
    form_ = Form::trig;
    precession_cycles = 2.0 * trig_.kappa_hi + trig_.nu_hi;
  }
  precession_ = 2.0 * std::numbers::pi * precession_cycles;

  Vector3d I_sorted = I, w_sorted = w;
  for (const auto& [a, b] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{0, 1}}) {
    if (I_sorted[a] > I_sorted[b]) std::swap(I_sorted[a], I_sorted[b]), std::swap(w_sorted[a], w_sorted[b]);
  }
  kind_ = s.I[2] > s.I[0] ? FreeKind::about_greatest : FreeKind::about_least;
  classify(I_sorted, w_sorted, exact_axes);

  Matrix3d M;
  for (int c = 0; c < 3; ++c)
    for (int a = 0; a < 3; ++a) M(c, a) = s.M[c][a];
  Quat first;
  if (form_ == Form::trig) first = exact::first_attitude(trig_);
  if (form_ == Form::hyper) first = exact::first_attitude(hyper_);
  frame_ = exact::make_free_frame(R_BP, M, frame_.time_scale, first, attitude_);
}

double FreeMotion::checked_time(double t) const {
  const double scaled = t * frame_.time_scale;
  if (std::isnan(t) || std::isinf(t)) throw InvalidInput("t", "finite", to_text(t));
  if (form_ != Form::rest && !(std::abs(scaled) <= longest_)) {
    throw InvalidInput("t", "such that |omega t| <= 1e25 rad", to_text(t) + " s",
                       "beyond this the phase has no reliable digits");
  }
  return scaled;
}

/// At rest, or exactly on the unstable axis: omega as given, and a rotation about it.
void FreeMotion::write_constant(const double* t, std::size_t n, double* omega, double* attitude) const {
  for (std::size_t i = 0; i < n; ++i) {
    if (omega) std::copy_n(omega_.data(), 3, omega + 3 * i);
    if (attitude == nullptr) continue;
    double sine = 0.0, cosine = 1.0;
    const double scaled = t[i] * frame_.time_scale;
    if (form_ == Form::intermediate) {
      math::sincos_cycles(math::cycle_fraction(scaled, trig_.kappa_hi, trig_.kappa_lo, 0.0), sine, cosine);
    }
    for (std::size_t c = 0; c < 4; ++c)
      attitude[4 * i + c] = frame_.attitude[4 * c + 1] * sine + frame_.attitude[4 * c + 3] * cosine;
  }
}

State FreeMotion::at(double t) const { return exact::find_state(*this, t); }

void FreeMotion::at(const double* t, std::size_t n, double* omega, double* attitude) const {
  exact::each_part(exact::TimeGrid(t, n), [&](const exact::TimeGrid& part, std::size_t begin) {
    at(part, omega ? omega + 3 * begin : nullptr, attitude ? attitude + 4 * begin : nullptr);
  });
}

void FreeMotion::at(const exact::TimeGrid& times, double* omega, double* attitude) const {
  const exact::FreeKernels& kernels = exact::free_kernels();
  const double longest = form_ == Form::rest ? std::numeric_limits<double>::max() : longest_;
  const double scale = form_ == Form::rest ? 1.0 : frame_.time_scale;
  if (!(kernels.times.reach(times.t, times.n) * scale <= longest)) {
    for (std::size_t i = 0; i < times.n; ++i) checked_time(times.t[i]);
  }
  if (form_ == Form::trig) return kernels.trig(trig_, frame_, times, omega, attitude);
  if (form_ == Form::hyper) return kernels.hyper(hyper_, frame_, times, omega, attitude);
  write_constant(times.t, times.n, omega, attitude);
}

double FreeMotion::period() const {
  switch (kind_) {
    case FreeKind::rest:
    case FreeKind::spherical:
    case FreeKind::steady:
      return 0.0;
    case FreeKind::separatrix:
      return std::numeric_limits<double>::infinity();
    default:
      break;
  }
  const double scaled = form_ == Form::trig ? 1.0 / trig_.nu_hi : 2.0 / hyper_.rate_hi;
  return representable(std::abs(scaled), -time_exponent_, "period");
}

double FreeMotion::precession_rate() const { return std::ldexp(precession_, time_exponent_); }

double FreeMotion::energy() const {
  return representable(0.5 * twice_T_, moment_exponent_ + 2 * time_exponent_, "energy");
}

/// L_B(0) in scaled units.
Vector3d FreeMotion::momentum_direction() const {
  const Vector3d w = ldexp(omega_, -time_exponent_);
  if (inertia_.is_diagonal()) return ldexp(inertia_.matrix().diagonal(), -moment_exponent_).cwiseProduct(w);
  return inertia_.matrix() * w * std::ldexp(1.0, -moment_exponent_);
}

Vector3d FreeMotion::angular_momentum() const {
  if (form_ == Form::rest) return Vector3d::Zero();
  representable(L_, moment_exponent_ + time_exponent_, "angular_momentum");
  return ldexp(rotate(attitude_, momentum_direction()), moment_exponent_ + time_exponent_);
}

}  // namespace polhode
