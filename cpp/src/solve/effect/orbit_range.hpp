#pragma once

#include "polhode/formula/ephemeris.hpp"

namespace polhode::effect {

/// Bounds of an orbit over a span.
struct OrbitRange {
  double least_distance, most_distance;   ///< [m]
  double most_speed;                      ///< [m/s]
};

/// A conic by its elements; without bounds, from 0 to infinity, for another path. They include the rounding of r and v.
OrbitRange find_range(const formula::Ephemeris& ephemeris, double first, double last);

}  // namespace polhode::effect
