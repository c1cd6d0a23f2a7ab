#pragma once

#include <vector>

#include "polhode/batch/free_motion.hpp"
#include "polhode/exact/free_sensitivity.hpp"

namespace polhode {

/// Derivatives of the free motion of many bodies at many times: d omega and d theta (bodies, times, 3, columns), and
/// the states; omega and attitude may be null. Errors, failed rows and refusals are those of free_motion. The bits of the
/// result do not depend on the number of threads.
std::size_t free_sensitivity(const FreeMotionBatch& batch, std::vector<SensitivityTo> wrt, RotationSide side,
                             double* omega, double* attitude, double* d_omega, double* d_attitude, int threads = 0);

}  // namespace polhode
