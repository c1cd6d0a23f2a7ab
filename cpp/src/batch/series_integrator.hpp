#pragma once

#include <algorithm>
#include <cmath>

#include "batch/lane_method.hpp"
#include "batch/lanes/taylor_block.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/ode/series.hpp"
#include "polhode/ode/taylor.hpp"

namespace polhode {

inline void put_rows(LaneState::Row* rows, int lane, const double* values, int n) {
  for (int i = 0; i < n; ++i) rows[i][lane] = values[i];
}

/// One order for all lanes, fitted to measured times: in lanes the cost of a step grows as about its order squared.
inline int choose_lane_order(const ode::Tolerances& tolerances) {
  const int order = static_cast<int>(std::ceil(1.0 - 0.65 * math::fast_log(tolerances.rtol + tolerances.atol)));
  return std::clamp(order, ode::Taylor::least_order, ode::most_series_order - 2);
}

/// What all steppers of bodies by Taylor series share: the times and outcomes of the lanes.
class SeriesIntegrator : public LaneIntegrator {
 public:
  LaneState& state() final { return b_; }

  void clear(int lane) final {
    for (int i = 0; i < 8; ++i) b_.y[i][lane] = b_.carry[i][lane] = 0.0;
    b_.t_end[lane] = b_.time[lane] = b_.time_low[lane] = 0.0, b_.unit[lane] = 1.0;
  }

  unsigned advance(int rounds) final {
    unsigned ready = 0;
    for (int round = 0; round < rounds && ready == 0; ++round, ++b_.rounds) {
      step();
      for (int lane = 0; lane < width; ++lane)
        if ((b_.active >> lane & 1u) != 0 && needs_host(lane)) ready |= 1u << lane;
    }
    return ready;
  }

  double find_position(int lane, double t) const final {
    return ((t - b_.time_old[lane]) - b_.time_old_low[lane]) / b_.unit_old[lane];
  }

 protected:
  /// @param block  a member of the class that derives
  explicit SeriesIntegrator(TaylorBlock& block) : b_(block) {}

  void put_tolerances(const ode::Tolerances& tolerances) {
    b_.order = choose_lane_order(tolerances), b_.rtol = tolerances.rtol, b_.atol = tolerances.atol;
  }

  /// @param unit  of the first step's time, about
  void put_start(int lane, const double* y, const double* carry, double unit) {
    put_rows(b_.y, lane, y, 8), put_rows(b_.carry, lane, carry, 8);
    b_.time_low[lane] = 0.0, attempts_[lane] = 0;
    const double most = std::min(unit, std::abs(b_.t_end[lane] - b_.time[lane]));
    b_.unit[lane] = math::power_of_two_below(std::clamp(most, 0x1p-900, 0x1p900));
  }

  virtual void step() = 0;   ///< of all lanes

 private:
  static constexpr int most_attempts = 8;   // each in a smaller unit of time

  /// After a step of the lane; counts it if it was accepted.
  bool needs_host(int lane) {
    if (b_.outcome[lane] == double{lane_not_finite}) return ++attempts_[lane] > most_attempts;
    if (b_.outcome[lane] == double{lane_underflow}) return true;
    attempts_[lane] = 0;
    const double reached = b_.time[lane], next = b_.next_sample[lane];
    const bool due = b_.t_end[lane] >= b_.time_old[lane] ? next <= reached : next >= reached;
    return ++b_.steps[lane] >= b_.max_steps || due;
  }

  TaylorBlock& b_;
  int attempts_[width] = {};
};

}  // namespace polhode
