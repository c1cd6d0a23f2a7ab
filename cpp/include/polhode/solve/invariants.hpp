#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "polhode/solve/motion.hpp"

namespace polhode {

/// Kinetic plus potential energy [J] of n states, with that of driven rotors and the damper, without that inside
/// other rotors: omega
/// (n, 3), attitude (n, 4) or null if no torque has a potential, and states (n, count_states()).
/// @param states  may be null without driven rotors and damper
void compute_energy(const Scene& scene, std::size_t n, const double* t, const double* omega, const double* attitude,
                    double* energy, const double* states = nullptr);

/// Angular momentum in space axes, L_W = R_WB (I w + h) [kg m^2/s] with the momentum h of rotors, of n states, written
/// as (n, 3).
void compute_angular_momentum(const Scene& scene, std::size_t n, const double* t, const double* omega,
                              const double* attitude, double* L_W, const double* states = nullptr);

/// The largest change of each invariant of the scene over the samples, from its value at the start.
/// - "energy": relative to the largest kinetic plus the largest potential energy.
/// - "angular_momentum": relative to |L| at the start, or to |I w| + |h| of a body with rotors.
/// - "vertical_momentum": L_z, relative to the largest |L|.
/// - "jacobi": energy - n L_z, for a potential that rotates with the orbit; relative like the energy.
/// - "energy_rise": how far the energy rises above an earlier value, relative to its largest, of a body that only loses
///   energy, by the friction of its rotors and its damper.
/// Quantities that the scene does not conserve are left out, and those that need a state that was not requested.
std::map<std::string, double> compute_drift(const Scene& scene, const Motion& motion);

}  // namespace polhode
