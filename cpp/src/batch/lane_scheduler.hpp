#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "batch/lane_job.hpp"
#include "polhode/ode/problem.hpp"

namespace polhode {

/// Runs all jobs, eight side by side, each with its own time, step and error. A lane that becomes free takes the next
/// job. A job's result does not depend on the other jobs. `stopped` is polled every 1024 rounds.
void run_in_lanes(const std::vector<std::unique_ptr<LaneJob>>& jobs, const ode::Tolerances& tolerances, long max_steps,
                  const std::function<bool()>& stopped);

}  // namespace polhode
