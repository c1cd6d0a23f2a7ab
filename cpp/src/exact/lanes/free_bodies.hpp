#pragma once

#include "exact/lanes/free_loops.hpp"
#include "polhode/exact/free_setup.hpp"

// Many bodies at once: the set-up, too, runs in lanes.
namespace polhode::POLHODE_ISA {

using exact::FreeFrameOf;
using exact::FreeStarts;
using exact::FreeTrig;

POLHODE_INLINE double lane(One a, int) { return a.v; }
POLHODE_INLINE unsigned bits(bool mask) { return mask; }
template <class T>
POLHODE_INLINE double lane(T a, int i) {
  double all[T::width];
  a.store(all);
  return all[i];
}

/// What double-double cannot tell of the separatrix is told exactly, one lane at a time: rare.
template <class M, class T>
POLHODE_INLINE void make_exact(M lost, math::DoubleDouble<T>& distance, T I1, T I2, T I3, T w1, T w3) {
  const unsigned which = bits(lost);
  if (which == 0) return;
  double hi[T::width], lo[T::width];
  for (int i = 0; i < T::width; ++i) {
    hi[i] = lane(distance.hi, i), lo[i] = lane(distance.lo, i);
    if ((which >> i & 1u) == 0) continue;
    const auto d = exact::separatrix_distance_exact(lane(I1, i), lane(I2, i), lane(I3, i), lane(w1, i), lane(w3, i));
    hi[i] = d.hi, lo[i] = d.lo;
  }
  distance = {T::load(hi), T::load(lo)};
}

template <class T>
struct Bodies {
  FreeTrig<T> trig;
  FreeFrameOf<T> frame;
  unsigned left;  ///< one bit a lane: not for this form
};

template <class T>
struct Turn {
  T x, y, z, w;
};

template <class T>
POLHODE_INLINE Turn<T> product(Turn<T> a, Turn<T> b) {
  return {madd(a.w, b.x, madd(a.x, b.w, madd(a.y, b.z, -(a.z * b.y)))), madd(a.w, b.y, madd(a.y, b.w, madd(a.z, b.x, -(a.x * b.z)))),
          madd(a.w, b.z, madd(a.z, b.w, madd(a.x, b.y, -(a.y * b.x)))), madd(a.w, b.w, -madd(a.x, b.x, madd(a.y, b.y, a.z * b.z)))};
}

template <class T>
POLHODE_INLINE Bodies<T> set_up_bodies(const T (&moments)[3], const T (&omega)[3], const T (&attitude)[4]) {
  using math::abs, math::max, math::select, math::sqrt;
  const T zero(0.0), one(1.0);
  Bodies<T> bodies;
  const T fastest = max(abs(omega[0]), max(abs(omega[1]), abs(omega[2])));
  const T largest = max(moments[0], max(moments[1], moments[2]));
  const auto usual = (fastest > T(1e-290)) & (fastest < T(1e290)) & (largest > T(1e-290)) & (largest < T(1e290));
  const T unit = select(usual, power_of_two_below(fastest), one), unit_I = select(usual, power_of_two_below(largest), one);
  exact::FreeStart<T> start;
  for (int a = 0; a < 3; ++a) {
    start.I[a] = select(usual, moments[a] / unit_I, one);
    start.w[a] = select(usual, omega[a] / unit, one);
    for (int c = 0; c < 3; ++c) start.M[a][c] = a == c ? one : zero;
  }
  const exact::FreeConstants<T> f = exact::analyse(start);
  const auto& s = f.start;
  const auto on_unstable_axis = (s.w[0] == zero) & (s.w[2] == zero) & ((s.I[0] < s.I[1]) | (s.I[1] < s.I[0])) &
                                ((s.I[1] < s.I[2]) | (s.I[2] < s.I[1]));
  const unsigned all = (1u << T::width) - 1u;
  bodies.left = bits(on_unstable_axis) | bits(f.k.hi * f.k.hi > T(0.97)) | (bits(usual) ^ all);

  bodies.trig = exact::set_up_trig(f);
  bodies.frame.time_scale = unit;
  const auto first = exact::evaluate(bodies.trig, zero);
  const T v[3] = {first.x, first.y, first.z};
  T turned[3];
  for (int c = 0; c < 3; ++c) turned[c] = madd(s.M[c][0], v[0], madd(s.M[c][1], v[1], s.M[c][2] * v[2]));
  Turn<T> left = product<T>({attitude[0], attitude[1], attitude[2], attitude[3]}, {-turned[0], -turned[1], -turned[2], first.w});
  const T scale = one / sqrt(madd(left.x, left.x, madd(left.y, left.y, madd(left.z, left.z, left.w * left.w))));
  left = {left.x * scale, left.y * scale, left.z * scale, left.w * scale};
  for (int i = 0; i < 4; ++i) {
    const Turn<T> q = i == 3 ? left : product<T>(left, {s.M[0][i % 3], s.M[1][i % 3], s.M[2][i % 3], zero});
    bodies.frame.attitude[i] = q.x;
    bodies.frame.attitude[4 + i] = q.y;
    bodies.frame.attitude[8 + i] = q.z;
    bodies.frame.attitude[12 + i] = q.w;
  }
  for (int c = 0; c < 3; ++c)
    for (int a = 0; a < 3; ++a) bodies.frame.omega[3 * c + a] = s.M[c][a] * unit;
  return bodies;
}

/// One column of an array of rows, T::width rows from the row `first`, the last one repeated where they end.
template <class T>
POLHODE_INLINE T column(const double* rows, int width, int which, std::size_t first, std::size_t n) {
  double values[T::width];
  for (std::size_t i = 0; i < T::width; ++i) {
    const std::size_t row = first + i < n ? first + i : n - 1;
    values[i] = rows[row * static_cast<std::size_t>(width) + static_cast<std::size_t>(which)];
  }
  return T::load(values);
}

template <class T>
Bodies<T> read_bodies(FreeStarts starts, std::size_t first, std::size_t n) {
  T moments[3], omega[3], attitude[4];
  for (int a = 0; a < 3; ++a) moments[a] = column<T>(starts.moments, 3, a, first, n), omega[a] = column<T>(starts.omega, 3, a, first, n);
  for (int a = 0; a < 4; ++a) attitude[a] = column<T>(starts.attitude, 4, a, first, n);
  return set_up_bodies<T>(moments, omega, attitude);
}

inline std::size_t once(FreeStarts starts, const double* t, std::size_t n, double* omega, double* attitude, std::size_t* left) {
  constexpr std::size_t width = Wide::width;
  std::size_t count = 0;
  for (std::size_t first = 0; first < n; first += width) {
    const Bodies<Wide> bodies = read_bodies<Wide>(starts, first, n);
    const Rows<Wide> rows = rows_at(bodies.trig, bodies.frame, column<Wide>(t, 1, 0, first, n));
    const std::size_t here = n - first < width ? n - first : width;
    double w[3 * width], q[4 * width];
    store3(w, rows.omega[0], rows.omega[1], rows.omega[2]);
    store4(q, rows.attitude[0], rows.attitude[1], rows.attitude[2], rows.attitude[3]);
    if (omega) for (std::size_t i = 0; i < 3 * here; ++i) omega[3 * first + i] = w[i];
    if (attitude) for (std::size_t i = 0; i < 4 * here; ++i) attitude[4 * first + i] = q[i];
    for (std::size_t i = 0; i < here; ++i)
      if (bodies.left >> i & 1u) left[count++] = first + i;
  }
  return count;
}

inline std::size_t set_up(FreeStarts starts, std::size_t n, FreeTrig<double>* trig, FreeFrame* frames, std::size_t* left) {
  constexpr std::size_t width = Wide::width;
  std::size_t count = 0;
  for (std::size_t first = 0; first < n; first += width) {
    const Bodies<Wide> bodies = read_bodies<Wide>(starts, first, n);
    const std::size_t here = n - first < width ? n - first : width;
    // Both structs are numbers of one type in a row: field by field, lane by lane.
    const auto* from_trig = reinterpret_cast<const double*>(&bodies.trig);
    const auto* from_frame = reinterpret_cast<const double*>(&bodies.frame);
    for (std::size_t i = 0; i < here; ++i) {
      auto* to_trig = reinterpret_cast<double*>(trig + first + i);
      auto* to_frame = reinterpret_cast<double*>(frames + first + i);
      for (std::size_t k = 0; k < sizeof(FreeTrig<double>) / sizeof(double); ++k) to_trig[k] = from_trig[k * width + i];
      for (std::size_t k = 0; k < sizeof(FreeFrame) / sizeof(double); ++k) to_frame[k] = from_frame[k * width + i];
      if (bodies.left >> i & 1u) left[count++] = first + i;
    }
  }
  return count;
}

inline constexpr exact::FreeKernels kernels = {&at_times<FreeTrig<double>>, &at_times<exact::FreeHyper<double>>, &once, &set_up};

}  // namespace polhode::POLHODE_ISA
