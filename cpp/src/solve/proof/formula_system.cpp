#include "solve/proof/formula_system.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "polhode/core/error.hpp"
#include "polhode/formula/derivative.hpp"
#include "polhode/torque/detail/law_arguments.hpp"
#include "solve/proof/exact_graph.hpp"
#include "solve/proof/index.hpp"

namespace polhode::proof {
namespace {

using formula::Expr;
using formula::Program;
using formula::Vec;

class Builder {
 public:
  Builder(const Scene& scene, const Units& units, bool has_attitude)
      : scene_(scene), units_(units), has_attitude_(has_attitude),
        part_(math::Interval(std::ldexp(1.0, -std::ilogb(scene.inertia_B().matrix().cwiseAbs().maxCoeff())))),
        I_(enclose_inertia(scene, part_.middle.hi)), inverse_(invert(I_)),
        per_pace_(Interval(1.0) / Interval(units.pace)), products_(enclose_products(I_)) {
    Graph& graph = exact_.graph();
    w_ = formula::list_states<3>(graph, formula::first_rate);
    q_ = formula::list_states<4>(graph, formula::first_attitude);
    for (const Expr& rate : w_.components) body_.push_back(rate * units.rate);
    for (const Expr& part : q_.components) body_.push_back(part);
    for (std::size_t i = 0; i < units.states.size(); ++i)
      own_.push_back(Expr(graph, graph.state(formula::first_extra + static_cast<int>(i))) * units.states[i]);
    own_rates_.resize(own_.size());
  }

  FormulaEquations build(const std::vector<AnyTorque>& torques, const std::vector<bool>& rotating) {
    const Interval rate(units_.rate);
    add_products(w_, -rate * per_pace_);
    for (std::size_t i = 0; i < rotating.size(); ++i)
      if (rotating[i]) add_rotor(scene_.rotors()[i]);
    for (std::size_t i = 0; i < torques.size(); ++i) add(torques[i], i);

    Program program;
    for (const Expr& change : change_.components) program.outputs.push_back((change * units_.sign).form());
    if (has_attitude_) {
      const Vec<Expr, 4> q_rate = formula::multiply_pure(q_, w_);
      for (int i = 0; i < 4; ++i) {
        const double half = 0.5 * units_.sign * (units_.rate / units_.pace);
        program.outputs.push_back((q_rate[to_index(i)] * half).form());
      }
    }
    for (std::size_t i = 0; i < own_.size(); ++i) {
      const Expr change = own_rates_[i] ? *own_rates_[i] : Expr(0.0);
      program.outputs.push_back((change * (units_.sign / (units_.pace * units_.states[i]))).form());
    }
    program.graph = exact_.take();
    const int size = static_cast<int>(program.outputs.size());
    return {size, std::move(program), exact_.values(), scene_.t0(), units_.sign / units_.pace, has_attitude_};
  }

 private:
  using Graph = formula::Graph;

  /// What a torque about one axis gives to each component of w', times a factor.
  void accelerate(int axis, const Expr& torque, const Interval& factor) {
    for (int i = 0; i < 3; ++i) {
      const Interval part = inverse_[to_index(i)][to_index(axis)] * factor;
      change_[to_index(i)] = change_[to_index(i)] + exact_.number(part) * torque;
    }
  }

  /// I^-1 (strength v x I v)
  void add_products(const Vec<Expr, 3>& v, const Interval& strength) {
    for (int axis = 0; axis < 3; ++axis)
      for (int j = 0; j < 3; ++j)
        for (int l = j; l < 3; ++l) {
          const Interval& sum = products_[to_index(axis)][to_index(j)][to_index(l)];
          if (!sum.is_zero()) accelerate(axis, v[to_index(j)] * v[to_index(l)], sum * strength);
        }
  }

  void add_rotor(const Rotor& rotor) {   // h x w
    const Vector h = enclose_momentum(rotor, scene_.omega());
    for_permutations([&](int i, int j, int k, double s) {
      accelerate(i, w_[to_index(k)], Interval(s) * h[to_index(j)] * part_ * per_pace_);
    });
  }

  /// From N m to the units of w', for a body of inertia 1 / part_.
  Interval torque_unit() const { return part_ * per_pace_ / Interval(units_.rate); }

  void add_torque(const std::vector<Expr>& tau_B) {
    for (int axis = 0; axis < 3; ++axis) accelerate(axis, tau_B[to_index(axis)], torque_unit());
  }

