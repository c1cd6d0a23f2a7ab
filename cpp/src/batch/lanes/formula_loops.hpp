#pragma once

#include "batch/lanes/formula_block.hpp"
#include "batch/lanes/taylor_loops.hpp"

// Taylor steps of bodies under formulas, with a body in each lane. Sums run in the order of formula::compute_series().
namespace polhode::POLHODE_ISA {

class FormulaSteps {
  using Code = FormulaCode;
  using Place = FormulaCode::Place;
  using Kind = FormulaCode::Line::Kind;

 public:
  static void step(FormulaBlock& block) {
    for (int at = 0; at < TaylorBlock::width; at += Wide::width) FormulaSteps(block, Pass{at}).run();
  }

 private:
  POLHODE_INLINE FormulaSteps(FormulaBlock& block, Pass pass)
      : b_(block), pass_(pass), code_(*block.code), rows_(block.rows + pass.at), numbers_(block.numbers + pass.at),
        older_(block.older + pass.at), starts_(block.starts + pass.at), unit_(pass.load(block.unit)) {}

  POLHODE_INLINE Wide load(const Row& row) const { return pass_.load(row); }
  POLHODE_INLINE Wide get(const Place& place, int n) const { return Wide::load(rows_ + place.offset + n * place.step); }
  POLHODE_INLINE void put(const Place& place, int n, Wide x) const { x.store(rows_ + place.offset + n * place.step); }
  POLHODE_INLINE Wide number(std::ptrdiff_t i) const { return Wide::load(numbers_ + lanes * i); }

  void run() {
    const int order = b_.order;
    start();
    begin();
    for (int n = 0; n < order; ++n) {
      integrate(n);
      if (n + 1 == order) break;
      if (n % 2 == 1) sum_older(n + 1);
      advance(n + 1);
    }
    const int row[5] = {0, 1, 2, order - 1, order};
    Wide rates[5][3];
    for (int k = 0; k < 5; ++k)
      for (int i = 0; i < 3; ++i) rates[k][i] = load(b_.c[i][row[k]]);
    finish_step<true, false>(b_, pass_, rates);
  }

  /// w_B = R_BP w_P of row n.
  POLHODE_INLINE void put_rates(int n, const Wide (&w)[3]) const {
    for (int i = 0; i < 3; ++i) put(code_.w_P[i], n, w[i]), pass_.store(b_.c[i][n], w[i] * unit_);
    if (!code_.rotated) return;
    for (int i = 0; i < 3; ++i) {
      const Wide first = load(b_.axes[i][0]) * w[0];
      put(code_.w_B[i], n, madd(load(b_.axes[i][2]), w[2], madd(load(b_.axes[i][1]), w[1], first)));
    }
  }

  /// Row 0 of the states. Those of waves and of vectors that rotate are there.
  void start() const {
    const Wide w[3] = {load(b_.y[0]), load(b_.y[1]), load(b_.y[2])};
    put_rates(0, w);
    Wide q[4];
    for (int i = 0; i < 4; ++i) {
      q[i] = load(b_.y[4 + i]);
      put(code_.q[i], 0, q[i]), pass_.store(b_.c[4 + i][0], q[i]);
    }
    const Wide two(2.0), x = -q[0], y = -q[1], z = -q[2];
    for (const Code::Vector& vector : code_.vectors) {
      Wide s[3];
      for (int i = 0; i < 3; ++i) s[i] = vector.rotates ? get(vector.place[i], 0) : number(vector.cosine + i);
      const Wide t0 = two * (y * s[2] - z * s[1]), t1 = two * (z * s[0] - x * s[2]), t2 = two * (x * s[1] - y * s[0]);
      put(vector.place[0], 0, madd(q[3], t0, s[0]) + (y * t2 - z * t1));
      put(vector.place[1], 0, madd(q[3], t1, s[1]) + (z * t0 - x * t2));
      put(vector.place[2], 0, madd(q[3], t2, s[2]) + (x * t1 - y * t0));
    }
    for (const Place& place : code_.time) put(place, 0, load(b_.time)), put(place, 1, unit_);
    for (const Code::Term& constant : code_.constants) put(constant.place, 0, number(constant.factor));
  }

