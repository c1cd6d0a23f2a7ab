#pragma once

#include "exact/lanes/free_loops.hpp"
#include "math/lanes/floats.hpp"

// What is not omega and attitude in doubles: floats, and rotated vectors. Each file that is built for one instruction
// set includes this once.
namespace polhode::POLHODE_ISA {

/// Numbers of a body as floats. Below 1e-30 they are 0: subnormal floats would be slow.
template <class To, class From>
inline To as_floats(const From& from) {
  To to;
  static_assert(sizeof(From) == 2 * sizeof(To));
  const auto* numbers = reinterpret_cast<const double*>(&from);   // both consist of numbers of one type
  auto* floats = reinterpret_cast<float*>(&to);
  for (std::size_t i = 0; i < sizeof(To) / sizeof(float); ++i)
    floats[i] = math::abs(numbers[i]) < 1e-30 ? 0.0f : static_cast<float>(numbers[i]);
  return to;
}

/// Writes the first n rows of a register of states.
template <bool want_omega, bool want_attitude>
POLHODE_INLINE void write_first(const Rows<Floats>& rows, std::size_t n, float* omega, float* attitude) {
  const auto& w = rows.omega;
  const auto& q = rows.attitude;
  if (n >= Floats::width) {
    if constexpr (want_omega) store3(omega, w[0], w[1], w[2]);
    if constexpr (want_attitude) store4(attitude, q[0], q[1], q[2], q[3]);
    return;
  }
  float own[4 * Floats::width];
  if constexpr (want_omega) {
    store3(own, w[0], w[1], w[2]);
    std::memcpy(omega, own, 3 * n * sizeof(float));
  }
  if constexpr (want_attitude) {
    store4(own, q[0], q[1], q[2], q[3]);
    std::memcpy(attitude, own, 4 * n * sizeof(float));
  }
}

/// In blocks: the phases in double, reduced to a fraction of a turn, then all else in floats.
template <bool want_omega, bool want_attitude, bool along>
void single_loop(const AlongBodyAxes& axes, const FreeFrame& frame_in, const double* t, std::size_t n, float* omega,
                 float* attitude) {
  constexpr std::size_t block = TimeGrid::block, width = Floats::width;
  const auto body = as_floats<exact::FreeTrig<float>>(axes.body);
  const auto frame = as_floats<exact::FreeFrameOf<float>>(frame_in);
  const int order[3] = {axes.order[0], axes.order[1], axes.order[2]};
  const exact::FreeTrig<double>& b = axes.body;
  const Wide scale(frame_in.time_scale), nu_hi(b.nu_hi), nu_lo(b.nu_lo), phi0(b.phi0);
  const Wide kappa_hi(b.kappa_hi), kappa_lo(b.kappa_lo);
  alignas(64) float phi[block], kappa[block];
  alignas(64) double own[block] = {};
  for (std::size_t first = 0; first < n; first += block) {
    const std::size_t count = in_block(n, first), padded = (count + width - 1) / width * width;
    const double* times = t + first;
    if (padded != count) {
      std::memcpy(own, times, count * sizeof(double));
      times = own;
    }
    for (std::size_t k = 0; k < padded; k += Wide::width) {
      const Wide now = Wide::load(times + k) * scale;
      store_floats(phi + k, math::cycle_fraction(now, nu_hi, nu_lo, phi0));
      store_floats(kappa + k, math::cycle_fraction(now, kappa_hi, kappa_lo, Wide(0.0)));
    }
    for (std::size_t k = 0; k < padded; k += width) {
      Floats s, c, ks, kc;
      sincos_cycles(Floats::load(phi + k), s, c);
      sincos_cycles(Floats::load(kappa + k), ks, kc);
      const auto state = exact::evaluate(body, exact::evaluate_pair(body, s, c), s, c, ks, kc, order);
      write_first<want_omega, want_attitude>(in_caller_frames<along>(frame, state), count - k, omega + 3 * (first + k),
                                             attitude + 4 * (first + k));
    }
  }
}

template <bool want_omega, bool want_attitude>
void single_loop(const exact::FreeTrig<double>& body, const FreeFrame& frame, const double* t, std::size_t n,
                 float* omega, float* attitude) {
  const AlongBodyAxes axes = along_body_axes(body, frame);
  if (axes.found) return single_loop<want_omega, want_attitude, true>(axes, frame, t, n, omega, attitude);
  single_loop<want_omega, want_attitude, false>(axes, frame, t, n, omega, attitude);
}

inline void on_times_single(const exact::FreeTrig<double>& body, const FreeFrame& frame, const double* t,
                            std::size_t n, float* omega, float* attitude) {
  if (omega && attitude) return single_loop<true, true>(body, frame, t, n, omega, attitude);
  if (omega) return single_loop<true, false>(body, frame, t, n, omega, attitude);
  if (attitude) return single_loop<false, true>(body, frame, t, n, omega, attitude);
}

inline void narrow(const double* numbers, std::size_t n, float* rounded) {
  std::size_t i = 0;
  for (; i + Wide::width <= n; i += Wide::width) store_floats(rounded + i, Wide::load(numbers + i));
  for (; i < n; ++i) rounded[i] = static_cast<float>(numbers[i]);
}

/// The rows x0 y0 z0 w0 x1 ... of four numbers as columns.
POLHODE_INLINE void load4(const double* p, One (&q)[4]) {
  for (int c = 0; c < 4; ++c) q[c] = p[c];
}
#if defined(__AVX512F__)
POLHODE_INLINE void load4(const double* p, Wide (&q)[4]) {
  const __m512i low = _mm512_setr_epi64(0, 4, 8, 12, 1, 5, 9, 13), high = _mm512_setr_epi64(2, 6, 10, 14, 3, 7, 11, 15);
  const __m512d a = _mm512_loadu_pd(p), b = _mm512_loadu_pd(p + 8);
  const __m512d c = _mm512_loadu_pd(p + 16), d = _mm512_loadu_pd(p + 24);
  const __m512d xy0 = _mm512_permutex2var_pd(a, low, b), zw0 = _mm512_permutex2var_pd(a, high, b);
  const __m512d xy1 = _mm512_permutex2var_pd(c, low, d), zw1 = _mm512_permutex2var_pd(c, high, d);
  q[0] = _mm512_shuffle_f64x2(xy0, xy1, 0x44), q[1] = _mm512_shuffle_f64x2(xy0, xy1, 0xee);
  q[2] = _mm512_shuffle_f64x2(zw0, zw1, 0x44), q[3] = _mm512_shuffle_f64x2(zw0, zw1, 0xee);
}
#elif defined(__AVX2__)
POLHODE_INLINE void load4(const double* p, Wide (&q)[4]) {
  const __m256d a = _mm256_loadu_pd(p), b = _mm256_loadu_pd(p + 4);
  const __m256d c = _mm256_loadu_pd(p + 8), d = _mm256_loadu_pd(p + 12);
  const __m256d xy0 = _mm256_permute2f128_pd(a, c, 0x20), zw0 = _mm256_permute2f128_pd(a, c, 0x31);   // rows 0, 2
  const __m256d xy1 = _mm256_permute2f128_pd(b, d, 0x20), zw1 = _mm256_permute2f128_pd(b, d, 0x31);   // rows 1, 3
  q[0] = _mm256_unpacklo_pd(xy0, xy1), q[1] = _mm256_unpackhi_pd(xy0, xy1);
  q[2] = _mm256_unpacklo_pd(zw0, zw1), q[3] = _mm256_unpackhi_pd(zw0, zw1);
}
#endif

/// v + w t + u x t with t = 2 u x v / |q|^2, where q = (u, w) is the attitude; `sense` -1 for its inverse. The attitude
/// is unit up to rounding, so 2 / |q|^2 is 4 - 2 |q|^2.
template <class T>
POLHODE_INLINE void rotate_at(const double* v, const double* attitude, double sense, double* rotated) {
  T q[4];
  load4(attitude, q);
  const T size2 = madd(q[0], q[0], q[1] * q[1]) + madd(q[2], q[2], q[3] * q[3]), twice = madd(T(-2.0), size2, T(4.0));
  const T a(v[0]), b(v[1]), c(v[2]), w = q[3] * T(sense), x = q[0] * twice, y = q[1] * twice, z = q[2] * twice;
  const T tx = madd(y, c, -(z * b)), ty = madd(z, a, -(x * c)), tz = madd(x, b, -(y * a));
  store3(rotated, a + madd(w, tx, madd(q[1], tz, -(q[2] * ty))), b + madd(w, ty, madd(q[2], tx, -(q[0] * tz))),
         c + madd(w, tz, madd(q[0], ty, -(q[1] * tx))));
}

inline void rotate_all(const double* vector, const double* attitude, std::size_t n, bool inverse, double* rotated) {
  const double v[3] = {vector[0], vector[1], vector[2]}, sense = inverse ? -1.0 : 1.0;
  std::size_t i = 0;
  for (; i + Wide::width <= n; i += Wide::width) rotate_at<Wide>(v, attitude + 4 * i, sense, rotated + 3 * i);
  for (; i < n; ++i) rotate_at<One>(v, attitude + 4 * i, sense, rotated + 3 * i);
}

}  // namespace polhode::POLHODE_ISA
