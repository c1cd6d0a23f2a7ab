#include <cmath>
#include <string>

#include "exact/free_frame.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/math/detail/functions.hpp"

// Geometry of a free motion: Poinsot's curves, Euler's angles, the flips of the tennis racket.
namespace polhode {
namespace {

using math::DD;

}  // namespace

Vector3d FreeMotion::euler_angles(double t) const {
  if (form_ == Form::rest) throw InvalidInput("omega", "other than zero for angles about the angular momentum", "rest");
  return exact::euler_angles_about(rotate(attitude_, momentum_direction()), at(t).attitude);
}

Vector3d FreeMotion::polhode(double t) const {
  if (form_ == Form::rest) throw InvalidInput("omega", "other than zero for a polhode", "rest");
  // omega' / sqrt(2 T') is scaled by 2^(-moment exponent / 2).
  const double odd = moment_exponent_ % 2 == 0 ? 1.0 : std::sqrt(2.0);
  const int e = (moment_exponent_ % 2 == 0 ? moment_exponent_ : moment_exponent_ - 1) / 2;
  const double scale = 1.0 / (std::sqrt(twice_T_) * odd);
  const Vector3d w = at(t).omega;
  Vector3d point;
  for (int a = 0; a < 3; ++a) point[a] = std::ldexp(std::ldexp(w[a], -time_exponent_) * scale, -e);
  return point;
}

Vector3d FreeMotion::herpolhode(double t) const { return rotate(at(t).attitude, polhode(t)); }

std::vector<double> FreeMotion::flip_times(double begin, double end) const {
  const double first = checked_time(begin), last = checked_time(end);
  if (!(end >= begin)) throw InvalidInput("end", "at or after begin", to_text(end));
  std::vector<double> times;
  if (kind_ != FreeKind::about_least && kind_ != FreeKind::about_greatest && kind_ != FreeKind::separatrix)
    return times;
  if (kind_ == FreeKind::separatrix) {
    const DD t = -(DD(hyper_.v0_hi, hyper_.v0_lo) / DD(hyper_.v_hi, hyper_.v_lo));
    const double at_zero = std::ldexp(t.hi, -time_exponent_);
    if (begin <= at_zero && at_zero <= end) times.push_back(at_zero);
    return times;
  }
  // The theta argument in half turns, start + rate t', is a whole number where sn = 0.
  const bool trig = form_ == Form::trig;
  const DD rate = trig ? math::scaled(DD(trig_.nu_hi, trig_.nu_lo), 2.0) : DD(hyper_.rate_hi, hyper_.rate_lo);
  const DD start = trig ? math::scaled(DD(trig_.phi0) + DD(0.25), 2.0) : DD(hyper_.start_hi, hyper_.start_lo);
  const double n_begin = (start + rate * DD(first)).hi, n_end = (start + rate * DD(last)).hi;
  const double low = std::ceil(std::min(n_begin, n_end)), high = std::floor(std::max(n_begin, n_end));
  constexpr double most = 1e8;
  if (high - low > most) {
    throw InvalidInput("end", "near enough to begin for at most 1e8 flips", to_text(high - low + 1) + " flips");
  }
  for (double n = low; n <= high; n += 1.0) {
    const double forward = rate.hi > 0.0 ? n : high - (n - low);
    const double t = std::ldexp(((DD(forward) - start) / rate).hi, -time_exponent_);
    if (begin <= t && t <= end) times.push_back(t);
    if (times.size() % 65536 == 1) check_interrupt();
  }
  return times;
}

}  // namespace polhode
