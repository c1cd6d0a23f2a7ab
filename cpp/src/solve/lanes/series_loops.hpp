#pragma once

#include <type_traits>

#include "math/lanes/octet.hpp"
#include "polhode/ode/series.hpp"
#include "solve/lanes/levels.hpp"

namespace polhode::POLHODE_ISA {

constexpr int W = ode::series_width;

constexpr auto reciprocals = [] {
  struct Table {
    double of[ode::most_series_order + 2];
  } table{};
  for (int n = 1; n < ode::most_series_order + 2; ++n) table.of[n] = 1.0 / n;
  return table;
}();

/// The products of the recurrences, sum_j left_j right_{n-j}, eight components each, all in one loop: a loop's end costs
/// as much as several products. From `shared` on they have one right factor in common. The rows of the factors are kept,
/// the first and the last also in registers: nothing waits for a row to be written and read back.
template <int count, int shared>
class Products {
 public:
  static constexpr int rights = shared < count ? shared + 1 : count;

  POLHODE_INLINE void put_left(int p, int n, Octet row) {
    store8(left_[n][p], row);
    last_left_[p] = row;
    if (n == 0) first_left_[p] = row;
  }
  POLHODE_INLINE void put_right(int p, int n, Octet row) {
    store8(right_[n][p], row);
    last_right_[p] = row;
    if (n == 0) first_right_[p] = row;
  }
  POLHODE_INLINE void put(int p, int n, Octet left, Octet right) { put_left(p, n, left), put_right(p, n, right); }

  /// The newest rows come last, so that the rest of the sums can be made while they are still on their way.
  POLHODE_INLINE void sum(int n, Octet (&out)[count]) const {
    Octet a[count], b[count];
    const int middle = n / 2;
    const auto right = [](int p) { return p < rights ? p : rights - 1; };
    if (n == 0) {
      for (int p = 0; p < count; ++p) out[p] = first_left_[p] * first_right_[right(p)];
      return;
    }
    for (int p = 0; p < count; ++p) {
      a[p] = n % 2 == 0 ? load8(left_[middle][p]) * load8(right_[middle][right(p)]) : all8(0.0);
      b[p] = all8(0.0);
    }
    for (int i = middle + 1; i < n; ++i) {
      for (int p = 0; p < count; ++p) {
        a[p] = madd(load8(left_[i][p]), load8(right_[n - i][right(p)]), a[p]);
        b[p] = madd(load8(left_[n - i][p]), load8(right_[i][right(p)]), b[p]);
      }
    }
    for (int p = 0; p < count; ++p) {
      out[p] = madd(last_left_[p], first_right_[right(p)], a[p]) + madd(first_left_[p], last_right_[right(p)], b[p]);
    }
  }

