#pragma once

#include "math/lanes/octet.hpp"
#include "polhode/math/detail/double_double.hpp"
#include "polhode/ode/series.hpp"
#include "method/series/lanes/levels.hpp"
#include "method/series/lanes/shared.hpp"

namespace polhode::POLHODE_ISA {

constexpr int W = ode::series_width;

/// The products of the recurrences, sum_j left_j right_{n-j}, eight components each. One pass makes the sums of two
/// rows and uses every loaded factor twice, because loads limit the speed. From `shared` on the products have one
/// right factor in common.
template <int count, int shared>
class Products {
 public:
  static constexpr int rights = shared < count ? shared + 1 : count;

  POLHODE_INLINE void put_left(int p, int n, Octet row) { store8(left_[n][p], row); }
  POLHODE_INLINE void put_right(int p, int n, Octet row) { store8(right_[n][p], row); }
  POLHODE_INLINE void put(int p, int n, Octet left, Octet right) { put_left(p, n, left), put_right(p, n, right); }

  /// The sums of row n over 0 < j < n. They omit the two terms that need row n, to keep it off the critical path.
  /// `next` receives the terms of row n + 1 that need no row above n - 1.
  POLHODE_INLINE void sum_older(int n, Octet (&out)[count], Octet (&next)[count]) const {
    for (int p = 0; p < count; ++p) out[p] = next[p] = all8(0.0);
    if (n < 2) return;
    sum_groups<0>(n, out, next);
  }

  /// Adds the terms of row n + 1 with 0 < j < n + 1 that sum_older omitted, once row n is known.
  POLHODE_INLINE void add_newer(int n, Octet (&next)[count]) const {
    if (n == 0) return;
    for (int p = 0; p < count; ++p) {
      next[p] = madd(load8(left_[1][p]), load8(right_[n][right(p)]), next[p]);
      next[p] = madd(load8(left_[n][p]), load8(right_[1][right(p)]), next[p]);
    }
  }

  POLHODE_INLINE Octet sum_newest(int p, int n) const {
    const Octet first = load8(left_[n][p]) * load8(right_[0][right(p)]);
    return n == 0 ? first : madd(load8(left_[0][p]), load8(right_[n][right(p)]), first);
  }

 private:
  static constexpr int right(int p) { return p < rights ? p : rights - 1; }

  /// Sums as many products at once as the registers hold.
  template <int begin>
  POLHODE_INLINE void sum_groups(int n, Octet (&out)[count], Octet (&next)[count]) const {
    constexpr int end = begin + octets_at_once < count ? begin + octets_at_once : count;
    // Row n - 1 comes last, so that nothing here waits for it.
    if (n > 2) {
      Octet above[end - begin];   // right_{n + 1 - i}
      for (int p = begin; p < end; ++p) {
        above[p - begin] = load8(right_[n - 2][right(p)]);
        out[p] = load8(left_[2][p]) * above[p - begin];
      }
      for (int i = 3; i < n - 1; ++i) {
        for (int p = begin; p < end; ++p) {
          const Octet left = load8(left_[i][p]), here = load8(right_[n - i][right(p)]);
          out[p] = madd(left, here, out[p]);
          next[p] = madd(left, above[p - begin], next[p]);
          above[p - begin] = here;
        }
      }
    }
    for (int p = begin; p < end; ++p) {
      const Octet newest_left = load8(left_[n - 1][p]), newest_right = load8(right_[n - 1][right(p)]);
      out[p] = madd(newest_left, load8(right_[1][right(p)]), out[p]);
      if (n == 2) continue;
      out[p] = madd(load8(left_[1][p]), newest_right, out[p]);
      next[p] = madd(newest_left, load8(right_[2][right(p)]), next[p]);
      next[p] = madd(load8(left_[2][p]), newest_right, next[p]);
    }
    if constexpr (end < count) sum_groups<end>(n, out, next);
  }

