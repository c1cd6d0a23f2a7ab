#pragma once

#include "exact/lanes/grid_loops.hpp"
#include "math/lanes/two.hpp"
#include "polhode/exact/detail/free_kernels.hpp"

// The loops over times, for one lane type `Wide`. Each file that is built for one instruction set includes this once.
namespace polhode::POLHODE_ISA {

using exact::FreeFrame;

template <class T>
struct Rows {
  T omega[3], attitude[4];
};

/// A state in the caller's frames, from one in the working frames. A zero of omega is +0. `along`: omega is there.
template <bool along = false, class T, class Frame>
POLHODE_INLINE Rows<T> in_caller_frames(const Frame& frame, const exact::FreeState<T>& s) {
  Rows<T> rows;
  for (int c = 0; c < 3; ++c) {
    const auto* m = frame.omega + 3 * c;
    rows.omega[c] = along ? s.omega[c]
                          : madd(T(m[0]), s.omega[0], madd(T(m[1]), s.omega[1], madd(T(m[2]), s.omega[2], T(0.0))));
  }
  for (int c = 0; c < 4; ++c) {
    const auto* m = frame.attitude + 4 * c;
    rows.attitude[c] = madd(T(m[0]), s.x, madd(T(m[1]), s.y, madd(T(m[2]), s.z, T(m[3]) * s.w)));
  }
  return rows;
}

template <class T, class Body, class Frame>
POLHODE_INLINE Rows<T> rows_at(const Body& body, const Frame& frame, T t) {
  return in_caller_frames(frame, exact::evaluate(body, t * T(frame.time_scale)));
}

template <bool want_omega, bool want_attitude, class T>
POLHODE_INLINE void write(const Rows<T>& rows, double* omega, double* attitude) {
  if constexpr (want_omega) store3(omega, rows.omega[0], rows.omega[1], rows.omega[2]);
  if constexpr (want_attitude) store4(attitude, rows.attitude[0], rows.attitude[1], rows.attitude[2], rows.attitude[3]);
}

template <bool want_omega, bool want_attitude, class T, class Body>
POLHODE_INLINE void write_at(const Body& body, const FreeFrame& frame, const double* t, double* omega,
                             double* attitude) {
  write<want_omega, want_attitude>(rows_at(body, frame, T::load(t)), omega, attitude);
}

template <bool want_omega, bool want_attitude, class Body>
void loop(const Body& body_in, const FreeFrame& frame_in, const double* t, std::size_t n, double* omega,
          double* attitude) {
  std::size_t i = 0;
  if (n >= Wide::width) {
    const Body body = body_in;  // a copy, which writing the results cannot change
    const FreeFrame frame = frame_in;
    for (; i + Wide::width <= n; i += Wide::width)
      write_at<want_omega, want_attitude, Wide>(body, frame, t + i, omega + 3 * i, attitude + 4 * i);
  }
  for (; i < n; ++i)
    write_at<want_omega, want_attitude, One>(body_in, frame_in, t + i, omega + 3 * i, attitude + 4 * i);
}

/// A body whose omega comes out along the body axes: where those are the working axes in another order, up to signs.
struct AlongBodyAxes {
  exact::FreeTrig<double> body;
  int order[3] = {0, 1, 2};   ///< the working axis of each body axis
  bool found = false;         ///< false: omega is along the working axes
};

/// The entries of the frame are then powers of two, so the change is exact.
inline AlongBodyAxes along_body_axes(const exact::FreeTrig<double>& body, const FreeFrame& frame) {
  AlongBodyAxes along{.body = body};
  if (!(frame.time_scale > 0x1p-900 && frame.time_scale < 0x1p900)) return along;   // no number becomes subnormal
  for (int c = 0; c < 3; ++c) {
    const double* row = frame.omega + 3 * c;
    const int axis = row[0] != 0.0 ? 0 : row[1] != 0.0 ? 1 : 2;
    if (math::abs(row[axis]) != frame.time_scale || row[(axis + 1) % 3] != 0.0 || row[(axis + 2) % 3] != 0.0)
      return {.body = body};
    along.order[c] = axis;
    for (int i = 0; i < 5; ++i) along.body.omega[c][i] = row[axis] * body.omega[axis][i];
  }
  along.found = true;
  return along;
}

template <bool want_omega, bool want_attitude, bool along>
void trig_loop(const AlongBodyAxes& axes, const FreeFrame& frame_in, const TimeGrid& grid, double* omega,
               double* attitude) {
  const exact::FreeTrig<double> body = axes.body;  // a copy, as above
  const int order[3] = {axes.order[0], axes.order[1], axes.order[2]};
  const FreeFrame frame = frame_in;
  const Rates<2> rates{frame.time_scale, {body.nu_hi, body.kappa_hi}, {body.nu_lo, body.kappa_lo}, {body.phi0, 0.0}};
  const auto pair = [&]<class T>(const Angle<T>(&now)[2], T(&kept)[5]) __attribute__((always_inline)) {
    const auto p = exact::evaluate_pair(body, now[0].sine, now[0].cosine);
    kept[0] = p.re_a, kept[1] = p.im_a, kept[2] = p.re_b, kept[3] = p.im_b, kept[4] = p.scale;
  };
  const auto finish = [&]<class T>(const Angle<T>(&now)[2], const T(&p)[5], std::size_t k)
                          __attribute__((always_inline)) {
    const exact::FreePair<T> found{p[0], p[1], p[2], p[3], p[4]};
    const auto state = exact::evaluate(body, found, now[0].sine, now[0].cosine,
                                       now[1].sine, now[1].cosine, order);
    write<want_omega, want_attitude>(in_caller_frames<along>(frame, state), omega + 3 * k, attitude + 4 * k);
  };
  at_phases<5>(rates, grid, pair, finish);
}

template <bool want_omega, bool want_attitude>
void trig_loop(const exact::FreeTrig<double>& body, const FreeFrame& frame, const TimeGrid& grid, double* omega,
               double* attitude) {
  if (grid.n < TimeGrid::row) return loop<want_omega, want_attitude>(body, frame, grid.t, grid.n, omega, attitude);
  if constexpr (want_omega) {
    const AlongBodyAxes axes = along_body_axes(body, frame);
    if (axes.found) return trig_loop<true, want_attitude, true>(axes, frame, grid, omega, attitude);
  }
  trig_loop<want_omega, want_attitude, false>({.body = body}, frame, grid, omega, attitude);
}

inline void on_times(const exact::FreeTrig<double>& body, const FreeFrame& frame, const TimeGrid& grid, double* omega,
                     double* attitude) {
  if (omega && attitude) return trig_loop<true, true>(body, frame, grid, omega, attitude);
  if (omega) return trig_loop<true, false>(body, frame, grid, omega, attitude);
  if (attitude) return trig_loop<false, true>(body, frame, grid, omega, attitude);
}

/// In blocks and short loops like `at_phases`. A uniform grid has no advantage here.
template <bool want_omega, bool want_attitude>
void hyper_loop(const exact::FreeHyper<double>& body_in, const FreeFrame& frame_in, const TimeGrid& grid, double* omega,
                double* attitude) {
  const std::size_t whole = grid.n / Wide::width * Wide::width;
  if (whole > 0) {
    const exact::FreeHyper<double> body = body_in;  // a copy, as above
    const FreeFrame frame = frame_in;
    alignas(64) double middle[6][TimeGrid::block];
    for (std::size_t first = 0; first < whole; first += TimeGrid::block) {
      const std::size_t n = in_block(whole, first);
      in_twos(n, [&]<class T>(std::size_t k) __attribute__((always_inline)) {
        const auto p = exact::evaluate_passage(body, T::load(grid.t + first + k) * T(frame.time_scale));
        p.v.store(middle[0] + k), p.flip.store(middle[1] + k), p.E.store(middle[2] + k);
        p.sine.store(middle[3] + k), p.cosine.store(middle[4] + k), p.grown.store(middle[5] + k);
      });
      in_twos(n, [&]<class T>(std::size_t k) __attribute__((always_inline)) {
        const exact::FreePassage<T> p{T::load(middle[0] + k), T::load(middle[1] + k), T::load(middle[2] + k),
                                      T::load(middle[3] + k), T::load(middle[4] + k), T::load(middle[5] + k)};
        write<want_omega, want_attitude>(in_caller_frames(frame, exact::evaluate(body, p)), omega + 3 * (first + k),
                                         attitude + 4 * (first + k));
      });
    }
  }
  for (std::size_t i = whole; i < grid.n; ++i)
    write_at<want_omega, want_attitude, One>(body_in, frame_in, grid.t + i, omega + 3 * i, attitude + 4 * i);
}

inline void on_times(const exact::FreeHyper<double>& body, const FreeFrame& frame, const TimeGrid& grid, double* omega,
                     double* attitude) {
  if (omega && attitude) return hyper_loop<true, true>(body, frame, grid, omega, attitude);
  if (omega) return hyper_loop<true, false>(body, frame, grid, omega, attitude);
  if (attitude) return hyper_loop<false, true>(body, frame, grid, omega, attitude);
}

}  // namespace polhode::POLHODE_ISA
