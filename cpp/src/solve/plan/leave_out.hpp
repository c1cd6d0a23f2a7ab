#pragma once

#include <optional>
#include <string>
#include <vector>

#include "polhode/solve/effect.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

/// The torques of a scene that change no sample by more than a third of the accuracy, all together.
struct Negligible {
  std::vector<LeftOut> torques;
  double error;   ///< bound on the change of every sample that is wanted
};

/// Nothing where a torque matters, where no bound is known, or where the options forbid it. The remaining body is free,
/// and so has a closed form.
std::optional<Negligible> find_negligible(const Scene& scene, const SolveOptions& options);

/// Formulas of `given` became torques of the list, perhaps several. Their records are joined to those of `given`.
void number_as_given(const Scene& given, std::vector<LeftOut>& records);

/// "Damping left out: at most 3e-11 rad"
std::string describe(const LeftOut& left);

}  // namespace polhode
