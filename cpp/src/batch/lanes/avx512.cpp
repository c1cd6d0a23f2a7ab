// Built with the flags of avx512 (cpp/CMakeLists.txt) where the compiler has them, else empty.
#include "batch/lanes/levels.hpp"

#if defined(__AVX512DQ__)
#define POLHODE_ISA isa_avx512
#include "math/lanes/avx512.hpp"
// The loops need `Wide`, which the line above defines.
#include "batch/lanes/taylor_loops.hpp"

namespace polhode {
LaneKernels avx512_lane_kernels(const SeriesTerms& terms, bool attitude) { return POLHODE_ISA::choose_lanes(terms, attitude); }
}  // namespace polhode
#else
namespace polhode {
LaneKernels avx512_lane_kernels(const SeriesTerms&, bool) { return {nullptr, nullptr}; }
}  // namespace polhode
#endif
