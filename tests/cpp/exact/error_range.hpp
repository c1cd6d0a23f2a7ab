#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <utility>

/// A range for the largest of some errors. An error above the range fails at once: the code became worse. A largest
/// error below the range fails at the end: the code became better, and the range no longer states its accuracy.
///
/// A range leaves a factor of 3 on each side of the measured values, which stand beside it for the levels of SIMD. The
/// upper side has less where a stricter bound held before. The lower side is 0 where a result may be exact by chance.
class ErrorRange {
 public:
  ErrorRange(std::string what, double least, double most) : what_(std::move(what)), least_(least), most_(most) {}
  ErrorRange(const ErrorRange&) = delete;
  ErrorRange& operator=(const ErrorRange&) = delete;
  ~ErrorRange() {
    CHECK_MESSAGE(largest_ >= least_, what_, ": the largest error, ", largest_, ", is below ", least_,
                  ": tighten the range");
  }

  void add(double error) {
    CHECK_MESSAGE(error <= most_, what_, ": an error of ", error, " is above ", most_);
    largest_ = std::fmax(largest_, error);
  }

  /// Adds |value - expected| relative to the expected value.
  void compare(double value, double expected) { add(std::abs(value - expected) / std::abs(expected)); }

 private:
  std::string what_;
  double least_, most_, largest_ = 0.0;
};
