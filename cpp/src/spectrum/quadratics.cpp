#include "polhode/spectrum/quadratics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode::spectrum {
namespace {

constexpr std::size_t columns = quadratic_numbers, width = columns + 1;   // the samples stand beside the columns
constexpr std::size_t pairs = columns * (columns + 1) / 2;
constexpr double no_variation = 1e-9;   // of the square of a function: without its mean it does not vary

using Row = std::array<double, width>;

/// The products of the numbers of all functions, pair by pair: the sum over pairs with a normal matrix is its form.
class Functions {
 public:
  explicit Functions(std::span<const double> numbers) : count_(numbers.size() / columns) {
    products_.resize(pairs * count_), numbers_.resize(columns * count_);
    for (std::size_t a = 0; a < count_; ++a) {
      const double* w = &numbers[columns * a];
      std::size_t pair = 0;
      for (std::size_t i = 0; i < columns; ++i) {
        numbers_[i * count_ + a] = w[i];
        for (std::size_t j = i; j < columns; ++j, ++pair)
          products_[pair * count_ + a] = (i == j ? 1.0 : 2.0) * w[i] * w[j];
      }
    }
  }

  std::size_t count() const { return count_; }
  const double* products(std::size_t pair) const { return &products_[pair * count_]; }
  const double* numbers(std::size_t column) const { return &numbers_[column * count_]; }

 private:
  std::size_t count_;
  std::vector<double> products_, numbers_;
};

/// The columns of one curve and their normal matrix.
class Match {
 public:
  Match(const Series& series, const Curves& curves, const Functions& functions, const Calibration& calibration)
      : series_(series), curves_(curves), functions_(functions), calibration_(calibration) {
    const std::size_t n = series.t.size();
    first_.resize(n), part_.resize(n), cos_.resize(n), sin_.resize(n);
    form_.resize(functions.count()), met_.resize(functions.count());
  }

  void begin(const Trial& trial) {
    curve_ = &curves_.axes[trial.curve * curves_.phases * 6];
    const double count = static_cast<double>(curves_.phases);
    for (std::size_t k = 0; k < series_.t.size(); ++k) {
      const double phase = trial.f * series_.t[k] * (count / (2.0 * std::numbers::pi));
      const double place = phase - count * std::floor(phase / count);
      first_[k] = std::min(static_cast<std::size_t>(place), curves_.phases - 1);
      part_[k] = place - static_cast<double>(first_[k]);
      const math::SinCosPair angle = math::sincos(trial.g * series_.t[k]);
      cos_[k] = angle.cos, sin_[k] = angle.sin;
    }
  }

  /// The least cost over the functions, and the function.
  void find(std::size_t shift, double& cost, double& which) {
    sum(shift);
    total_ = normal_[0][0];
    if (calibration_.offset) leave_out_constant();
    const std::size_t count = functions_.count();
    std::fill(form_.begin(), form_.end(), 0.0);
    std::fill(met_.begin(), met_.end(), 0.0);
    std::size_t pair = 0;
    for (std::size_t i = 0; i < columns; ++i) {
      const double* numbers = functions_.numbers(i);
      for (std::size_t a = 0; a < count; ++a) met_[a] += normal_[i][columns] * numbers[a];
      for (std::size_t j = i; j < columns; ++j, ++pair) {
        const double* products = functions_.products(pair);
        for (std::size_t a = 0; a < count; ++a) form_[a] += normal_[i][j] * products[a];
      }
    }
    cost = squares_, which = 0.0;
    for (std::size_t a = 0; a < count; ++a) {
      const double met = met_[a], form = std::max(form_[a], 0.0);
      const double here = !calibration_.scale ? squares_ - 2.0 * met + form
                          : met > 0.0 && form > no_variation * total_ ? squares_ - met * met / form : squares_;
      if (a == 0 || here < cost) cost = here, which = static_cast<double>(a);
    }
  }