 private:
  alignas(64) double left_[ode::most_series_order + 1][count][W], right_[ode::most_series_order + 1][rights][W];
  Octet first_left_[count], first_right_[rights], last_left_[count], last_right_[rights];
};

/// The recurrences of Euler's equations, a body's quaternion and what its torques see. Separatrix variables or plain
/// ones; `attitude`: the second half of y is the quaternion, else a fixed vector if there is one, else nothing.
template <bool separatrix, bool attitude, int fixed, bool gradient>
void expand(const SeriesTerms& c, const SeriesStart& start, int order, double* rows) {
  constexpr int vectors = fixed + (gradient ? 2 : 0);
  const double H = start.unit;
  const Octet unscale = join(all4(1.0 / H), all4(1.0));   // rates leave in their own unit
  const Quad product = load4(c.product), product_low = load4(c.product_low), to_rates = load4(c.to_rates);
  const Quad orbit = all4(c.orbit_rate * H);
  Quad damping[3] = {}, pull[fixed > 0 ? fixed : 1][3] = {}, tidal[2] = {};
  const bool damped = c.damped;
  for (int j = 0; j < 3; ++j) damping[j] = load4(c.damping[j]) * all4(H);
  for (int i = 0; i < fixed; ++i)
    for (int j = 0; j < 3; ++j) pull[i][j] = load4(c.pull[i][j]) * all4(H * H);
  for (int i = 0; i < 2; ++i) tidal[i] = load4(c.tidal[i]) * all4(H * H);

  // (q times k, rates) with (w3, rates); (q times i, q times j) with (w1, w2); u with itself; vectors with the rates
  constexpr int mixed = 0, turn = 1, pair = turn + attitude, carried = pair + gradient;
  Products<carried + vectors, carried> products;

  Quad r = load4(start.y) * all4(H), q = load4(start.y + 4), w, v[vectors > 0 ? vectors : 1] = {};
  for (int i = 0; i < vectors; ++i) v[i] = load4(start.vectors + 4 * i);
  Quad tau = load4(c.torque) * all4(H * H);

  const auto put = [&](int n) __attribute__((always_inline)) {
    if constexpr (!attitude && fixed == 1) q = v[0];
    store8(rows + W * n, join(r, q) * unscale);
    if constexpr (separatrix) {
      w = (permute<1, 2, 1, 3>(r) + (permute<0, 3, 0, 3>(r) ^ set4(-0.0, 0.0, 0.0, 0.0))) * to_rates;
    } else {
      w = r;
    }
    const Quad left = separatrix ? blend<4>(r, permute<3, 3, 0, 3>(w)) : permute<1, 2, 0, 3>(w);
    if constexpr (attitude) {
      const Octet signs = join(set4(0.0, 0.0, -0.0, -0.0), set4(-0.0, 0.0, 0.0, -0.0));
      products.put(turn, n, spread<3, 2, 1, 0, 2, 3, 0, 1>(q) ^ signs, spread<0, 0, 0, 0, 1, 1, 1, 1>(w));
      const Quad qk = permute<1, 0, 3, 2>(q) ^ set4(0.0, -0.0, 0.0, -0.0);
      products.put(mixed, n, join(qk, left), separatrix ? spread<2, 2, 2, 2, 1, 1, 2, 3>(w) : spread<2, 2, 2, 2, 2, 0, 1, 3>(w));
    } else {
      products.put(mixed, n, join(left, left), separatrix ? spread<1, 1, 2, 3, 1, 1, 2, 3>(w) : spread<2, 0, 1, 3, 2, 0, 1, 3>(w));
    }
    const Octet behind = join(all4(0.0), all4(-0.0));
    if constexpr (vectors > 0) products.put_right(carried, n, spread<2, 0, 1, 3, 1, 2, 0, 3>(w));
    for (int i = 0; i < vectors; ++i) products.put_left(carried + i, n, spread<1, 2, 0, 3, 2, 0, 1, 3>(v[i]) ^ behind);
    if constexpr (gradient) {
      const Quad u = v[fixed];
      if constexpr (separatrix) {
        products.put(pair, n, spread<0, 0, 2, 3, 1, 1, 3, 3>(u), spread<1, 1, 0, 3, 2, 2, 3, 3>(u));
      } else {
        products.put(pair, n, spread<1, 2, 0, 3, 3, 3, 3, 3>(u), spread<2, 0, 1, 3, 3, 3, 3, 3>(u));
      }
    }
    if (damped) {
      tau = madd(permute<0, 0, 0, 0>(w), damping[0], tau);
      tau = madd(permute<1, 1, 1, 1>(w), damping[1], tau);
      tau = madd(permute<2, 2, 2, 2>(w), damping[2], tau);
    }
    for (int i = 0; i < fixed; ++i) {
      tau = madd(permute<0, 0, 0, 0>(v[i]), pull[i][0], tau);
      tau = madd(permute<1, 1, 1, 1>(v[i]), pull[i][1], tau);
      tau = madd(permute<2, 2, 2, 2>(v[i]), pull[i][2], tau);
    }
  };

  put(0);
  for (int n = 0; n < order; ++n) {
    const Quad inverse = all4(reciprocals.of[n + 1]);
    Octet sums[carried + vectors];
    products.sum(n, sums);
    if constexpr (gradient) {
      const Octet uu = sums[pair];
      tau = madd(low(uu), tidal[0], tau);
      if constexpr (separatrix) tau = madd(high(uu), tidal[1], tau);
    }
    const Quad rates = high(sums[mixed]);
    // What the first coefficients lose to a rounded constant is lost at every step alike, and adds up.
    if (n < 4) tau = madd(rates, product_low, tau);
    const Quad slope = madd(rates, product, tau);
    r = n == 2 ? slope / all4(3.0) : slope * inverse;
    if constexpr (attitude) {
      const Quad sum = (low(sums[turn]) + high(sums[turn])) + low(sums[mixed]);
      q = n == 2 ? sum / all4(6.0) : sum * (inverse * all4(0.5));
    }
    Quad next[vectors > 0 ? vectors : 1];
    for (int i = 0; i < vectors; ++i) {
      next[i] = low(sums[carried + i]) + high(sums[carried + i]);
    }
    if constexpr (gradient) {
      next[fixed] = madd(orbit, v[fixed + 1], next[fixed]);
      next[fixed + 1] = next[fixed + 1] - orbit * v[fixed];
    }
    for (int i = 0; i < vectors; ++i) v[i] = next[i] * inverse;
    tau = all4(0.0);
    put(n + 1);
  }
}

template <bool separatrix>
SeriesKernel choose(const SeriesTerms& c, bool attitude) {
  if (!attitude) return c.fixed_vectors == 1 ? &expand<separatrix, false, 1, false> : &expand<separatrix, false, 0, false>;
  if (c.gradient) return c.fixed_vectors > 0 ? &expand<separatrix, true, 2, true> : &expand<separatrix, true, 0, true>;
  if (c.fixed_vectors == 0) return &expand<separatrix, true, 0, false>;
  return c.fixed_vectors == 1 ? &expand<separatrix, true, 1, false> : &expand<separatrix, true, 2, false>;
}

SeriesKernel choose(const SeriesTerms& c, bool attitude) {
  return c.variables == RateVariables::separatrix ? choose<true>(c, attitude) : choose<false>(c, attitude);
}

}  // namespace polhode::POLHODE_ISA
