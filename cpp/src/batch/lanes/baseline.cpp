// One lane at a time, for any processor.
#define POLHODE_ISA isa_baseline
#include "math/lanes/scalar.hpp"

namespace polhode::POLHODE_ISA {
using Wide = One;
POLHODE_INLINE unsigned bits(bool mask) { return mask; }
}

#include "batch/lanes/rk45_loops.hpp"
#include "batch/lanes/step_loops.hpp"
#include "batch/lanes/taylor_loops.hpp"
#include "batch/lanes/formula_loops.hpp"

namespace polhode {
TaylorKernels baseline_taylor_lanes(const SeriesTerms& terms, bool attitude) {
  return POLHODE_ISA::choose_lanes(terms, attitude);
}
Rk45Kernels baseline_rk45_lanes(bool diagonal, bool attitude) { return POLHODE_ISA::choose_rk45(diagonal, attitude); }
const StepKernels* baseline_step_lanes() { return POLHODE_ISA::step_kernels(); }
FormulaKernels baseline_formula_lanes() { return POLHODE_ISA::formula_kernels(); }
}  // namespace polhode
