#pragma once

#include <cstddef>
#include <span>

#include "polhode/spectrum/lines.hpp"

namespace polhode::spectrum {

/// Two unit vectors at even phases of periodic curves, (curves, phases, 2, 3).
struct Curves {
  std::span<const double> axes;
  std::size_t phases = 64;
};

/// The two vectors of a curve: the phase advances with the frequency f, and they rotate about the third axis with g
/// [rad/s].
struct Trial {
  std::size_t curve = 0;
  double f = 0.0, g = 0.0;
};

/// Numbers of a quadratic function of the two vectors: a constant, and xx, yy, xy, xz, yz of two symmetric matrices
/// without a trace.
constexpr std::size_t quadratic_numbers = 11;

/// What is known of the samples beside the function.
struct Calibration {
  bool scale = true;     ///< a factor >= 0 is found by least squares
  bool offset = false;   ///< a constant is found by least squares
};

/// The least sum of squares that each curve leaves, over quadratic functions that are given.
///
/// @param series     one series; y times the weight
/// @param shifts     the curves are tried from so many even phases of their first half
/// @param functions  (count, 11)
/// @param cost       (trials, shifts): the sum of squares that is left
/// @param which      (trials, shifts): the function that leaves it
/// @param threads    at most; 0: as many as the machine has. The numbers do not depend on it
/// @throws InvalidInput unless the sizes agree
void match_quadratics(const Series& series, const Curves& curves, std::span<const Trial> trials, std::size_t shifts,
                      std::span<const double> functions, const Calibration& calibration, double* cost, double* which,
                      int threads = 0);

}  // namespace polhode::spectrum
