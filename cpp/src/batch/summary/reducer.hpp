#pragma once

#include <cstddef>
#include <vector>

#include "batch/summary/kernels.hpp"
#include "polhode/batch/summary.hpp"

namespace polhode::summary {

/// How the numbers of a summary lie: scalars have one plane and sums of two rows, attitudes four planes and ten rows.
struct Layout {
  struct Entry {
    const SummaryQuantity* quantity;
    const std::vector<double>* planes;   ///< of the reference
    std::size_t plane, sums, value;      ///< its first plane, row of sums, and number among the values
    std::size_t bins;                    ///< without the one for NaN
  };
  std::vector<Entry> entries;
  std::size_t times, row;                ///< row: times padded
  std::size_t planes = 0, rows = 0, values = 0;
  bool needs_omega = false, needs_attitude = false;

  Layout(const std::vector<SummaryQuantity>& quantities, const std::vector<std::vector<double>>& planes,
         std::size_t times);
  Summary::Sums make_sums() const { return Summary::Sums(rows * row, 0.0); }
  Summary::Totals make_totals() const;
};

std::size_t count_bins(const SummaryQuantity& quantity);

/// Gathers the numbers of up to `tile` bodies at up to `span` times, then adds them up.
class Reducer {
 public:
  explicit Reducer(const Layout& layout);

  double* omega() { return layout_.needs_omega ? omega_.data() : nullptr; }         ///< (span, 3), to be filled
  double* attitude() { return layout_.needs_attitude ? attitude_.data() : nullptr; }   ///< (span, 4)

  /// The states above are those of body `i` of the tile at n times from `from` on. Values are (times, values) or null.
  void measure(std::size_t i, std::size_t from, std::size_t n, const double* tensor, const double* values);
  /// Row k of body i does not count.
  void leave_out(std::size_t i, std::size_t k);
  void add(std::size_t bodies, std::size_t from, std::size_t n, Summary::Totals& totals, Summary::Sums& sums) const;

 private:
  double* plane_of(std::size_t plane, std::size_t i, std::size_t width) {
    return numbers_.data() + plane * tile * span + i * width * span;
  }
  const Layout& layout_;
  std::vector<double> omega_, attitude_, numbers_;
};

}  // namespace polhode::summary
