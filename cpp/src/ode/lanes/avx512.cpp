// Built with the flags of avx512 (cpp/CMakeLists.txt) where the compiler has them, else empty.
#include "ode/lanes/levels.hpp"

#if defined(__AVX512DQ__)
#define POLHODE_ISA isa_avx512
#include "ode/lanes/series_loops.hpp"

namespace polhode::ode {
const SeriesKernels* avx512_series_kernels() { return &POLHODE_ISA::series_kernels; }
}  // namespace polhode::ode
#else
namespace polhode::ode {
const SeriesKernels* avx512_series_kernels() { return nullptr; }
}  // namespace polhode::ode
#endif
