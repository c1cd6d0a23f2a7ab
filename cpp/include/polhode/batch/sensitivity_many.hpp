#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "polhode/batch/solve_many.hpp"
#include "polhode/derivative/sensitivity.hpp"

namespace polhode {

/// The derivatives of one body among many.
struct ManySensitivity {
  MotionSensitivity found = {};
  std::string failure = {};   ///< why there are none; empty where there are
};

/// Differentiates n motions, each as by compute_sensitivity(). A thread takes one body at a time. A result depends neither
/// on the number of threads (0: as many as the machine has) nor on the other bodies.
/// @param refuse  false: where make_scene throws InvalidInput, the body has a failure
/// @param numbers  as in solve_many()
/// @throws InvalidInput, with the number of the body, for what compute_sensitivity() refuses
std::vector<ManySensitivity> compute_sensitivities(std::size_t n, const MakeScene& make_scene,
                                                   const std::vector<std::string>& groups,
                                                   const SensitivityOptions& options = {}, int threads = 0,
                                                   bool refuse = true, std::span<const std::uint64_t> numbers = {});

}  // namespace polhode
