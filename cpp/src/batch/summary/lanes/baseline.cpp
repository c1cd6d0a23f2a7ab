// One number at a time, for any processor.
#define POLHODE_ISA isa_baseline
#include "math/lanes/scalar.hpp"

namespace polhode::POLHODE_ISA {
using Wide = One;
}

#include "batch/summary/lanes/summary_loops.hpp"

namespace polhode::summary {
const Kernels* baseline_kernels() { return &POLHODE_ISA::summary_kernels; }
}  // namespace polhode::summary
