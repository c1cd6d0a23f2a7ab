#include "batch/lane_job.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "method/samples.hpp"
#include "polhode/core/error.hpp"

namespace polhode {

LaneJob::LaneJob(Scene scene, const LaneMethod& method, const LaneJob* before)
    : scene_(std::move(scene)),
      problem_(method.make_problem(scene_, before != nullptr ? before->problem_.get() : nullptr)),
      kind_(problem_->kind()),
      itinerary_(scene_.times(), scene_.t0()),
      reached_(scene_.times().size(), 0) {
  const std::size_t n = scene_.times().size();
  if (scene_.want().omega) motion_.omega.resize(3 * n);
  if (scene_.want().attitude) motion_.attitude.resize(4 * n);
  motion_.start = scene_.start(), motion_.t_reached = scene_.t0();
  motion_.model = "euler", motion_.state = problem_->describe_state();
  motion_.plan = {"euler", std::string(method.record.name), motion_.state};
}

bool LaneJob::start_next_direction(LaneIntegrator& integrator, int lane) {
  while (directions_started_ < 2) {
    direction_ = directions_started_++ == 0 ? &itinerary_.backward : &itinerary_.forward;
    next_ = 0;
    if (direction_->empty()) continue;
    const std::vector<double>& times = scene_.times();
    const double t0 = scene_.t0();
    motion_.t_reached = t0;
    for (; next_ < direction_->size() && sample_time() == t0; ++next_) write((*direction_)[next_], nullptr, nullptr);
    if (next_ == direction_->size()) continue;
    LaneState& state = integrator.state();
    state.time[lane] = t0, state.t_end[lane] = times[direction_->back()];
    state.next_sample[lane] = sample_time(), state.steps[lane] = 0.0;
    state.active |= 1u << lane;
    integrator.load(lane, *problem_);
    return true;
  }
  return false;
}

bool LaneJob::has_sample(const LaneState& state, int lane) const {
  if (next_ == direction_->size() || state.outcome[lane] > double{lane_arrived}) return false;
  const double t = sample_time(), reached = state.time[lane];
  return state.t_end[lane] >= scene_.t0() ? t <= reached : t >= reached;
}

void LaneJob::take_sample(LaneState& state, int lane, const double* y) {
  double omega[3], attitude[4];
  problem_->unpack(y, omega, attitude);
  write((*direction_)[next_++], omega, attitude);
  if (next_ < direction_->size()) state.next_sample[lane] = sample_time();
}

void LaneJob::write(std::size_t row, const double* omega, const double* attitude) {
  const Quat& q = scene_.attitude();
  const double start[4] = {q.x, q.y, q.z, q.w};
  if (omega == nullptr) omega = scene_.omega().data(), attitude = start;   // exactly as given
  if (scene_.want().omega) std::copy_n(omega, 3, motion_.omega.data() + 3 * row);
  if (scene_.want().attitude) std::copy_n(attitude, 4, motion_.attitude.data() + 4 * row);
  reached_[row] = 1;
}

bool LaneJob::continues(const LaneState& state, int lane) {
  const auto outcome = static_cast<LaneOutcome>(static_cast<int>(state.outcome[lane]));
  if (outcome == lane_stepped && state.steps[lane] < state.max_steps) return true;
  count(state, lane);
  if (outcome == lane_stepped) {
    fail(Status::max_steps,
         "gave up after max_steps = " + std::to_string(static_cast<long>(state.max_steps)) + " steps");
  } else if (outcome == lane_not_finite) {
    fail(Status::failed, "the derivative is not finite", " just beyond t = ");
  } else if (outcome == lane_underflow) {
    fail(Status::failed, "the step became smaller than the spacing of the times");
  }
  return false;
}

void LaneJob::count(const LaneState& state, int lane) {
  motion_.t_reached = state.time[lane];
  motion_.stats.steps += static_cast<long>(state.steps[lane]);
}

void LaneJob::stop(const LaneState& state, int lane) {
  count(state, lane);
  cancel();
}

void LaneJob::cancel() { fail(Status::stopped, "stopped by the progress callback"); }

void LaneJob::fail(Status status, const std::string& why, const char* when) {
  motion_.status = status;
  motion_.message = why;
  motion_.message += when + to_text(motion_.t_reached) + " s";
  directions_started_ = 2;
}

void LaneJob::finish() { drop_unreached(scene_.times(), reached_, motion_); }

}  // namespace polhode
