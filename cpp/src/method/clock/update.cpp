#include "method/clock/update.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "polhode/core/error.hpp"
#include "polhode/formula/derivative.hpp"
#include "polhode/formula/modes.hpp"

namespace polhode {
namespace {

constexpr double rounding = 4 * rounding_unit;   // of an operation's operands in a law

std::vector<std::size_t> list_used(const formula::Program& program) {
  const std::vector<bool> live = formula::find_live(program.graph, program.outputs);
  std::vector<std::size_t> used;
  for (int i = 0; i < program.graph.size(); ++i)
    if (live[static_cast<std::size_t>(i)] && program.graph[i].op == formula::Op::state)
      used.push_back(static_cast<std::size_t>(program.graph[i].index));
  std::sort(used.begin(), used.end());
  return used;
}

}  // namespace

double Carried::find_error(std::size_t i) const {
  return std::abs(errors[0][i]) + std::abs(errors[1][i]) + std::abs(errors[2][i]);
}

void Carried::widen(std::size_t i, double size) {
  errors[1][i] += std::copysign(size, errors[1][i]);
  // Neighbours move apart in the other sample.
  errors[2][i] += std::copysign(size, i % 2 == 0 ? errors[1][i] : -errors[1][i]);
}

Update::Update(const Controller& controller)
    : controller_(controller),
      inputs_(7 + formula::list_values(controller.inputs()).size()),
      outputs_(inputs_ - 7),
      row_(inputs_),
      results_(outputs_) {
  if (!controller_.is_traced()) return;
  program_ = controller_.program();
  const std::vector<formula::Form> guards = formula::list_guards(*program_);
  guards_ = guards.size();
  program_->outputs.insert(program_->outputs.end(), guards.begin(), guards.end());
  values_ = std::make_unique<formula::Evaluator>(*program_);
  by_ = list_used(*program_);
  std::vector<formula::Variable> variables;
  for (const std::size_t input : by_) variables.push_back({formula::Variable::Kind::state, static_cast<int>(input)});
  slopes_program_ = formula::differentiate(*program_, variables);
  slopes_ = std::make_unique<formula::Evaluator>(*slopes_program_);
  results_.resize((1 + by_.size()) * (outputs_ + guards_));
}

void Update::call(double t, const double* in, double* out) {
  if (!values_) return controller_.parts().function(t, in, out);
  (*values_)(t, in, nullptr, results_.data());
  std::copy_n(results_.data(), outputs_, out);
}

void Update::operator()(double t, std::uint64_t tick, const Carried& in, bool with_errors, Carried& out) {
  if (with_errors && slopes_) carry_by_slopes(t, in, out);
  else call(t, in.values.data(), out.values.data());
  for (std::size_t i = 0; i < outputs_; ++i) {
    if (std::isfinite(out.values[i])) continue;
    throw InvalidInput("the controller's function", "finite in all numbers",
                       to_text(out.values[i]) + " at tick " + std::to_string(tick) + ", t = " + to_text(t) + " s");
  }
  if (with_errors && !slopes_) carry_by_calls(t, in, out);
}

void Update::carry_by_slopes(double t, const Carried& in, Carried& out) {
  (*slopes_)(t, in.values.data(), nullptr, results_.data());
  const std::size_t rows = outputs_ + guards_;
  std::copy_n(results_.data(), outputs_, out.values.begin());
  const auto slope = [&](std::size_t row, std::size_t k) { return results_[rows * (1 + k) + row]; };
  for (std::size_t i = 0; i < outputs_; ++i) {
    double moved[3] = {}, size = std::abs(out.values[i]);
    for (std::size_t k = 0; k < by_.size(); ++k) {
      const double s = slope(i, k);
      if (s == 0.0) continue;
      for (std::size_t e = 0; e < 3; ++e) moved[e] += s * in.errors[e][by_[k]];
      size += std::abs(s * in.values[by_[k]]);
    }
    for (std::size_t e = 0; e < 3; ++e) out.errors[e][i] = moved[e];
    out.widen(i, rounding * size);
  }
  std::vector<std::size_t> unsure;
  std::vector<std::vector<double>> towards;   // the errors of the inputs that move an unsure guard most
  for (std::size_t g = 0; g < guards_; ++g) {
    double moved[3] = {}, noise = 0.0;
    for (std::size_t k = 0; k < by_.size(); ++k) {
      const double s = slope(outputs_ + g, k);
      if (s == 0.0) continue;
      for (std::size_t e = 0; e < 3; ++e) moved[e] += s * in.errors[e][by_[k]];
      noise += rounding * std::abs(s * in.values[by_[k]]);
    }
    const double error = std::abs(moved[0]) + std::abs(moved[1]) + std::abs(moved[2]) + noise;
    if (!(error > 0.0) || std::abs(results_[outputs_ + g]) > certain_errors * error) continue;
    unsure.push_back(g);
    towards.emplace_back(inputs_);
    for (std::size_t e = 0; e < 3; ++e)
      for (std::size_t i = 0; i < inputs_; ++i)
        towards.back()[i] += certain_errors * std::copysign(1.0, moved[e]) * in.errors[e][i];
  }
  if (unsure.empty()) return;
  std::vector<bool> all(guards_);
  for (std::size_t n = 0; n < unsure.size(); ++n) {
    std::vector<bool> one(guards_);
    one[unsure[n]] = all[unsure[n]] = true;
    add_jump(t, in, one, towards[n], out);
  }
  if (unsure.size() > 1) add_jump(t, in, all, towards[0], out);
}

void Update::add_jump(double t, const Carried& in, const std::vector<bool>& flipped, const std::vector<double>& towards,
                      Carried& out) {
  formula::Program law = *program_;
  law.outputs.resize(outputs_);
  const std::vector<int> switches = formula::list_switches(*program_), own = formula::list_switches(law);
  const formula::Mode all = formula::find_mode(*program_, t, in.values.data());
  formula::Mode mode, other;
  for (const int node : own) {
    const auto at = static_cast<std::size_t>(std::lower_bound(switches.begin(), switches.end(), node) - switches.begin());
    mode.push_back(all[at]), other.push_back(all[at] != flipped[at]);
  }
  const formula::Program here = formula::in_mode(law, mode), there = formula::in_mode(law, other);
  formula::Evaluator evaluate_here(here), evaluate_there(there);
  std::vector<double> a(outputs_), b(outputs_), jump(outputs_), at(inputs_);
  for (const double side : {-1.0, 0.0, 1.0}) {
    for (std::size_t i = 0; i < inputs_; ++i) at[i] = in.values[i] + side * towards[i];
    evaluate_here(t, at.data(), nullptr, a.data());
    evaluate_there(t, at.data(), nullptr, b.data());
    for (std::size_t i = 0; i < outputs_; ++i)   // NaN counts as an unknown jump
      jump[i] = std::abs(a[i] - b[i]) <= jump[i] ? jump[i] : std::abs(a[i] - b[i]);
  }
  for (std::size_t i = 0; i < outputs_; ++i)
    if (jump[i] != 0.0) out.widen(i, std::isnan(jump[i]) ? std::numeric_limits<double>::max() : jump[i]);
}

/// Differences of calls, for a function whose derivative is not known.
void Update::carry_by_calls(double t, const Carried& in, Carried& out) {
  constexpr double part = 1e-6;   // of the largest number: differences keep ten digits
  double largest = 0.0;
  for (const double value : in.values) largest = std::max(largest, std::abs(value));
  std::vector<double> moved(outputs_);
  for (std::size_t e = 0; e < 3; ++e) {
    double size = 0.0;
    for (const double error : in.errors[e]) size = std::max(size, std::abs(error));
    std::fill(out.errors[e].begin(), out.errors[e].end(), 0.0);
    if (!(size > 0.0)) continue;
    const double scale = part * largest / size;
    for (std::size_t i = 0; i < inputs_; ++i) row_[i] = in.values[i] + scale * in.errors[e][i];
    moved = out.values;
    call(t, row_.data(), moved.data());
    for (std::size_t i = 0; i < outputs_; ++i) out.errors[e][i] = (moved[i] - out.values[i]) / scale;
  }
}

}  // namespace polhode
