#pragma once

#include <cstddef>

#include "polhode/ode/problem.hpp"

namespace polhode::ode {

/// `sliding`: on a surface of jumps both sides push back. `chattering`: switches follow each other without end.
enum class StepResult { accepted, underflow, not_finite, no_solution, sliding, chattering };

/// An integration in progress, as drive() sees it. A step is one virtual call; the code of a step is compiled for its
/// problem.
class Stepper {
 public:
  virtual ~Stepper() = default;
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  /// Makes one accepted step towards t_end, at most up to it.
  virtual StepResult advance(double t_end) = 0;
  /// y at a time within the last step.
  virtual void interpolate(double t, double* y) = 0;
  /// The same at n times, row by row.
  virtual void interpolate_many(const double* times, std::size_t n, double* y) {
    for (std::size_t i = 0; i < n; ++i, y += dimension_) interpolate(times[i], y);
  }
  /// The last step's continuous extension, `segment_size` numbers for `evaluate`.
  virtual const double* segment() = 0;
  virtual const double* y() const = 0;

  using Evaluate = void (*)(const double* segment, double fraction, double* y);
  int dimension() const { return dimension_; }
  int segment_size() const { return segment_size_; }
  Evaluate evaluate() const { return evaluate_; }
  double t() const { return t_; }
  double t_old() const { return t_old_; }
  const Counts& counts() const { return counts_; }
  long& event_count() { return counts_.events; }

 protected:
  Stepper(int size, int numbers_per_segment, Evaluate evaluate_segment, double t0)
      : t_(t0), t_old_(t0), dimension_(size), segment_size_(numbers_per_segment), evaluate_(evaluate_segment) {}

  double t_, t_old_;
  Counts counts_;

 private:
  int dimension_, segment_size_;
  Evaluate evaluate_;
};

}  // namespace polhode::ode
