#include "polhode/exact/pendulum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/time_parts.hpp"
#include "exact/pendulum_start.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"
#include "polhode/exact/detail/free_setup_hyper.hpp"

namespace polhode {
namespace {

using math::DD;

constexpr double most_angle = 1e25;       // beyond it even 106 bits leave fewer than 7 digits of the phase
constexpr double hyper_above = 0.97;        // k^2; either form is good to 1e-15 on both sides of it
constexpr std::size_t states_at_once = 8 * exact::TimeGrid::block;

/// Jacobi's constants of a free body whose omega is (a1 cn, a2 sn, a3 dn) with a1 = a3 = sqrt(1/2), a2^2 = (1 + k^2)/2,
/// and moments 1, so that the series of the free body give the three functions.
exact::FreeConstants<double> make_constants(const exact::PendulumStart& start) {
  exact::FreeConstants<double> f;
  const DD one(1.0), k2 = start.k * start.k, share = one + k2;
  for (int i = 0; i < 3; ++i) f.start.I[i] = 1.0, f.start.w[i] = 0.0;
  f.L = f.twice_T = one;
  f.r = one / share, f.r12 = k2 / share;
  f.a1 = f.a3 = f.La1 = f.La3 = sqrt(DD(0.5));
  f.m[0] = f.a1 * start.cn, f.m[1] = sqrt(math::scaled(share, 0.5)) * start.sn, f.m[2] = f.a3 * start.dn;
  f.k = start.k, f.kc = start.kc, f.p = start.rate;
  return f;
}

}  // namespace

const char* to_text(PendulumKind kind) {
  constexpr const char* names[] = {"rest", "swinging", "rotating", "separatrix"};
  return names[static_cast<int>(kind)];
}

Pendulum::Pendulum(const InertiaTensor& inertia, double weight, const Vector3d& arm, const Vector3d& omega,
                   const Quat& attitude)
    : inertia_(inertia), weight_(weight), arm_(arm), omega_(omega), attitude_(make_attitude(attitude)) {
  const auto require_finite = [](const char* where, const Vector3d& v) {
    for (int i = 0; i < 3; ++i)
      if (!std::isfinite(v[i])) throw InvalidInput(where, "finite", to_text(v[i]));
  };
  if (!std::isfinite(weight)) throw InvalidInput("weight", "finite", to_text(weight));
  require_finite("arm", arm), require_finite("omega", omega);
  const std::string why_not = refuse(inertia, weight, arm, omega, attitude_);
  if (!why_not.empty()) throw InvalidInput("start", "that of a plane pendulum", "another", why_not);
  set_up(exact::find_pendulum_axis(inertia.matrix(), arm, omega, attitude_).axis);
}

std::string Pendulum::refuse(const InertiaTensor& inertia, double weight, const Vector3d& arm, const Vector3d& omega,
                             const Quat& attitude) {
  if (weight == 0.0 || arm.isZero(0.0)) return "no gravity acts";
  const exact::PendulumAxis found = exact::find_pendulum_axis(inertia.matrix(), arm, omega, attitude);
  if (found.axis < 0) return found.why_not;
  return exact::carries_pendulum(inertia.matrix()(found.axis, found.axis), weight, arm, omega[found.axis])
             ? ""
             : "its rates are too small or too large for float64; choose other units";
}

void Pendulum::set_up(int axis) {
  const exact::PendulumStart start =
      exact::analyse_pendulum(inertia_.matrix()(axis, axis), weight_, arm_, omega_[axis], attitude_, axis);
  kind_ = start.kind;
  axis_[axis] = omega_[axis] < 0.0 ? -1.0 : 1.0;
  half_sine_ = start.half_sine.hi, half_cosine_ = start.half_cosine.hi;
  frequency_ = start.frequency.hi;
  rate_exponent_ = start.rate_exponent;
  longest_ = std::numeric_limits<double>::max();
  if (kind_ == PendulumKind::rest) return;
  const double fastest = std::max(start.rate.hi, (start.rate * start.k).hi);
  longest_ = std::min(longest_, std::ldexp(most_angle / fastest, -rate_exponent_));
  const exact::FreeConstants<double> f = make_constants(start);
  hyper_form_ = f.k.hi * f.k.hi > hyper_above;
  if (hyper_form_) {
    hyper_ = exact::set_up_hyper(f);
  } else {
    trig_ = exact::set_up_trig(f);
  }
  // Rows: sin(theta / 2), cos(theta / 2), theta'. Columns: a1 cn, a2 sn, a3 dn.
  const DD a1 = f.a1, a2 = f.a1 / sqrt(f.r);
  const bool swings = kind_ == PendulumKind::swinging;
  const DD rate = math::twice(start.rate);
  frame_.omega[1] = ((swings ? start.k : DD(1.0)) / a2).hi;
  frame_.omega[swings ? 5 : 3] = (DD(1.0) / a1).hi;
  frame_.omega[swings ? 6 : 8] = std::ldexp(((swings ? rate * start.k : rate) / a1).hi, rate_exponent_);
  frame_.time_scale = std::ldexp(1.0, rate_exponent_);
}

double Pendulum::period() const {
  if (kind_ == PendulumKind::rest) return 0.0;
  if (kind_ == PendulumKind::separatrix) return std::numeric_limits<double>::infinity();
  const double whole = hyper_form_ ? 2.0 / hyper_.rate_hi : 1.0 / trig_.nu_hi;   // 4 K
  return std::ldexp(kind_ == PendulumKind::rotating ? 0.5 * whole : whole, -rate_exponent_);
}

double Pendulum::frequency() const { return std::ldexp(frequency_, rate_exponent_); }

State Pendulum::at(double t) const { return exact::find_state(*this, t); }

void Pendulum::at(const double* t, std::size_t n, double* omega, double* attitude) const {
  for (std::size_t i = 0; i < n; ++i) {
    if (std::abs(t[i]) <= longest_) continue;
    throw InvalidInput("t", "finite and at most " + to_text(longest_) + " s in size", to_text(t[i]),
                       "beyond 1e25 rad the phase has no reliable digits");
  }
  const exact::FreeKernels& kernels = exact::free_kernels();
  const exact::TimeGrid grid(t, n);
  double now[3 * states_at_once];
  for (std::size_t first = 0; first < n; first += states_at_once) {
    if (first > 0) check_interrupt();
    const std::size_t count = std::min(states_at_once, n - first);
    if (kind_ == PendulumKind::rest) {
      for (std::size_t i = 0; i < count; ++i)
        now[3 * i] = half_sine_, now[3 * i + 1] = half_cosine_, now[3 * i + 2] = 0.0;
    } else if (hyper_form_) {
      kernels.hyper(hyper_, frame_, grid.piece(first, count), now, nullptr);
    } else {
      kernels.trig(trig_, frame_, grid.piece(first, count), now, nullptr);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double sine = now[3 * i], cosine = now[3 * i + 1], rate = now[3 * i + 2];
      for (int c = 0; omega != nullptr && c < 3; ++c) *omega++ = axis_[c] == 0.0 ? 0.0 : rate * axis_[c];
      if (attitude == nullptr) continue;
      // q = q0 (e sin((theta - theta0) / 2), cos((theta - theta0) / 2))
      const double s = sine * half_cosine_ - cosine * half_sine_, c = cosine * half_cosine_ + sine * half_sine_;
      const Quat q = attitude_ * Quat{axis_[0] * s, axis_[1] * s, axis_[2] * s, c};
      for (const double part : {q.x, q.y, q.z, q.w}) *attitude++ = part;
    }
  }
}

}  // namespace polhode
