// Compiled with the flags of avx512 (cpp/CMakeLists.txt) if the compiler has them, else empty.
#include "formula/lanes/levels.hpp"

#if defined(__AVX512DQ__)
#define POLHODE_ISA isa_avx512
#include "formula/lanes/table_loops.hpp"

namespace polhode::formula {
TableKernel avx512_table_kernel() { return &POLHODE_ISA::run; }
}  // namespace polhode::formula
#else
namespace polhode::formula {
TableKernel avx512_table_kernel() { return nullptr; }
}  // namespace polhode::formula
#endif
