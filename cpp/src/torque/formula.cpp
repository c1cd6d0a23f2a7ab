#include "polhode/torque/formula.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "polhode/core/error.hpp"
#include "polhode/formula/derivative.hpp"
#include "polhode/formula/facts.hpp"
#include "polhode/torque/detail/law_arguments.hpp"

namespace polhode::torques {
namespace {

constexpr int most_states = 56;   // numbers of one torque: rows of a series have at most 64

void require_states(const formula::Program& program) {
  const std::vector<double> starts = formula::list_values(program.states);
  if (starts.size() > most_states)
    throw InvalidInput("Formula.states", "at most " + std::to_string(most_states) + " numbers",
                       std::to_string(starts.size()));
  for (const formula::Input& state : program.states)
    for (const double start : state.values)
      if (!std::isfinite(start)) throw InvalidInput("Formula.states." + state.name, "finite", to_text(start));
  if (program.outputs.size() != 3 + starts.size())
    throw InvalidInput("Formula", "a torque of 3 components" + std::string(starts.empty() ? "" : " and a rate for each state"),
                       std::to_string(program.outputs.size()));
}

void replace(std::vector<formula::Input>& inputs, const std::vector<double>& numbers) {
  std::size_t next = 0;
  for (formula::Input& input : inputs)
    for (double& value : input.values) value = numbers.at(next++);
}

}  // namespace

struct Formula::Parts {
  /// @param of_law  the last parameter is the inertia, if it has that name
  explicit Parts(const formula::Program& given, bool of_law = false)
      : text(formula::print(given)),
        open_law(of_law ? std::optional(given) : std::nullopt),
        own_numbers(count_own(given, of_law)),
        potential(is_potential(given) ? std::optional(bind(given)) : std::nullopt),
        program(of_law ? bind_own(given, own_numbers) : bind(potential ? formula::derive_torque(given) : given)),
        potential_evaluator(potential ? std::optional<formula::Evaluator>(*potential) : std::nullopt),
        facts(formula::find_facts(program)),
        evaluator(program) {}

  /// @param in  with an attitude of unit length
  void compute(const TorqueInput& in, const double* states, double* outputs) const {
    evaluate(program, evaluator, in, states, outputs);
  }

  void compute_rate_slopes(const TorqueInput& in, const double* states, double* outputs) const {
    std::call_once(differentiated, [this] { rate_slopes = std::make_unique<const Slopes>(program); });
    evaluate(rate_slopes->program, rate_slopes->evaluator, in, states, outputs);
  }

  void evaluate(const formula::Program& of, const formula::Evaluator& by, const TorqueInput& in, const double* states,
                double* outputs) const {
    const double *omega = in.omega, *attitude = in.attitude, *inertia = in.inertia_B.data();   // it is symmetric
    std::array<double, formula::first_extra + most_states> y;
    std::copy_n(omega, 3, y.begin());
    std::copy_n(attitude, 4, y.begin() + formula::first_attitude);
    std::copy_n(states, program.outputs.size() - 3, y.begin() + formula::first_extra);
    constexpr int few = 256;
    if (of.graph.size() <= few) {
      std::array<double, few> values;
      by.evaluate(in.t, y.data(), inertia, values.data(), outputs);
    } else {
      std::vector<double> values(static_cast<std::size_t>(of.graph.size()));
      by.evaluate(in.t, y.data(), inertia, values.data(), outputs);
    }
  }

  static std::size_t count_own(const formula::Program& given, bool of_law) {
    const std::size_t all = formula::list_values(given.parameters).size();
    return of_law && !given.parameters.empty() && given.parameters.back().name == inertia_input ? all - 9 : all;
  }
  static formula::Program bind_own(const formula::Program& given, std::size_t count) {
    std::vector<double> values = formula::list_values(given.parameters);
    values.resize(count);
    return formula::bind_some(given, 0, values);
  }
  bool is_open() const { return !program.parameters.empty(); }

  static bool is_potential(const formula::Program& given) { return given.outputs.size() == 1 && given.states.empty(); }
  static formula::Program bind(const formula::Program& given) {
    return formula::rewrite(formula::bind_parameters(given, formula::list_values(given.parameters)));
  }

  /// The derivatives of tau_B by the first rate, then by the others.
  struct Slopes {
    explicit Slopes(const formula::Program& torque) : program(differentiate(torque)), evaluator(program) {}

    static formula::Program differentiate(const formula::Program& torque) {
      using formula::Variable;
      std::vector<Variable> rates;
      for (int i = 0; i < 3; ++i) rates.push_back({Variable::Kind::state, formula::first_rate + i});
      formula::Program made = formula::differentiate(torque, rates);
      std::vector<formula::Form> wanted;
      for (std::size_t i = 1; i <= 3; ++i)
        for (std::size_t k = 0; k < 3; ++k) wanted.push_back(made.outputs[torque.outputs.size() * i + k]);
      made.outputs = std::move(wanted);
      return formula::rewrite(made);
    }

    formula::Program program;
    formula::Evaluator evaluator;
  };

