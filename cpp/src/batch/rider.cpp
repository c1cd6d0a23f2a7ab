#include "batch/rider.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "polhode/core/error.hpp"

namespace polhode {
namespace {

void put(double (*rows)[LaneBlock::width], int lane, const double* values, int n) {
  for (int i = 0; i < n; ++i) rows[i][lane] = values[i];
}

void put_constants(LaneBlock& b, int lane, const BodySeries& series) {
  const SeriesTerms& terms = series.terms();
  b.to_rates[lane] = terms.to_rates[0], b.orbit_rate[lane] = terms.orbit_rate;
  put(b.product, lane, terms.product, 3), put(b.product_low, lane, terms.product_low, 3), put(b.torque, lane, terms.torque, 3);
  for (int j = 0; j < 3; ++j) put(b.damping[j], lane, terms.damping[j], 3);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 3; ++j) put(b.pull[i][j], lane, terms.pull[i][j], 3);
    put(b.tidal[i], lane, terms.tidal[i], 3), put(b.space[i], lane, series.fixed_vector(i).data(), 3);
    b.kept[i][lane] = series.kept(i).hi, b.kept_low[i][lane] = series.kept(i).lo;
  }
  b.balance[lane] = series.balance();
}

}  // namespace

Rider::Rider(Scene scene)
    : scene_(std::move(scene)), series_(scene_, scene_.want().attitude), itinerary_(scene_.times(), scene_.t0()),
      answered_(scene_.times().size(), 0) {
  const std::size_t n = scene_.times().size();
  if (scene_.want().omega) motion_.omega.resize(3 * n);
  if (scene_.want().attitude) motion_.attitude.resize(4 * n);
  motion_.start = scene_.start(), motion_.t_reached = scene_.t0();
  motion_.plan = {"euler", "taylor", series_.describe_state()};
}

int Rider::kind() const {
  const SeriesTerms& terms = series_.terms();
  const int flags = (terms.variables == RateVariables::separatrix) | series_.has_attitude() << 1 | terms.gradient << 2 |
                    terms.damped << 3 | series_.keeps_balance() << 4;
  return flags | terms.fixed_vectors << 5;
}

bool Rider::board(LaneBlock& b, int lane) {
  while (legs_ < 2) {
    leg_ = legs_++ == 0 ? &itinerary_.backward : &itinerary_.forward;
    next_ = 0, attempts_ = 0, leg_steps_ = 0;
    const std::vector<double>& times = scene_.times();
    const double t0 = scene_.t0();
    for (; next_ < leg_->size() && times[(*leg_)[next_]] == t0; ++next_) write((*leg_)[next_], nullptr, nullptr);
    if (next_ == leg_->size()) continue;

    const double t_end = times[leg_->back()];
    put_constants(b, lane, series_);
    double carry[8];
    series_.start_carry(carry);
    put(b.y, lane, series_.start(), 8), put(b.carry, lane, carry, 8);
    b.time[lane] = t0, b.time_low[lane] = 0.0, b.t_end[lane] = t_end;
    const double unit = std::min(series_.compute_time_scale(t0, series_.start()), std::abs(t_end - t0));
    b.unit[lane] = math::power_of_two_below(std::clamp(unit, 0x1p-900, 0x1p900));
    return true;
  }
  return false;
}

bool Rider::has_sample(const LaneBlock& b, int lane, double& s) const {
  if (next_ == leg_->size()) return false;
  const double t = scene_.times()[(*leg_)[next_]], reached = b.time[lane];
  if (b.t_end[lane] >= scene_.t0() ? t > reached : t < reached) return false;
  s = ((t - b.time_old[lane]) - b.time_old_low[lane]) / b.unit_old[lane];
  return true;
}

void Rider::take_sample(const double* y) {
  double omega[3], attitude[4];
  series_.unpack(y, omega, attitude);
  write((*leg_)[next_++], omega, attitude);
}

void Rider::write(std::size_t row, const double* omega, const double* attitude) {
  const Quat& q = scene_.attitude();
  const double start[4] = {q.x, q.y, q.z, q.w};
  if (omega == nullptr) omega = scene_.omega().data(), attitude = start;   // the start is as it was given
  if (scene_.want().omega) std::copy_n(omega, 3, motion_.omega.data() + 3 * row);
  if (scene_.want().attitude) std::copy_n(attitude, 4, motion_.attitude.data() + 4 * row);
  answered_[row] = 1;
}

bool Rider::step(LaneOutcome outcome, double time, long max_steps) {
  if (outcome == lane_not_finite) {
    if (++attempts_ <= 8) return true;
    fail(Status::failed, "the derivative is not finite");
    return false;
  }
  if (outcome == lane_underflow) {
    fail(Status::failed, "the step became smaller than the spacing of the times");
    return false;
  }
  attempts_ = 0;
  motion_.t_reached = time;
  ++motion_.stats.steps, ++leg_steps_;
  if (outcome == lane_arrived) return false;
  if (leg_steps_ < max_steps) return true;
  fail(Status::max_steps, "gave up after max_steps = " + std::to_string(max_steps) + " steps");
  return false;
}

void Rider::stop() { fail(Status::stopped, "stopped by the progress callback"); }

void Rider::fail(Status status, const std::string& why) {
  motion_.status = status;
  motion_.message = why;
  motion_.message += " at t = " + to_text(motion_.t_reached) + " s";
  legs_ = 2;
}

void Rider::finish() {
  const std::vector<double>& times = scene_.times();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!answered_[i]) continue;
    motion_.t.push_back(times[i]);
    if (scene_.want().omega) std::copy_n(motion_.omega.data() + 3 * i, 3, motion_.omega.data() + 3 * kept);
    if (scene_.want().attitude) std::copy_n(motion_.attitude.data() + 4 * i, 4, motion_.attitude.data() + 4 * kept);
    ++kept;
  }
  if (scene_.want().omega) motion_.omega.resize(3 * kept);
  if (scene_.want().attitude) motion_.attitude.resize(4 * kept);
}

}  // namespace polhode
