#pragma once

#include "math/lanes/octet.hpp"
#include "derivative/column_rows.hpp"
#include "method/series/lanes/shared.hpp"

// Variational equations of a body by Taylor recurrences, eight columns in the lanes of registers.
namespace polhode::POLHODE_ISA {

void expand_vectors(const VectorRows& w, int order, double unit, double orbit, int count, VectorRows* vectors) {
  VectorRows front_w, back_w;   // of w, reversed: v x w = front(v) back(w) - back(v) front(w)
  for (int k = 0; k < order; ++k) {
    const Quad row = load4(w[k]);
    store4(front_w[k], negative(front(row))), store4(back_w[k], back(row));
  }
  for (int n = 0; n < order; ++n) {
    const Quad scale = all4(unit * reciprocals.of[n + 1]);
    for (int i = 0; i < count; ++i) {
      Quad even = all4(0.0), odd = all4(0.0), minus_even = all4(0.0), minus_odd = all4(0.0);
      for (int j = 0; j < n; j += 2) {
        const Quad v = load4(vectors[i][j]), after = load4(vectors[i][j + 1]);
        even = madd(front(v), load4(back_w[n - j]), even), odd = madd(front(after), load4(back_w[n - j - 1]), odd);
        minus_even = madd(back(v), load4(front_w[n - j]), minus_even);
        minus_odd = madd(back(after), load4(front_w[n - j - 1]), minus_odd);
      }
      if (n % 2 == 0) {
        const Quad v = load4(vectors[i][n]);
        even = madd(front(v), load4(back_w[0]), even), minus_even = madd(back(v), load4(front_w[0]), minus_even);
      }
      Quad sum = (even + odd) + (minus_even + minus_odd);
      if (orbit != 0.0 && i == count - 2) sum = madd(all4(orbit), load4(vectors[i + 1][n]), sum);
      if (orbit != 0.0 && i == count - 1) sum = madd(all4(-orbit), load4(vectors[i - 1][n]), sum);
      store4(vectors[i][n + 1], sum * scale);
    }
  }
}

/// Four rows at once, whose sums do not wait for each other.
void multiply_rows(const VectorRows& a, const VectorRows& b, int order, VectorRows& out) {
  int n = 0;
  for (; n + 3 <= order; n += 4) {
    Quad sum[4];
    for (Quad& row : sum) row = all4(0.0);
    for (int j = 0; j <= n; ++j) {
      const Quad left = load4(a[j]);
      for (int r = 0; r < 4; ++r) sum[r] = madd(left, load4(b[n + r - j]), sum[r]);
    }
    for (int r = 1; r < 4; ++r)
      for (int j = n + 1; j <= n + r; ++j) sum[r] = madd(load4(a[j]), load4(b[n + r - j]), sum[r]);
    for (int r = 0; r < 4; ++r) store4(out[n + r], sum[r]);
  }
  for (; n <= order; ++n) {
    Quad sum = all4(0.0);
    for (int j = 0; j <= n; ++j) sum = madd(load4(a[j]), load4(b[n - j]), sum);
    store4(out[n], sum);
  }
}

// As many columns as a register holds.
#if defined(__AVX512DQ__)
using Columns = Octet;
POLHODE_INLINE Columns load_columns(const double* p) { return load8(p); }
POLHODE_INLINE void store_columns(double* p, Columns a) { store8(p, a); }
POLHODE_INLINE Columns all_columns(double a) { return all8(a); }
constexpr int columns_at_once = 8;
#else
using Columns = Quad;
POLHODE_INLINE Columns load_columns(const double* p) { return load4(p); }
POLHODE_INLINE void store_columns(double* p, Columns a) { store4(p, a); }
POLHODE_INLINE Columns all_columns(double a) { return all4(a); }
constexpr int columns_at_once = 4;
#endif

/// The sums of one row in parts, so that no sum waits long for the last one.
template <bool pulled>
struct ColumnSums {
  Columns rates[3], pull[3], theta[3];

  /// Adds a row of the matrix times a row of the columns.
  POLHODE_INLINE void add(const MatrixRow& m, const Columns (&x)[6]) {
    rates[0] = madd(all_columns(m.rates[0]), x[1], rates[0]), rates[1] = madd(all_columns(m.rates[2]), x[2], rates[1]);
    rates[2] = madd(all_columns(m.rates[4]), x[0], rates[2]), theta[0] = madd(all_columns(m.theta[0]), x[4], theta[0]);
    theta[1] = madd(all_columns(m.theta[2]), x[5], theta[1]), theta[2] = madd(all_columns(m.theta[4]), x[3], theta[2]);
    rates[0] = madd(all_columns(m.rates[1]), x[2], rates[0]), rates[1] = madd(all_columns(m.rates[3]), x[0], rates[1]);
    rates[2] = madd(all_columns(m.rates[5]), x[1], rates[2]), theta[0] = madd(all_columns(m.theta[1]), x[5], theta[0]);
    theta[1] = madd(all_columns(m.theta[3]), x[3], theta[1]), theta[2] = madd(all_columns(m.theta[5]), x[4], theta[2]);
    if constexpr (pulled) {
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 3; ++i) pull[i] = madd(all_columns(m.pull[3 * i + c]), x[3 + c], pull[i]);
    }
  }
};

