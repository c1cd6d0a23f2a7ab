// Built with the flags of avx2 (cpp/CMakeLists.txt) where the compiler has them, else empty.
#include "ode/lanes/levels.hpp"

#if defined(__AVX2__) && defined(__FMA__)
#define POLHODE_ISA isa_avx2
#include "ode/lanes/series_loops.hpp"

namespace polhode::ode {
const SeriesKernels* avx2_series_kernels() { return &POLHODE_ISA::series_kernels; }
}  // namespace polhode::ode
#else
namespace polhode::ode {
const SeriesKernels* avx2_series_kernels() { return nullptr; }
}  // namespace polhode::ode
#endif
