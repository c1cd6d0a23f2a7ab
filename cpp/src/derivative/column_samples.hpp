#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "derivative/column_motion.hpp"

namespace polhode {

/// The motion of a scene and its columns at the scene's times, from one run.
struct ColumnSamples {
  std::vector<double> omega, attitude;   ///< (n, 3) and (n, 4)
  std::vector<double> d_omega, theta;     ///< (n, 3, columns) in body axes
  std::vector<double> d_states;          ///< (n, states, columns)
  std::vector<std::size_t> samples;      ///< those that were computed
  std::vector<int> scale;                ///< of each sample: its columns are 2^scale times these
  std::string uncertain = {};            ///< what the branches of controllers leave open, in words
  long steps = 0;
};

/// Where a run writes its samples.
class SampleTarget {
 public:
  SampleTarget(ColumnSamples& out, std::size_t states, std::size_t columns)
      : out_(out), states_count_(states), columns_(columns) {}

  /// @param rows  (6 and the states, columns)
  void put(std::size_t sample, const double* omega, const double* attitude, const double* rows) const {
    std::copy_n(omega, 3, out_.omega.data() + 3 * sample);
    std::copy_n(attitude, 4, out_.attitude.data() + 4 * sample);
    std::copy_n(rows, 3 * columns_, out_.d_omega.data() + 3 * columns_ * sample);
    std::copy_n(rows + 3 * columns_, 3 * columns_, out_.theta.data() + 3 * columns_ * sample);
    const std::size_t more = states_count_ * columns_;
    std::copy_n(rows + 6 * columns_, more, out_.d_states.data() + more * sample);
  }

  /// Samples within the last step.
  void put(ColumnMotion& motion, const std::vector<double>& times, const std::size_t* which, std::size_t count) {
    const std::size_t numbers = (6 + states_count_) * columns_;
    times_.resize(count), states_.resize(7 * count), rows_.resize(numbers * count);
    for (std::size_t i = 0; i < count; ++i) times_[i] = times[which[i]];
    double *omega = states_.data(), *attitude = omega + 3 * count;
    motion.sample(times_.data(), count, omega, attitude, rows_.data());
    for (std::size_t i = 0; i < count; ++i)
      put(which[i], omega + 3 * i, attitude + 4 * i, rows_.data() + numbers * i);
  }

 private:
  ColumnSamples& out_;
  std::size_t states_count_, columns_;
  std::vector<double> times_, states_, rows_;
};

}  // namespace polhode
