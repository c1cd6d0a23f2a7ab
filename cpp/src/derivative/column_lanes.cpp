#include "derivative/column_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "polhode/math/detail/double_double.hpp"

namespace polhode {

ColumnLanes::ColumnLanes(std::size_t size, std::size_t count, const Matrix3d& R_BP, bool rotated,
                         const std::vector<double>& columns)
    : size_(size), count_(count), R_BP_(R_BP), rotated_(rotated) {
  for (auto* octets : {&arrived_, &arrived_low_, &start_, &start_low_}) octets->resize(size_ * groups());
  series_.resize(size_ * groups());
  write(columns);
}

void ColumnLanes::write(const std::vector<double>& columns) {
  const std::size_t count = count_;
  const Matrix3d R_PB = R_BP_.transpose();
  std::fill(arrived_low_.begin(), arrived_low_.end(), Octet{});
  for (std::size_t c = 0; c < count; ++c) {
    Octet* own = arrived_.data() + size_ * (c / 8);
    for (std::size_t half = 0; half < 6; half += 3) {
      const Vector3d v = R_PB * Vector3d(columns[half * count + c], columns[(half + 1) * count + c],
                                         columns[(half + 2) * count + c]);
      for (std::size_t i = 0; i < 3; ++i) own[half + i].of[c % 8] = v[static_cast<Eigen::Index>(i)];
    }
    for (std::size_t i = 6; i < size_; ++i) own[i].of[c % 8] = columns[i * count + c];
  }
}

void ColumnLanes::begin(int order) {
  order_ = order;
  start_ = arrived_, start_low_ = arrived_low_;
  for (std::size_t i = 0; i < series_.size(); ++i) std::copy_n(start_[i].of, 8, series_[i].of[0]);
}

double ColumnLanes::measure(const ColumnSeriesRows* rows, int row, std::size_t lane, double rate) const {
  const auto size = [&](int k) {
    double parts[6];
    for (int i = 0; i < 6; ++i) parts[i] = std::abs(rows[i].of[k][lane]);
    return std::max(std::max({parts[0], parts[1], parts[2]}) / rate, std::max({parts[3], parts[4], parts[5]})) +
           0.0 * (parts[0] + parts[1] + parts[2] + parts[3] + parts[4] + parts[5]);   // NaN if one is
  };
  const double first = std::max({size(0), size(1), size(2)});
  return size(row) / (first > 0.0 ? first : 1.0);
}

double ColumnLanes::measure(int row, double rate) const {
  double largest = 0.0;
  const auto take = [&](double ratio) {
    if (!(ratio <= largest)) largest = ratio;
  };
  for (std::size_t c = 0; c < count_; ++c) {
    const ColumnSeriesRows* rows = series_.data() + size_ * (c / 8);
    take(measure(rows, row, c % 8, rate));
    for (std::size_t i = 6; i < size_; ++i) {
      const auto size = [&](int k) { return std::abs(rows[i].of[k][c % 8]); };
      const double first = std::max({size(0), size(1), size(2)});
      take(size(row) / (first > 0.0 ? first : 1.0));
    }
  }
  return largest;
}

void ColumnLanes::advance(double s) {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    static constexpr double zero[8] = {};
    alignas(64) double increment[8];
    ode::evaluate_series(series_[i].of[0], order_, ode::series_width, zero, start_low_[i].of, &s, 1, increment);
    for (int lane = 0; lane < 8; ++lane) {
      const math::DD sum = math::two_sum(start_[i].of[lane], increment[lane]);
      arrived_[i].of[lane] = sum.hi, arrived_low_[i].of[lane] = sum.lo;
    }
  }
}

/// The numbers of the columns of one group; `out` has a row of `count_` for each number.
void ColumnLanes::to_body(std::size_t group, const Octet* column, double* out) const {
  const std::size_t lanes = std::min<std::size_t>(8, count_ - 8 * group);
  for (std::size_t i = rotated_ ? 6 : 0; i < size_; ++i) std::copy_n(column[i].of, lanes, out + i * count_ + 8 * group);
  if (!rotated_) return;
  for (int i = 0; i < 6; ++i) {
    const Octet* v = column + (i < 3 ? 0 : 3);
    for (std::size_t c = 0; c < lanes; ++c)
      out[static_cast<std::size_t>(i) * count_ + 8 * group + c] =
          R_BP_(i % 3, 0) * v[0].of[c] + R_BP_(i % 3, 1) * v[1].of[c] + R_BP_(i % 3, 2) * v[2].of[c];
  }
}

void ColumnLanes::evaluate(const double* s, std::size_t n, double* out) const {
  constexpr std::size_t most = 16;   // at once
  alignas(64) double values[8 * most];
  std::vector<Octet> columns(size_ * most);
  for (std::size_t begin = 0; begin < n; begin += most) {
    const std::size_t count = std::min(most, n - begin);
    for (std::size_t g = 0; g < groups(); ++g) {
      for (std::size_t i = 0; i < size_; ++i) {
        const std::size_t own = size_ * g + i;
        ode::evaluate_series(series_[own].of[0], order_, ode::series_width, start_[own].of, start_low_[own].of,
                             s + begin, count, values);
        for (std::size_t k = 0; k < count; ++k) std::copy_n(values + 8 * k, 8, columns[size_ * k + i].of);
      }
      for (std::size_t k = 0; k < count; ++k)
        to_body(g, columns.data() + size_ * k, out + size_ * count_ * (begin + k));
    }
  }
}

std::vector<double> ColumnLanes::columns() const {
  std::vector<double> out(size_ * count_);
  for (std::size_t g = 0; g < groups(); ++g) to_body(g, arrived_.data() + size_ * g, out.data());
  return out;
}

}  // namespace polhode
