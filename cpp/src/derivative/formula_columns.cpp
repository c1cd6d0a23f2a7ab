#include "derivative/formula_columns.hpp"

#include <algorithm>
#include <cmath>

#include "core/choose_level.hpp"

namespace polhode {

FormulaColumns::FormulaColumns(const Scene& piece, std::shared_ptr<const ColumnEquations> equations, std::size_t count,
                               const std::vector<double>& columns)
    : body_(piece, equations->table),
      equations_(std::move(equations)),
      kernels_(*choose_level(simd_level(), baseline_column_kernels, avx2_column_kernels, avx512_column_kernels)),
      columns_(equations_->first_term.size() - 1, count, body_.frame().axes(), body_.frame().is_rotated(), columns),
      extras_(static_cast<std::size_t>(equations_->table->extra_width() * (ode::most_series_order + 1)) + 8) {}

void FormulaColumns::compute_series(math::DD t, double unit, const double* y, const double*, int order,
                                    double* rows) const {
  double* extras = align_to_line(extras_);
  body_.expand(t, unit, y, order, rows, extras);
  rows_ = rows;
  double w[3];
  body_.frame().compute_rates(rows, w);
  rate_ = std::max({std::abs(w[0]), std::abs(w[1]), std::abs(w[2]), 1.0 / unit});
  columns_.begin(order);
  equations_->expand(kernels_, extras, order, unit, columns_);
}

/// The columns are measured relative to their own first rows: their block begins with 1.
void FormulaColumns::compute_sizes(const double* row, double* sizes) const {
  body_.compute_sizes(row, sizes);
  const auto k = static_cast<int>((row - rows_) / width());
  sizes[body_.count_blocks()] = k == 0 ? 1.0 : k < 3 ? 0.0 : columns_.measure(k, rate_);
}

}  // namespace polhode
