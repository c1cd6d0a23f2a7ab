#pragma once

#include "batch/lanes/taylor_step.hpp"

// Taylor steps with a body in each lane, for one lane type `Wide`. Each file that is built for one instruction set
// includes this header once. The recurrences are those of method/series/lanes/series_loops.hpp.
namespace polhode::POLHODE_ISA {

/// Sum over 0 <= j <= n of left_j right_{n-j} for several products. `term(j, i)` adds left_j right_i. The products with
/// the newest coefficients come last, because these are ready last.
template <class Term>
POLHODE_INLINE void sum_products(int n, const Term& term) {
  for (int j = 1; j < n; ++j) term(j, n - j);
  term(0, n);
  if (n > 0) term(n, 0);
}

/// Keeps a value in a register. GCC would load the factor again for each product, and loads limit this loop.
POLHODE_INLINE Wide held(Wide a) {
#if defined(__AVX512DQ__) && defined(__GNUC__)
  asm("" : "+v"(a.v));
#endif
  return a;
}

template <bool separatrix, bool attitude, int fixed, bool gradient>
class LaneSeries {
  static constexpr int vectors = fixed + (gradient ? 2 : 0), kept = vectors > 0 ? vectors : 1;
  static constexpr bool vector_only = !attitude && fixed == 1;   // a vector in place of the quaternion

 public:
  static void step(TaylorBlock& block) {
    for (int at = 0; at < TaylorBlock::width; at += Wide::width) {
      LaneSeries series(block, Pass{at});
      series.start();
      int n = 0;
      for (; n < 4 && n < block.order; ++n) series.advance<true>(n);
      for (; n < block.order; ++n) series.advance<false>(n);
      const int row[5] = {0, 1, 2, block.order - 1, block.order};
      Wide rates[5][3];
      for (int k = 0; k < 5; ++k)
        for (int i = 0; i < 3; ++i) rates[k][i] = series.rate(i, row[k]);
      finish_step<attitude, vector_only>(block, Pass{at}, rates);
    }
  }

 private:
  POLHODE_INLINE LaneSeries(TaylorBlock& block, Pass pass) : b_(block), pass_(pass) {}

  POLHODE_INLINE Wide load(const Row& row) const { return pass_.load(row); }

  // Where the coefficients are stored.
  static POLHODE_INLINE auto& rate_rows(const TaylorBlock& b, int i) {
    return !separatrix || i == 1 ? b.c[separatrix ? 2 : i] : b.side[i];
  }
  POLHODE_INLINE auto& rate_rows(int i) const { return rate_rows(b_, i); }
  POLHODE_INLINE auto& vector_rows(int v, int i) const { return vector_only ? b_.c[4 + i] : b_.vector[v][i]; }
  POLHODE_INLINE Wide rate(int i, int n) const { return load(rate_rows(i)[n]); }

  POLHODE_INLINE void put_rates(int n, const Wide (&r)[3]) {
    for (int i = 0; i < 3; ++i) pass_.store(b_.c[i][n], r[i]);
    if constexpr (separatrix) {   // the coefficients of v - u and of w3 = (v + u) / 2
      const Wide difference = r[1] - r[0];
      pass_.store(b_.side[1][n], difference);
      pass_.store(b_.side[0][n], difference * load(b_.to_rates));
      pass_.store(b_.side[2][n], (r[0] + r[1]) * Wide(0.5));
    }
  }

  /// R^T s, with the rotation at the start of the step.
  POLHODE_INLINE void put_vector(int v, const Wide (&q)[4], Wide s0, Wide s1, Wide s2) {
    const Wide two(2.0), x = -q[0], y = -q[1], z = -q[2], w = q[3];
    const Wide t0 = two * (y * s2 - z * s1), t1 = two * (z * s0 - x * s2), t2 = two * (x * s1 - y * s0);
    pass_.store(vector_rows(v, 0)[0], madd(w, t0, s0) + (y * t2 - z * t1));
    pass_.store(vector_rows(v, 1)[0], madd(w, t1, s1) + (z * t0 - x * t2));
    pass_.store(vector_rows(v, 2)[0], madd(w, t2, s2) + (x * t1 - y * t0));
  }

