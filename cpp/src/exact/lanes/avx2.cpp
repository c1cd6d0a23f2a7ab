// Built with the flags of avx2 (cpp/CMakeLists.txt) where the compiler has them, else empty.
#include "exact/lanes/levels.hpp"

#ifdef __AVX2__
#define POLHODE_ISA isa_avx2
#include "math/lanes/avx2.hpp"
// The loops need `Wide`, which the line above defines.
#include "exact/lanes/free_bodies.hpp"
#include "exact/lanes/gyrostat_loops.hpp"
#include "exact/lanes/heavy_top_loops.hpp"

namespace polhode::exact {
const FreeKernels* avx2_free_kernels() { return &POLHODE_ISA::free_kernels; }
const FreeBatchKernels* avx2_free_batch_kernels() { return &POLHODE_ISA::free_batch_kernels; }
const DampedKernels* avx2_damped_kernels() { return &POLHODE_ISA::damped_kernels; }
const HeavyTopKernels* avx2_heavy_top_kernels() { return &POLHODE_ISA::heavy_top_kernels; }
const GyrostatKernels* avx2_gyrostat_kernels() { return &POLHODE_ISA::gyrostat_kernels; }
}  // namespace polhode::exact
#else
namespace polhode::exact {
const FreeKernels* avx2_free_kernels() { return nullptr; }
const FreeBatchKernels* avx2_free_batch_kernels() { return nullptr; }
const DampedKernels* avx2_damped_kernels() { return nullptr; }
const HeavyTopKernels* avx2_heavy_top_kernels() { return nullptr; }
const GyrostatKernels* avx2_gyrostat_kernels() { return nullptr; }
}  // namespace polhode::exact
#endif