template <bool pulled>
class ColumnExpansion {
 public:
  ColumnExpansion(const MatrixRow* matrix, const double* linear, const ColumnForce* forces, int force_count,
                  double unit, int lane, ColumnRows columns)
      : matrix_(matrix), linear_(linear), forces_(forces), force_count_(force_count), unit_(unit), lane_(lane),
        rows_(columns) {}

  /// Two rows at once share what they load. Row n + 1 takes its newest term last.
  POLHODE_INLINE void run(int order) {
    for (int n = 0; n < order; n += 2) {
      ColumnSums<pulled> first, second;
      start(n, first), start(n + 1, second);
      Columns x[6], before[6];
      load(n, x);
      first.add(matrix_[0], x);
      for (int k = 1; k <= n; ++k) {
        for (int i = 0; i < 6; ++i) before[i] = x[i];
        load(n - k, x);
        first.add(matrix_[k], x);
        second.add(matrix_[k], before);
      }
      second.add(matrix_[n + 1], x);
      finish(n, first);
      if (n + 1 == order) return;
      load(n + 1, x);
      second.add(matrix_[0], x);
      finish(n + 1, second);
    }
  }

 private:
  POLHODE_INLINE void load(int n, Columns (&x)[6]) const {
    for (int i = 0; i < 6; ++i) x[i] = load_columns(rows_[i].of[n] + lane_);
  }

  /// Begins with what forces row n.
  POLHODE_INLINE void start(int n, ColumnSums<pulled>& sums) const {
    for (int i = 0; i < 3; ++i) sums.rates[i] = sums.pull[i] = sums.theta[i] = all_columns(0.0);
    for (const ColumnForce* force = forces_; force != forces_ + force_count_; ++force) {
      const Columns parts = load_columns(force->parts + lane_), value = all_columns(force->first[4 * n]);
      for (int i = 0; i < 3; ++i)
        if (force->component == i) sums.pull[i] = madd(parts, value, sums.pull[i]);
    }
  }

  /// Stores row n + 1.
  POLHODE_INLINE void finish(int n, const ColumnSums<pulled>& sums) {
    const Columns scale = all_columns(unit_ * reciprocals.of[n + 1]);
    for (int i = 0; i < 3; ++i) {
      Columns d = sums.rates[i] + sums.pull[i];
      for (int c = 0; c < 3; ++c)
        d = madd(all_columns(linear_[3 * i + c]), load_columns(rows_[c].of[n] + lane_), d);
      store_columns(rows_[i].of[n + 1] + lane_, d * scale);
      store_columns(rows_[3 + i].of[n + 1] + lane_, (load_columns(rows_[i].of[n] + lane_) + sums.theta[i]) * scale);
    }
  }

  const MatrixRow* matrix_;
  const double* linear_;
  const ColumnForce* forces_;
  int force_count_;
  double unit_;
  int lane_;
  ColumnRows rows_;
};

template <bool pulled>
void expand_columns(const MatrixRow* matrix, const double* linear, const ColumnForce* forces, int force_count,
                    int order, double unit, ColumnRows columns) {
  for (int lane = 0; lane < 8; lane += columns_at_once)
    ColumnExpansion<pulled>(matrix, linear, forces, force_count, unit, lane, columns).run(order);
}

void expand_columns(const MatrixRow* matrix, const double* linear, bool pulled, const ColumnForce* forces,
                    int force_count, int order, double unit, ColumnRows columns) {
  (pulled ? &expand_columns<true> : &expand_columns<false>)(matrix, linear, forces, force_count, order, unit, columns);
}

/// The sum of a number's terms in row n, in two parts, so that no product waits for the last one.
POLHODE_INLINE Columns add_terms(const LinearEquations& f, int i, int n, int lane, const ColumnSeriesRows* x) {
  Columns even = all_columns(0.0), odd = all_columns(0.0);
  for (const LinearForce* force = f.forces + f.first_force[i]; force != f.forces + f.first_force[i + 1]; ++force) {
    const Columns parts = load_columns(force->parts + lane);
    if (force->series >= 0) even = madd(parts, all_columns(f.series[n * f.stride + force->series]), even);
    else if (n == 0) even = even + parts;
  }
  for (const LinearTerm* term = f.terms + f.first_term[i]; term != f.terms + f.first_term[i + 1]; ++term) {
    const double(*from)[ode::series_width] = x[term->from].of;
    if (term->series < 0) {
      odd = madd(all_columns(term->factor), load_columns(from[n] + lane), odd);
      continue;
    }
    const double* a = f.series + term->series;
    int k = 0;
    for (; k < n; k += 2, a += 2 * f.stride) {
      even = madd(all_columns(a[0]), load_columns(from[n - k] + lane), even);
      odd = madd(all_columns(a[f.stride]), load_columns(from[n - k - 1] + lane), odd);
    }
    if (k == n) even = madd(all_columns(a[0]), load_columns(from[0] + lane), even);
  }
  return even + odd;
}

void expand_linear(const LinearEquations& equations, int order, double unit, ColumnRows columns) {
  for (int lane = 0; lane < 8; lane += columns_at_once) {
    for (int n = 0; n < order; ++n) {
      const Columns scale = all_columns(unit * reciprocals.of[n + 1]);
      for (int i = 0; i < equations.size; ++i)
        store_columns(columns[i].of[n + 1] + lane, add_terms(equations, i, n, lane, columns) * scale);
    }
  }
}

constexpr ColumnKernels column_kernels{&expand_vectors, &multiply_rows, &expand_columns, &expand_linear};

}  // namespace polhode::POLHODE_ISA
