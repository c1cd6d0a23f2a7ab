// Built with the flags of avx2 (cpp/CMakeLists.txt) where the compiler has them, else empty.
#include "batch/summary/kernels.hpp"

#if defined(__AVX2__) && defined(__FMA__)
#define POLHODE_ISA isa_avx2
#include "math/lanes/avx2.hpp"
// The loops need `Wide`, which the line above defines.
#include "batch/summary/lanes/summary_loops.hpp"

namespace polhode::summary {
const Kernels* avx2_kernels() { return &POLHODE_ISA::summary_kernels; }
}  // namespace polhode::summary
#else
namespace polhode::summary {
const Kernels* avx2_kernels() { return nullptr; }
}  // namespace polhode::summary
#endif
