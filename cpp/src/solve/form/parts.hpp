#pragma once

#include <cstdio>
#include <optional>
#include <string>

#include "polhode/scene/scene.hpp"
#include "polhode/solve/closed_form.hpp"

// What the closed forms share: the parts of a scene from which one is made, and its refusal in words.
namespace polhode {

/// The gravity of a scene in which it is the only torque; rotors may spin beside it.
const torques::Gravity* find_only_gravity(const Scene& scene);

/// The symmetry axis of HeavyTop, which requires two moments equal bit for bit. A full tensor has none, because its
/// moments are rounded.
std::optional<int> find_top_axis(const Scene& scene, const Vector3d& arm);

/// True if free rotors take their axial moments from the inertia.
bool has_carrier(const Scene& scene);

/// True if a vector has no component beside that along one axis.
bool is_along(const Vector3d& v, int axis);

/// True if every torque that acts damps.
bool only_damps(const Scene& scene);

}  // namespace polhode

namespace polhode::form {

inline Refusal holds() { return {}; }

/// A refusal whose words are a literal, or are made by a function where they are wanted.
template <class Make>
Refusal refuse(Words words, const Make& make) {
  if constexpr (std::is_convertible_v<Make, const char*>) {
    return {true, words == Words::yes ? std::string(make) : std::string()};
  } else {
    return {true, words == Words::yes ? make() : std::string()};
  }
}

/// "Gravity and rotors act"
std::string list_torques(const Scene& scene, const Facts& facts);

/// "3e-05" of less than a thousandth, else "2.5 %"
std::string to_percent(double part);

/// "not free: Gravity acts"
Refusal refuse_torques(const Scene& scene, const Facts& facts, Words words);

inline int count_no_set_ups(const Scene&, const Facts&) { return 0; }

}  // namespace polhode::form
