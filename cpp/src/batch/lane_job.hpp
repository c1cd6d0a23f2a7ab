#pragma once

#include <memory>
#include <string>
#include <vector>

#include "batch/lane_method.hpp"
#include "method/samples.hpp"
#include "polhode/solve/motion.hpp"

namespace polhode {

/// The run of one body in a lane: backward to the times before its start, then forward, in the order of solve().
class LaneJob {
 public:
  /// @param before  the job of another body, or null
  LaneJob(Scene scene, const LaneMethod& method, const LaneJob* before);

  const Scene& scene() const { return scene_; }
  const LaneProblem& problem() const { return *problem_; }
  const std::string& kind() const { return kind_; }
  Motion& motion() { return motion_; }

  /// Loads the lane for the next direction; false when none is left.
  bool start_next_direction(LaneIntegrator& integrator, int lane);
  /// Whether another sample lies in the last step.
  bool has_sample(const LaneState& state, int lane) const;
  double sample_time() const { return scene_.times()[(*direction_)[next_]]; }
  void take_sample(LaneState& state, int lane, const double* y);
  /// Called when the lane needed the host; false when the direction is done or has failed.
  bool continues(const LaneState& state, int lane);
  /// Ends a running job because the caller stopped the batch.
  void stop(const LaneState& state, int lane);
  /// The same for a job that has not started.
  void cancel();
  /// Removes the rows that were not reached, as solve() does.
  void finish();

 private:
  void count(const LaneState& state, int lane);
  void fail(Status status, const std::string& why, const char* when = " at t = ");
  void write(std::size_t row, const double* omega, const double* attitude);

  Scene scene_;
  std::unique_ptr<LaneProblem> problem_;
  std::string kind_;
  SampleOrder itinerary_;
  Motion motion_;
  std::vector<unsigned char> reached_;                     ///< one flag a row
  const std::vector<std::size_t>* direction_ = nullptr;    ///< rows in the order of integration
  int directions_started_ = 0;
  std::size_t next_ = 0;                                   ///< index into *direction_
};

}  // namespace polhode
