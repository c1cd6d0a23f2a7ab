// The operations of each closed form for one state, and the time that its products alone take on a processor with
// AVX-512. No clock is read: a number type counts. Loads, stores, shuffles and the call come on top. There are no
// divisions and no roots.
//
//     bench_operations [GHz] [512-bit fused multiply-adds a cycle]     # 3.6 and 1 of Zen 4, 3.55 and 2 of a Xeon
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "polhode/exact/detail/free_series.hpp"
#include "polhode/exact/detail/heavy_top_kernel.hpp"

namespace {

struct Count {
  long products = 0, sums = 0, others = 0;
};
Count count;

/// A double that counts what is done with it. A product fused with a sum is one operation, and so is a sign changed.
struct Counted {
  double v = 0.0;
  Counted() = default;
  Counted(double a) : v(a) {}  // NOLINT(google-explicit-constructor)
};
Counted counted(long& kind, double v) {
  ++kind;
  return v;
}
Counted operator+(Counted a, Counted b) { return counted(count.sums, a.v + b.v); }
Counted operator-(Counted a, Counted b) { return counted(count.sums, a.v - b.v); }
Counted operator*(Counted a, Counted b) { return counted(count.products, a.v * b.v); }
Counted operator-(Counted a) { return -a.v; }  // becomes part of the fused operation
bool operator<(Counted a, Counted b) { return ++count.others, a.v < b.v; }
bool operator>(Counted a, Counted b) { return ++count.others, a.v > b.v; }
Counted select(bool mask, Counted a, Counted b) { return counted(count.others, mask ? a.v : b.v); }
Counted madd(Counted a, Counted b, Counted c) { return counted(count.products, std::fma(a.v, b.v, c.v)); }
Counted fma(Counted a, Counted b, Counted c) { return madd(a, b, c); }
Counted rint(Counted a) { return counted(count.others, std::rint(a.v)); }
Counted abs(Counted a) { return counted(count.others, std::abs(a.v)); }
Counted copysign(Counted a, Counted b) { return counted(count.others, std::copysign(a.v, b.v)); }
Counted power_of_two(Counted n) { return counted(count.others, std::ldexp(1.0, static_cast<int>(n.v))); }
Counted guess_inverse_sqrt(Counted a) {
  count.others += 2;
  return polhode::math::guess_inverse_sqrt(a.v);
}
void add_quarters(Counted turns, Counted sin_r, Counted cos_r, Counted& sine, Counted& cosine) {
  count.others += 9;
  polhode::math::add_quarters(turns.v, sin_r.v, cos_r.v, sine.v, cosine.v);
}

double gigahertz = 3.6, fused_a_cycle = 1.0;

/// A register of eight states takes as many operations as one state does here. Sums are not counted as time: Zen 4 has
/// ports of their own for them.
template <class Work>
void tell(const char* name, const Work& work) {
  count = {};
  work();
  const double cycles = static_cast<double>(count.products) / fused_a_cycle;
  std::printf("%-28s %5ld %5ld %5ld   %6.1f  %5.2f\n", name, count.products, count.sums, count.others, cycles,
              cycles / 8.0 / gigahertz);
}

}  // namespace

int main(int arguments, char** values) {
  using namespace polhode::exact;
  if (arguments > 1) gigahertz = std::atof(values[1]);
  if (arguments > 2) fused_a_cycle = std::atof(values[2]);
  std::printf("%g GHz, %g fused multiply-adds a cycle; a state is one of eight lanes\n", gigahertz, fused_a_cycle);
  std::puts("closed form                  *,fma   +,-  rest   cycles  ns a state");
  FreeTrig<double> trig{};
  FreeHyper<double> hyper{};
  HeavyTopConstants top;
  Counted sink = 0.0;
  const Counted t = 0.3;
  const auto turned = [&](const auto& s) { sink.v += s.w.v; };
  tell("free motion, any times", [&] { turned(evaluate(trig, t)); });
  tell("free motion, grid", [&] {   // two angles turned by a table's, four operations and one for the rest each
    const Counted s = 0.3, c = 0.9;
    count.products += 2 * 8;
    turned(evaluate(trig, evaluate_pair(trig, s, c), s, c, s, c));
  });
  tell("near the separatrix", [&] { turned(evaluate(hyper, evaluate_passage(hyper, t))); });
  tell("heavy top, any times", [&] { turned(evaluate_heavy_top<false, false>(top, t)); });
  return sink.v == 1e300;
}
