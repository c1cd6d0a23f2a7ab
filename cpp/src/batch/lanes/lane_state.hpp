#pragma once

namespace polhode {

/// How a lane's step ended.
enum LaneOutcome { lane_stepped, lane_arrived, lane_not_finite, lane_underflow };

/// What every lane method keeps of eight bodies side by side: row[i] belongs to the body in lane i. No lane reads
/// another lane, so a body's bits do not depend on its neighbours.
struct alignas(64) LaneState {
  static constexpr int width = 8;
  using Row = double[width];

  unsigned active = 0;          ///< bits of the lanes that hold a body
  long rounds = 0;              ///< steps of all lanes together, so far
  double max_steps = 0.0;       ///< of one body in one direction

  alignas(64) Row time = {};    // a row is one cache line
  Row t_end = {}, next_sample = {}, steps = {}, outcome = {};   ///< steps: the accepted ones
};

}  // namespace polhode