  formula::Text text;
  std::optional<formula::Program> open_law;   // of the library, as it was given
  std::size_t own_numbers;                    // of its parameters but the inertia
  std::optional<formula::Program> potential;
  formula::Program program;
  std::optional<formula::Evaluator> potential_evaluator;   // of the potential above
  formula::Facts facts;
  formula::Evaluator evaluator;   // of the program above
  mutable std::once_flag differentiated;
  mutable std::unique_ptr<const Slopes> rate_slopes;
};

Formula::Formula(const formula::Text& text, bool recognise) : Formula(formula::parse(text), recognise) {}

Formula::Formula(const formula::Program& program, bool recognise) : recognise_(recognise) {
  if (!Parts::is_potential(program)) require_states(program);
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

const std::vector<formula::Input>& Formula::states() const { return parts_->text.states; }

Formula Formula::of_law(const formula::Program& open_law) {
  require_states(open_law);
  return Formula(std::make_shared<const Parts>(open_law, true), false);
}

formula::Program Formula::program(const Matrix3d& inertia_B) const {
  if (!parts_->is_open()) return parts_->program;
  return formula::bind_some(parts_->program, 0, {inertia_B.data(), inertia_B.data() + 9});
}

formula::Program Formula::given() const {
  return parts_->open_law ? *parts_->open_law : formula::parse(parts_->text);
}

Formula Formula::with_starts(const std::vector<double>& starts) const {
  if (parts_->open_law) {
    formula::Program law = *parts_->open_law;
    replace(law.states, starts);
    return of_law(law);
  }
  formula::Text text = parts_->text;
  replace(text.states, starts);
  return Formula(text, recognise_);
}

Formula Formula::with_parameters(const std::vector<double>& values) const {
  formula::Text text = parts_->text;
  replace(text.parameters, values);
  return Formula(text, recognise_);
}

Formula Formula::as_given() const {
  Formula other = *this;
  other.recognise_ = false;
  return other;
}

formula::Program Formula::law(const Matrix3d& inertia_B) const {
  const formula::Program given = this->given();
  if (parts_->is_open())
    return formula::bind_some(given, static_cast<int>(parts_->own_numbers), {inertia_B.data(), inertia_B.data() + 9});
  return parts_->potential ? formula::derive_torque(given) : given;
}

bool Formula::has_switches() const { return parts_->facts.has_switches; }

TorqueTraits Formula::traits() const {
  const formula::Facts& facts = parts_->facts;
  const auto& outputs = parts_->program.outputs;
  return {.uses_time = facts.uses_time,
          .uses_attitude = facts.uses_attitude,
          .uses_rates = facts.uses_rates,
          .has_potential = parts_->potential.has_value(),
          .vanishes = states().empty() && std::all_of(outputs.begin(), outputs.end(), [](const auto& form) { return form.is_zero(); })};
}

std::vector<double> Formula::compute(const TorqueInput& in, const std::vector<double>& states) const {
  const double* q = in.attitude;
  const double d = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  const double s = 1.0 / std::sqrt(d);
  const double unit[4] = {s * q[0], s * q[1], s * q[2], s * q[3]};
  std::vector<double> outputs(parts_->program.outputs.size());
  parts_->compute({in.t, in.omega, d == 1.0 ? q : unit, in.inertia_B}, states.data(), outputs.data());
  return outputs;
}

void Formula::add(const TorqueInput& in, double* tau_B) const {
  const double* q = in.attitude;
  const double d = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  const double s = 1.0 / std::sqrt(d);
  const double unit[4] = {s * q[0], s * q[1], s * q[2], s * q[3]};
  std::array<double, 3 + most_states> outputs;
  const std::vector<double> starts = formula::list_values(states());
  parts_->compute({in.t, in.omega, d == 1.0 ? q : unit, in.inertia_B}, starts.data(), outputs.data());
  for (std::size_t i = 0; i < 3; ++i) tau_B[i] += outputs[i];
}

void Formula::add_rate_slopes(const TorqueInput& in, Matrix3d& slopes) const {
  const Quat unit = normalized({in.attitude[0], in.attitude[1], in.attitude[2], in.attitude[3]});
  const double q[4] = {unit.x, unit.y, unit.z, unit.w};
  Matrix3d found;
  parts_->compute_rate_slopes({in.t, in.omega, q, in.inertia_B}, formula::list_values(states()).data(), found.data());
  slopes += found;
}

double Formula::compute_potential(const TorqueInput& in) const {
  if (!parts_->potential) return 0.0;
  const double* q = in.attitude;
  const double s = 1.0 / std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const double y[formula::first_extra] = {in.omega[0], in.omega[1], in.omega[2], s * q[0], s * q[1], s * q[2], s * q[3]};
  std::vector<double> values(static_cast<std::size_t>(parts_->potential->graph.size()));
  double potential = 0.0;
  parts_->potential_evaluator->evaluate(in.t, y, nullptr, values.data(), &potential);
  return potential;
}

Custom Formula::as_custom(const Matrix3d& inertia_B) const {
  if (parts_->is_open()) return Formula(program(inertia_B), false).as_custom(inertia_B);
  if (!states().empty())
    throw InvalidInput("Formula", "without states of its own", "states " + states()[0].name, "taylor integrates them");
  const TorqueTraits traits = this->traits();
  const Custom::Function call = [](double t, const double* omega, const double* attitude, double* torque, void* data) {
    static const Matrix3d none = Matrix3d::Zero();   // it has no inertia
    static_cast<const Parts*>(data)->compute({t, omega, attitude, none}, nullptr, torque);
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
