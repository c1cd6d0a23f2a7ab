#include "method/clock/clock.hpp"

#include <algorithm>
#include <cmath>

namespace polhode {

Clock::Clock(const Scene& scene, std::uint64_t body, const std::vector<Carrying>& carrying, bool keep_ticks) {
  for (std::size_t i = 0; i < scene.controllers().size(); ++i)
    channels_.push_back(std::make_unique<Channel>(scene, i, body, carrying[i], keep_ticks));
  for (const HeldWindow& held : scene.held_windows()) {
    const auto place = static_cast<std::size_t>(7 + formula::find_place(scene.states(), held.state).first);
    for (const torques::Window& window : held.during.windows()) {
      if (std::isfinite(window.begin) && window.begin > scene.t0()) edges_.push_back({window.begin, place, 1.0});
      if (std::isfinite(window.end) && window.end > scene.t0()) edges_.push_back({window.end, place, 0.0});
    }
  }
  std::stable_sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.t < b.t; });
}

double Clock::next() const {
  double t = edge_ < edges_.size() ? edges_[edge_].t : std::numeric_limits<double>::infinity();
  for (const auto& channel : channels_) t = std::min(t, channel->next());
  return t;
}

bool Clock::is_due(double t) const {
  const double first = next();
  return first <= t || is_same_instant(first, t);
}

void Clock::act(double t, Carried& state) {
  for (const auto& channel : channels_) channel->end_pulse(t, state);
  for (; edge_ < edges_.size() && (edges_[edge_].t <= t || is_same_instant(edges_[edge_].t, t)); ++edge_)
    state.values[edges_[edge_].state] = edges_[edge_].value;
  if (channels_.size() > 1) before_ = state;   // all measure the same
  const Carried& measured = channels_.size() > 1 ? before_ : state;
  for (const auto& channel : channels_) channel->measure(t, measured);
  for (const auto& channel : channels_) channel->begin_commands(t, state);
}

void Clock::stop_at(double t) {
  for (const auto& channel : channels_) channel->stop_at(t);
}

void Clock::scale_changes(double factor) {
  for (const auto& channel : channels_) channel->scale_changes(factor);
}

std::vector<Ticks> Clock::ticks() const {
  std::vector<Ticks> all;
  for (const auto& channel : channels_) all.push_back(channel->ticks());
  return all;
}

}  // namespace polhode
