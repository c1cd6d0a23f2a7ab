#pragma once

#include <limits>

#include "exact/lanes/free_loops.hpp"
#include "exact/lanes/gyrostat_coefficients.hpp"
#include "polhode/exact/detail/gyrostat_kernels.hpp"

// One gyrostat at many times, for one lane type `Wide`. Each file that is built for one instruction set includes this
// once.
namespace polhode::POLHODE_ISA::gyrostat {

/// The exact cases: omega constant, or constant plus a multiple of the momentum. Returns false for all others.
inline bool set_up_constant_rates(const Form& f, GyrostatSeries& out, exact::GyrostatMotion& motion) {
  const double(&J)[3] = f.start.J;
  const DD(&w)[3] = f.start.w;
  DD moved(0.0), speed(0.0);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    moved = moved + squared(f.M[j] * w[k] - f.M[k] * w[j]);
    speed = speed + squared(w[i]);
  }
  const bool rest = speed.hi == 0.0;
  if (rest || root_of(moved).hi <= 0x1p-98 * f.L.hi * root_of(speed).hi) {
    DD m[3] = {DD(0.0), DD(0.0), DD(1.0)};
    if (!rest)
      for (int i = 0; i < 3; ++i) m[i] = w[i] / root_of(speed);
    set_constant_rates(out, f, DD(0.0), w, m);
    for (int i = 0; i < 3; ++i) out.rate[i] = {}, out.rate[i].even_cos[0] = w[i].hi;
    motion.kind = rest ? GyrostatKind::rest : GyrostatKind::steady;
    return true;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const bool sphere = J[0] == J[1] && J[1] == J[2];
    if (!sphere && (J[j] != J[k] || f.has_rotor[j] || f.has_rotor[k])) continue;
    DD c[3] = {DD(0.0), DD(0.0), DD(0.0)};
    if (sphere) {
      for (int a = 0; a < 3; ++a) c[a] = -f.g[a];
    } else {
      c[i] = w[i] - f.A[j] * f.M[i];
    }
    set_constant_rates(out, f, f.A[j], c, f.m);
    motion.kind = GyrostatKind::precession;
    motion.period = 1.0 / out.nu_hi;
    return true;
  }
  return false;
}

inline void set_up(const exact::GyrostatStart& start, GyrostatSeries& out, exact::GyrostatMotion& motion) {
  out = {}, motion = {};
  const Form f(start);
  if (set_up_constant_rates(f, out, motion)) return;
  const Roots roots(f);
  const int third = roots.pair ? 0 : 2, fourth = roots.pair ? 0 : 3;
  const Eigenvector vectors[4] = {
      {f, roots.real[0]}, {f, roots.real[1]}, {f, roots.real[third]}, {f, roots.real[fourth]}};
  const Pairing pairing(f, roots, vectors);
  const Solution s = solve(f, pairing, vectors[pairing.a], vectors[pairing.b]);
  motion.kind = s.nome.hi < 0.0 ? GyrostatKind::single : GyrostatKind::paired;
  if (s.trig) {
    constexpr int J = exact::gyrostat_trig_terms;
    Complex<DD> weights[2 * J + 1];
    Complex<DD>* const c = weights + J;
    const Complex<DD> one{DD(1.0), DD(0.0)}, y = one / s.x;
    c[0] = one;
    DD q(1.0);
    for (int j = 1; j <= J; ++j) {
      if (j % 2 == 0) q = q * s.nome;  // from floor((j-1)^2/4) to floor(j^2/4) the power of Q grows by floor(j/2)
      c[j] = q * (c[j - 1] * s.x), c[-j] = q * (c[1 - j] * y);
    }
    set_trig(out, f, c, s.bE, s.bO);
    set_cycles(out.nu_hi, out.nu_lo, s.nu);
    set_cycles(out.kappa_hi, out.kappa_lo, s.kappa);
    motion.period = 1.0 / out.nu_hi;
  } else {
    set_hyper(out, f, s);
    motion.period = (s.nome.hi < 0.0 ? 2.0 : 1.0) / math::abs(out.nu_hi);
    if (out.nome == 0.0) {
      motion.kind = GyrostatKind::separatrix;
      motion.period = std::numeric_limits<double>::infinity();
    }
  }
}

template <class T>
POLHODE_INLINE void write_rows(const exact::FreeState<T>& s, const FreeFrame& frame, double* omega, double* attitude) {
  const Rows<T> rows = in_caller_frames(frame, s);
  if (omega) write<true, false>(rows, omega, nullptr);
  if (attitude) write<false, true>(rows, nullptr, attitude);
}

POLHODE_INLINE double* row_at(double* rows, std::size_t offset) { return rows ? rows + offset : rows; }

inline void loop(const GyrostatSeries& given, const FreeFrame& frame_in, const double* t, std::size_t n, double* omega,
                 double* attitude) {
  std::size_t i = 0;
  if (n >= Wide::width) {
    const GyrostatSeries body = given;  // a copy, which writing the results cannot change
    const FreeFrame frame = frame_in;
    i = in_twos(n, [&]<class T>(std::size_t k) __attribute__((always_inline)) {
      write_rows(exact::evaluate_gyrostat(body, T::load(t + k) * T(frame.time_scale)), frame, row_at(omega, 3 * k),
                 row_at(attitude, 4 * k));
    });
  }
  for (; i < n; ++i)
    write_rows(exact::evaluate_gyrostat(given, One::load(t + i) * One(frame_in.time_scale)), frame_in,
               row_at(omega, 3 * i), row_at(attitude, 4 * i));
}

inline void at(const GyrostatSeries& given, const FreeFrame& frame_in, const TimeGrid& grid, double* omega,
               double* attitude) {
  if (given.hyper || grid.n < TimeGrid::row) return loop(given, frame_in, grid.t, grid.n, omega, attitude);
  const GyrostatSeries body = given;  // a copy, as above
  const FreeFrame frame = frame_in;
  const POLHODE_ISA::Rates<2> rates{frame.time_scale, {body.nu_hi, body.kappa_hi}, {body.nu_lo, body.kappa_lo},
                                    {0.0, 0.0}};
  const auto pair = [&]<class T>(const Angle<T>(&now)[2], T(&kept)[5]) __attribute__((always_inline)) {
    const auto p = exact::gyrostat_trig_pair(body, now[0].sine, now[0].cosine);
    kept[0] = p.re_a, kept[1] = p.im_a, kept[2] = p.re_b, kept[3] = p.im_b, kept[4] = p.scale;
  };
  const auto finish = [&]<class T>(const Angle<T>(&now)[2], const T(&p)[5], std::size_t k)
                          __attribute__((always_inline)) {
    const exact::FreePair<T> found{p[0], p[1], p[2], p[3], p[4]};
    const auto state = exact::gyrostat_trig_state(body, found, now[0].sine, now[0].cosine, now[1].sine, now[1].cosine);
    write_rows(state, frame, row_at(omega, 3 * k), row_at(attitude, 4 * k));
  };
  at_phases<5>(rates, grid, pair, finish);
}

}  // namespace polhode::POLHODE_ISA::gyrostat

namespace polhode::POLHODE_ISA {
inline constexpr exact::GyrostatKernels gyrostat_kernels = {
    .times = time_kernels, .at = &gyrostat::at, .set_up = &gyrostat::set_up};
}  // namespace polhode::POLHODE_ISA
