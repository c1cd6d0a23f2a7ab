#include "batch/lane_scheduler.hpp"

#include <algorithm>

namespace polhode {
namespace {

constexpr int width = LaneTeam::width;
constexpr int rounds_between_questions = 1024;

void ride_together(const std::vector<Rider*>& riders, const ode::Tolerances& tolerances, long max_steps,
                   const std::function<bool()>& stopped) {
  const std::unique_ptr<LaneTeam> team = riders.front()->body().make_team(tolerances);
  LaneClock& clock = team->clock();
  clock.most_steps = static_cast<double>(max_steps);

  Rider* in[width] = {};
  std::size_t waiting = 0;
  const auto fill = [&](int lane) {
    while (in[lane] != nullptr || waiting < riders.size()) {
      if (in[lane] == nullptr) in[lane] = riders[waiting++];
      if (in[lane]->board(*team, lane)) return;
      in[lane] = nullptr;
    }
    clock.riding &= ~(1u << lane);
    team->leave_empty(lane);
  };
  for (int lane = 0; lane < width; ++lane) fill(lane);

  alignas(64) double places[width] = {}, y[8][width];
  for (long question = rounds_between_questions; clock.riding != 0;) {
    if (clock.rounds >= question) {
      question = clock.rounds + rounds_between_questions;
      if (stopped()) {
        for (int lane = 0; lane < width; ++lane)
          if (in[lane] != nullptr) in[lane]->stop(clock, lane);
        for (; waiting < riders.size(); ++waiting) riders[waiting]->never_begin();
        return;
      }
    }
    const unsigned calls = team->advance(rounds_between_questions);
    for (unsigned have = calls; have != 0;) {   // a sample of each that has one, then the next
      for (int lane = 0; lane < width; ++lane) {
        if ((have >> lane & 1u) == 0) continue;
        if (!in[lane]->has_sample(clock, lane)) {
          have &= ~(1u << lane);
        } else {
          places[lane] = team->find_place(lane, in[lane]->sample_time());
        }
      }
      if (have == 0) break;
      team->sample(places, y);
      for (int lane = 0; lane < width; ++lane) {
        if ((have >> lane & 1u) == 0) continue;
        double column[8];
        for (int i = 0; i < 8; ++i) column[i] = y[i][lane];
        in[lane]->take_sample(clock, lane, column);
      }
    }
    for (int lane = 0; lane < width; ++lane)
      if ((calls >> lane & 1u) != 0 && !in[lane]->go_on(clock, lane)) fill(lane);
  }
}

}  // namespace

void ride(const std::vector<std::unique_ptr<Rider>>& riders, const ode::Tolerances& tolerances, long max_steps,
          const std::function<bool()>& stopped) {
  std::vector<Rider*> order;
  for (const auto& rider : riders) order.push_back(rider.get());
  std::stable_sort(order.begin(), order.end(), [](const Rider* a, const Rider* b) { return a->kind() < b->kind(); });
  for (auto begin = order.begin(); begin != order.end();) {
    const auto end = std::find_if(begin, order.end(), [&](const Rider* r) { return r->kind() != (*begin)->kind(); });
    ride_together({begin, end}, tolerances, max_steps, stopped);
    begin = end;
  }
  for (const auto& rider : riders) rider->finish();
}

}  // namespace polhode
