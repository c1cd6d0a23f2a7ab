#pragma once

#include <bit>
#include <cstdint>

#include "polhode/math/detail/number.hpp"

// Bins from a number's bits. Each file that is built for one instruction set includes this after `Wide`.
namespace polhode::POLHODE_ISA {

/// The bits above the lowest 46: sign, exponent, and 6 bits of the mantissa.
#if defined(__AVX512DQ__)

POLHODE_INLINE void store_bits(std::int64_t* to, Wide a) {
  _mm512_storeu_si512(to, _mm512_srli_epi64(_mm512_castpd_si512(a.v), 46));
}

#elif defined(__AVX2__)

POLHODE_INLINE void store_bits(std::int64_t* to, Wide a) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_srli_epi64(_mm256_castpd_si256(a.v), 46));
}

#else

POLHODE_INLINE void store_bits(std::int64_t* to, Wide a) {
  *to = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(a.v) >> 46);
}

#endif

}  // namespace polhode::POLHODE_ISA
