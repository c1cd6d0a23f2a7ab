// One number at a time, for any processor.
#define POLHODE_ISA isa_baseline
#include "math/lanes/scalar.hpp"

namespace polhode::POLHODE_ISA {
using Wide = One;
}

#include "exact/sensitivity/lanes/column_loops.hpp"

namespace polhode::exact {
const FreeColumnsKernels* baseline_free_columns_kernels() { return &POLHODE_ISA::column_kernels; }
}  // namespace polhode::exact
