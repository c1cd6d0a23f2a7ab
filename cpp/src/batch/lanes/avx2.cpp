// Built with the flags of avx2 (cpp/CMakeLists.txt) where the compiler has them, else empty.
#include "batch/lanes/formula_block.hpp"
#include "batch/lanes/rk45_block.hpp"
#include "batch/lanes/step_kernels.hpp"
#include "batch/lanes/taylor_block.hpp"

#if defined(__AVX2__) && defined(__FMA__)
#define POLHODE_ISA isa_avx2
#include "math/lanes/avx2.hpp"
// The loops need `Wide`, which the line above defines.
#include "batch/lanes/rk45_loops.hpp"
#include "batch/lanes/step_loops.hpp"
#include "batch/lanes/taylor_loops.hpp"
#include "batch/lanes/formula_loops.hpp"

namespace polhode {
TaylorKernels avx2_taylor_lanes(const SeriesTerms& terms, bool attitude) {
  return POLHODE_ISA::choose_lanes(terms, attitude);
}
Rk45Kernels avx2_rk45_lanes(bool diagonal, bool attitude) { return POLHODE_ISA::choose_rk45(diagonal, attitude); }
const StepKernels* avx2_step_lanes() { return POLHODE_ISA::step_kernels(); }
FormulaKernels avx2_formula_lanes() { return POLHODE_ISA::formula_kernels(); }
}  // namespace polhode
#else
namespace polhode {
TaylorKernels avx2_taylor_lanes(const SeriesTerms&, bool) { return {nullptr, nullptr}; }
Rk45Kernels avx2_rk45_lanes(bool, bool) { return {nullptr, nullptr}; }
const StepKernels* avx2_step_lanes() { return nullptr; }
FormulaKernels avx2_formula_lanes() { return {nullptr, nullptr}; }
}  // namespace polhode
#endif
