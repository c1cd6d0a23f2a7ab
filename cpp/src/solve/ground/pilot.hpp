#pragma once

#include <vector>

#include "polhode/method/trajectory.hpp"
#include "polhode/solve/facts.hpp"

namespace polhode {

/// A low-accuracy run, which estimates |omega| and the angle of rotation at each sample.
struct PilotRun {
  std::vector<double> t, rate;    ///< [s], [rad/s]
  std::vector<double> angle;      ///< integral of |omega| since the start by trapezoids [rad]
  double revolutions() const;     ///< over all samples
};

inline constexpr double pilot_rtol = 1e-4;   ///< the tolerance of pilot runs

/// @param t0, rate0  time and |omega| at the start
PilotRun measure_rotation(const Trajectory& trajectory, double t0, double rate0);

/// `count` + 1 evenly spaced times over the whole span.
std::vector<double> spread_times(const Scene& scene, const Facts& facts, int count);

}  // namespace polhode