  POLHODE_INLINE Wide add_up(const Code::Sum& sum, int n) const {
    Wide total = n == 0 ? number(sum.constant) : Wide(0.0);
    const Code::Term *term = code_.terms.data() + sum.begin, *end = code_.terms.data() + sum.end;
    for (; term != end; ++term) total = madd(number(term->factor), get(term->place, n), total);
    return total;
  }

  /// Row 0 of all lines, and the constants of the recurrences.
  void begin() const {
    for (const Code::Line& line : code_.lines) {
      switch (line.kind) {
        case Kind::sum: put(line.out, 0, add_up(line.sum, 0)); break;
        case Kind::product: put(line.out, 0, get(line.first, 0) * get(line.second, 0)); break;
        case Kind::general: begin_general(line); break;
        case Kind::copy: break;
      }
      if (line.weighted.offset >= 0) put(line.weighted, 0, Wide(0.0));
    }
  }

  void begin_general(const Code::Line& line) const {
    double* out = starts_ + line.start;
    for (int i = 0; i < Wide::width; ++i) {
      const formula::Recurrence& operation =
          b_.tapes[pass_.at + i]->operations()[static_cast<std::size_t>(line.operation)];
      const formula::RecurrenceStart from =
          formula::start_recurrence(operation, rows_[line.a.offset + i], rows_[line.b.offset + i]);
      rows_[line.out.offset + i] = from.value;
      out[i] = from.alpha, out[lanes + i] = from.c1, out[2 * lanes + i] = from.c2;
    }
  }

  /// Row n >= 1 of all lines.
  void advance(int n) const {
    const bool second = n % 2 == 1;
    const Wide count(n), inverse(1.0 / n);
    for (const Code::Line *at = code_.lines.data(), *end = at + code_.lines.size(); at != end; ++at) {
      const Code::Line& line = *at;
      Wide z;
      if (line.kind == Kind::sum) {
        z = add_up(line.sum, n);
      } else if (line.kind == Kind::copy) {
        z = get(line.out, n);
      } else {
        const Wide older = second ? add_newer(line, n) : Wide::load(older_ + 2 * lanes * line.product);
        const Wide first = get(line.first, n), other = get(line.second, n);
        if (line.kind == Kind::product) {
          z = madd(get(line.second, 0), first, madd(get(line.first, 0), other, older));
        } else {
          const double* start = starts_ + line.start;
          const Wide alpha = Wide::load(start), part = older * (line.divided ? alpha * inverse : alpha);
          z = madd(Wide::load(start + lanes), first, madd(Wide::load(start + 2 * lanes), other, part));
        }
      }
      if (line.kind != Kind::copy) put(line.out, n, z);
      if (line.weighted.offset >= 0) put(line.weighted, n, z * count);
    }
  }

  /// The older terms of row n, n odd: those found with row n - 1, and those that need row n - 1.
  POLHODE_INLINE Wide add_newer(const Code::Line& line, int n) const {
    if (n == 1) return Wide(0.0);
    const Code::Product& product = code_.products[static_cast<std::size_t>(line.product)];
    const double *left = rows_ + product.left, *right = rows_ + product.right;
    const Wide sum = Wide::load(older_ + 2 * lanes * line.product + lanes);
    const Wide one = madd(Wide::load(left + lanes * (n - 1)), Wide::load(right + lanes), sum);
    return madd(Wide::load(left + lanes), Wide::load(right + lanes * (n - 1)), one);
  }

  /// The terms of rows n and n + 1, n even, that need rows below n only.
  void sum_older(int n) const {
    const std::size_t count = code_.products.size();
    std::size_t first = 0;
    for (; first + at_once <= count; first += at_once) sum_group<at_once>(n, first);
    for (; first < count; ++first) sum_group<1>(n, first);
  }