  void add(const AnyTorque& torque, std::size_t number) {
    const torques::Formula* formula = find_formula(torque);
    const Program law = formula != nullptr ? formula->given() : make_open_law(torque, scene_.inertia_B().matrix());
    const bool is_potential = law.outputs.size() == 1 && law.states.empty();
    if (is_potential) return add_torque(exact_.add_potential(law, body_));
    // The inertia that the body has without its free rotors is known up to the rounding of its making.
    const Rotor* driven = find_driven(law);
    std::vector<Interval> values;
    for (const formula::Input& input : law.parameters) {
      if (input.name == torques::inertia_input && &input == &law.parameters.back()) {
        for (std::size_t i = 0; i < 9; ++i) values.push_back(I_[i / 3][i % 3] / part_);
      } else if (driven != nullptr && input.name == "axis") {
        for (const Interval& component : enclose_axis(*driven)) values.push_back(component);
      } else {
        for (const double value : input.values) values.emplace_back(value);
      }
    }
    std::vector<Expr> states = body_;
    for (const formula::Input& state : law.states) {
      const formula::Place place = formula::find_place(scene_.states(), state.name);
      states.insert(states.end(), own_.begin() + place.first, own_.begin() + place.first + place.count);
    }
    std::vector<Expr> outputs = exact_.add(law, states, values);
    auto rate = outputs.begin() + 3;
    for (const formula::Input& state : law.states) {
      const formula::Place place = formula::find_place(scene_.states(), state.name);
      for (int i = 0; i < place.count; ++i) keep_rate(to_index(place.first + i), *rate++, number);
    }
    outputs.resize(3);
    add_torque(outputs);
  }

  void keep_rate(std::size_t state, const Expr& rate, std::size_t torque) {
    std::optional<Expr>& kept = own_rates_[state];
    if (kept && !(kept->form() == rate.form()))
      throw InvalidInput("torques[" + std::to_string(torque) + "].states",
                         "with the rates that the torques before it give", "another rate",
                         "name states of different torques differently");
    kept = rate;
  }

  /// The driven rotor that a law is of; null for another law.
  const Rotor* find_driven(const Program& law) const {
    for (const Rotor& rotor : scene_.rotors())
      if (!law.states.empty() && !rotor.state().empty() && law.states[0].name == rotor.state()) return &rotor;
    return nullptr;
  }

  const Scene& scene_;
  const Units units_;
  const bool has_attitude_;
  const Interval part_;
  const Matrix I_, inverse_;
  const Interval per_pace_;
  const std::array<Matrix, 3> products_;
  ExactGraph exact_;
  Vec<Expr, 3> w_, change_;
  Vec<Expr, 4> q_;
  std::vector<Expr> body_, own_;
  std::vector<std::optional<Expr>> own_rates_;
};

}  // namespace

bool needs_formula_system(const std::vector<AnyTorque>& torques) {
  return std::any_of(torques.begin(), torques.end(),
                     [](const AnyTorque& torque) { return find_formula(torque) != nullptr; });
}

FormulaSystem differentiate(const FormulaEquations& equations, const Program& smooth) {
  const auto n = to_index(equations.size), count = smooth.outputs.size() - n;
  std::vector<formula::Variable> variables;
  for (int state = 0; static_cast<int>(variables.size()) < equations.size; ++state) {
    const bool is_attitude = formula::first_attitude <= state && state < formula::first_extra;
    if (!is_attitude || equations.has_attitude) variables.push_back({formula::Variable::Kind::state, state});
  }
  if (count > 0) variables.push_back({formula::Variable::Kind::time, 0});
  FormulaSystem system{equations, formula::differentiate(smooth, variables), static_cast<int>(count), smooth};
  if (count == 0) return system;
  const std::vector<formula::Form> all = std::move(system.derivatives.outputs);
  system.surface = system.derivatives;
  std::vector<formula::Form>&of_step = system.derivatives.outputs, &of_surface = system.surface.outputs;
  of_step.clear(), of_surface.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n + count));
  for (std::size_t block = 0; block <= n + 1; ++block) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(block * (n + count));
    if (block <= n) of_step.insert(of_step.end(), first, first + static_cast<std::ptrdiff_t>(n));
    if (block > 0) of_surface.insert(of_surface.end(), first + static_cast<std::ptrdiff_t>(n),
                                     first + static_cast<std::ptrdiff_t>(n + count));
  }
  of_step.insert(of_step.end(), all.begin() + static_cast<std::ptrdiff_t>(n),
                 all.begin() + static_cast<std::ptrdiff_t>(n + count));
  system.surface = formula::rewrite(system.surface);
  return system;
}

FormulaEquations make_formula_equations(const Scene& scene, const std::vector<AnyTorque>& torques,
                                  const std::vector<bool>& rotating, const Units& units, bool has_attitude) {
  return Builder(scene, units, has_attitude).build(torques, rotating);
}

}  // namespace polhode::proof
