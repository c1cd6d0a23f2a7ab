#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "method/clock/channel.hpp"

namespace polhode {

/// What happens at instants of a run: all controllers of a scene, and the windows of its torques.
class Clock {
 public:
  /// @param carrying  of each controller
  Clock(const Scene& scene, std::uint64_t body, const std::vector<Carrying>& carrying, bool keep_ticks);

  /// The next time at which something happens; infinity if nothing does.
  double next() const;
  bool is_due(double t) const;
  /// All of one instant, in this order: pulses end and windows begin or end, controllers measure, commands begin.
  void act(double t, Carried& state);
  /// Ticks from this time on are not called.
  void stop_at(double t);
  void scale_changes(double factor);

  std::vector<Ticks> ticks() const;
  const std::vector<std::unique_ptr<Channel>>& channels() const { return channels_; }

 private:
  struct Edge {
    double t;
    std::size_t state;   ///< its number in a state of the run
    double value;
  };

  std::vector<std::unique_ptr<Channel>> channels_;
  std::vector<Edge> edges_;   ///< of windows, by time
  std::size_t edge_ = 0;
  Carried before_;            ///< the state that ticks measure
};

}  // namespace polhode
