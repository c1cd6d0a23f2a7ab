#include "polhode/spectrum/lines.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"
#include "spectrum/phases.hpp"

namespace polhode::spectrum {
namespace {

constexpr double lost = 1e-9;   // a column's square that is left beside the others, of its own: below, it adds nothing

void require_sizes(bool good, std::size_t found) {
  if (!good) throw InvalidInput("y", "one row for each time, in whole blocks", std::to_string(found) + " numbers");
}

/// The powers 0 to `most` of exp(i f t), power by power.
class Powers {
 public:
  Powers(std::size_t n, int most) : n_(n), most_(most), cos_(n * size(most), 1.0), sin_(n * size(most), 0.0) {}

  void fill(const Phases& phases) {
    if (most_ < 1) return;
    const double *c = phases.cos(), *s = phases.sin();
    std::copy(c, c + n_, &cos_[n_]);
    std::copy(s, s + n_, &sin_[n_]);
    for (int power = 2; power <= most_; ++power) {
      const double *pc = cos(power - 1), *ps = sin(power - 1);
      double *qc = &cos_[n_ * static_cast<std::size_t>(power)], *qs = &sin_[n_ * static_cast<std::size_t>(power)];
      for (std::size_t k = 0; k < n_; ++k) {
        qc[k] = pc[k] * c[k] - ps[k] * s[k];
        qs[k] = ps[k] * c[k] + pc[k] * s[k];
      }
    }
  }

  const double* cos(int power) const { return &cos_[n_ * static_cast<std::size_t>(power)]; }
  const double* sin(int power) const { return &sin_[n_ * static_cast<std::size_t>(power)]; }

 private:
  static std::size_t size(int most) { return static_cast<std::size_t>(most) + 1; }

  std::size_t n_;
  int most_;
  std::vector<double> cos_, sin_;
};

/// The columns of the lines beside the series, (n, columns + series), their normal matrix, and its elimination.
class Normal {
 public:
  Normal(const Series& series, std::span<const Line> lines)
      : series_(series), lines_(lines.begin(), lines.end()), n_(series.t.size()) {
    for (const Line& line : lines_) columns_ += line.a == 0 && line.b == 0 ? 1 : 2;
    width_ = columns_ + series.count;
    rows_.resize(n_ * width_);
    matrix_.resize(columns_ * width_);
    for (std::size_t k = 0; k < n_; ++k) {
      std::copy_n(&series.y[k * series.count], series.count, &rows_[k * width_ + columns_]);
    }
  }

  void fill(const Powers& f, const Powers& g) {
    std::size_t column = 0;
    for (const Line& line : lines_) {
      const double *fc = f.cos(std::abs(line.a)), *fs = f.sin(std::abs(line.a));
      const double *gc = g.cos(std::abs(line.b)), *gs = g.sin(std::abs(line.b));
      const double sign = (line.a < 0) == (line.b < 0) ? 1.0 : -1.0;
      const bool constant = line.a == 0 && line.b == 0;
      for (std::size_t k = 0; k < n_; ++k) {
        const double weight = series_.weight.empty() ? 1.0 : series_.weight[k];
        double* row = &rows_[k * width_ + column];
        row[0] = weight * (fc[k] * gc[k] - sign * (fs[k] * gs[k]));
        if (!constant) row[1] = weight * (fs[k] * gc[k] + sign * (fc[k] * gs[k]));
      }
      column += constant ? 1 : 2;
    }
  }

