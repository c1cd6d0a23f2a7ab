#pragma once

#include <cstddef>
#include <vector>

#include "derivative/column_rows.hpp"
#include "polhode/core/quat.hpp"

namespace polhode {

/// The columns of a body's variational equations in groups of eight, each with its series: d omega and the small
/// rotation R -> R exp([theta]x), then the changes of further states. Vectors are in principal axes here, and in body
/// axes outside.
class ColumnLanes {
 public:
  /// @param size     numbers of a column: 6, and those of the states
  /// @param rotated  R_BP is not the identity
  /// @param columns  at the start, (size, count)
  ColumnLanes(std::size_t size, std::size_t count, const Matrix3d& R_BP, bool rotated,
              const std::vector<double>& columns);

  std::size_t size() const { return size_; }
  std::size_t count() const { return count_; }
  std::size_t groups() const { return (count_ + 7) / 8; }

  /// A number of a column at the end of the last step, in principal axes.
  double& at(std::size_t i, std::size_t c) { return arrived_[size_ * (c / 8) + i].of[c % 8]; }

  /// Puts the columns at the end of the last step into rows 0.
  void begin(int order);
  /// The series of a group, whose rows from 1 on the caller fills.
  ColumnRows rows(std::size_t group) { return series_.data() + size_ * group; }

  /// The largest size of a row of a column relative to that of its first three rows. Each state is measured alone.
  /// @param rate  divides d omega, which is then comparable with the small rotation
  double measure(int row, double rate) const;
  /// Ends the step at s units of time of the last series.
  void advance(double s);
  /// Sets those at the end of the step, from (size, count).
  void write(const std::vector<double>& columns);
  /// The columns at n such times within the step, as (n, size, count).
  void evaluate(const double* s, std::size_t n, double* out) const;
  /// Those at the end of the step, as (size, count).
  std::vector<double> columns() const;

 private:
  struct alignas(64) Octet {
    double of[8] = {};
  };

  double measure(const ColumnSeriesRows* rows, int row, std::size_t lane, double rate) const;
  void to_body(std::size_t group, const Octet* column, double* out) const;

  std::size_t size_, count_;
  Matrix3d R_BP_;
  bool rotated_;
  int order_ = 0;
  // Numbers of a column, group after group.
  std::vector<Octet> arrived_, arrived_low_;   ///< at the end of the last step, and the rounding errors of their sums
  std::vector<Octet> start_, start_low_;       ///< at its begin
  std::vector<ColumnSeriesRows> series_;
};

}  // namespace polhode
