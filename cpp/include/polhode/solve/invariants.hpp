#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "polhode/solve/motion.hpp"

namespace polhode {

/// Kinetic plus potential energy [J] of n states; omega (n, 3), attitude (n, 4) or null when no torque has a potential.
void compute_energy(const Scene& scene, std::size_t n, const double* t, const double* omega, const double* attitude,
                    double* energy);

/// Angular momentum in space axes, L_W = R_WB I w [kg m^2/s], of n states, written as (n, 3).
void compute_angular_momentum(const Scene& scene, std::size_t n, const double* omega, const double* attitude,
                              double* L_W);

/// How far each invariant that should hold moved from its value at the start, at most, over the samples:
/// "energy" relative to the largest kinetic plus potential energy seen, "angular_momentum" relative to its start,
/// "vertical_momentum" (L_z) relative to the largest |L|, "jacobi" (energy - n L_z, when a potential turns with the
/// orbit) as the energy. Invariants that do not hold, or need what was not wanted, are left out.
std::map<std::string, double> compute_drift(const Scene& scene, const Motion& motion);

}  // namespace polhode
