#pragma once

#include "exact/lanes/damped_loops.hpp"
#include "exact/lanes/free_loops.hpp"
#include "exact/lanes/single_loops.hpp"
#include "math/lanes/two.hpp"
#include "polhode/exact/detail/free_setup_hyper.hpp"

// Many bodies at once: their set-up also runs in lanes.
namespace polhode::POLHODE_ISA {

using exact::FreeFrameOf;
using exact::FreeStarts;
using exact::FreeTrig;

POLHODE_INLINE double lane(One a, int) { return a.v; }
POLHODE_INLINE unsigned bits(bool mask) { return mask; }
POLHODE_INLINE unsigned bits(TwoMask mask) { return bits(mask.first) | bits(mask.second) << Wide::width; }
template <class T>
POLHODE_INLINE double lane(T a, int i) {
  double all[T::width];
  a.store(all);
  return all[i];
}

/// Recomputes exactly, one lane at a time, the distances from the separatrix that double-double loses. This is rare.
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
struct LaneQuat {
  T x, y, z, w;
};

template <class T>
POLHODE_INLINE LaneQuat<T> product(LaneQuat<T> a, LaneQuat<T> b) {
  return {madd(a.w, b.x, madd(a.x, b.w, madd(a.y, b.z, -(a.z * b.y)))),
          madd(a.w, b.y, madd(a.y, b.w, madd(a.z, b.x, -(a.x * b.z)))),
          madd(a.w, b.z, madd(a.z, b.w, madd(a.x, b.y, -(a.y * b.x)))),
          madd(a.w, b.w, -madd(a.x, b.x, madd(a.y, b.y, a.z * b.z)))};
}

/// A block of bodies, as needed by both forms of the series.
template <class T>
struct Block {
  exact::FreeConstants<T> constants;
  T unit, attitude[4];
  unsigned neither, hyper;  ///< bits of lanes: left to FreeMotion; for the hyperbolic form
};

/// Row numbers for lanes: entries of `index`, or all rows, from `first` on. The last one repeats at the end.
struct Pick {
  const std::size_t* index;
  std::size_t first, n;
  /// Whether the lanes are rows that follow one another.
  POLHODE_INLINE bool in_line(std::size_t width) const { return !index && first + width <= n; }
  POLHODE_INLINE std::size_t operator()(std::size_t i) const {
    const std::size_t k = first + i < n ? first + i : n - 1;
    return index ? index[k] : k;
  }
};

template <class T>
POLHODE_INLINE T column(const double* rows, std::size_t width, std::size_t which, Pick pick) {
  double values[T::width];
  for (std::size_t i = 0; i < T::width; ++i) values[i] = rows[pick(i) * width + which];
  return T::load(values);
}

template <class T>
POLHODE_INLINE Block<T> read_block(FreeStarts starts, Pick pick) {
  using math::abs, math::max, math::select;
  const T zero(0.0), one(1.0);
  Block<T> block;
  T moments[3], omega[3];
  T(&q)[4] = block.attitude;
  if (pick.in_line(T::width)) {
    load3(starts.moments + 3 * pick.first, moments[0], moments[1], moments[2]);
    load3(starts.omega + 3 * pick.first, omega[0], omega[1], omega[2]);
    load4(starts.attitude + 4 * pick.first, q[0], q[1], q[2], q[3]);
  } else {
    for (std::size_t a = 0; a < 3; ++a)
      moments[a] = column<T>(starts.moments, 3, a, pick), omega[a] = column<T>(starts.omega, 3, a, pick);
    for (std::size_t a = 0; a < 4; ++a) q[a] = column<T>(starts.attitude, 4, a, pick);
  }
  const T fastest = max(abs(omega[0]), max(abs(omega[1]), abs(omega[2])));
  const T largest = max(moments[0], max(moments[1], moments[2]));
  const auto usual = (fastest > T(1e-290)) & (fastest < T(1e290)) & (largest > T(1e-290)) & (largest < T(1e290));
  block.unit = select(usual, power_of_two_below(fastest), one);
  const T unit_I = select(usual, power_of_two_below(largest), one);
  exact::FreeStart<T> start;
  for (int a = 0; a < 3; ++a) {
    start.I[a] = select(usual, moments[a] / unit_I, one);
    start.w[a] = select(usual, omega[a] / block.unit, one);
    for (int c = 0; c < 3; ++c) start.M[a][c] = a == c ? one : zero;
  }
  block.constants = exact::analyse(start);
  const exact::FreeConstants<T>& f = block.constants;
  const auto& s = f.start;
  const auto on_unstable_axis = (s.w[0] == zero) & (s.w[2] == zero) & ((s.I[0] < s.I[1]) | (s.I[1] < s.I[0])) &
                                ((s.I[1] < s.I[2]) | (s.I[2] < s.I[1]));
  const unsigned all = (1u << T::width) - 1u;
  block.neither = bits(on_unstable_axis) | (bits(usual) ^ all) | bits(f.kc.hi < T(1e-140));
  block.hyper = bits(f.k.hi * f.k.hi > T(0.97)) & ~block.neither;
  return block;
}

template <class T>
POLHODE_INLINE FreeFrameOf<T> make_frame(const Block<T>& block, const exact::FreeState<T>& first) {
  using math::sqrt;
  const auto& s = block.constants.start;
  FreeFrameOf<T> frame;
  frame.time_scale = block.unit;
  const T v[3] = {first.x, first.y, first.z};
  T rotated[3];
  for (int c = 0; c < 3; ++c) rotated[c] = madd(s.M[c][0], v[0], madd(s.M[c][1], v[1], s.M[c][2] * v[2]));
  const T* q0 = block.attitude;
  LaneQuat<T> left = product<T>({q0[0], q0[1], q0[2], q0[3]}, {-rotated[0], -rotated[1], -rotated[2], first.w});
  const T scale = T(1.0) / sqrt(madd(left.x, left.x, madd(left.y, left.y, madd(left.z, left.z, left.w * left.w))));
  left = {left.x * scale, left.y * scale, left.z * scale, left.w * scale};
  for (int i = 0; i < 4; ++i) {
    const LaneQuat<T> q = i == 3 ? left : product<T>(left, {s.M[0][i % 3], s.M[1][i % 3], s.M[2][i % 3], T(0.0)});
    frame.attitude[i] = q.x;
    frame.attitude[4 + i] = q.y;
    frame.attitude[8 + i] = q.z;
    frame.attitude[12 + i] = q.w;
  }
  for (int c = 0; c < 3; ++c)
    for (int a = 0; a < 3; ++a) frame.omega[3 * c + a] = s.M[c][a] * block.unit;
  return frame;
}

/// Writes the states of a block to the rows of `pick` whose bit is set in `rows_wanted`.
template <class T, class Body>
POLHODE_INLINE void write_block(const Body& body, const Block<T>& block, const double* t, Pick pick,
                                unsigned rows_wanted, double* omega, double* attitude) {
  const FreeFrameOf<T> frame = make_frame(block, exact::evaluate(body, T(0.0)));
  const bool in_line = pick.in_line(T::width);
  const Rows<T> rows = rows_at(body, frame, in_line ? T::load(t + pick.first) : column<T>(t, 1, 0, pick));
  if (in_line && ~rows_wanted << (8 * sizeof(unsigned) - T::width) == 0) {
    if (omega) store3(omega + 3 * pick.first, rows.omega[0], rows.omega[1], rows.omega[2]);
    if (attitude)
      store4(attitude + 4 * pick.first, rows.attitude[0], rows.attitude[1], rows.attitude[2], rows.attitude[3]);
    return;
  }
  double w[3 * T::width], q[4 * T::width];
  store3(w, rows.omega[0], rows.omega[1], rows.omega[2]);
  store4(q, rows.attitude[0], rows.attitude[1], rows.attitude[2], rows.attitude[3]);
  for (std::size_t i = 0; i < T::width && pick.first + i < pick.n; ++i) {
    if ((rows_wanted >> i & 1u) == 0) continue;
    const std::size_t row = pick(i);
    if (omega) for (std::size_t k = 0; k < 3; ++k) omega[3 * row + k] = w[3 * i + k];
    if (attitude) for (std::size_t k = 0; k < 4; ++k) attitude[4 * row + k] = q[4 * i + k];
  }
}

inline void once_hyper(FreeStarts starts, const double* t, const std::size_t* which, std::size_t n, double* omega,
                       double* attitude) {
  for (std::size_t first = 0; first < n; first += Two::width) {
    const Pick pick{which, first, n};
    const Block<Two> block = read_block<Two>(starts, pick);
    write_block(exact::set_up_hyper(block.constants), block, t, pick, ~0u, omega, attitude);
  }
}

template <class T>
inline std::size_t once_in(FreeStarts starts, const double* t, std::size_t n, double* omega, double* attitude,
                           std::size_t* left) {
  constexpr std::size_t queue_size = 64;
  std::size_t count = 0, hyper[queue_size], waiting = 0;
  for (std::size_t first = 0; first < n; first += T::width) {
    const Pick pick{nullptr, first, n};
    const Block<T> block = read_block<T>(starts, pick);
    write_block(exact::set_up_trig(block.constants), block, t, pick, ~(block.neither | block.hyper), omega, attitude);
    for (std::size_t i = 0; i < T::width && first + i < n; ++i) {
      if (block.neither >> i & 1u) left[count++] = first + i;
      if (block.hyper >> i & 1u) hyper[waiting++] = first + i;
    }
    if (waiting + T::width > queue_size || first + T::width >= n) {
      once_hyper(starts, t, hyper, waiting, omega, attitude);
      waiting = 0;
    }
  }
  return count;
}

template <class T>
inline std::size_t set_up_in(FreeStarts starts, std::size_t n, FreeTrig<double>* trig, FreeFrame* frames,
                             std::size_t* left) {
  constexpr std::size_t width = T::width;
  std::size_t count = 0;
  for (std::size_t first = 0; first < n; first += width) {
    const Pick pick{nullptr, first, n};
    const Block<T> block = read_block<T>(starts, pick);
    const FreeTrig<T> body = exact::set_up_trig(block.constants);
    const FreeFrameOf<T> frame = make_frame(block, exact::evaluate(body, T(0.0)));
    // Both structs consist of numbers of one type, which are copied lane by lane.
    const auto* from_trig = reinterpret_cast<const double*>(&body);
    const auto* from_frame = reinterpret_cast<const double*>(&frame);
    for (std::size_t i = 0; i < width && first + i < n; ++i) {
      auto* to_trig = reinterpret_cast<double*>(trig + first + i);
      auto* to_frame = reinterpret_cast<double*>(frames + first + i);
      for (std::size_t k = 0; k < sizeof(FreeTrig<double>) / sizeof(double); ++k) to_trig[k] = from_trig[k * width + i];
      for (std::size_t k = 0; k < sizeof(FreeFrame) / sizeof(double); ++k) to_frame[k] = from_frame[k * width + i];
      if ((block.neither | block.hyper) >> i & 1u) left[count++] = first + i;
    }
  }
  return count;
}

// A few bodies take one register: two would compute unused states.
inline std::size_t once(FreeStarts starts, const double* t, std::size_t n, double* omega, double* attitude,
                        std::size_t* left) {
  return (n > Wide::width ? once_in<Two> : once_in<Wide>)(starts, t, n, omega, attitude, left);
}
inline std::size_t set_up(FreeStarts starts, std::size_t n, FreeTrig<double>* trig, FreeFrame* frames,
                          std::size_t* left) {
  return (n > Wide::width ? set_up_in<Two> : set_up_in<Wide>)(starts, n, trig, frames, left);
}

/// One body, for FreeMotion: the constants and the form of the series that it needs.
inline void prepare(const exact::FreeStart<double>& start, exact::FreeConstants<double>& constants,
                    FreeTrig<double>& trig, exact::FreeHyper<double>& hyper) {
  static_assert(sizeof(exact::FreeConstants<One>) == sizeof(exact::FreeConstants<double>));
  exact::FreeStart<One> s;
  __builtin_memcpy(static_cast<void*>(&s), &start, sizeof s);
  const exact::FreeConstants<One> f = exact::analyse(s);
  __builtin_memcpy(static_cast<void*>(&constants), &f, sizeof f);
  if (f.k.hi.v * f.k.hi.v > 0.97) {
    const exact::FreeHyper<One> h = exact::set_up_hyper(f);
    __builtin_memcpy(static_cast<void*>(&hyper), &h, sizeof h);
  } else {
    const FreeTrig<One> g = exact::set_up_trig(f);
    __builtin_memcpy(static_cast<void*>(&trig), &g, sizeof g);
  }
}

inline constexpr exact::FreeKernels free_kernels = {
    .times = time_kernels, .trig = &on_times, .hyper = &on_times, .prepare = &prepare};
inline constexpr exact::FreeBatchKernels free_batch_kernels = {
    .trig_single = &on_times_single, .rotate = &rotate_all, .narrow = &narrow, .once = &once, .set_up = &set_up};
inline constexpr exact::DampedKernels damped_kernels = {
    .trig = &at_slowed_times, .hyper = &at_slowed_times, .slow = &slow};

}  // namespace polhode::POLHODE_ISA
