#pragma once

#include "math/lanes/scalar.hpp"
#include "polhode/exact/heavy_top_kernels.hpp"

// One top at many times, for one lane type `Wide`; included once by each file that is built for one instruction set.
namespace polhode::POLHODE_ISA {

template <bool hyper, bool framed, class T>
POLHODE_INLINE void write_top(const exact::HeavyTopConstants& c, const double* t, double* omega, double* attitude) {
  const auto s = exact::evaluate_heavy_top<hyper, framed>(c, T::load(t));
  if (omega) store3(omega, s.w1, s.w2, s.w3);
  if (attitude) store4(attitude, s.x, s.y, s.z, s.w);
}

template <bool hyper, bool framed>
void top_loop(const exact::HeavyTopConstants& given, const double* t, std::size_t n, double* omega, double* attitude) {
  const auto from = [](double* rows, std::size_t at) { return rows ? rows + at : rows; };
  std::size_t i = 0;
  if (n >= Wide::width) {
    const exact::HeavyTopConstants c = given;  // of our own: the results written cannot change it
    for (; i + Wide::width <= n; i += Wide::width)
      write_top<hyper, framed, Wide>(c, t + i, from(omega, 3 * i), from(attitude, 4 * i));
  }
  for (; i < n; ++i) write_top<hyper, framed, One>(given, t + i, from(omega, 3 * i), from(attitude, 4 * i));
}

inline void heavy_top(const exact::HeavyTopConstants& c, const double* t, std::size_t n, double* omega,
                      double* attitude) {
  constexpr exact::HeavyTopLoop forms[2][2] = {{top_loop<false, false>, top_loop<false, true>},
                                               {top_loop<true, false>, top_loop<true, true>}};
  forms[c.hyper][c.framed](c, t, n, omega, attitude);
}

}  // namespace polhode::POLHODE_ISA
