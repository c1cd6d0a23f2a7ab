// Compiled with AVX2 flags (cpp/CMakeLists.txt) if the compiler has them, else empty.
#include "derivative/column_rows.hpp"

#if defined(__AVX2__) && defined(__FMA__)
#define POLHODE_ISA isa_avx2
#include "derivative/lanes/column_loops.hpp"

namespace polhode {
const ColumnKernels* avx2_column_kernels() { return &POLHODE_ISA::column_kernels; }
}  // namespace polhode
#else
namespace polhode {
const ColumnKernels* avx2_column_kernels() { return nullptr; }
}  // namespace polhode
#endif