  /// Adds up the normal matrix and eliminates its columns: row i is then that of the i-th of orthogonal columns.
  void eliminate() {
    std::fill(matrix_.begin(), matrix_.end(), 0.0);
    for (std::size_t k = 0; k < n_; ++k) {
      const double* row = &rows_[k * width_];
      for (std::size_t i = 0; i < columns_; ++i) {
        double* sum = &matrix_[i * width_];
        const double factor = row[i];
        for (std::size_t j = i; j < width_; ++j) sum[j] += factor * row[j];
      }
    }
    scales_.assign(columns_, 0.0);
    for (std::size_t i = 0; i < columns_; ++i) scales_[i] = matrix_[i * width_ + i];
    for (std::size_t i = 0; i < columns_; ++i) {
      const double* pivot = &matrix_[i * width_];
      const bool gone = !(pivot[i] > lost * scales_[i]);
      scales_[i] = gone ? 0.0 : 1.0 / pivot[i];
      if (gone) continue;
      for (std::size_t r = i + 1; r < columns_; ++r) {
        double* rest = &matrix_[r * width_];
        const double factor = pivot[r] * scales_[i];
        for (std::size_t j = r; j < width_; ++j) rest[j] -= factor * pivot[j];
      }
    }
  }

  /// The products of the projected series of each block.
  double* write(std::size_t block, double* out) const {
    for (std::size_t first = columns_; first < width_; first += block) {
      std::fill_n(out, block * block, 0.0);
      for (std::size_t i = 0; i < columns_; ++i) {
        const double* part = &matrix_[i * width_ + first];
        for (std::size_t a = 0; a < block; ++a) {
          const double factor = scales_[i] * part[a];
          for (std::size_t b = 0; b < block; ++b) out[a * block + b] += factor * part[b];
        }
      }
      out += block * block;
    }
    return out;
  }

 private:
  Series series_;
  std::vector<Line> lines_;
  std::size_t n_, columns_ = 0, width_ = 0;
  std::vector<double> rows_, matrix_, scales_;
};

int most(std::span<const Line> lines, int Line::*part) {
  int found = 0;
  for (const Line& line : lines) found = std::max(found, std::abs(line.*part));
  return found;
}

}  // namespace

void project(const Series& series, std::span<const Line> lines, const Grid& f, const Grid& g, std::size_t block,
             double* out) {
  const std::size_t n = series.t.size();
  require_sizes(series.y.size() == n * series.count && (series.weight.empty() || series.weight.size() == n) &&
                    block > 0 && series.count % block == 0,
                series.y.size());
  Phases first(series.t, f), second(series.t, g);
  Powers of_first(n, most(lines, &Line::a)), of_second(n, most(lines, &Line::b));
  Normal normal(series, lines);
  for (std::size_t i = 0; i < f.count; ++i, first.advance()) {
    of_first.fill(first);
    second.rewind();
    for (std::size_t j = 0; j < g.count; ++j, second.advance()) {
      if (j % 256 == 0) check_interrupt();
      of_second.fill(second);
      normal.fill(of_first, of_second);
      normal.eliminate();
      out = normal.write(block, out);
    }
  }
}

void periodogram(std::span<const double> t, std::span<const double> z, std::size_t count, const Grid& f, double* out) {
  const std::size_t n = t.size();
  require_sizes(z.size() == 2 * n * count, z.size());
  Phases phases(t, f);
  std::vector<double> sums(4 * count);   // of cos and sin times real and imaginary parts
  for (std::size_t trial = 0; trial < f.count; ++trial, phases.advance()) {
    if (trial % 256 == 0) check_interrupt();
    std::fill(sums.begin(), sums.end(), 0.0);
    double *by_cos = sums.data(), *by_sin = sums.data() + 2 * count;
    for (std::size_t k = 0; k < n; ++k) {
      const double c = phases.cos()[k], s = phases.sin()[k];
      const double* row = &z[2 * count * k];
      for (std::size_t j = 0; j < 2 * count; ++j) {
        by_cos[j] += c * row[j];
        by_sin[j] += s * row[j];
      }
    }
    double power = 0.0;
    for (std::size_t j = 0; j < count; ++j) {
      const double real = by_cos[2 * j] + by_sin[2 * j + 1], imaginary = by_cos[2 * j + 1] - by_sin[2 * j];
      power += real * real + imaginary * imaginary;
    }
    out[trial] = power;
  }
}

}  // namespace polhode::spectrum
