#pragma once

namespace polhode {

/// What became of a lane's step.
enum LaneOutcome { lane_stepped, lane_arrived, lane_not_finite, lane_underflow };

/// What all methods in lanes keep of eight bodies side by side: row[i] belongs to body i. Nothing that is done in lanes
/// looks from one of them to another, so a body's bits do not depend on its neighbours.
struct alignas(64) LaneClock {
  static constexpr int width = 8;
  using Row = double[width];

  unsigned riding = 0;          ///< bits of the lanes with a body
  long rounds = 0;              ///< steps of all lanes together, so far
  double most_steps = 0.0;      ///< of a body in one direction

  alignas(64) Row time = {};    // a row is a line of the cache
  Row t_end = {}, next_sample = {}, steps = {}, outcome = {};   ///< steps: those that were accepted
};

}  // namespace polhode
