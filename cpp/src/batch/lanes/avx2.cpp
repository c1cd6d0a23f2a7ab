// Built with the flags of avx2 (cpp/CMakeLists.txt) where the compiler has them, else empty.
#include "batch/lanes/levels.hpp"

#if defined(__AVX2__) && defined(__FMA__)
#define POLHODE_ISA isa_avx2
#include "math/lanes/avx2.hpp"
// The loops need `Wide`, which the line above defines.
#include "batch/lanes/taylor_loops.hpp"

namespace polhode {
LaneKernels avx2_lane_kernels(const SeriesTerms& terms, bool attitude) { return POLHODE_ISA::choose_lanes(terms, attitude); }
}  // namespace polhode
#else
namespace polhode {
LaneKernels avx2_lane_kernels(const SeriesTerms&, bool) { return {nullptr, nullptr}; }
}  // namespace polhode
#endif
