#include "derivative/switched_columns.hpp"

#include <algorithm>
#include <cmath>

#include "core/choose_level.hpp"
#include "polhode/core/error.hpp"

namespace polhode {

SwitchedColumns::SwitchedColumns(const Scene& piece, const std::vector<ColumnCause>& causes, ModeEquations& known,
                                 const std::vector<double>& columns)
    : piece_(piece), causes_(causes), known_(known), body_(piece),
      kernels_(*choose_level(simd_level(), baseline_column_kernels, avx2_column_kernels, avx512_column_kernels)),
      columns_(6 + static_cast<std::size_t>(body_.count_states()), causes.size(), body_.whole().frame().axes(),
               body_.whole().frame().is_rotated(), columns) {}

SwitchedColumns::Mode& SwitchedColumns::find_mode() const {
  const auto found = modes_.find(body_.sides());
  if (found != modes_.end()) return found->second;
  std::shared_ptr<const ColumnEquations> equations = find_equations(piece_, causes_, body_.sides(), known_);
  FormulaSeries series = body_.whole().with_table(equations->table);
  const auto orders = static_cast<std::size_t>(ode::most_series_order + 1);
  const auto width = static_cast<std::size_t>(equations->table->width()),
             extra_width = static_cast<std::size_t>(equations->table->extra_width());
  return modes_.emplace(body_.sides(), Mode{std::move(equations), std::move(series),
                                            std::vector<double>(width * orders + 8),
                                            std::vector<double>(extra_width * orders + 8)}).first->second;
}

void SwitchedColumns::compute_series(math::DD t, double unit, const double* y, const double* carry, int order,
                                     double* rows) const {
  body_.compute_series(t, unit, y, carry, order, rows);
  Mode& mode = find_mode();
  double* extras = align_to_line(mode.extras);
  mode.series.expand(t, unit, y, order, align_to_line(mode.rows), extras);
  if (projected_ != body_.sides()) project(mode, extras);
  rows_ = rows;
  double w[3];
  body_.whole().frame().compute_rates(rows, w);
  rate_ = std::max({std::abs(w[0]), std::abs(w[1]), std::abs(w[2]), 1.0 / unit});
  mode.equations->expand(kernels_, extras, order, unit, columns_);
}

void SwitchedColumns::compute_sizes(const double* row, double* sizes) const {
  body_.compute_sizes(row, sizes);
  const auto k = static_cast<int>((row - rows_) / width());
  sizes[body_.count_blocks()] = k == 0 ? 1.0 : k < 3 ? 0.0 : columns_.measure(k, rate_);
}

ode::StepResult SwitchedColumns::switch_mode(math::DD t, double unit, const double* y, int order, double direction,
                                             const ode::CrossingSink& sink) const {
  return body_.switch_mode(t, unit, y, order, direction, [&](const ode::Crossing& crossing) {
    jump(t, unit, y, crossing);
    sink(crossing);
  });
}

void SwitchedColumns::project(const Mode& mode, const double* extras) const {
  projected_ = body_.sides();
  const auto value = [&](const LinearTerm& term) { return term.series < 0 ? term.factor : extras[term.series]; };
  for (const ColumnEquations::Held& held : mode.equations->held) {
    const ColumnEquations::Guard& guard = mode.equations->guards[held.guard];
    std::vector<double> change(columns_.count(), 0.0);
    for (std::size_t c = 0; c < change.size(); ++c)
      for (const LinearTerm& term : guard.terms)
        change[c] += value(term) * columns_.at(static_cast<std::size_t>(term.from), c);
    for (const auto& force : guard.forces) change[static_cast<std::size_t>(force.term.from)] += value(force.term) * force.part;
    for (std::size_t c = 0; c < change.size(); ++c)
      for (const LinearTerm& term : held.response)
        columns_.at(static_cast<std::size_t>(term.from), c) -= value(term) * change[c];
  }
}

void SwitchedColumns::jump(math::DD t, double unit, const double* y, const ode::Crossing& crossing) const {
  Mode& mode = find_mode();
  double* extras = align_to_line(mode.extras);
  mode.series.expand(t, 1.0, y, 1, align_to_line(mode.rows), extras);
  const double* rates = extras + mode.equations->table->extra_width();
  const auto value = [&](const LinearTerm& term) { return term.series < 0 ? term.factor : extras[term.series]; };
  const ColumnEquations::Guard& guard =
      mode.equations->guards[static_cast<std::size_t>(body_.number_of(crossing.guard))];
  std::vector<double>& earlier = earlier_;
  if (body_.lets_go(crossing.guard)) {
    // The torque is continuous where friction lets go, unless another switch made it do so at this time.
    if (!crossed_ || crossed_->hi != t.hi || crossed_->lo != t.lo) return;
  } else {
    if (crossing.slope * crossing.slope <= 4 * crossing.curvature * crossing.rounding || crossing.slope == 0.0)
      throw IntegrationFailure(t.hi, "sensitivity: the motion grazes the surface of a switch, where it has no derivatives");
    earlier.assign(columns_.count(), 0.0);
    for (std::size_t c = 0; c < earlier.size(); ++c) {
      for (const LinearTerm& term : guard.terms)
        earlier[c] += value(term) * columns_.at(static_cast<std::size_t>(term.from), c) / rates[guard.series];
    }
    for (const auto& force : guard.forces)
      earlier[static_cast<std::size_t>(force.term.from)] += value(force.term) / rates[force.series];
    crossed_ = t;
  }
  double before[3], behind[3];
  body_.whole().frame().compute_rates(crossing.before, before);
  body_.whole().frame().compute_rates(crossing.behind, behind);
  const double per_second = 1.0 / unit;
  for (std::size_t c = 0; c < earlier.size(); ++c) {
    for (std::size_t i = 0; i < 3; ++i) columns_.at(i, c) += (behind[i] - before[i]) * earlier[c] * per_second;
    for (std::size_t i = 6; i < columns_.size(); ++i) {
      const std::size_t k = ode::series_width + i - 6;
      columns_.at(i, c) += (crossing.behind[k] - crossing.before[k]) * earlier[c] * per_second;
    }
  }
}

}  // namespace polhode
