#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "polhode/scene/scene.hpp"

namespace polhode {

/// One number of a scene by which a motion is differentiated.
struct SceneParameter {
  enum class Of { omega, attitude, inertia, axes, torque, torque_windows, rotor, rotor_windows, state, controller,
                  controller_state };
  enum RotorField { momentum, inertia, speed };

  Of of;
  std::size_t index = 0;   ///< which torque, rotor or controller of the scene; state: its number among those of all
  int field = 0;           ///< torque: its number in the record; rotor: a RotorField; windows: which window
  int component = 0;       ///< of a vector, or of a matrix row by row; windows: 0 is the begin, 1 the end;
                           ///< controller: its number among those of all parameters, or of all states
  std::string column;      ///< its name, as "torques.0.arm_x"
};

/// The number of the torque whose formula has a state of this name, among scene.torques(); their count if there is none.
std::size_t find_torque_of_state(const Scene& scene, std::string_view state);
/// The number of a formula's input among its parameters; -1 if there is none of this name.
int find_field(const torques::Formula& formula, std::string_view name);

/// The numbers of a group: "omega", "attitude" (a small rotation of the start), "inertia" (the principal moments: in
/// the caller's order if the axes are principal, else ascending), "axes" (a small rotation of the principal axes in the
/// body), "torques.0.weight" or "gravity.weight" where only one is there, "torques.0.windows" (the finite ends of its
/// windows), "rotors.0.momentum", "rotors.0.inertia", "rotors.0.speed", "rotors.0.during", "states.h" (the start of a state).
/// Of a controller "controllers.0.kp" (a parameter of its law, or the start of a state).
/// Of driven rotors also "rotors.0.torque", "rotors.0.viscous" and others; of a damper "damper.viscous".
/// @throws InvalidInput for a name that the scene does not have
std::vector<SceneParameter> find_parameters(const Scene& scene, std::string_view group);

}  // namespace polhode