  alignas(64) double left_[ode::most_series_order + 1][count][W], right_[ode::most_series_order + 1][rights][W];
};

template <int i>
POLHODE_INLINE Quad broadcast(Quad a) {
  return permute<i, i, i, i>(a);
}

/// m[0] a_0 + m[1] a_1 + m[2] a_2 + rest, in two independent halves.
POLHODE_INLINE Quad apply(const Quad (&m)[3], Quad a, Quad rest) {
  return madd(broadcast<0>(a), m[0], rest) + madd(broadcast<2>(a), m[2], broadcast<1>(a) * m[1]);
}

/// The recurrences of Euler's equations, the quaternion, and the vectors in the torques, in separatrix or plain
/// variables. With `attitude` the second half of y is the quaternion. Otherwise it is a fixed vector, if there is one.
///
/// Each coefficient waits for the one before, so the path between them is kept short. The newest terms of every product
/// are linear in the newest coefficients, and their constant factors are multiplied out in advance.
template <bool separatrix, bool attitude, int fixed, bool gradient>
class Expansion {
  static constexpr int vectors = fixed + (gradient ? 2 : 0), kept = vectors > 0 ? vectors : 1;
  // (q times k, rates) with (w3, rates); (q times i, q times j) with (w1, w2); u with itself; vectors with the rates
  static constexpr int mixed = 0, with_vector = 1, pair = with_vector + attitude, carried = pair + gradient,
                       count = carried + vectors;

 public:
  using Rows = Products<count, carried>;

  POLHODE_INLINE Expansion(const SeriesTerms& c, const SeriesStart& start, Rows& products, double* rows)
      : rows_(rows), damped_(c.damped) {
    // Never H * H, which leaves the range of float64 for units below 1e-162 s and above 1e154 s.
    const Quad H = all4(start.unit);
    unscale_ = join(all4(1.0 / start.unit), all4(1.0));   // rates are returned in their own unit
    product_ = load4(c.product), product_low_ = load4(c.product_low), to_rates_ = load4(c.to_rates);
    orbit_ = all4(c.orbit_rate) * H;
    for (int j = 0; j < 3; ++j) damping_[j] = load4(c.damping[j]) * H;
    for (int i = 0; i < fixed; ++i)
      for (int j = 0; j < 3; ++j) pull_[i][j] = load4(c.pull[i][j]) * H * H;
    for (int i = 0; i < 2; ++i) tidal_[i] = load4(c.tidal[i]) * H * H;
    r_ = load4(start.y) * H, q_ = load4(start.y + 4);
    for (int i = 0; i < vectors; ++i) v_[i] = load4(start.vectors + 4 * i);
    torque_ = load4(c.torque) * H * H;
    put(0, products);
    minus_front_w_ = negative(front(w_)), back_w_ = back(w_);
    for (int i = 0; i < vectors; ++i) front_v_[i] = front(v_[i]), minus_back_v_[i] = negative(back(v_[i]));
    if constexpr (separatrix) {
      // of (u w2, v w2, (v - u)(v + u)): the last is 2 (v_0 v_n - u_0 u_n)
      newest_[0] = blend<1>(all4(0.0), broadcast<2>(r_)) + blend<4>(all4(0.0), broadcast<0>(r_) * all4(-2.0));
      newest_[1] = blend<2>(all4(0.0), broadcast<2>(r_)) + blend<4>(all4(0.0), broadcast<1>(r_) * all4(2.0));
      newest_[2] = blend<3>(all4(0.0), r_);
    } else {
      // of (w2 w3, w3 w1, w1 w2)
      newest_[0] = blend<2>(all4(0.0), broadcast<2>(r_)) + blend<4>(all4(0.0), broadcast<1>(r_));
      newest_[1] = blend<1>(all4(0.0), broadcast<2>(r_)) + blend<4>(all4(0.0), broadcast<0>(r_));
      newest_[2] = blend<1>(all4(0.0), broadcast<1>(r_)) + blend<2>(all4(0.0), broadcast<0>(r_));
    }
    for (int j = 0; j < 3; ++j) times_r_[j] = newest_[j] * product_;
    if constexpr (attitude) {
      times_q_[0] = permute<3, 2, 1, 0>(q_) ^ signs(0), times_q_[1] = permute<2, 3, 0, 1>(q_) ^ signs(1);
      times_q_[2] = permute<1, 0, 3, 2>(q_) ^ signs(2);
      times_w_[0] = broadcast<0>(w_) ^ signs(0), times_w_[1] = broadcast<1>(w_) ^ signs(1),
      times_w_[2] = broadcast<2>(w_) ^ signs(2);
    }
  }

