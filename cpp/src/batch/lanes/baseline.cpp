// One lane at a time, for any processor.
#define POLHODE_ISA isa_baseline
#include "batch/lanes/levels.hpp"
#include "math/lanes/scalar.hpp"

namespace polhode::POLHODE_ISA {
using Wide = One;
}

#include "batch/lanes/taylor_loops.hpp"

namespace polhode {
LaneKernels baseline_lane_kernels(const SeriesTerms& terms, bool attitude) { return POLHODE_ISA::choose_lanes(terms, attitude); }
}  // namespace polhode
