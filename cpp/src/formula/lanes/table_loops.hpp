#pragma once

#include <cstddef>

#include "formula/lanes/levels.hpp"
#include "formula/lanes/octet.hpp"

// A table run row by row. The order of all sums is that of compute_series() on the table's tape.
namespace polhode::formula::POLHODE_ISA {

class Expansion {
 public:
  POLHODE_INLINE Expansion(const TableParts& parts, const Workspace& workspace, double unit)
      : stages_(parts.stages.data()), stages_end_(stages_ + parts.stages.size()), rates_(parts.rates.data()),
        picks_(parts.picks.data()), values_(workspace.values), w_(workspace), unit_(unit), states_(parts.states),
        waves_(parts.waves), stores_(parts.stores), given_(parts.given), extras_(parts.extras),
        first_wave_(8 * parts.first_wave), first_extra_(8 * parts.first_extra), row_size_(16 * parts.stores) {}

  /// Values of row 0, and the constants of the recurrences.
  POLHODE_INLINE void begin(const Recurrence* operations) {
    double* constants = w_.constants;
    for (const Stage* at_stage = stages_; at_stage != stages_end_; ++at_stage) {
      const Stage& stage = *at_stage;
      double* out = values_ + 8 * stage.octet;
      if (stage.kind == Stage::Kind::sum) {
        store(out, sum(stage.first, load(stage.constant.data())));
      } else if (stage.kind == Stage::Kind::product) {
        store(out, put_factors(stage, 0).both());
      } else {
        for (int i = 0; i < 8; ++i) {
          const auto lane = static_cast<std::size_t>(i);
          const RecurrenceStart start =
              start_recurrence(operations[stage.operations[lane]], values_[stage.a[lane]], values_[stage.b[lane]]);
          constants[i] = start.alpha, constants[8 + i] = start.c1, constants[16 + i] = start.c2;
          w_.scratch[i] = start.value;
        }
        store(out, load(w_.scratch));
        constants += 24;
      }
    }
  }

  /// Row n of all stages, n >= 1, from the older terms of its sums: `second` says whether they are those of row n + 1
  /// of the last pass.
  POLHODE_INLINE void advance(int n, bool second) {
    const double* constants = w_.constants;
    for (const Stage* at_stage = stages_; at_stage != stages_end_; ++at_stage) {
      const Stage& stage = *at_stage;
      double* out = values_ + 8 * stage.octet;
      if (stage.kind == Stage::Kind::sum) {
        store(out, sum(stage.first, all(0.0)));
        continue;
      }
      const Octet older = load(w_.older + 16 * stage.store + (second ? 8 : 0));
      if (stage.kind == Stage::Kind::product) {
        const Factors now = put_factors(stage, n);
        const double* start = row(0) + 16 * stage.store;
        store(out, madd(load(start + 8), now.left, madd(load(start), now.right, older)));
      } else {
        const Octet divided = load(stage.divided.data());
        const Octet part = load(constants) * madd(divided, all(1.0 / n), one_minus(divided));
        const Octet first = gather(values_, picks_, stage.first), other = gather(values_, picks_, stage.second);
        store(out, madd(load(constants + 8), first, madd(load(constants + 16), other, older * part)));
        constants += 24;
      }
    }
  }

  /// Factors of general operations, once all values of row n are known.
  POLHODE_INLINE void put_general(int n) {
    for (const Stage* at_stage = stages_; at_stage != stages_end_; ++at_stage) {
      const Stage& stage = *at_stage;
      if (stage.kind != Stage::Kind::general) continue;
      double* at = row(n) + 16 * stage.store;
      const Octet weighted = load(stage.weighted.data());
      store(at, gather(values_, picks_, stage.left) * madd(weighted, all(n), one_minus(weighted)));
      store(at + 8, gather(values_, picks_, stage.right));
    }
  }

  /// Row n + 1 of the states and the waves.
  POLHODE_INLINE void integrate(int n) {
    switch (states_) {
      case 1: integrate_states<1>(n); break;
      case 2: integrate_states<2>(n); break;
      case 3: integrate_states<3>(n); break;
      default: integrate_many(n);
    }
    for (int i = 0; i < waves_; ++i)
      store(values_ + first_wave_ + 8 * i, load(w_.waves + 8 * ((n + 1) * waves_ + i)));
  }

  /// The terms of rows n and n + 1, n even, that need rows below n only.
  POLHODE_INLINE void sum_older(int n) {
    int o = 0;
    for (; o + octets_at_once <= stores_; o += octets_at_once) sum_group<octets_at_once>(n, o);
    if constexpr (octets_at_once > 1) {
      if (o < stores_) sum_group<1>(n, o);
    }
  }

  /// The terms of row n + 1 that need row n.
  POLHODE_INLINE void sum_newer(int n) {
    if (n == 0) return;
    const double *now = row(n), *start = row(1);
    for (int o = 0; o < stores_; ++o, now += 16, start += 16) {
      double* out = w_.older + 16 * o + 8;
      store(out, madd(load(start), load(now + 8), madd(load(now), load(start + 8), load(out))));
    }
  }

