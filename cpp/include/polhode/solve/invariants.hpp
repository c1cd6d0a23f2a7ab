#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "polhode/solve/motion.hpp"

namespace polhode {

/// Kinetic plus potential energy [J] of n states, without that inside rotors: omega (n, 3), attitude (n, 4) or null if
/// no torque has a potential.
void compute_energy(const Scene& scene, std::size_t n, const double* t, const double* omega, const double* attitude,
                    double* energy);

/// Angular momentum in space axes, L_W = R_WB (I w + h) [kg m^2/s] with the momentum h of rotors, of n states, written
/// as (n, 3).
void compute_angular_momentum(const Scene& scene, std::size_t n, const double* t, const double* omega,
                              const double* attitude, double* L_W);

/// The largest change of each invariant of the scene over the samples, from its value at the start.
/// - "energy": relative to the largest kinetic plus the largest potential energy.
/// - "angular_momentum": relative to |L| at the start, or to |I w| + |h| of a body with rotors.
/// - "vertical_momentum": L_z, relative to the largest |L|.
/// - "jacobi": energy - n L_z, for a potential that rotates with the orbit; relative like the energy.
/// Quantities that the scene does not conserve are left out, and those that need a state that was not requested.
std::map<std::string, double> compute_drift(const Scene& scene, const Motion& motion);

}  // namespace polhode
