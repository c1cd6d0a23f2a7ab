#include "batch/lane_job.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "method/samples.hpp"
#include "polhode/core/error.hpp"

namespace polhode {

Rider::Rider(Scene scene, const LaneMethod& method)
    : scene_(std::move(scene)),
      body_(method.make_body(scene_)),
      kind_(body_->kind()),
      itinerary_(scene_.times(), scene_.t0()),
      answered_(scene_.times().size(), 0) {
  const std::size_t n = scene_.times().size();
  if (scene_.want().omega) motion_.omega.resize(3 * n);
  if (scene_.want().attitude) motion_.attitude.resize(4 * n);
  motion_.start = scene_.start(), motion_.t_reached = scene_.t0();
  motion_.model = "euler", motion_.state = body_->describe_state();
  motion_.plan = {"euler", std::string(method.record.name), motion_.state};
}

bool Rider::board(LaneTeam& team, int lane) {
  while (legs_ < 2) {
    leg_ = legs_++ == 0 ? &itinerary_.backward : &itinerary_.forward;
    next_ = 0;
    if (leg_->empty()) continue;
    const std::vector<double>& times = scene_.times();
    const double t0 = scene_.t0();
    motion_.t_reached = t0;
    for (; next_ < leg_->size() && sample_time() == t0; ++next_) write((*leg_)[next_], nullptr, nullptr);
    if (next_ == leg_->size()) continue;
    LaneClock& clock = team.clock();
    clock.time[lane] = t0, clock.t_end[lane] = times[leg_->back()];
    clock.next_sample[lane] = sample_time(), clock.steps[lane] = 0.0;
    clock.riding |= 1u << lane;
    team.seat(lane, *body_);
    return true;
  }
  return false;
}

bool Rider::has_sample(const LaneClock& clock, int lane) const {
  if (next_ == leg_->size() || clock.outcome[lane] > double{lane_arrived}) return false;
  const double t = sample_time(), reached = clock.time[lane];
  return clock.t_end[lane] >= scene_.t0() ? t <= reached : t >= reached;
}

void Rider::take_sample(LaneClock& clock, int lane, const double* y) {
  double omega[3], attitude[4];
  body_->unpack(y, omega, attitude);
  write((*leg_)[next_++], omega, attitude);
  if (next_ < leg_->size()) clock.next_sample[lane] = sample_time();
}

void Rider::write(std::size_t row, const double* omega, const double* attitude) {
  const Quat& q = scene_.attitude();
  const double start[4] = {q.x, q.y, q.z, q.w};
  if (omega == nullptr) omega = scene_.omega().data(), attitude = start;   // the start is as it was given
  if (scene_.want().omega) std::copy_n(omega, 3, motion_.omega.data() + 3 * row);
  if (scene_.want().attitude) std::copy_n(attitude, 4, motion_.attitude.data() + 4 * row);
  answered_[row] = 1;
}

bool Rider::go_on(const LaneClock& clock, int lane) {
  const auto outcome = static_cast<LaneOutcome>(static_cast<int>(clock.outcome[lane]));
  if (outcome == lane_stepped && clock.steps[lane] < clock.most_steps) return true;
  count(clock, lane);
  if (outcome == lane_stepped) {
    fail(Status::max_steps,
         "gave up after max_steps = " + std::to_string(static_cast<long>(clock.most_steps)) + " steps");
  } else if (outcome == lane_not_finite) {
    fail(Status::failed, "the derivative is not finite", " just beyond t = ");
  } else if (outcome == lane_underflow) {
    fail(Status::failed, "the step became smaller than the spacing of the times");
  }
  return false;
}

void Rider::count(const LaneClock& clock, int lane) {
  motion_.t_reached = clock.time[lane];
  motion_.stats.steps += static_cast<long>(clock.steps[lane]);
}

void Rider::stop(const LaneClock& clock, int lane) {
  count(clock, lane);
  never_begin();
}

void Rider::never_begin() { fail(Status::stopped, "stopped by the progress callback"); }

void Rider::fail(Status status, const std::string& why, const char* when) {
  motion_.status = status;
  motion_.message = why;
  motion_.message += when + to_text(motion_.t_reached) + " s";
  legs_ = 2;
}

void Rider::finish() { drop_unreached(scene_.times(), answered_, motion_); }

}  // namespace polhode