  POLHODE_INLINE void start() {
    const Wide unit = load(b_.unit), square = unit * unit;
    const Wide r[3] = {load(b_.y[0]) * unit, load(b_.y[1]) * unit, load(b_.y[2]) * unit};
    put_rates(0, r);
    for (int i = 0; i < 3; ++i) {
      // separatrix: the third product is (v - u) w3 here, half of (v - u)(v + u)
      const Wide factor(separatrix && i == 2 ? 2.0 : 1.0);
      product_[i] = load(b_.product[i]) * factor, product_low_[i] = load(b_.product_low[i]) * factor;
      torque_[i] = load(b_.torque[i]) * square;
      for (int j = 0; j < 3; ++j) damping_[j][i] = load(b_.damping[j][i]) * unit;
      for (int v = 0; v < fixed; ++v)
        for (int j = 0; j < 3; ++j) pull_[v][j][i] = load(b_.pull[v][j][i]) * square;
      if constexpr (gradient)
        for (int j = 0; j < 2; ++j) tidal_[j][i] = load(b_.tidal[j][i]) * square;
    }
    orbit_ = load(b_.orbit_rate) * unit;
    for (int i = 4; i < 8; ++i) pass_.store(b_.c[i][0], load(b_.y[i]));
    if constexpr (attitude) {
      const Wide q[4] = {load(b_.y[4]), load(b_.y[5]), load(b_.y[6]), load(b_.y[7])};
      for (int v = 0; v < fixed; ++v)
        put_vector(v, q, load(b_.space[v][0]), load(b_.space[v][1]), load(b_.space[v][2]));
      if constexpr (gradient) {
        const Wide c = load(b_.orbit_cos), s = load(b_.orbit_sin), zero(0.0);
        put_vector(fixed, q, c, s, zero), put_vector(fixed + 1, q, -s, c, zero);
      }
    }
  }

  /// Sums of the rates' products (p) and of the components of q w (a and o, two each). They are chains of fused
  /// operations that do not wait for each other.
  struct Sums {
    Wide p[3], a[4], o[4];
  };

  /// Nearly all of the work is done here.
  static POLHODE_INLINE void sum_rates(const TaylorBlock& b, Pass pass, int n, Sums& sums) {
    const Wide zero(0.0);
    Wide p[3] = {zero, zero, zero}, a[4] = {zero, zero, zero, zero}, o[4] = {zero, zero, zero, zero};
    const auto load = [pass](const Row& row) __attribute__((always_inline)) { return pass.load(row); };
    const auto &w0 = rate_rows(b, 0), &w1 = rate_rows(b, 1), &w2 = rate_rows(b, 2);
    const auto &l0 = separatrix ? b.c[0] : w1, &l1 = separatrix ? b.c[1] : w2, &l2 = separatrix ? b.side[1] : w0;
    const auto &x = b.c[4], &y = b.c[5], &z = b.c[6], &w = b.c[7];
    sum_products(n, [&](int j, int i) __attribute__((always_inline)) {
      const Wide r0 = load(w0[i]), r1 = load(w1[i]), r2 = load(w2[i]);
      p[0] = madd(load(l0[j]), separatrix ? r1 : r2, p[0]);
      p[1] = madd(load(l1[j]), separatrix ? r1 : r0, p[1]);
      p[2] = madd(load(l2[j]), separatrix ? r2 : r1, p[2]);
      if constexpr (attitude) {
        const Wide qx = held(load(x[j])), qy = held(load(y[j])), qz = held(load(z[j])), qw = held(load(w[j]));
        a[0] = madd(qw, r0, a[0]), o[0] = madd(qz, r1, o[0]);
        a[1] = madd(qw, r1, a[1]), o[1] = madd(qx, r2, o[1]);
        a[2] = madd(qw, r2, a[2]), o[2] = madd(qy, r0, o[2]);
        a[3] = madd(qx, r0, a[3]), o[3] = madd(qz, r2, o[3]);
        a[0] = madd(qy, r2, a[0]), a[1] = madd(qz, r0, a[1]), a[2] = madd(qx, r1, a[2]), a[3] = madd(qy, r1, a[3]);
      }
    });
    for (int i = 0; i < 3; ++i) sums.p[i] = p[i];
    for (int i = 0; i < 4; ++i) sums.a[i] = a[i], sums.o[i] = o[i];
  }

  /// Computes row n + 1 from the rows before it. In the first rows (`early`) the constants keep their low parts: an
  /// error of theirs would be the same in every step and add up.
  template <bool early>
  POLHODE_INLINE void advance(int n) {
    const Wide zero(0.0), count(n + 1.0), inverse(1.0 / (n + 1));
    const auto over = [&](Wide a) { return early && n == 2 ? a / count : a * inverse; };   // 1, 1/2 and 1/4 are exact
    Sums sums;
    sum_rates(b_, pass_, n, sums);
    const auto& p = sums.p;
    const auto &a = sums.a, &o = sums.o;
    Wide tau[3] = {zero, zero, zero};
    if (n == 0)
      for (int i = 0; i < 3; ++i) tau[i] = torque_[i];
    add_torques(n, tau);
    advance_vectors<early>(n);
    if constexpr (attitude) {
      const Wide half(0.5);
      pass_.store(b_.c[4][n + 1], over(half * (a[0] - o[0])));
      pass_.store(b_.c[5][n + 1], over(half * (a[1] - o[1])));
      pass_.store(b_.c[6][n + 1], over(half * (a[2] - o[2])));
      pass_.store(b_.c[7][n + 1], over(-half * (a[3] + o[3])));
    }
    Wide next[3];
    for (int i = 0; i < 3; ++i) {
      if constexpr (early) tau[i] = madd(p[i], product_low_[i], tau[i]);
      next[i] = over(madd(p[i], product_[i], tau[i]));
    }
    put_rates(n + 1, next);
  }

