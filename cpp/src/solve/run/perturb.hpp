#pragma once

#include "polhode/scene/scene.hpp"

namespace polhode {

/// The scene with every non-zero input changed by some units in the last place, up or down by a fixed rule. Its motion
/// shows the effect of rounded inputs. Custom torques are not changed, nor are ends of windows at the start or outside
/// the span, nor any window if rotors have some.
Scene perturb(const Scene& scene, int units = 2);

/// A state changed by `units` units of rounding, up or down by a rule that `seed` chooses. Components that are exactly
/// 0 may be kept.
State perturb_state(const State& state, double units, int seed, bool keep_zeros = false);

}  // namespace polhode
