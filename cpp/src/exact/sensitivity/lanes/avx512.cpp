// Built with the flags of avx512 (cpp/CMakeLists.txt) where the compiler has them, else empty.
#include "exact/sensitivity/kernels.hpp"

#ifdef __AVX512DQ__
#define POLHODE_ISA isa_avx512
#include "math/lanes/avx512.hpp"
// The loops need `Wide`, which the line above defines.
#include "exact/sensitivity/lanes/column_loops.hpp"

namespace polhode::exact {
const FreeColumnsKernels* avx512_free_columns_kernels() { return &POLHODE_ISA::column_kernels; }
}  // namespace polhode::exact
#else
namespace polhode::exact {
const FreeColumnsKernels* avx512_free_columns_kernels() { return nullptr; }
}  // namespace polhode::exact
#endif