  /// Rows n + 1 and n + 2, of even n.
  template <bool early>
  POLHODE_INLINE void advance_pair(int n, Rows& products) {
    Octet older[count], next[count];
    products.sum_older(n, older, next);
    advance<early>(n, products, older);
    products.add_newer(n, next);
    advance<early>(n + 1, products, next);
  }

  /// Row n + 1 alone.
  POLHODE_INLINE void advance_last(int n, Rows& products) {
    Octet older[count], next[count];
    products.sum_older(n, older, next);
    advance<false>(n, products, older);
  }

  /// Row n + 1 from the rows before. With `early` the constants keep their low parts, because the rounding of a
  /// constant in the first coefficients gives the same error in each step, which accumulates.
  template <bool early>
  POLHODE_INLINE void advance(int n, Rows& products, const Octet (&older)[count]) {
    const Quad inverse = all4(reciprocals.of[n + 1]);
    Quad tau = n == 0 ? torque_ : all4(0.0);
    if (damped_) tau = apply(damping_, w_, tau);
    for (int i = 0; i < fixed; ++i) tau = apply(pull_[i], v_[i], tau);
    if constexpr (gradient) {
      const Octet uu = older[pair] + products.sum_newest(pair, n);
      tau = madd(low(uu), tidal_[0], tau);
      if constexpr (separatrix) tau = madd(high(uu), tidal_[1], tau);
    }
    Quad next_v[kept];
    for (int i = 0; i < vectors; ++i) {
      const Quad x = low(older[carried + i]) + high(older[carried + i]);
      Quad sum = madd(back(v_[i]), minus_front_w_, madd(front(v_[i]), back_w_, x));
      if (n > 0) sum = sum + madd(minus_back_v_[i], front(w_), front_v_[i] * back(w_));
      next_v[i] = sum;
    }
    if constexpr (gradient) {
      next_v[fixed] = madd(orbit_, v_[fixed + 1], next_v[fixed]);
      next_v[fixed + 1] = next_v[fixed + 1] - orbit_ * v_[fixed];
    }

    if constexpr (attitude)
      advance_attitude<early>(n, low(older[with_vector]) + high(older[with_vector]) + low(older[mixed]), inverse);
    advance_rates<early>(n, high(older[mixed]), tau, inverse);
    for (int i = 0; i < vectors; ++i) v_[i] = next_v[i] * inverse;
    put(n + 1, products);
  }

 private:
  static POLHODE_INLINE Quad signs(int axis) {
    if (axis == 0) return set4(0.0, 0.0, -0.0, -0.0);
    return axis == 1 ? set4(-0.0, 0.0, 0.0, -0.0) : set4(0.0, -0.0, 0.0, -0.0);
  }

  template <bool early>
  POLHODE_INLINE void advance_rates(int n, Quad older, Quad tau, Quad inverse) {
    if constexpr (early) {
      const Quad step = all4(n + 1.0);
      const Quad sum = n == 0 ? left_ * right_ : apply(newest_, r_, older);
      const Quad c = product_ / step, c_low = (remainder(c, step, product_) + product_low_) * inverse;
      r_ = madd(sum, c, madd(sum, c_low, tau / step));
    } else {
      r_ = (apply(times_r_, r_, older * product_) + tau) * inverse;
    }
  }

  /// product - c step without rounding.
  static POLHODE_INLINE Quad remainder(Quad c, Quad step, Quad product) {
#ifdef __FMA__
    return madd(negative(c), step, product);
#else
    double factor[4], steps[4], rest[4];
    store4(factor, c), store4(steps, step), store4(rest, product);
    for (int i = 0; i < 4; ++i) {
      const math::DD whole = math::two_prod(factor[i], steps[i]);
      rest[i] = (rest[i] - whole.hi) - whole.lo;
    }
    return load4(rest);
#endif
  }

  template <bool early>
  POLHODE_INLINE void advance_attitude(int n, Quad older, Quad inverse) {
    const Quad i = permute<3, 2, 1, 0>(q_), j = permute<2, 3, 0, 1>(q_), k = permute<1, 0, 3, 2>(q_), half = all4(0.5);
    if constexpr (early) {
      if (n > 0) older = apply(times_q_, w_, older);
      const Quad sum = madd(i, times_w_[0], madd(j, times_w_[1], madd(k, times_w_[2], older)));
      q_ = half * sum / all4(n + 1.0);
    } else {
      const Quad known = apply(times_q_, w_, older);
      q_ = (madd(i, times_w_[0], known) + madd(k, times_w_[2], j * times_w_[1])) * (half * inverse);
    }
  }

