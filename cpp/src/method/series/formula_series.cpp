#include "method/series/formula_series.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "method/series/body_laws.hpp"
#include "method/series/recent_equations.hpp"
#include "polhode/core/error.hpp"
#include "polhode/formula/expression.hpp"
#include "polhode/math/detail/coin.hpp"

namespace polhode {
namespace {

using formula::Expr;
using formula::Form;
using formula::Graph;
using formula::Vec;
using math::DD;

bool is_power_of_two(double x) { return (std::bit_cast<std::uint64_t>(x) & 0xf'ffff'ffff'ffffull) == 0; }

std::shared_ptr<const formula::Table> find_table(const Scene& scene, const BodySeries& frame,
                                                 const std::vector<formula::Input>& states) {
  thread_local RecentEquations<formula::Table> recent;
  return recent.find(
      EquationsKey(scene, frame),
      [&] { return std::make_shared<const formula::Table>(formula::Tape(make_body_system(scene, frame, states))); },
      &is_small);
}

/// Whether a state is what a controller commands.
bool holds_command(const Scene& scene, const std::string& name) {
  return std::any_of(scene.controllers().begin(), scene.controllers().end(), [&](const Controller& controller) {
    return controller.parts().output != Output::rotor_momentum &&
           std::find(controller.held().begin(), controller.held().end(), name) != controller.held().end();
  });
}

}  // namespace

Scene drop_torques(const Scene& scene) {
  SceneParts parts = scene.parts();
  parts.torques.clear();
  return Scene(std::move(parts));
}

double* align_to_line(std::vector<double>& numbers) {
  const auto address = reinterpret_cast<std::uintptr_t>(numbers.data());
  return numbers.data() + (64 - address % 64) % 64 / sizeof(double);
}

bool needs_formula_series(const Scene& scene) {
  return std::any_of(scene.torques().begin(), scene.torques().end(),
                     [](const AnyTorque& torque) { return find_formula(torque) != nullptr; });
}

FormulaSeries::FormulaSeries(const Scene& scene, bool) : FormulaSeries(scene, nullptr) {}

FormulaSeries::FormulaSeries(const Scene& scene, std::shared_ptr<const formula::Table> table)
    : frame_(drop_torques(scene), true), table_(std::move(table)) {
  states_ = list_states(scene.torques());
  const std::vector<double> starts = formula::list_values(states_);
  if (starts.size() > most_width - ode::series_width)
    throw InvalidInput("torques", "formulas with at most 56 numbers of states", std::to_string(starts.size()));
  int end = ode::series_width;
  for (const formula::Input& state : states_) {
    ends_.push_back(end += static_cast<int>(state.values.size()));
    counted_.push_back(!holds_command(scene, state.name));
  }
  if (!table_) table_ = find_table(scene, frame_, states_);
  start_.assign(static_cast<std::size_t>(width()), 0.0);
  std::copy_n(frame_.start(), ode::series_width, start_.begin());
  std::copy(starts.begin(), starts.end(), start_.begin() + ode::series_width);
  largest_.assign(states_.size(), 0.0);
  workspace_.resize(table_->workspace_size(ode::most_series_order) + 8);
}

FormulaSeries FormulaSeries::with_table(std::shared_ptr<const formula::Table> table) const {
  FormulaSeries other = *this;
  other.table_ = std::move(table);
  other.workspace_.resize(other.table_->workspace_size(ode::most_series_order) + 8);
  return other;
}

formula::Program make_body_system(const Scene& scene, const BodySeries& frame,
                                  const std::vector<formula::Input>& states) {
  formula::Program made;
  Graph& graph = made.graph;
  const SeriesTerms& terms = frame.terms();
  const bool plain = terms.variables == RateVariables::plain;
  const Vec<Expr, 3> r = formula::list_states<3>(graph, formula::first_rate);
  const Vec<Expr, 4> q_WP = formula::list_states<4>(graph, formula::first_attitude);
  const double half_over_k = terms.to_rates[0];
  const Vec<Expr, 3> w_P = plain ? r : Vec<Expr, 3>{{(r[1] - r[0]) * half_over_k, r[2], (r[0] + r[1]) * 0.5}};
  std::vector<Form> rates;
  const Vec<Expr, 3> a = BodyLaws(graph, frame, w_P, q_WP, states).accelerate(scene, rates);

  Vec<Expr, 3> change;
  const double* product = terms.product;
  if (plain) {
    for (std::size_t i = 0; i < 3; ++i) change[i] = a[i] + r[(i + 1) % 3] * r[(i + 2) % 3] * product[i];
  } else {
    const Expr along = a[0] * (0.5 / half_over_k);   // k a_1
    change = {{a[2] - along + r[0] * r[2] * product[0], a[2] + along + r[1] * r[2] * product[1],
               a[1] + (r[1] - r[0]) * (r[1] + r[0]) * product[2]}};
  }
  for (const Expr& rate : change.components) made.outputs.push_back(rate.form());
  const Vec<Expr, 4> rotation = formula::multiply_pure(q_WP, w_P);
  for (const Expr& rate : rotation.components) made.outputs.push_back((rate * 0.5).form());
  for (Form& rate : rates) made.outputs.push_back(std::move(rate));
  if (!plain)
    for (const Expr& rate : w_P.components) made.rates.push_back(rate.form());
  return formula::rewrite(made);
}

std::string FormulaSeries::describe_state() const {
  std::string state = frame_.describe_state();
  for (const formula::Input& one : states_) state += ", " + one.name;
  return state;
}

void FormulaSeries::unpack(const double* rows, std::size_t n, double* omega, double* attitude) const {
  const auto stride = static_cast<std::size_t>(width());
  if (stride == ode::series_width) return frame_.unpack(rows, n, omega, attitude);
  for (std::size_t i = 0; i < n; ++i) frame_.unpack(rows + stride * i, 1, omega + 3 * i, attitude + 4 * i);
}

FormulaSeries FormulaSeries::perturbed(double part, int choice) const {
  FormulaSeries other = *this;
  const SeriesTerms& terms = frame_.terms();
  const bool rounded = frame_.is_rotated() && frame_.axes().cwiseAbs().maxCoeff() < 1.0;
  const Vector3d& I = frame_.moments();
  const auto change = [&](double x) {
    const double size = std::abs(x);
    double by = (rounded ? 8.0 : 2.0) * size;
    bool is_product = false;
    for (int i = 0; i < 3; ++i) {
      if (size != std::abs(terms.product[i])) continue;
      is_product = true;
      if (rounded) by = std::max(by, I.maxCoeff() / I[i]);
    }
    if (x == 0.0 || !std::isfinite(x) || (is_power_of_two(x) && !is_product)) return x;
    math::Coin coin(std::bit_cast<std::uint64_t>(size) ^ (2025 + static_cast<std::uint64_t>(choice)));
    return std::copysign(size + (coin.toss() ? part * by : -part * by), x);
  };
  other.table_ = std::make_shared<const formula::Table>(table_->with_constants(change));
  return other;
}

FormulaSeries FormulaSeries::shifted(double, const double* error) const {
  FormulaSeries other = *this;
  for (std::size_t i = 0; i < start_.size(); ++i) other.start_[i] += error[i];
  return other;
}

void FormulaSeries::measure_error(const double* y, const double* error, double* out) const {
  frame_.measure_error(y, error, out);
  int begin = ode::series_width;
  for (std::size_t i = 0; i < ends_.size(); begin = ends_[i++]) {
    if (!counted_[i]) continue;
    double apart = 0.0;
    for (int k = begin; k < ends_[i]; ++k) {
      apart = std::max(apart, std::abs(error[k]));
      largest_[i] = std::max(largest_[i], std::abs(y[k]));
    }
    if (apart > 0.0) out[3] = std::max(out[3], apart / largest_[i]);
  }
}

void FormulaSeries::expand(DD t, double unit, const double* y, int order, double* rows, double* extras) const {
  double states[most_width];
  std::copy_n(y, 3, states);
  std::copy_n(y + 4, width() - 4, states + 3);
  table_->compute_series(simd_level(), t, unit, states, order, rows, extras, align_to_line(workspace_));
}

void FormulaSeries::compute_sizes(const double* row, double* sizes) const {
  frame_.compute_sizes(row, sizes);
  int begin = ode::series_width;
  for (std::size_t i = 0; i < ends_.size(); begin = ends_[i++]) {
    double largest = 0.0, sum = 0.0;
    for (int k = begin; k < ends_[i]; ++k) largest = std::max(largest, std::abs(row[k])), sum += row[k];
    sizes[2 + i] = largest + 0.0 * sum;   // NaN if a number is
  }
}

double FormulaSeries::compute_known_size(int row, int which) const {
  return table_->compute_known_size(align_to_line(workspace_), row, which);
}

/// From the first two derivatives: the rates' own, and those of the quaternion and the states.
double FormulaSeries::compute_time_scale(DD t, const double* y) const {
  alignas(64) double rows[3 * most_width];
  compute_series(t, 1.0, y, y, 2, rows);
  double size[3][blocks], rate = 0.0;
  for (int k = 0; k < 3; ++k) compute_sizes(rows + width() * k, size[k]);
  rate = std::max(size[0][0], std::sqrt(size[1][0]));
  for (int b = 0; b < count_blocks(); ++b) {
    if (!(size[0][b] > 0.0)) continue;
    rate = std::max({rate, size[1][b] / size[0][b], std::sqrt(size[2][b] / size[0][b])});
  }
  for (int k = 0; k < count_known(); ++k) rate = std::max(rate, compute_known_size(1, k) / compute_known_size(0, k));
  return rate > 0.0 && rate < std::numeric_limits<double>::infinity() ? 1.0 / rate : 0x1p900;
}

void FormulaSeries::start_carry(double* carry) const {
  std::fill_n(carry, width(), 0.0);
  frame_.start_carry(carry);
}

void FormulaSeries::correct(DD, long, double* y, double* carry) const { BodySeries::keep_unit(y, carry); }

}  // namespace polhode
