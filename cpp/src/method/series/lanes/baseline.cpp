// For any processor.
#define POLHODE_ISA isa_baseline
#include "method/series/lanes/levels.hpp"
#include "method/series/lanes/series_loops.hpp"

namespace polhode {
SeriesKernel baseline_series_kernel(const SeriesTerms& terms, bool attitude) {
  return POLHODE_ISA::choose(terms, attitude);
}
}  // namespace polhode
