#include "polhode/batch/solve_many.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "batch/lane_scheduler.hpp"
#include "batch/one_body.hpp"
#include "batch/parallel.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"
#include "solve/ground/formulas.hpp"
#include "solve/ground/options.hpp"
#include "solve/ground/pieces.hpp"

namespace polhode {
namespace {

constexpr double not_reached = std::numeric_limits<double>::quiet_NaN();

/// Copies the rows that were reached to their places; the others become NaN.
void store_rows(const Scene& scene, const Motion& motion, double* omega, double* attitude) {
  const std::vector<double>& times = scene.times();
  std::size_t row = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool reached = row < motion.t.size() && motion.t[row] == times[i];
    for (std::size_t k = 0; omega != nullptr && k < 3; ++k)
      omega[3 * i + k] = reached ? motion.omega[3 * row + k] : not_reached;
    for (std::size_t k = 0; attitude != nullptr && k < 4; ++k)
      attitude[4 * i + k] = reached ? motion.attitude[4 * row + k] : not_reached;
    row += reached;
  }
}

/// The lane method for these options, or null. Lanes have taylor and rk45, which is also the default for tolerances.
const LaneMethod* find_lane_method(const SolveOptions& options) {
  if (!(options.rtol || options.atol) || options.step || options.formulation != Formulation::euler) return nullptr;
  const std::string name = options.method.value_or("rk45");
  for (const LaneMethod* method : {&taylor_lanes, &rk45_lanes})
    if (name == method->record.name) return method;
  return nullptr;
}

}  // namespace

std::vector<ManyResult> solve_many(std::size_t n, std::size_t times, const MakeScene& make_scene,
                                   const SolveOptions& options, double* omega, double* attitude, int threads,
                                   bool refuse, std::span<const std::uint64_t> numbers) {
  std::vector<ManyResult> results(n);
  if (options.dense || !options.events.empty()) {
    throw InvalidInput("solve_many", "used without dense output and events", "one of them", "solve() has them");
  }
  std::atomic<std::size_t> next{0}, done{0};
  std::atomic<bool> stopped{false};
  std::mutex reporting;
  const auto report = [&](double, double) {
    const std::lock_guard lock(reporting);
    if (!stopped && !options.progress(static_cast<double>(done.load()), static_cast<double>(n))) stopped = true;
    return !stopped.load();
  };
  const auto go_on = [&](double reached, double last) {
    check_interrupt();
    return options.progress ? report(reached, last) : !stopped.load();
  };
  SolveOptions single = options;
  single.progress = go_on;
  single.keep_ticks = false;

  std::vector<unsigned char> stored(n, 0);
  const auto store = [&](std::size_t body, const Scene& scene, const Motion& motion, bool lane) {
    store_rows(scene, motion, omega ? omega + 3 * times * body : nullptr,
               attitude ? attitude + 4 * times * body : nullptr);
    results[body] = {motion.status, motion.message, motion.plan.method, motion.t_reached, motion.error,
                     motion.stats.steps, succeeded(scene, motion), lane};
    stored[body] = 1;
    ++done;
  };
  // What is no body fails alone, if it may: its rows are NaN.
  const auto leave_out = [&](std::size_t body, const char* why) {
    if (omega != nullptr) std::fill_n(omega + 3 * times * body, 3 * times, not_reached);
    if (attitude != nullptr) std::fill_n(attitude + 4 * times * body, 4 * times, not_reached);
    ManyResult& result = results[body];
    result.status = Status::failed, result.message = why, result.refused = true;
    result.t_reached = result.error = not_reached;
    stored[body] = 1;
    ++done;
  };
  const auto guarded = [&](std::size_t body, const auto& work) {
    work_on(body, "a scene that solve() accepts", stopped, work);
  };
  const auto make = [&](std::size_t body) {
    return make_one(make_scene, body, refuse, [&](const char* why) { leave_out(body, why); });
  };
  const LaneMethod* lanes = find_lane_method(options);
  std::vector<unsigned char> in_lanes(n, 0);
  const auto solve_singly = [&](std::size_t, std::size_t) {
    // Each free thread takes the next body, so a long run delays no other. No result depends on the order.
    for (std::size_t body = next++; body < n && !stopped; body = next++) {
      if (in_lanes[body] != 0 || stored[body] != 0) continue;
      guarded(body, [&] {
        if (!go_on(0.0, 0.0)) return;   // a closed form ends before it asks
        const std::optional<Scene> scene = make(body);
        if (!scene) return;
        SolveOptions own = single;
        own.body = numbers.empty() ? options.body + body : numbers[body];
        store(body, *scene, solve(*scene, own), false);
      });
    }
  };
  const std::size_t thread_limit = thread_count(threads, n, 2);
  const std::size_t chunk = std::clamp<std::size_t>(n / (2 * thread_limit), 64, 512);
  const auto solve_in_lanes = [&](std::size_t, std::size_t) {
    const StepTolerances step = choose_tolerances(lanes->record, options);
    Recognitions recognitions;
    for (std::size_t begin = next.fetch_add(chunk); begin < n && !stopped; begin = next.fetch_add(chunk)) {
      std::vector<std::unique_ptr<LaneJob>> jobs;
      std::vector<std::size_t> bodies;
      const std::size_t end = std::min(n, begin + chunk);
      for (std::size_t body = begin; body < end; ++body) {
        guarded(body, [&] {
          check_interrupt();
          std::optional<Scene> made = make(body);
          if (!made) return;
          Scene scene = resolve_formulas(*made, AsCustom::no, recognitions);
          check_options(scene, options);
          if (!scene.controllers().empty() || has_windows(scene) || !lanes->accepts(scene)) return;
          if (scene.torque_sum().acting > 0) require_finite_start(scene);
          jobs.push_back(std::make_unique<LaneJob>(std::move(scene), *lanes, jobs.empty() ? nullptr : jobs.back().get()));
          bodies.push_back(body), in_lanes[body] = 1;
        });
      }
      const auto stop_requested = [&] { return !go_on(0.0, 0.0); };
      guarded(begin, [&] { run_in_lanes(jobs, step.tolerances, options.max_steps, stop_requested); });
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        LaneJob& job = *jobs[i];
        describe_end(step, job.motion());
        store(bodies[i], job.scene(), job.motion(), true);
      }
    }
  };
  if (lanes != nullptr) {
    const std::size_t workers = std::min(thread_limit, (n + chunk - 1) / chunk);
    parallel_for(workers, workers, 1, solve_in_lanes);
    next = 0;
  }
  if (std::ranges::find(in_lanes, 0) != in_lanes.end()) parallel_for(thread_limit, thread_limit, 1, solve_singly);
  for (std::size_t i = 0; stopped && i < n; ++i) {
    if (stored[i] != 0) continue;
    results[i].status = Status::stopped, results[i].message = "not begun: stopped by the progress callback";
    if (omega != nullptr) std::fill_n(omega + 3 * times * i, 3 * times, not_reached);
    if (attitude != nullptr) std::fill_n(attitude + 4 * times * i, 4 * times, not_reached);
  }
  return results;
}

}  // namespace polhode