  template <std::size_t count>
  POLHODE_INLINE void sum_group(int n, std::size_t first) const {
    const double *left[count], *right[count];
    Wide out[count], next[count];
    for (std::size_t p = 0; p < count; ++p) {
      const Code::Product& product = code_.products[first + p];
      left[p] = rows_ + product.left, right[p] = rows_ + product.right, out[p] = next[p] = Wide(0.0);
    }
    const auto at = [](const double* row, int j) __attribute__((always_inline)) { return Wide::load(row + lanes * j); };
    if (n > 3) {
      Wide above[count];   // right_{n + 1 - j}
      for (std::size_t p = 0; p < count; ++p) {
        above[p] = at(right[p], n - 2), out[p] = madd(at(left[p], 2), above[p], out[p]);
      }
      for (int j = 3; j <= n - 2; ++j) {
        for (std::size_t p = 0; p < count; ++p) {
          const Wide l = at(left[p], j), r = at(right[p], n - j);
          out[p] = madd(l, r, out[p]), next[p] = madd(l, above[p], next[p]);
          above[p] = r;
        }
      }
    }
    for (std::size_t p = 0; p < count; ++p) {
      const Wide newest_left = at(left[p], n - 1), newest_right = at(right[p], n - 1);
      out[p] = madd(newest_left, at(right[p], 1), out[p]);
      if (n == 2) continue;
      out[p] = madd(at(left[p], 1), newest_right, out[p]);
      next[p] = madd(newest_left, at(right[p], 2), next[p]), next[p] = madd(at(left[p], 2), newest_right, next[p]);
    }
    for (std::size_t p = 0; p < count; ++p) {
      double* to = older_ + 2 * lanes * static_cast<std::ptrdiff_t>(first + p);
      out[p].store(to), next[p].store(to + lanes);
    }
  }

  POLHODE_INLINE Wide over(int n, Wide rate) const {
    return n == 2 ? rate * unit_ / Wide(3.0) : rate * (unit_ * Wide(1.0 / (n + 1)));
  }

  /// Row n + 1 of the states, once row n of the lines is known.
  void integrate(int n) const {
    Wide tau[3];
    for (int i = 0; i < 3; ++i) tau[i] = add_up(code_.torque[i], n);
    integrate_vectors(n);
    Wide next[3];
    integrate_body(n, tau, next);
    put_rates(n + 1, next);
  }

  POLHODE_INLINE void integrate_body(int n, const Wide (&tau_B)[3], Wide (&next)[3]) const {
    const double* w[3];
    const double* r[3];
    const double* q[4];
    for (int i = 0; i < 3; ++i) w[i] = rows_ + code_.w_P[i].offset, r[i] = rows_ + code_.w_B[i].offset;
    for (int i = 0; i < 4; ++i) q[i] = rows_ + code_.q[i].offset;
    const Wide zero(0.0);
    Wide p[3] = {zero, zero, zero}, a[4] = {zero, zero, zero, zero}, o[4] = {zero, zero, zero, zero};
    const auto at = [](const double* row, int j) __attribute__((always_inline)) { return Wide::load(row + lanes * j); };
    sum_products(n, [&](int j, int i) __attribute__((always_inline)) {
      const Wide r0 = held(at(r[0], i)), r1 = held(at(r[1], i)), r2 = held(at(r[2], i));
      p[0] = madd(at(w[1], j), at(w[2], i), p[0]);
      p[1] = madd(at(w[2], j), at(w[0], i), p[1]);
      p[2] = madd(at(w[0], j), at(w[1], i), p[2]);
      const Wide qx = held(at(q[0], j)), qy = held(at(q[1], j)), qz = held(at(q[2], j)), qw = held(at(q[3], j));
      a[0] = madd(qw, r0, a[0]), o[0] = madd(qz, r1, o[0]);
      a[1] = madd(qw, r1, a[1]), o[1] = madd(qx, r2, o[1]);
      a[2] = madd(qw, r2, a[2]), o[2] = madd(qy, r0, o[2]);
      a[3] = madd(qx, r0, a[3]), o[3] = madd(qz, r2, o[3]);
      a[0] = madd(qy, r2, a[0]), a[1] = madd(qz, r0, a[1]), a[2] = madd(qx, r1, a[2]), a[3] = madd(qy, r1, a[3]);
    });
    const Wide half(0.5);
    const Wide rate[4] = {a[0] - o[0], a[1] - o[1], a[2] - o[2], -(a[3] + o[3])};
    for (int i = 0; i < 4; ++i) {
      const Wide row = over(n, half * rate[i]);
      put(code_.q[i], n + 1, row), pass_.store(b_.c[4 + i][n + 1], row);
    }
    Wide tau[3] = {tau_B[0], tau_B[1], tau_B[2]};
    if (code_.rotated) {
      for (int i = 0; i < 3; ++i) {
        const Wide first = load(b_.axes[0][i]) * tau_B[0];
        tau[i] = madd(load(b_.axes[2][i]), tau_B[2], madd(load(b_.axes[1][i]), tau_B[1], first));
      }
    }
    if (b_.rotors) {   // + h x w
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        tau[i] = madd(load(b_.momentum[j]), get(code_.w_P[k], n), tau[i]);
        tau[i] = madd(-load(b_.momentum[k]), get(code_.w_P[j], n), tau[i]);
      }
    }
    // The low part of a constant counts in the first rows: its error would be the same in every step.
    for (int i = 0; i < 3; ++i) {
      Wide sum = tau[i] * load(b_.inverse[i]);
      if (n < 4) sum = madd(p[i], load(b_.product_low[i]), sum);
      next[i] = over(n, madd(p[i], load(b_.product[i]), sum));
    }
  }

