#pragma once

#include <span>
#include <vector>

#include "polhode/math/detail/functions.hpp"
#include "polhode/spectrum/lines.hpp"

namespace polhode::spectrum {

/// exp(i f t) at all samples for the frequencies of a grid, one after the other: a rotation by exp(i step t) each time.
/// The rounding of the rotations grows to some 1e-16 for each frequency, which no scan notices.
class Phases {
 public:
  Phases(std::span<const double> t, const Grid& grid) : t_(t), grid_(grid), size_(t.size()) {
    for (std::vector<double>* part : {&cos_, &sin_, &step_cos_, &step_sin_}) part->resize(size_);
    for (std::size_t k = 0; k < size_; ++k) {
      const math::SinCosPair unit = math::sincos(grid.step * t[k]);
      step_cos_[k] = unit.cos, step_sin_[k] = unit.sin;
    }
    rewind();
  }

  void rewind() {
    for (std::size_t k = 0; k < size_; ++k) {
      const math::SinCosPair start = math::sincos(grid_.first * t_[k]);
      cos_[k] = start.cos, sin_[k] = start.sin;
    }
  }

  void advance() {
    double *c = cos_.data(), *s = sin_.data();
    const double *tc = step_cos_.data(), *ts = step_sin_.data();
    for (std::size_t k = 0; k < size_; ++k) {
      const double next = c[k] * tc[k] - s[k] * ts[k];
      s[k] = s[k] * tc[k] + c[k] * ts[k];
      c[k] = next;
    }
  }

  const double* cos() const { return cos_.data(); }
  const double* sin() const { return sin_.data(); }

 private:
  std::span<const double> t_;
  Grid grid_;
  std::size_t size_;
  std::vector<double> cos_, sin_, step_cos_, step_sin_;
};

}  // namespace polhode::spectrum
