#pragma once

#include "exact/lanes/free_loops.hpp"
#include "polhode/math/detail/dd_functions.hpp"

// A free body in slowed time: torque -c I omega. With s = (1 - e^-ct) / c the attitude is the free body's at s, and
// omega is e^-ct times the free body's at s (docs/damped_free.md). s is a double-double, so that |omega0| s may be large.
namespace polhode::POLHODE_ISA {

using math::DoubleDouble;

/// The slowed time and e^-ct.
template <class T>
struct SlowedTime {
  DoubleDouble<T> s;
  T decay;
};

/// e^y - 1 with a relative error of 1e-30, |y| <= 0.022, then doubled four times: e^16y - 1. The terms from y^7 on are
/// below 2e-14 of the first, so plain numbers hold them.
template <class T>
POLHODE_INLINE DoubleDouble<T> expm1_of_16(DoubleDouble<T> y) {
  constexpr double c[] = {1.0 / 5040,      1.0 / 40320,      1.0 / 362880,     1.0 / 3628800,
                          1.0 / 39916800., 1.0 / 479001600., 1.0 / 6227020800.};
  DoubleDouble<T> e(math::polynomial(c, y.hi));
  for (int i = 6; i >= 1; --i) {
    const double* term = math::inverse_factorial_dd[i];
    e = math::plus(DoubleDouble<T>(T(term[0]), T(term[1])), e * y);
  }
  e = e * y;
  for (int i = 0; i < 4; ++i) e = math::plus(math::twice(e), e * e);   // (e^y)^2 - 1 = 2 e + e^2
  return e;
}

/// |c t| <= 709, beyond which t is taken as if it were. `c` is not 0.
template <class T>
POLHODE_INLINE SlowedTime<T> slow_down(T t, T c) {
  using math::two_prod;   // and that of One
  using N = DoubleDouble<T>;
  const T limit = T(709.0) / abs(c);
  t = math::max(-limit, math::min(limit, t));
  const auto x = two_prod(t, c);
  const auto tiny = abs(x.hi) < T(1e-20);
  const T n = rint(x.hi * T(1.4426950408889634));
  const N ln2(T(0.6931471805599453), T(2.3190468138462996e-17));
  const N r = N(x) - ln2 * N(n);
  const N e = expm1_of_16(math::scaled(-r, T(0x1p-4)));
  // 2^-n in two factors: n may be 1023.
  const T half = rint(T(0.5) * n), first = power_of_two(-half), second = power_of_two(half - n);
  const N decay = math::scaled(math::scaled(N(T(1.0)) + e, first), second);
  const N lost = math::select(abs(n) < T(0.5), -e, N(T(1.0)) - decay);
  SlowedTime<T> out;
  // (1 - e^-x) / c = t - t x / 2 + ...; the product x has no low part where it is tiny.
  out.s = math::select(tiny, N(math::two_sum(t, T(-0.5) * t * x.hi)), lost / N(c));
  out.decay = select(tiny, T(1.0), decay.hi);
  return out;
}

inline void slow(double c, const double* t, std::size_t n, double* hi, double* lo, double* decay) {
  for (std::size_t i = 0; i < n; ++i) {
    const SlowedTime<One> slowed = slow_down(One(t[i]), One(c));
    hi[i] = slowed.s.hi.v, lo[i] = slowed.s.lo.v, decay[i] = slowed.decay.v;
  }
}

template <bool want_omega, bool want_attitude, class T, class Body>
POLHODE_INLINE void write_damped(const Body& body, const FreeFrame& frame, double c, const double* t, double* omega,
                                 double* attitude) {
  const SlowedTime<T> slowed = slow_down(T::load(t), T(c));
  const auto s = math::scaled(slowed.s, T(frame.time_scale));
  Rows<T> rows = in_caller_frames(frame, exact::evaluate(body, s.hi, s.lo));
  for (int i = 0; i < 3; ++i) rows.omega[i] = rows.omega[i] * slowed.decay;
  write<want_omega, want_attitude>(rows, omega, attitude);
}

template <bool want_omega, bool want_attitude, class Body>
void damped_loop(const Body& body_in, const FreeFrame& frame_in, double c, const double* t, std::size_t n,
                 double* omega, double* attitude) {
  const Body body = body_in;   // copies, which writing the results cannot change
  const FreeFrame frame = frame_in;
  std::size_t i = in_twos(n, [&]<class T>(std::size_t k) __attribute__((always_inline)) {
    write_damped<want_omega, want_attitude, T>(body, frame, c, t + k, omega + 3 * k, attitude + 4 * k);
  });
  for (; i < n; ++i)
    write_damped<want_omega, want_attitude, One>(body, frame, c, t + i, omega + 3 * i, attitude + 4 * i);
}

template <class Body>
void at_slowed_times(const Body& body, const FreeFrame& frame, double c, const double* t, std::size_t n, double* omega,
                     double* attitude) {
  if (omega && attitude) return damped_loop<true, true>(body, frame, c, t, n, omega, attitude);
  if (omega) return damped_loop<true, false>(body, frame, c, t, n, omega, attitude);
  if (attitude) return damped_loop<false, true>(body, frame, c, t, n, omega, attitude);
}

}  // namespace polhode::POLHODE_ISA
