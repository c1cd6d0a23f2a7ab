#include "polhode/batch/solve_many.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>

#include "polhode/batch/parallel.hpp"
#include "polhode/core/error.hpp"

namespace polhode {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// The rows that were reached go to their places; those that were not are left NaN.
void place(const Scene& scene, const Motion& motion, double* omega, double* attitude) {
  const std::vector<double>& times = scene.times();
  std::size_t row = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool there = row < motion.t.size() && motion.t[row] == times[i];
    for (std::size_t k = 0; omega != nullptr && k < 3; ++k) omega[3 * i + k] = there ? motion.omega[3 * row + k] : nothing;
    for (std::size_t k = 0; attitude != nullptr && k < 4; ++k) attitude[4 * i + k] = there ? motion.attitude[4 * row + k] : nothing;
    row += there;
  }
}

}  // namespace

std::vector<ManyResult> solve_many(std::size_t n, std::size_t times, const MakeScene& make_scene, const SolveOptions& options,
                                   double* omega, double* attitude, int threads) {
  std::vector<ManyResult> results(n);
  if (omega != nullptr) std::fill_n(omega, 3 * n * times, nothing);
  if (attitude != nullptr) std::fill_n(attitude, 4 * n * times, nothing);
  if (options.dense || !options.events.empty()) {
    throw InvalidInput("solve_many", "used without dense output and events", "one of them", "solve() has them");
  }
  std::atomic<std::size_t> next{0}, done{0};
  std::atomic<bool> stopped{false};
  std::mutex told;
  const auto tell = [&](double, double) {
    const std::lock_guard lock(told);
    if (!stopped && !options.progress(static_cast<double>(done.load()), static_cast<double>(n))) stopped = true;
    return !stopped.load();
  };
  SolveOptions one = options;
  if (options.progress) one.progress = tell;

  const auto work = [&](std::size_t, std::size_t) {
    // Bodies are taken one by one as threads come free: a long run holds up nobody, and no answer depends on it.
    for (std::size_t body = next++; body < n && !stopped; body = next++) {
      try {
        const Scene scene = make_scene(body);
        const Motion motion = solve(scene, one);
        place(scene, motion, omega ? omega + 3 * times * body : nullptr, attitude ? attitude + 4 * times * body : nullptr);
        results[body] = {motion.status, motion.message, motion.plan.method, motion.t_reached, motion.error,
                         motion.stats.steps, succeeded(scene, motion)};
      } catch (const InvalidInput& error) {
        stopped = true;
        throw InvalidInput("body " + std::to_string(body), "one that solve() takes", error.what());
      } catch (...) {
        stopped = true;
        throw;
      }
      ++done;
    }
  };
  const std::size_t team = thread_count(threads, n, 2);
  parallel_for(team, team, 1, work);
  for (std::size_t i = 0; stopped && i < n; ++i) {
    if (results[i].message.empty()) results[i].status = Status::stopped, results[i].message = "not begun: stopped by the progress callback";
  }
  return results;
}

}  // namespace polhode
