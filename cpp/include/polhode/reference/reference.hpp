#pragma once

#include <functional>
#include <vector>

#include "polhode/scene/scene.hpp"

namespace polhode {

struct ReferenceOptions {
  int order = 24;                ///< of the series
  double tolerance = 1e-20;      ///< of a step: the last terms of the series, relative to the rates and to 1
  long max_steps = 400'000;
  std::function<bool()> go_on = {};   ///< called every 256 steps; false ends the run
};

struct Reference {
  std::vector<double> omega;      ///< (n, 3), w_B at the scene's times [rad/s]
  std::vector<double> attitude;   ///< (n, 4), q_WB as (x, y, z, w)
  long steps = 0;
};

/// A reference solution: w_B and q_WB of a scene at its times by Taylor series in `long double`, which has 64 bits on
/// x86-64 and may have only 53 elsewhere. The difference of two runs of different order estimates the error of both.
///
/// The recurrences use Cauchy products. The step follows from the last two terms as in Jorba & Zou 2005, Experimental
/// Mathematics 14, 99.
/// @throws InvalidInput for a torque that has no series (a user's function), IntegrationFailure past max_steps
Reference compute_reference(const Scene& given, const ReferenceOptions& options = {});

}  // namespace polhode
