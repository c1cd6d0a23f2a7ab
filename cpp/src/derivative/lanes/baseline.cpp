// For any processor.
#define POLHODE_ISA isa_baseline
#include "derivative/lanes/column_loops.hpp"

namespace polhode {
const ColumnKernels* baseline_column_kernels() { return &POLHODE_ISA::column_kernels; }
}  // namespace polhode
