// For any processor.
#define POLHODE_ISA isa_baseline
#include "formula/lanes/levels.hpp"
#include "formula/lanes/table_loops.hpp"

namespace polhode::formula {
TableKernel baseline_table_kernel() { return &POLHODE_ISA::run; }
}  // namespace polhode::formula
