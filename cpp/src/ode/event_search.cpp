#include "polhode/ode/event_search.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace polhode::ode {

EventSearch::EventSearch(std::span<const Event> events, double t, const double* y) : events_(events) {
  for (const Event& event : events) trackers_.emplace_back(event, t, y);
}

EventSearch::Found EventSearch::step(Stepper& stepper) {
  constexpr int pieces = 8;
  Found all;
  if (trackers_.empty()) return all;
  double y[64];
  const double t0 = stepper.t_old(), h = stepper.t() - t0;
  for (int piece = 1; piece <= pieces && !all.ended; ++piece) {
    const double t = piece == pieces ? stepper.t() : t0 + h * (static_cast<double>(piece) / pieces);
    stepper.interpolate(t, y);
    Found found = look(stepper, t, y);
    std::move(found.hits.begin(), found.hits.end(), std::back_inserter(all.hits));
    all.ended = found.ended, all.t = found.t;
  }
  return all;
}

EventSearch::Found EventSearch::look(Stepper& stepper, double t, const double* y) {
  const auto at = [&](double time, double* out) { stepper.interpolate(time, out); };
  const auto size = static_cast<std::size_t>(stepper.dimension());
  std::vector<EventHit> found;
  for (std::size_t i = 0; i < trackers_.size(); ++i) {
    double root = 0.0;
    if (!trackers_[i].crosses(t, y, at, stepper.event_count(), root)) continue;
    std::vector<double> state(size);
    if (root == t) std::copy_n(y, size, state.begin());
    else stepper.interpolate(root, state.data());
    found.push_back({static_cast<int>(i), root, std::move(state)});
  }
  const bool forward = stepper.t() >= stepper.t_old();
  std::stable_sort(found.begin(), found.end(),
                   [forward](const EventHit& a, const EventHit& b) { return forward ? a.t < b.t : a.t > b.t; });
  Found kept;
  for (EventHit& hit : found) {
    kept.ended = events_[static_cast<std::size_t>(hit.event)].terminal;
    kept.t = hit.t;
    kept.hits.push_back(std::move(hit));
    if (kept.ended) break;
  }
  return kept;
}

}  // namespace polhode::ode
