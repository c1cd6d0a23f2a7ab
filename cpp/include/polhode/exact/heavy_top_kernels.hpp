#pragma once

#include <cstddef>

#include "polhode/core/simd.hpp"
#include "polhode/exact/heavy_top_kernel.hpp"

namespace polhode::exact {

/// The loop, compiled for one instruction set: one top at many times, omega (n, 3) and attitude (n, 4) row by row;
/// either may be null. A row's bits depend neither on n nor on its place; avx2 and avx512 give the same.
using HeavyTopLoop = void (*)(const HeavyTopConstants&, const double* t, std::size_t n, double* omega,
                              double* attitude);

/// That of a level; of the next lower one that was compiled.
HeavyTopLoop heavy_top_loop(SimdLevel level);

/// That of simd_level(), decided once.
HeavyTopLoop heavy_top_loop();

}  // namespace polhode::exact
