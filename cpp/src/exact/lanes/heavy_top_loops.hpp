#pragma once

#include "exact/lanes/grid_loops.hpp"
#include "exact/lanes/heavy_top_setup.hpp"
#include "math/lanes/two.hpp"
#include "polhode/exact/detail/heavy_top_kernels.hpp"

// One top at many times, for one lane type `Wide`. Each file that is built for one instruction set includes this once.
namespace polhode::POLHODE_ISA {

/// The row at offset `at`, or null for an output that is not wanted.
POLHODE_INLINE double* row_of(double* rows, std::size_t at) { return rows ? rows + at : rows; }

template <class T>
POLHODE_INLINE void write_top(const exact::HeavyTopState<T>& s, double* omega, double* attitude) {
  if (omega) store3(omega, s.w1, s.w2, s.w3);
  if (attitude) store4(attitude, s.x, s.y, s.z, s.w);
}

template <bool hyper, bool framed>
void top_loop(const HeavyTopConstants& given, const double* t, std::size_t n, double* omega, double* attitude) {
  std::size_t i = 0;
  if (n >= Wide::width) {
    const HeavyTopConstants c = given;  // a copy, which writing the results cannot change
    i = in_twos(n, [&]<class T>(std::size_t k) __attribute__((always_inline)) {
      write_top(exact::evaluate_heavy_top<hyper, framed>(c, T::load(t + k)), row_of(omega, 3 * k),
                row_of(attitude, 4 * k));
    });
  }
  for (; i < n; ++i)
    write_top(exact::evaluate_heavy_top<hyper, framed>(given, One::load(t + i)), row_of(omega, 3 * i),
              row_of(attitude, 4 * i));
}

template <bool framed>
void top_trig(const HeavyTopConstants& given, const TimeGrid& grid, double* omega, double* attitude) {
  if (grid.n < TimeGrid::row) return top_loop<false, framed>(given, grid.t, grid.n, omega, attitude);
  const HeavyTopConstants c = given;  // a copy, as above
  const Rates<3> rates{c.rate_scale,
                       {c.rate_z.hi, c.rate_a.hi, c.rate_b.hi},
                       {c.rate_z.lo, c.rate_a.lo, c.rate_b.lo},
                       {c.start_z, 0.0, 0.0}};
  const auto pair = [&]<class T>(const Angle<T>(&now)[3], T(&kept)[6]) __attribute__((always_inline)) {
    const auto f = exact::heavy_top_trig(c, now[0].sine, now[0].cosine);
    kept[0] = f.a_re, kept[1] = f.a_im, kept[2] = f.b_re, kept[3] = f.b_im, kept[4] = f.inverse2, kept[5] = f.inverse;
  };
  const auto finish = [&]<class T>(const Angle<T>(&now)[3], const T(&p)[6],
                                   std::size_t k) __attribute__((always_inline)) {
    const auto transverse = exact::heavy_top_trig_transverse(c, now[0].sine, now[0].cosine);
    const exact::HeavyTopPair<T> f{p[0], p[1], p[2], p[3], p[4], p[5]};
    const auto state =
        exact::heavy_top_state<framed>(c, f, transverse, now[1].cosine, now[1].sine, now[2].cosine, now[2].sine);
    write_top(state, row_of(omega, 3 * k), row_of(attitude, 4 * k));
  };
  at_phases<6>(rates, grid, pair, finish);
}

inline void top_at(const HeavyTopConstants& c, const TimeGrid& grid, double* omega, double* attitude) {
  if (!c.hyper) return c.framed ? top_trig<true>(c, grid, omega, attitude) : top_trig<false>(c, grid, omega, attitude);
  return (c.framed ? top_loop<true, true> : top_loop<true, false>)(c, grid.t, grid.n, omega, attitude);
}

inline constexpr exact::HeavyTopKernels heavy_top_kernels = {
    .times = time_kernels, .at = &top_at, .set_up = &set_up_top};

}  // namespace polhode::POLHODE_ISA
