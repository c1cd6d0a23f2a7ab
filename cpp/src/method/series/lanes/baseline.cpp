// For any processor.
#define POLHODE_ISA isa_baseline
#include "method/series/lanes/levels.hpp"
#include "method/series/lanes/series_loops.hpp"
#include "method/series/lanes/column_loops.hpp"

namespace polhode {
SeriesKernel baseline_series_kernel(const SeriesTerms& terms, bool attitude) {
  return POLHODE_ISA::choose(terms, attitude);
}
const ColumnKernels* baseline_column_kernels() { return &POLHODE_ISA::column_kernels; }
}  // namespace polhode
