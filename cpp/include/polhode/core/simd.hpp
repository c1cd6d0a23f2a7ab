#pragma once

namespace polhode {

/// The instruction sets that the kernels are compiled for.
enum class SimdLevel { baseline, avx2, avx512 };

/// "baseline", "avx2" or "avx512".
const char* to_text(SimdLevel level);

/// The highest level this machine has, capped by the environment variable POLHODE_SIMD; decided at the first call.
/// Throws InvalidInput for a value of POLHODE_SIMD that names no level.
SimdLevel simd_level();

}  // namespace polhode
