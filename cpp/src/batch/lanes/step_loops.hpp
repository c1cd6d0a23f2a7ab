#pragma once

#include "batch/lanes/step_kernels.hpp"
#include "batch/lanes/step_lanes.hpp"

// The loop of step_bodies(): rows of numbers into registers, all steps of these bodies, and back.
namespace polhode::POLHODE_ISA {

/// The body of a block that is in a lane: the order in which rows of four come out of their transposition.
constexpr int body_of(int lane, int width) { return lane % 4 * (width / 4) + lane / 4; }

template <class V, int... i>
POLHODE_INLINE V shuffle(V a, V b, std::integer_sequence<int, i...>) {
  return __builtin_shufflevector(a, b, i...);
}

/// Indices made by `f(lane)`.
template <int (*f)(int), int... lane>
constexpr auto indices(std::integer_sequence<int, lane...>) {
  return std::integer_sequence<int, f(lane)...>{};
}
template <int width, int (*f)(int), class V>
POLHODE_INLINE V shuffle(V a, V b) {
  return shuffle(a, b, decltype(indices<f>(std::make_integer_sequence<int, width>{})){});
}

/// Rows of three numbers in three registers. As 3 and `width` have no common factor, the numbers of one column are in
/// different lanes: two blends gather them, and one permutation orders them.
template <int width, int column>
struct Column {
  static constexpr int place(int body) { return 3 * body + column; }
  /// The register that has a number of this column in the lane.
  static constexpr int source(int lane) {
    for (int body = 0; body < width; ++body)
      if (place(body) % width == lane) return place(body) / width;
    return 0;
  }
  static constexpr int first(int lane) { return source(lane) == 1 ? lane + width : lane; }
  static constexpr int second(int lane) { return source(lane) == 2 ? lane + width : lane; }
  static constexpr int gather(int lane) { return place(body_of(lane, width)) % width; }
  static constexpr int scatter(int lane) {
    for (int from = 0; from < width; ++from)
      if (gather(from) == lane) return from;
    return 0;
  }
};
/// The column whose number is in a lane of a register.
template <int width, int at>
struct Place {
  static constexpr int first(int lane) { return (at * width + lane) % 3 == 1 ? lane + width : lane; }
  static constexpr int second(int lane) { return (at * width + lane) % 3 == 2 ? lane + width : lane; }
};

template <class V, class S>
POLHODE_INLINE V load(const S* p) {
  V v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
template <class V, class S>
POLHODE_INLINE void store(S* p, V v) {
  std::memcpy(p, &v, sizeof v);
}

template <class S>
struct Rows3 {
  using V = typename Lanes<S>::V;
  static constexpr int w = Lanes<S>::width;

  template <int column>
  static POLHODE_INLINE V gather(V a, V b, V c) {
    using C = Column<w, column>;
    const V found = shuffle<w, C::second>(shuffle<w, C::first>(a, b), c);
    return shuffle<w, C::gather>(found, found);
  }
  static POLHODE_INLINE void get(const S* p, V& x, V& y, V& z) {
    const V a = load<V>(p), b = load<V>(p + w), c = load<V>(p + 2 * w);
    x = gather<0>(a, b, c), y = gather<1>(a, b, c), z = gather<2>(a, b, c);
  }
  template <int at>
  static POLHODE_INLINE V join(V x, V y, V z) {
    return shuffle<w, Place<w, at>::second>(shuffle<w, Place<w, at>::first>(x, y), z);
  }
  static POLHODE_INLINE void put(S* p, V x, V y, V z) {
    x = shuffle<w, Column<w, 0>::scatter>(x, x), y = shuffle<w, Column<w, 1>::scatter>(y, y);
    z = shuffle<w, Column<w, 2>::scatter>(z, z);
    store(p, join<0>(x, y, z)), store(p + w, join<1>(x, y, z)), store(p + 2 * w, join<2>(x, y, z));
  }
};

/// Rows of four numbers in four registers: 4 x 4 transpositions side by side, each its own inverse.
template <class S>
struct Rows4 {
  using V = typename Lanes<S>::V;
  static constexpr int w = Lanes<S>::width;
  static constexpr bool single = sizeof(S) == 4;

  // The numbers of two registers that one instruction interleaves: 0 1 of each, or 0 2; then 2 3, or 1 3.
  static constexpr int low(int lane) {
    const int k = lane % 4, number = single ? k / 2 : k / 2 * 2;
    return lane / 4 * 4 + number + (k % 2) * w;
  }
  static constexpr int high(int lane) { return low(lane) + (single ? 2 : 1); }
  static constexpr int halves(int lane) { return lane / 4 * 4 + lane % 2 + (lane % 4 / 2) * w; }
  static constexpr int other_halves(int lane) { return halves(lane) + 2; }

  static POLHODE_INLINE void transpose(V& a, V& b, V& c, V& d) {
    const V ab = shuffle<w, low>(a, b), AB = shuffle<w, high>(a, b);
    const V cd = shuffle<w, low>(c, d), CD = shuffle<w, high>(c, d);
    a = shuffle<w, halves>(ab, cd);
    const V from_low = shuffle<w, other_halves>(ab, cd), from_high = shuffle<w, halves>(AB, CD);
    b = single ? from_low : from_high, c = single ? from_high : from_low;
    d = shuffle<w, other_halves>(AB, CD);
  }
};

template <class S>
using Numbers3 = step::Vec<Lanes<S>>;
template <class S>
using Numbers4 = step::Quat<Lanes<S>>;

template <class S>
POLHODE_INLINE Numbers3<S> load3(const S* p, bool one) {
  constexpr int w = Lanes<S>::width;
  using O = step::Ops<Lanes<S>>;
  Numbers3<S> v;
  if (one) return {O::set(p[0]), O::set(p[1]), O::set(p[2])};
  Rows3<S>::get(p, v.x.a, v.y.a, v.z.a), Rows3<S>::get(p + 3 * w, v.x.b, v.y.b, v.z.b);
  return v;
}

/// A block of 2 w bodies, all steps.
template <bool space, class S>
POLHODE_INLINE void step_block(const StepBatch<S>& batch, const step::Inertia<Lanes<S>>& body, const S* torque,
                               S* L_rows, S* q_rows) {
  using T = Lanes<S>;
  using V = typename T::V;
  using O = step::Ops<T>;
  constexpr int w = T::width;
  Numbers3<S> L = load3(L_rows, false);
  V q[8];
  for (int i = 0; i < 8; ++i) q[i] = load<V>(q_rows + i * w);
  Rows4<S>::transpose(q[0], q[1], q[2], q[3]), Rows4<S>::transpose(q[4], q[5], q[6], q[7]);
  Numbers4<S> p{{q[0], q[4]}, {q[1], q[5]}, {q[2], q[6]}, {q[3], q[7]}};
  const double h = static_cast<double>(batch.step);
  const T step = O::set(h);
  const auto drift = [&]() __attribute__((always_inline)) {
    if constexpr (space) {
      step::drift_space(body, step, L, p);
    } else {
      step::drift_body(body, step, L, p);
    }
  };
  if (torque == nullptr) {
    for (long n = 0; n < batch.count; ++n) drift();
  } else {
    const Numbers3<S> tau = load3(torque, batch.one_torque);
    T time = O::set(batch.first * h);
    for (long n = 0; n < batch.count; ++n) {
      step::kick(L, tau, time);
      drift();
      time = step;
    }
    step::kick(L, tau, O::set(batch.last * h));
  }
  if (!space || torque != nullptr) {
    Rows3<S>::put(L_rows, L.x.a, L.y.a, L.z.a), Rows3<S>::put(L_rows + 3 * w, L.x.b, L.y.b, L.z.b);
  }
  q[0] = p.x.a, q[1] = p.y.a, q[2] = p.z.a, q[3] = p.w.a, q[4] = p.x.b, q[5] = p.y.b, q[6] = p.z.b, q[7] = p.w.b;
  Rows4<S>::transpose(q[0], q[1], q[2], q[3]), Rows4<S>::transpose(q[4], q[5], q[6], q[7]);
  for (int i = 0; i < 8; ++i) store(q_rows + i * w, q[i]);
}

template <class S>
POLHODE_INLINE void copy(const S* from, std::size_t n, S* to) {
  for (std::size_t i = 0; i < n; ++i) to[i] = from[i];
}

template <bool space, class S>
void run_frame(const StepBatch<S>& batch, std::size_t begin, std::size_t end) {
  constexpr std::size_t block = 2 * Lanes<S>::width;
  step::Inertia<Lanes<S>> body{};
  const auto read_body = [&](const S* p) __attribute__((always_inline)) {
    const Numbers3<S> I = load3(p, batch.one_inertia);
    body = step::make_inertia(I.x, I.y, I.z);
  };
  if (batch.one_inertia) read_body(batch.moments);
  std::size_t i = begin;
  for (; i + block <= end; i += block) {
    if (!batch.one_inertia) read_body(batch.moments + 3 * i);
    const S* torque = batch.torque == nullptr || batch.one_torque ? batch.torque : batch.torque + 3 * i;
    step_block<space>(batch, body, torque, batch.momentum + 3 * i, batch.attitude + 4 * i);
  }
  if (i == end) return;
  // The last few bodies with others at rest, in a block apart.
  const std::size_t left = end - i;
  S I[3 * block], torque[3 * block] = {}, L[3 * block] = {}, q[4 * block] = {};
  for (S& moment : I) moment = 1;
  if (!batch.one_inertia) {
    copy(batch.moments + 3 * i, 3 * left, I);
    read_body(I);
  }
  if (batch.torque != nullptr && !batch.one_torque) copy(batch.torque + 3 * i, 3 * left, torque);
  copy(batch.momentum + 3 * i, 3 * left, L), copy(batch.attitude + 4 * i, 4 * left, q);
  step_block<space>(batch, body, batch.torque == nullptr || batch.one_torque ? batch.torque : torque, L, q);
  copy(L, 3 * left, batch.momentum + 3 * i), copy(q, 4 * left, batch.attitude + 4 * i);
}

template <class S>
void run(const StepBatch<S>& batch, std::size_t begin, std::size_t end) {
  batch.space ? run_frame<true>(batch, begin, end) : run_frame<false>(batch, begin, end);
}

inline const StepKernels* step_kernels() {
  static constexpr StepKernels kernels{&run<float>, &run<double>};
  return &kernels;
}

}  // namespace polhode::POLHODE_ISA
