#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "polhode/batch/solve_many.hpp"
#include "polhode/core/error.hpp"

namespace polhode {

/// The scene of a body. Without `refuse` an impossible one has none, and leave_out(why) is called.
template <class LeaveOut>
std::optional<Scene> make_one(const MakeScene& make_scene, std::size_t body, bool refuse, const LeaveOut& leave_out) {
  if (refuse) return make_scene(body);
  try {
    return make_scene(body);
  } catch (const InvalidInput& error) {
    leave_out(error.what());
    return std::nullopt;
  }
}

/// Works on a body. What it throws stops all threads, and an InvalidInput gets the number of the body.
template <class Work>
void work_on(std::size_t body, const char* requirement, std::atomic<bool>& stopped, const Work& work) {
  try {
    work();
  } catch (const InvalidInput& error) {
    stopped = true;
    throw InvalidInput("body " + std::to_string(body), requirement, error.what());
  } catch (...) {
    stopped = true;
    throw;
  }
}

}  // namespace polhode
