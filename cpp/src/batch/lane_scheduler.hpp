#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "batch/lane_job.hpp"
#include "polhode/ode/problem.hpp"

namespace polhode {

/// Steps of all riders, eight side by side, each with its own time, step and error; a lane is taken by the next rider
/// as soon as it is free. A rider's answer depends on nothing but itself. `stopped` is asked now and then.
void ride(const std::vector<std::unique_ptr<Rider>>& riders, const ode::Tolerances& tolerances, long max_steps,
          const std::function<bool()>& stopped);

}  // namespace polhode
