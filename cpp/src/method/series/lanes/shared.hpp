#pragma once

#include "math/lanes/octet.hpp"
#include "polhode/ode/series.hpp"

// What the series of a body and those of its columns share.
namespace polhode::POLHODE_ISA {

constexpr auto reciprocals = [] {
  struct Table {
    double of[ode::most_series_order + 2];
  } table{};
  for (int n = 1; n < ode::most_series_order + 2; ++n) table.of[n] = 1.0 / n;
  return table;
}();

/// v x w = front(v) front(w) - back(v) back(w)
POLHODE_INLINE Quad front(Quad v) { return permute<1, 2, 0, 3>(v); }
POLHODE_INLINE Quad back(Quad v) { return permute<2, 0, 1, 3>(v); }
POLHODE_INLINE Quad negative(Quad v) { return v ^ all4(-0.0); }

}  // namespace polhode::POLHODE_ISA
