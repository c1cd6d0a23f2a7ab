#pragma once

#include <memory>
#include <string>
#include <vector>

#include "batch/lane_method.hpp"
#include "method/samples.hpp"
#include "polhode/solve/motion.hpp"

namespace polhode {

/// A body on its way through a lane: backwards to the times before its start, then forwards, as solve() goes.
class Rider {
 public:
  Rider(Scene scene, const LaneMethod& method);

  const Scene& scene() const { return scene_; }
  const LaneBody& body() const { return *body_; }
  const std::string& kind() const { return kind_; }
  Motion& motion() { return motion_; }

  /// Takes its place for the next leg; false when there is none left.
  bool board(LaneTeam& team, int lane);
  /// Whether another sample lies in the last step.
  bool has_sample(const LaneClock& clock, int lane) const;
  double sample_time() const { return scene_.times()[(*leg_)[next_]]; }
  void take_sample(LaneClock& clock, int lane, const double* y);
  /// After its lane has called; false when the leg is over.
  bool go_on(const LaneClock& clock, int lane);
  void stop(const LaneClock& clock, int lane);
  void never_begin();
  /// Leaves out the rows that were not reached, as solve() does.
  void finish();

 private:
  void count(const LaneClock& clock, int lane);
  void fail(Status status, const std::string& why, const char* when = " at t = ");
  void write(std::size_t row, const double* omega, const double* attitude);

  Scene scene_;
  std::unique_ptr<LaneBody> body_;
  std::string kind_;
  SampleOrder itinerary_;
  Motion motion_;
  std::vector<unsigned char> answered_;
  const std::vector<std::size_t>* leg_ = nullptr;
  int legs_ = 0;
  std::size_t next_ = 0;
};

}  // namespace polhode
