// Compiled with AVX2 flags (cpp/CMakeLists.txt) if the compiler has them, else empty.
#include "method/series/lanes/levels.hpp"

#if defined(__AVX2__) && defined(__FMA__)
#define POLHODE_ISA isa_avx2
#include "method/series/lanes/series_loops.hpp"

namespace polhode {
SeriesKernel avx2_series_kernel(const SeriesTerms& terms, bool attitude) {
  return POLHODE_ISA::choose(terms, attitude);
}
}  // namespace polhode
#else
namespace polhode {
SeriesKernel avx2_series_kernel(const SeriesTerms&, bool) { return nullptr; }
}  // namespace polhode
#endif
