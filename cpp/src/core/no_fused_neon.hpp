#pragma once

// Before every file for AArch64 by Clang (cpp/CMakeLists.txt): Eigen fuses products and sums where this macro is set, and
// answers would not have the bits of x86. Clang's own header needs the macro, so it is read first.
#include <arm_neon.h>
#undef __ARM_FEATURE_FMA
