// Built with the flags of avx512 (cpp/CMakeLists.txt) where the compiler has them, else empty.
#include "batch/summary/kernels.hpp"

#if defined(__AVX512DQ__)
#define POLHODE_ISA isa_avx512
#include "math/lanes/avx512.hpp"
// The loops need `Wide`, which the line above defines.
#include "batch/summary/lanes/summary_loops.hpp"

namespace polhode::summary {
const Kernels* avx512_kernels() { return &POLHODE_ISA::summary_kernels; }
}  // namespace polhode::summary
#else
namespace polhode::summary {
const Kernels* avx512_kernels() { return nullptr; }
}  // namespace polhode::summary
#endif