 private:
  void sum(std::size_t shift) {
    for (Row& row : normal_) row.fill(0.0);
    squares_ = 0.0;
    const std::size_t phases = curves_.phases;
    Row row{};
    for (std::size_t k = 0; k < series_.t.size(); ++k) {
      std::size_t low = first_[k] + shift;
      low = low >= phases ? low - phases : low;
      const double *here = curve_ + 6 * low, *next = curve_ + 6 * (low + 1 == phases ? 0 : low + 1);
      const double weight = series_.weight.empty() ? 1.0 : series_.weight[k];
      row[0] = weight;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const double* p = here + 3 * axis;
        const double* q = next + 3 * axis;
        const double u = p[0] + part_[k] * (q[0] - p[0]), v = p[1] + part_[k] * (q[1] - p[1]);
        const double x = cos_[k] * u - sin_[k] * v, y = sin_[k] * u + cos_[k] * v;
        const double z = p[2] + part_[k] * (q[2] - p[2]);
        double* out = &row[1 + 5 * axis];
        out[0] = weight * (x * x - z * z), out[1] = weight * (y * y - z * z);
        out[2] = 2.0 * weight * x * y, out[3] = 2.0 * weight * x * z, out[4] = 2.0 * weight * y * z;
      }
      row[columns] = series_.y[k];
      for (std::size_t i = 0; i < columns; ++i) {
        Row& out = normal_[i];
        const double factor = row[i];
        for (std::size_t j = 0; j < width; ++j) out[j] += factor * row[j];
      }
      squares_ += series_.y[k] * series_.y[k];
    }
  }

  void leave_out_constant() {
    const Row pivot = normal_[0];
    const double inverse = 1.0 / pivot[0];
    for (std::size_t i = 1; i < columns; ++i)
      for (std::size_t j = 0; j < width; ++j) normal_[i][j] -= pivot[i] * inverse * pivot[j];
    squares_ -= pivot[columns] * inverse * pivot[columns];
    normal_[0].fill(0.0);
  }

  Series series_;
  Curves curves_;
  const Functions& functions_;
  Calibration calibration_;
  const double* curve_ = nullptr;
  std::vector<std::size_t> first_;
  std::vector<double> part_, cos_, sin_, form_, met_;
  std::array<Row, columns> normal_{};
  double squares_ = 0.0, total_ = 0.0;   // of the samples, and of the weights
};

void require(bool good, const char* what, const char* requirement, std::size_t found) {
  if (!good) throw InvalidInput(what, requirement, std::to_string(found) + " numbers");
}

}  // namespace

void match_quadratics(const Series& series, const Curves& curves, std::span<const Trial> trials, std::size_t shifts,
                      std::span<const double> functions, const Calibration& calibration, double* cost, double* which,
                      int threads) {
  const std::size_t n = series.t.size(), each = 6 * curves.phases;
  require(series.count == 1 && series.y.size() == n && (series.weight.empty() || series.weight.size() == n), "y",
          "one row for each time", series.y.size());
  require(each > 0 && curves.axes.size() % each == 0, "curves", "two vectors at each phase", curves.axes.size());
  require(!functions.empty() && functions.size() % columns == 0, "functions", "of shape (n, 11)", functions.size());
  require(shifts > 0 && curves.phases % (2 * shifts) == 0, "shifts", "a divisor of half of the phases", shifts);
  for (const Trial& trial : trials)
    require(trial.curve < curves.axes.size() / each, "trials", "of curves that exist", trial.curve);
  const Functions all(functions);
  parallel_for(trials.size(), thread_count(threads, trials.size(), 32), 8, [&](std::size_t begin, std::size_t end) {
    Match match(series, curves, all, calibration);
    for (std::size_t k = begin; k < end; ++k) {
      check_interrupt();
      match.begin(trials[k]);
      for (std::size_t s = 0; s < shifts; ++s)
        match.find(s * (curves.phases / (2 * shifts)), cost[k * shifts + s], which[k * shifts + s]);
    }
  });
}

}  // namespace polhode::spectrum
