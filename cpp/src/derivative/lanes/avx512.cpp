// Compiled with AVX-512 flags (cpp/CMakeLists.txt) if the compiler has them, else empty.
#include "derivative/column_rows.hpp"

#if defined(__AVX512DQ__)
#define POLHODE_ISA isa_avx512
#include "derivative/lanes/column_loops.hpp"

namespace polhode {
const ColumnKernels* avx512_column_kernels() { return &POLHODE_ISA::column_kernels; }
}  // namespace polhode
#else
namespace polhode {
const ColumnKernels* avx512_column_kernels() { return nullptr; }
}  // namespace polhode
#endif