  /// Stores row n in the forms that the products need.
  POLHODE_INLINE void put(int n, Rows& products) {
    if constexpr (!attitude && fixed == 1) q_ = v_[0];
    store8(rows_ + W * n, join(r_, q_) * unscale_);
    Quad sides;   // separatrix: (v - u, w2, v + u)
    if constexpr (separatrix) {
      sides = permute<1, 2, 1, 3>(r_) + (permute<0, 3, 0, 3>(r_) ^ set4(-0.0, 0.0, 0.0, 0.0));
      w_ = sides * to_rates_;
      left_ = blend<4>(r_, broadcast<0>(sides)), right_ = permute<1, 1, 2, 3>(sides);
    } else {
      w_ = r_, left_ = front(r_), right_ = back(r_);
    }
    if constexpr (attitude) {
      const Quad i = permute<3, 2, 1, 0>(q_) ^ signs(0), j = permute<2, 3, 0, 1>(q_) ^ signs(1);
      products.put(with_vector, n, join(i, j), spread<0, 0, 0, 0, 1, 1, 1, 1>(w_));
      products.put(mixed, n, join(permute<1, 0, 3, 2>(q_) ^ signs(2), left_), join(broadcast<2>(w_), right_));
    } else {
      products.put(mixed, n, join(left_, left_), join(right_, right_));
    }
    if constexpr (vectors > 0) products.put_right(carried, n, join(back(w_), front(w_)));
    for (int i = 0; i < vectors; ++i) products.put_left(carried + i, n, join(front(v_[i]), negative(back(v_[i]))));
    if constexpr (gradient) {
      const Quad u = v_[fixed];
      if constexpr (separatrix) {
        products.put(pair, n, spread<0, 0, 2, 3, 1, 1, 3, 3>(u), spread<1, 1, 0, 3, 2, 2, 3, 3>(u));
      } else {
        products.put(pair, n, spread<1, 2, 0, 3, 3, 3, 3, 3>(u), spread<2, 0, 1, 3, 3, 3, 3, 3>(u));
      }
    }
  }

  double* rows_;
  bool damped_;
  Octet unscale_;
  Quad product_, product_low_, to_rates_, orbit_, torque_, damping_[3], pull_[fixed > 0 ? fixed : 1][3], tidal_[2];
  Quad r_, w_, q_, v_[kept], left_, right_;
  Quad minus_front_w_, back_w_, front_v_[kept], minus_back_v_[kept], newest_[3], times_r_[3], times_q_[3], times_w_[3];
};

template <bool separatrix, bool attitude, int fixed, bool gradient>
void expand(const SeriesTerms& terms, const SeriesStart& start, int order, double* rows) {
  using This = Expansion<separatrix, attitude, fixed, gradient>;
  typename This::Rows products;   // in memory, while the newest coefficients stay in registers
  This expansion(terms, start, products, rows);
  expansion.template advance_pair<true>(0, products);
  expansion.template advance_pair<true>(2, products);
  int n = 4;
  for (; n + 1 < order; n += 2) expansion.template advance_pair<false>(n, products);
  if (n < order) expansion.advance_last(n, products);
}

template <bool separatrix>
SeriesKernel choose(const SeriesTerms& c, bool attitude) {
  if (!attitude)
    return c.fixed_vectors == 1 ? &expand<separatrix, false, 1, false> : &expand<separatrix, false, 0, false>;
  if constexpr (few_kernels) {
    return &expand<separatrix, true, 2, true>;
  } else {
    if (c.gradient)
      return c.fixed_vectors > 0 ? &expand<separatrix, true, 2, true> : &expand<separatrix, true, 0, true>;
    if (c.fixed_vectors == 0) return &expand<separatrix, true, 0, false>;
    return c.fixed_vectors == 1 ? &expand<separatrix, true, 1, false> : &expand<separatrix, true, 2, false>;
  }
}

SeriesKernel choose(const SeriesTerms& c, bool attitude) {
  return c.variables == RateVariables::separatrix ? choose<true>(c, attitude) : choose<false>(c, attitude);
}

}  // namespace polhode::POLHODE_ISA
