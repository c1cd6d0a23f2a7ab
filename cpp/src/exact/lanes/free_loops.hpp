#pragma once

#include "math/lanes/scalar.hpp"
#include "polhode/exact/free_kernels.hpp"

// The loops themselves, for one lane type `Wide`; included once by each file that is built for one instruction set.
namespace polhode::POLHODE_ISA {

using exact::FreeFrame;

template <class T>
struct Rows {
  T omega[3], attitude[4];
};

template <class T, class Body, class Frame>
POLHODE_INLINE Rows<T> rows_at(const Body& body, const Frame& frame, T t) {
  const exact::FreeState<T> s = exact::evaluate(body, t * T(frame.time_scale));
  Rows<T> rows;
  for (int c = 0; c < 3; ++c) {
    const auto* m = frame.omega + 3 * c;
    rows.omega[c] = madd(T(m[0]), s.omega[0], madd(T(m[1]), s.omega[1], T(m[2]) * s.omega[2]));
  }
  for (int c = 0; c < 4; ++c) {
    const auto* m = frame.attitude + 4 * c;
    rows.attitude[c] = madd(T(m[0]), s.x, madd(T(m[1]), s.y, madd(T(m[2]), s.z, T(m[3]) * s.w)));
  }
  return rows;
}

template <bool want_omega, bool want_attitude, class T, class Body>
POLHODE_INLINE void write_at(const Body& body, const FreeFrame& frame, const double* t, double* omega, double* attitude) {
  const Rows<T> rows = rows_at(body, frame, T::load(t));
  if constexpr (want_omega) store3(omega, rows.omega[0], rows.omega[1], rows.omega[2]);
  if constexpr (want_attitude) store4(attitude, rows.attitude[0], rows.attitude[1], rows.attitude[2], rows.attitude[3]);
}

template <bool want_omega, bool want_attitude, class Body>
void loop(const Body& body_in, const FreeFrame& frame_in, const double* t, std::size_t n, double* omega, double* attitude) {
  std::size_t i = 0;
  if (n >= Wide::width) {
    const Body body = body_in;  // of our own: the results written cannot change it
    const FreeFrame frame = frame_in;
    for (; i + Wide::width <= n; i += Wide::width)
      write_at<want_omega, want_attitude, Wide>(body, frame, t + i, omega + 3 * i, attitude + 4 * i);
  }
  for (; i < n; ++i)
    write_at<want_omega, want_attitude, One>(body_in, frame_in, t + i, omega + 3 * i, attitude + 4 * i);
}

template <class Body>
void at_times(const Body& body, const FreeFrame& frame, const double* t, std::size_t n, double* omega, double* attitude) {
  if (omega && attitude) return loop<true, true>(body, frame, t, n, omega, attitude);
  if (omega) return loop<true, false>(body, frame, t, n, omega, attitude);
  if (attitude) return loop<false, true>(body, frame, t, n, omega, attitude);
}

}  // namespace polhode::POLHODE_ISA
