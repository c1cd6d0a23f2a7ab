#include <initializer_list>

#include "exact/expansion.hpp"
#include "polhode/exact/detail/free_setup.hpp"

namespace polhode::exact {
namespace {

using math::DD;

Expansion product(const Expansion& e, double b) {
  Expansion p;
  for (int i = 0; i < e.size; ++i) {
    const DD t = math::two_prod(e.term[i], b);
    p.add(t.lo);
    p.add(t.hi);
  }
  return p;
}

}  // namespace

DoubleDouble<double> separatrix_distance_exact(double I1, double I2, double I3, double w1, double w3) {
  const DD high = math::two_diff(I3, I2), low = math::two_diff(I2, I1);
  Expansion third, first;
  third.add(high.lo), third.add(high.hi);
  first.add(-low.lo), first.add(-low.hi);
  for (const double factor : {I3, w3, w3}) third = product(third, factor);
  for (const double factor : {I1, w1, w1}) first = product(first, factor);
  for (int i = 0; i < first.size; ++i) third.add(first.term[i]);
  DD sum(0.0);
  for (int i = third.size - 1; i >= 0; --i) sum = sum + third.term[i];
  return sum;
}

}  // namespace polhode::exact
