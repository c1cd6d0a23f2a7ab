#pragma once

#include <string>
#include <vector>

#include "batch/lanes/levels.hpp"
#include "polhode/solve/body_series.hpp"
#include "polhode/solve/motion.hpp"
#include "solve/itinerary.hpp"

namespace polhode {

/// A body on its way through a lane: backwards to the times before its start, then forwards, as solve() goes.
class Rider {
 public:
  explicit Rider(Scene scene);

  const Scene& scene() const { return scene_; }
  const BodySeries& series() const { return series_; }
  Motion& motion() { return motion_; }

  /// Riders of one kind ride together: what the kernels are compiled for, or ask of all lanes alike.
  int kind() const;

  /// Takes its place for the next leg; false when there is none left.
  bool board(LaneBlock& block, int lane);
  /// Whether another sample lies in the last step, and where in it.
  bool has_sample(const LaneBlock& block, int lane, double& s) const;
  void take_sample(const double* y);
  /// What a step came to; false when the leg is over.
  bool step(LaneOutcome outcome, double time, long max_steps);
  void stop();
  /// Leaves out the rows that were not reached, as solve() does.
  void finish();

 private:
  void fail(Status status, const std::string& why);
  void write(std::size_t row, const double* omega, const double* attitude);

  Scene scene_;
  BodySeries series_;
  Itinerary itinerary_;
  Motion motion_;
  std::vector<unsigned char> answered_;
  const std::vector<std::size_t>* leg_ = nullptr;
  int legs_ = 0, attempts_ = 0;
  std::size_t next_ = 0;
  long leg_steps_ = 0;
};

}  // namespace polhode
