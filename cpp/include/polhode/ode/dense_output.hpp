#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace polhode::ode {

/// The continuous extensions of all steps of a run, one after the other.
class DenseOutput {
 public:
  using Evaluate = void (*)(const double* segment, double fraction, double* out);

  DenseOutput() = default;
  DenseOutput(int segment_size, Evaluate evaluate) : size_(segment_size), evaluate_(evaluate) {}

  bool empty() const { return ends_.empty(); }
  double t_begin() const { return t_begin_; }
  double t_end() const { return ends_.empty() ? t_begin_ : ends_.back(); }

  void append(double t_old, double t, const double* segment) {
    if (ends_.empty()) t_begin_ = t_old;
    ends_.push_back(t);
    segments_.insert(segments_.end(), segment, segment + size_);
  }

  /// y at a time between t_begin and t_end (which may run backwards).
  void operator()(double t, double* out) const {
    const bool forward = t_end() >= t_begin_;
    const auto it = std::lower_bound(ends_.begin(), ends_.end(), t, [forward](double end, double value) {
      return forward ? end < value : end > value;
    });
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(it - ends_.begin()), ends_.size() - 1);
    const double a = i == 0 ? t_begin_ : ends_[i - 1], b = ends_[i];
    evaluate_(segments_.data() + i * static_cast<std::size_t>(size_), (t - a) / (b - a), out);
  }

 private:
  int size_ = 0;
  Evaluate evaluate_ = nullptr;
  double t_begin_ = 0.0;
  std::vector<double> ends_, segments_;
};

}  // namespace polhode::ode
