#include "polhode/torque/formula.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "polhode/core/error.hpp"
#include "polhode/formula/facts.hpp"

namespace polhode::torques {
namespace {

void refuse_states(std::size_t count) {
  if (count == 0) return;
  throw InvalidInput("Formula.states", "left out", std::to_string(count) + " states",
                     "states of a formula are not supported yet; keep them in the function of a Custom torque");
}

formula::Program parse_torque(const formula::Text& text) {
  refuse_states(std::max(text.states.size(), text.rates.size()));
  return formula::parse(text);
}

}  // namespace

struct Formula::Parts {
  explicit Parts(const formula::Program& given)
      : text(formula::print(given)),
        program(formula::rewrite(formula::bind_parameters(given, formula::list_values(given.parameters)))),
        facts(formula::find_facts(program)),
        evaluator(program) {}

  void compute(double t, const double* omega, const double* attitude, double* torque) const {
    std::array<double, formula::first_extra> y;
    std::copy_n(omega, 3, y.begin());
    std::copy_n(attitude, 4, y.begin() + formula::first_attitude);
    constexpr int few = 256;
    if (program.graph.size() <= few) {
      std::array<double, few> values;
      evaluator.evaluate(t, y.data(), nullptr, values.data(), torque);
    } else {
      std::vector<double> values(static_cast<std::size_t>(program.graph.size()));
      evaluator.evaluate(t, y.data(), nullptr, values.data(), torque);
    }
  }

  formula::Text text;
  formula::Program program;
  formula::Facts facts;
  formula::Evaluator evaluator;   // of the program above
};

Formula::Formula(const formula::Text& text, bool recognise) : Formula(parse_torque(text), recognise) {}

Formula::Formula(const formula::Program& program, bool recognise) : recognise_(recognise) {
  refuse_states(program.states.size());
  if (program.outputs.size() != 3)
    throw InvalidInput("Formula", "a torque of 3 components", std::to_string(program.outputs.size()));
  parts_ = std::make_shared<const Parts>(program);
}

const TorqueRecord& Formula::record() {
  static constexpr TorqueRecord record{"Formula", "formula",
                                       "A torque of the user's own as a formula: a traced function, or text.", "", {}};
  return record;
}

const formula::Text& Formula::text() const { return parts_->text; }
const std::vector<formula::Input>& Formula::parameters() const { return parts_->text.parameters; }
const formula::Program& Formula::program() const { return parts_->program; }

bool Formula::has_switches() const { return parts_->facts.has_switches; }

TorqueTraits Formula::traits() const {
  const formula::Facts& facts = parts_->facts;
  const auto& outputs = parts_->program.outputs;
  return {.uses_time = facts.uses_time,
          .uses_attitude = facts.uses_attitude,
          .uses_rates = facts.uses_rates,
          .vanishes = std::all_of(outputs.begin(), outputs.end(), [](const auto& form) { return form.is_zero(); })};
}

void Formula::add(const TorqueInput& in, double* tau_B) const {
  const double* q = in.attitude;
  const double d = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  const double s = 1.0 / std::sqrt(d);
  const double unit[4] = {s * q[0], s * q[1], s * q[2], s * q[3]};
  double torque[3];
  parts_->compute(in.t, in.omega, d == 1.0 ? q : unit, torque);
  for (int i = 0; i < 3; ++i) tau_B[i] += torque[i];
}

Custom Formula::as_custom() const {
  const TorqueTraits traits = this->traits();
  const Custom::Function call = [](double t, const double* omega, const double* attitude, double* torque, void* data) {
    static_cast<const Parts*>(data)->compute(t, omega, attitude, torque);
  };
  Custom custom(call, const_cast<Parts*>(parts_.get()),
                {.uses_time = traits.uses_time, .uses_attitude = traits.uses_attitude, .uses_rates = traits.uses_rates},
                nullptr, parts_);
  custom.name_ = "Formula";
  return custom;
}

bool operator==(const Formula& a, const Formula& b) {
  return a.recognise_ == b.recognise_ && (a.parts_ == b.parts_ || a.parts_->text == b.parts_->text);
}

}  // namespace polhode::torques
