#pragma once

#include "polhode/solve/motion.hpp"

namespace polhode {

/// Gives the samples of a body that changes, or has driven rotors or a damper, on which no torque acts, the rates w = J^-1 (R^T L - h) of the angular
/// momentum L in space, which is constant. The error grows by the largest change. Nothing is changed where the error
/// would exceed the accuracy, which a large h may cause, and where the attitude is not known.
void keep_momentum(const Scene& scene, Motion& motion);

}  // namespace polhode
