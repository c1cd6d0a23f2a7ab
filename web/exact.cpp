// The closed forms of cpp/src/exact/lanes/baseline.cpp: their loops over times are fast, and what runs once a body is
// small. A set-up takes the same time either way.
#define POLHODE_ISA isa_baseline
#include "math/lanes/scalar.hpp"

namespace polhode::POLHODE_ISA {
using Wide = One;
}

// What small and fast functions share stands before the pragma.
#include "exact/lanes/free_loops.hpp"
#include "exact/lanes/gyrostat_complex.hpp"
#include "exact/lanes/heavy_top_complex.hpp"
#include "polhode/math/detail/dd_functions.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/landen.hpp"

// The set-ups, and the damped body, which the page does not offer.
#pragma clang attribute push(__attribute__((minsize)), apply_to = function)
#include "exact/lanes/damped_loops.hpp"
#include "exact/lanes/gyrostat_coefficients.hpp"
#include "exact/lanes/heavy_top_setup.hpp"
#pragma clang attribute pop

#include "exact/lanes/baseline.cpp"
