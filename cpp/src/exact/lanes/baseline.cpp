// One number at a time, for any processor.
#define POLHODE_ISA isa_baseline
#include "math/lanes/scalar.hpp"

namespace polhode::POLHODE_ISA {
using Wide = One;
}

#include "exact/lanes/free_bodies.hpp"
#include "exact/lanes/gyrostat_loops.hpp"
#include "exact/lanes/heavy_top_loops.hpp"
#include "exact/lanes/levels.hpp"

namespace polhode::exact {

const FreeKernels* baseline_free_kernels() { return &POLHODE_ISA::free_kernels; }
const FreeBatchKernels* baseline_free_batch_kernels() { return &POLHODE_ISA::free_batch_kernels; }
const DampedKernels* baseline_damped_kernels() { return &POLHODE_ISA::damped_kernels; }
const HeavyTopKernels* baseline_heavy_top_kernels() { return &POLHODE_ISA::heavy_top_kernels; }
const GyrostatKernels* baseline_gyrostat_kernels() { return &POLHODE_ISA::gyrostat_kernels; }

}  // namespace polhode::exact
