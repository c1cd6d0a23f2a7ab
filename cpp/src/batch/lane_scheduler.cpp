#include "batch/lane_scheduler.hpp"

#include <algorithm>

namespace polhode {
namespace {

constexpr int width = LaneIntegrator::width;
constexpr int rounds_between_polls = 1024;

/// Runs jobs of one kind.
void run_kind(const std::vector<LaneJob*>& jobs, const ode::Tolerances& tolerances, long max_steps,
              const std::function<bool()>& stopped) {
  const std::unique_ptr<LaneIntegrator> integrator = jobs.front()->problem().make_integrator(tolerances);
  LaneState& state = integrator->state();
  state.max_steps = static_cast<double>(max_steps);

  LaneJob* job_in[width] = {};
  std::size_t next_job = 0;
  const auto refill = [&](int lane) {
    while (job_in[lane] != nullptr || next_job < jobs.size()) {
      if (job_in[lane] == nullptr) job_in[lane] = jobs[next_job++];
      if (job_in[lane]->start_next_direction(*integrator, lane)) return;
      job_in[lane] = nullptr;
    }
    state.active &= ~(1u << lane);
    integrator->clear(lane);
  };
  for (int lane = 0; lane < width; ++lane) refill(lane);

  alignas(64) double positions[width] = {}, y[8][width];
  for (long next_poll = rounds_between_polls; state.active != 0;) {
    if (state.rounds >= next_poll) {
      next_poll = state.rounds + rounds_between_polls;
      if (stopped()) {
        for (int lane = 0; lane < width; ++lane)
          if (job_in[lane] != nullptr) job_in[lane]->stop(state, lane);
        for (; next_job < jobs.size(); ++next_job) jobs[next_job]->cancel();
        return;
      }
    }
    const unsigned ready = integrator->advance(rounds_between_polls);
    for (unsigned sampling = ready; sampling != 0;) {   // each pass takes one sample of every lane that has one
      for (int lane = 0; lane < width; ++lane) {
        if ((sampling >> lane & 1u) == 0) continue;
        if (!job_in[lane]->has_sample(state, lane)) {
          sampling &= ~(1u << lane);
        } else {
          positions[lane] = integrator->find_position(lane, job_in[lane]->sample_time());
        }
      }
      if (sampling == 0) break;
      integrator->sample(positions, y);
      for (int lane = 0; lane < width; ++lane) {
        if ((sampling >> lane & 1u) == 0) continue;
        double column[8];
        for (int i = 0; i < 8; ++i) column[i] = y[i][lane];
        job_in[lane]->take_sample(state, lane, column);
      }
    }
    for (int lane = 0; lane < width; ++lane)
      if ((ready >> lane & 1u) != 0 && !job_in[lane]->continues(state, lane)) refill(lane);
  }
}

}  // namespace

void run_in_lanes(const std::vector<std::unique_ptr<LaneJob>>& jobs, const ode::Tolerances& tolerances, long max_steps,
                  const std::function<bool()>& stopped) {
  std::vector<LaneJob*> order;
  for (const auto& job : jobs) order.push_back(job.get());
  std::stable_sort(order.begin(), order.end(),
                   [](const LaneJob* a, const LaneJob* b) { return a->kind() < b->kind(); });
  for (auto begin = order.begin(); begin != order.end();) {
    const auto end =
        std::find_if(begin, order.end(), [&](const LaneJob* job) { return job->kind() != (*begin)->kind(); });
    run_kind({begin, end}, tolerances, max_steps, stopped);
    begin = end;
  }
  for (const auto& job : jobs) job->finish();
}

}  // namespace polhode