  POLHODE_INLINE void add_torques(int n, Wide (&tau)[3]) {
    if (b_.damped)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) tau[i] = madd(damping_[j][i], rate(j, n), tau[i]);
    for (int v = 0; v < fixed; ++v)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) tau[i] = madd(pull_[v][j][i], load(vector_rows(v, j)[n]), tau[i]);
    if constexpr (gradient) {
      Wide pair[3] = {Wide(0.0), Wide(0.0), Wide(0.0)};   // u2 u3, u3 u1, u1 u2
      sum_products(n, [&](int j, int i) __attribute__((always_inline)) {
        const auto& u = b_.vector[fixed];
        pair[0] = madd(load(u[1][j]), load(u[2][i]), pair[0]);
        pair[1] = madd(load(u[2][j]), load(u[0][i]), pair[1]);
        pair[2] = madd(load(u[0][j]), load(u[1][i]), pair[2]);
      });
      if constexpr (separatrix) {
        tau[0] = madd(tidal_[0][0], pair[2], madd(tidal_[1][0], pair[0], tau[0]));
        tau[1] = madd(tidal_[0][1], pair[2], madd(tidal_[1][1], pair[0], tau[1]));
        tau[2] = madd(tidal_[0][2], pair[1], tau[2]);
      } else {
        for (int i = 0; i < 3; ++i) tau[i] = madd(tidal_[0][i], pair[i], tau[i]);
      }
    }
  }

  /// v' = v x w for vectors fixed in space. The orbit's radius and tangent rotate into each other besides.
  template <bool early>
  POLHODE_INLINE void advance_vectors(int n) {
    const Wide count(n + 1.0), inverse(1.0 / (n + 1)), zero(0.0);
    Wide next[kept][3];
    for (int v = 0; v < vectors; ++v) {
      Wide a[3] = {zero, zero, zero}, o[3] = {zero, zero, zero};
      const auto &v0 = vector_rows(v, 0), &v1 = vector_rows(v, 1), &v2 = vector_rows(v, 2);
      const auto &w0 = rate_rows(0), &w1 = rate_rows(1), &w2 = rate_rows(2);
      sum_products(n, [&](int j, int i) __attribute__((always_inline)) {
        const Wide r0 = load(w0[i]), r1 = load(w1[i]), r2 = load(w2[i]), s0 = load(v0[j]), s1 = load(v1[j]),
                   s2 = load(v2[j]);
        a[0] = madd(s1, r2, a[0]), a[1] = madd(s2, r0, a[1]), a[2] = madd(s0, r1, a[2]);
        o[0] = madd(s2, r1, o[0]), o[1] = madd(s0, r2, o[1]), o[2] = madd(s1, r0, o[2]);
      });
      for (int i = 0; i < 3; ++i) {
        next[v][i] = a[i] - o[i];
        if (gradient && v == fixed) next[v][i] = madd(orbit_, load(vector_rows(v + 1, i)[n]), next[v][i]);
        if (gradient && v == fixed + 1) next[v][i] = next[v][i] - orbit_ * load(vector_rows(v - 1, i)[n]);
      }
    }
    for (int v = 0; v < vectors; ++v)
      for (int i = 0; i < 3; ++i)
        pass_.store(vector_rows(v, i)[n + 1], early && n == 2 ? next[v][i] / count : next[v][i] * inverse);
  }

  TaylorBlock& b_;
  Pass pass_;
  Wide product_[3], product_low_[3], torque_[3], damping_[3][3], pull_[fixed > 0 ? fixed : 1][3][3], tidal_[2][3],
      orbit_;
};

template <bool separatrix, bool attitude, int fixed, bool gradient>
TaylorKernels make_kernels() {
  return {&LaneSeries<separatrix, attitude, fixed, gradient>::step, &sample_lanes};
}

template <bool separatrix>
TaylorKernels choose_lanes(const SeriesTerms& c, bool attitude) {
  if (!attitude)
    return c.fixed_vectors == 1 ? make_kernels<separatrix, false, 1, false>()
                                : make_kernels<separatrix, false, 0, false>();
  if (c.gradient)
    return c.fixed_vectors > 0 ? make_kernels<separatrix, true, 2, true>() : make_kernels<separatrix, true, 0, true>();
  if (c.fixed_vectors == 0) return make_kernels<separatrix, true, 0, false>();
  return c.fixed_vectors == 1 ? make_kernels<separatrix, true, 1, false>() : make_kernels<separatrix, true, 2, false>();
}

inline TaylorKernels choose_lanes(const SeriesTerms& c, bool attitude) {
  return c.variables == RateVariables::separatrix ? choose_lanes<true>(c, attitude) : choose_lanes<false>(c, attitude);
}

}  // namespace polhode::POLHODE_ISA