  POLHODE_INLINE void write(int n, double* rows, double* extras) const {
    for (int i = 0; i < given_; ++i) copy(values_ + 8 * i, rows + 8 * (n * given_ + i));
    if (extras == nullptr) return;
    for (int i = 0; i < extras_; ++i)
      copy(values_ + first_extra_ + 8 * i, extras + 8 * (n * extras_ + i));
  }

 private:
  struct Factors {
    Octet left, right;
    POLHODE_INLINE Octet both() const { return left * right; }
  };

  POLHODE_INLINE double* row(int n) const { return w_.stores + n * row_size_; }
  static POLHODE_INLINE Octet one_minus(Octet a) { return madd(a, all(-1.0), all(1.0)); }
  static POLHODE_INLINE void copy(const double* from, double* to) {
    for (int i = 0; i < 8; ++i) to[i] = from[i];
  }

  POLHODE_INLINE Octet sum(Range terms, Octet total) const {
    for (const Pick *pick = picks_ + terms.begin, *end = picks_ + terms.end; pick != end; ++pick)
      total = madd(load(pick->factor.data()), take(values_, *pick), total);
    return total;
  }

  POLHODE_INLINE Factors put_factors(const Stage& stage, int n) {
    const Factors now{gather(values_, picks_, stage.first), gather(values_, picks_, stage.second)};
    double* at = row(n) + 16 * stage.store;
    store(at, now.left), store(at + 8, now.right);
    return now;
  }

  /// A rate times unit / (n + 1).
  POLHODE_INLINE Octet compute_next(const Stage& stage, int n) const {
    if (n == 0) return sum(stage.first, load(stage.constant.data())) * all(unit_);
    const Octet rate = sum(stage.first, all(0.0));
    // Of the first divisions the one by 3 rounds, and its error would be the same in each step.
    return n == 2 ? rate * all(unit_) / all(3.0) : rate * all(unit_ * (1.0 / (n + 1)));
  }

  /// All rates are computed before the first state changes.
  template <int count>
  POLHODE_INLINE void integrate_states(int n) {
    Octet next[count];
    for (int i = 0; i < count; ++i) next[i] = compute_next(rates_[i], n);
    for (int i = 0; i < count; ++i) store(values_ + 8 * i, next[i]);
  }
  POLHODE_INLINE void integrate_many(int n) {
    for (int i = 0; i < states_; ++i) store(w_.scratch + 8 * i, compute_next(rates_[i], n));
    for (int i = 0; i < states_; ++i) store(values_ + 8 * i, load(w_.scratch + 8 * i));
  }

  template <int count>
  POLHODE_INLINE void sum_group(int n, int first) {
    Octet out[count], next[count];
    for (int p = 0; p < count; ++p) out[p] = next[p] = all(0.0);
    const double* base = w_.stores + 16 * first;
    const auto left = [&](int j, int p) POLHODE_LAMBDA { return load(base + j * row_size_ + 16 * p); };
    const auto right = [&](int j, int p) POLHODE_LAMBDA { return load(base + j * row_size_ + 16 * p + 8); };
    if (n > 3) {
      Octet above[count];   // right_{n + 1 - j}
      for (int p = 0; p < count; ++p) above[p] = right(n - 2, p), out[p] = madd(left(2, p), above[p], out[p]);
      for (int j = 3; j <= n - 2; ++j) {
        for (int p = 0; p < count; ++p) {
          const Octet l = left(j, p), r = right(n - j, p);
          out[p] = madd(l, r, out[p]), next[p] = madd(l, above[p], next[p]);
          above[p] = r;
        }
      }
    }
    for (int p = 0; p < count && n > 0; ++p) {
      const Octet newest_left = left(n - 1, p), newest_right = right(n - 1, p);
      out[p] = madd(newest_left, right(1, p), out[p]);
      if (n == 2) continue;
      out[p] = madd(left(1, p), newest_right, out[p]);
      next[p] = madd(newest_left, right(2, p), next[p]), next[p] = madd(left(2, p), newest_right, next[p]);
    }
    for (int p = 0; p < count; ++p)
      store(w_.older + 16 * (first + p), out[p]), store(w_.older + 16 * (first + p) + 8, next[p]);
  }

  // Copies, because each store of a vector may change what a pointer or a reference leads to.
  const Stage *stages_, *stages_end_, *rates_;
  const Pick* picks_;
  double* values_;
  Workspace w_;
  double unit_;
  int states_, waves_, stores_, given_, extras_;
  std::ptrdiff_t first_wave_, first_extra_, row_size_;
};

void run(const TableParts& parts, const Recurrence* operations, const Workspace& workspace, double unit, int order,
         double* rows, double* extras) {
  Expansion expansion(parts, workspace, unit);
  expansion.begin(operations);
  expansion.sum_older(0);
  expansion.write(0, rows, extras);
  for (int n = 0; n < order; ++n) {
    expansion.integrate(n);
    const int m = n + 1;
    const bool second = m % 2 == 1;
    if (second) {
      expansion.sum_newer(n);
    } else {
      expansion.sum_older(m);
    }
    expansion.advance(m, second);
    expansion.put_general(m);
    expansion.write(m, rows, extras);
  }
}

}  // namespace polhode::formula::POLHODE_ISA
