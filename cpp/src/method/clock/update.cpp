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
  return std::abs(changes[0][i]) + std::abs(changes[1][i]) + std::abs(changes[2][i]);
}

void Carried::widen(std::size_t i, double size) {
  changes[1][i] += std::copysign(size, changes[1][i]);
  // Neighbours move apart in the other sample.
  changes[2][i] += std::copysign(size, i % 2 == 0 ? changes[1][i] : -changes[1][i]);
}

Update::Update(const Controller& controller, Carrying carrying)
    : controller_(controller),
      carrying_(std::move(carrying)),
      inputs_(7 + formula::list_values(controller.inputs()).size()),
      outputs_(inputs_ - 7),
      row_(inputs_),
      results_(outputs_),
      moved_(carrying_.count) {
  if (!controller_.is_traced()) {
    if (carrying_.what == Carry::columns)
      throw InvalidInput("sensitivity", "left out for a controller whose function is not traced", "trace=False",
                         "its derivative is not known");
    return;
  }
  program_ = controller_.program();
  const std::vector<formula::Form> guards = formula::list_guards(*program_);
  guards_ = guards.size();
  program_->outputs.insert(program_->outputs.end(), guards.begin(), guards.end());
  values_ = std::make_unique<formula::Evaluator>(*program_);
  results_.resize(outputs_ + guards_);
  if (carrying_.what == Carry::nothing) return;
  by_ = list_used(*program_);
  std::vector<formula::Variable> variables;
  for (const std::size_t input : by_) variables.push_back({formula::Variable::Kind::state, static_cast<int>(input)});
  if (carrying_.by.empty()) {
    slopes_program_ = formula::differentiate(*program_, variables);
  } else {
    for (const ParameterColumn& one : carrying_.by)
      variables.push_back({formula::Variable::Kind::parameter, one.number});
    formula::Program open = formula::expand_rotations(controller_.open_program());   // with parameters
    const std::vector<formula::Form> open_guards = formula::list_guards(open);
    guards_ = open_guards.size();
    open.outputs.insert(open.outputs.end(), open_guards.begin(), open_guards.end());
    slopes_program_ = formula::rewrite(formula::bind_parameters(formula::differentiate(open, variables),
                                                                formula::list_values(open.parameters)));
  }
  slopes_ = std::make_unique<formula::Evaluator>(*slopes_program_);
  results_.resize((1 + by_.size() + carrying_.by.size()) * (outputs_ + guards_));
}

void Update::call(double t, const double* in, double* out) {
  if (!values_) return controller_.parts().function(t, in, out);
  (*values_)(t, in, nullptr, results_.data());
  std::copy_n(results_.data(), outputs_, out);
}

void Update::operator()(double t, std::uint64_t tick, const Carried& in, Carry carry, Carried& out) {
  if (carry != Carry::nothing && slopes_) carry_by_slopes(t, in, out);
  else call(t, in.values.data(), out.values.data());
  for (std::size_t i = 0; i < outputs_; ++i) {
    if (std::isfinite(out.values[i])) continue;
    throw InvalidInput("the controller's function", "finite in all numbers",
                       to_text(out.values[i]) + " at tick " + std::to_string(tick) + ", t = " + to_text(t) + " s");
  }
  if (carry != Carry::nothing && !slopes_) carry_by_calls(t, in, out);
}

void Update::move(std::size_t row, const Carried& in) {
  std::fill(moved_.begin(), moved_.end(), 0.0);
  for (std::size_t k = 0; k < by_.size(); ++k) {
    const double s = slope(row, k);
    if (s == 0.0) continue;
    for (std::size_t e = 0; e < moved_.size(); ++e) moved_[e] += s * in.changes[e][by_[k]];
  }
  for (std::size_t k = 0; k < carrying_.by.size(); ++k) moved_[carrying_.by[k].column] += slope(row, by_.size() + k);
}

void Update::carry_by_slopes(double t, const Carried& in, Carried& out) {
  (*slopes_)(t, in.values.data(), nullptr, results_.data());
  std::copy_n(results_.data(), outputs_, out.values.begin());
  for (std::size_t i = 0; i < outputs_; ++i) {
    move(i, in);
    for (std::size_t e = 0; e < moved_.size(); ++e) out.changes[e][i] = moved_[e];
    if (carrying_.what != Carry::errors) continue;
    double size = std::abs(out.values[i]);
    for (std::size_t k = 0; k < by_.size(); ++k) size += std::abs(slope(i, k) * in.values[by_[k]]);
    out.widen(i, rounding * size);
  }
  if (carrying_.what == Carry::errors) carry_guards(t, in, out);
  else certain_ = are_certain(in);
}

/// Whether each guard is farther from 0 than the accuracy of the numbers. A guard that is 0 and does not move is.
bool Update::are_certain(const Carried& in) {
  const double rate = std::max({std::abs(in.values[0]), std::abs(in.values[1]), std::abs(in.values[2])});
  for (std::size_t g = 0; g < guards_; ++g) {
    const double guard = results_[outputs_ + g];
    double error = 0.0;
    for (std::size_t k = 0; k < by_.size(); ++k) {
      const std::size_t at = by_[k];
      const double size = at < 3 ? rate : at < 7 ? 1.0 : std::abs(in.values[at]);
      error += std::abs(slope(outputs_ + g, k)) * carrying_.accuracy * size;
    }
    if (std::abs(guard) > error) continue;
    if (guard != 0.0) return false;
    move(outputs_ + g, in);
    for (const double moved : moved_)
      if (moved != 0.0) return false;
  }
  return true;
}

void Update::carry_guards(double t, const Carried& in, Carried& out) {
  std::vector<std::size_t> unsure;
  std::vector<std::vector<double>> towards;   // the errors of the inputs that move an unsure guard most
  for (std::size_t g = 0; g < guards_; ++g) {
    double error = 0.0;
    for (std::size_t k = 0; k < by_.size(); ++k) error += rounding * std::abs(slope(outputs_ + g, k) * in.values[by_[k]]);
    move(outputs_ + g, in);
    for (const double moved : moved_) error += std::abs(moved);
    if (!(error > 0.0) || std::abs(results_[outputs_ + g]) > certain_errors * error) continue;
    unsure.push_back(g);
    towards.emplace_back(inputs_);
    for (std::size_t e = 0; e < moved_.size(); ++e)
      for (std::size_t i = 0; i < inputs_; ++i)
        towards.back()[i] += certain_errors * std::copysign(1.0, moved_[e]) * in.changes[e][i];
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
  for (std::size_t e = 0; e < in.changes.size(); ++e) {
    double size = 0.0;
    for (const double error : in.changes[e]) size = std::max(size, std::abs(error));
    std::fill(out.changes[e].begin(), out.changes[e].end(), 0.0);
    if (!(size > 0.0)) continue;
    const double scale = part * largest / size;
    for (std::size_t i = 0; i < inputs_; ++i) row_[i] = in.values[i] + scale * in.changes[e][i];
    moved = out.values;
    call(t, row_.data(), moved.data());
    for (std::size_t i = 0; i < outputs_; ++i) out.changes[e][i] = (moved[i] - out.values[i]) / scale;
  }
}

}  // namespace polhode