  /// v' = v x w, and n times the partner for a vector that rotates.
  POLHODE_INLINE void integrate_vectors(int n) const {
    const Wide zero(0.0);
    const auto at = [](const double* row, int j) __attribute__((always_inline)) { return Wide::load(row + lanes * j); };
    const double* r[3];
    for (int i = 0; i < 3; ++i) r[i] = rows_ + code_.w_B[i].offset;
    for (std::size_t index = 0; index < code_.vectors.size(); ++index) {
      const Code::Vector& vector = code_.vectors[index];
      const double* v[3];
      for (int i = 0; i < 3; ++i) v[i] = rows_ + vector.place[i].offset;
      Wide a[3] = {zero, zero, zero}, o[3] = {zero, zero, zero};
      sum_products(n, [&](int j, int i) __attribute__((always_inline)) {
        const Wide r0 = held(at(r[0], i)), r1 = held(at(r[1], i)), r2 = held(at(r[2], i));
        const Wide s0 = held(at(v[0], j)), s1 = held(at(v[1], j)), s2 = held(at(v[2], j));
        a[0] = madd(s1, r2, a[0]), a[1] = madd(s2, r0, a[1]), a[2] = madd(s0, r1, a[2]);
        o[0] = madd(s2, r1, o[0]), o[1] = madd(s0, r2, o[1]), o[2] = madd(s1, r0, o[2]);
      });
      for (int i = 0; i < 3; ++i) {
        Wide rate = a[i] - o[i];
        if (vector.rotates) {
          const Wide pace = vector.second ? -number(vector.rate) : number(vector.rate);
          rate = madd(pace, get(code_.vectors[vector.second ? index - 1 : index + 1].place[i], n), rate);
        }
        put(vector.place[i], n + 1, over(n, rate));
      }
    }
  }

  static constexpr std::ptrdiff_t lanes = TaylorBlock::width;
#if defined(__AVX512DQ__)
  static constexpr std::size_t at_once = 4;   // products whose sums are under way at a time
#else
  static constexpr std::size_t at_once = 2;
#endif

  FormulaBlock& b_;
  Pass pass_;
  const FormulaCode& code_;
  double *rows_, *numbers_, *older_, *starts_;
  Wide unit_;
};

inline FormulaKernels formula_kernels() { return {&FormulaSteps::step, &sample_lanes}; }

}  // namespace polhode::POLHODE_ISA
