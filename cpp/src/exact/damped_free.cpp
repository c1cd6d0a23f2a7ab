#include "polhode/exact/damped_free.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/time_parts.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/detail/free_kernels.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/phase.hpp"

namespace polhode {
namespace {

constexpr double most_exponent = 700.0;   // of e^-ct
constexpr double largest_swept = 1e25;     // |omega s| [rad], as for FreeMotion

}  // namespace

DampedFree::DampedFree(const InertiaTensor& inertia, double damping, const Vector3d& omega, const Quat& attitude)
    : free_(inertia, omega, attitude), damping_(damping) {
  if (!std::isfinite(damping)) throw InvalidInput("damping", "finite", to_text(damping));
}

DampedFree::DampedFree(const Vector3d& moments, double damping, const Vector3d& omega, const Quat& attitude)
    : DampedFree(InertiaTensor::from_moments(moments), damping, omega, attitude) {}

double DampedFree::slowed_time(double t) const {
  if (damping_ == 0.0) return t;
  double hi = 0.0, lo = 0.0, decay = 0.0;
  exact::damped_kernels().slow(damping_, &t, 1, &hi, &lo, &decay);
  return hi;
}

double DampedFree::total_angle() const {
  return damping_ > 0.0 ? omega().norm() / damping_ : std::numeric_limits<double>::infinity();
}

void DampedFree::check_time(double t) const {
  if (!std::isfinite(t)) throw InvalidInput("t", "finite", to_text(t));
  const double exponent = -damping_ * t, rate = omega().norm();
  if (rate == 0.0) return;
  const double angle = exponent > most_exponent ? std::numeric_limits<double>::infinity() : rate * slowed_time(t);
  if (std::abs(angle) <= largest_swept && (exponent <= 0.0 || rate * math::exp(exponent) < 1e300)) return;
  if (exponent <= 0.0) {
    throw InvalidInput("t", "such that |omega s| <= 1e25 rad", to_text(t) + " s",
                       "beyond this the phase has no reliable digits");
  }
  throw InvalidInput("t", "such that the body rotates by at most 1e25 rad at rates within float64", to_text(t) + " s",
                     std::string(damping_ < 0.0 ? "a negative damping drives the body"
                                                : "before its start a damped body rotated faster") +
                         ": omega is e^" + to_text(exponent) + " times that of the start; shorten the span");
}

State DampedFree::at(double t) const { return exact::find_state(*this, t); }

void DampedFree::at(const double* t, std::size_t n, double* omega, double* attitude) const {
  if (damping_ == 0.0) return free_.at(t, n, omega, attitude);
  double first = 0.0, last = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(t[i])) check_time(t[i]);
    first = std::min(first, t[i]), last = std::max(last, t[i]);
  }
  check_time(first), check_time(last);   // s grows with t
  exact::each_part(exact::TimeGrid(t, n), [&](const exact::TimeGrid& part, std::size_t begin) {
    write_part(part.t, part.n, omega ? omega + 3 * begin : nullptr, attitude ? attitude + 4 * begin : nullptr);
  });
}

void DampedFree::write_part(const double* t, std::size_t n, double* omega, double* attitude) const {
  const exact::DampedKernels& kernels = exact::damped_kernels();
  using Form = FreeMotion::Form;
  if (free_.form_ == Form::trig)
    return kernels.trig(free_.trig_, free_.frame_, damping_, t, n, omega, attitude);
  if (free_.form_ == Form::hyper)
    return kernels.hyper(free_.hyper_, free_.frame_, damping_, t, n, omega, attitude);
  // At rest, or exactly on the unstable axis.
  const double scale = free_.frame_.time_scale, rate = free_.trig_.kappa_hi;
  for (std::size_t i = 0; i < n; ++i) {
    double s = 0.0, s_low = 0.0, decay = 0.0, sine = 0.0, cosine = 1.0;
    kernels.slow(damping_, t + i, 1, &s, &s_low, &decay);
    if (omega != nullptr) Eigen::Map<Vector3d>(omega + 3 * i) = decay * free_.omega_;
    if (attitude == nullptr) continue;
    if (free_.form_ == Form::intermediate) {
      const double low = math::cycle_fraction(s_low * scale, rate, 0.0, 0.0);
      math::sincos_cycles(math::cycle_fraction(s * scale, rate, free_.trig_.kappa_lo, low), sine, cosine);
    }
    const double* m = free_.frame_.attitude;
    for (std::size_t c = 0; c < 4; ++c) attitude[4 * i + c] = m[4 * c + 1] * sine + m[4 * c + 3] * cosine;
  }
}

}  // namespace polhode
