#include "derivative/column_equations.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "derivative/column_lanes.hpp"
#include "derivative/held_friction.hpp"
#include "method/series/body_laws.hpp"
#include "method/series/formula_series.hpp"
#include "method/series/recent_equations.hpp"
#include "polhode/core/error.hpp"
#include "polhode/formula/derivative.hpp"
#include "polhode/formula/expression.hpp"
#include "polhode/formula/modes.hpp"

namespace polhode {
namespace {

using formula::Expr;
using formula::Form;
using formula::Graph;
using formula::Program;
using formula::Variable;
using formula::Vec;

constexpr std::size_t place(int i) { return static_cast<std::size_t>(i); }

Vec<Expr, 3> take(Graph& graph, const std::vector<Form>& forms, std::size_t first) {
  return {{Expr(graph, forms[first]), Expr(graph, forms[first + 1]), Expr(graph, forms[first + 2])}};
}

/// The number of a law's parameter.
int find_number(const Program& law, const ColumnCause& cause, const LastingTorque& torque) {
  auto field = place(cause.field);
  if (!std::holds_alternative<torques::Formula>(torque)) {   // as its record counts
    const std::string_view name =
        std::visit([](const auto& one) -> const TorqueRecord& { return one.record(); }, torque).parameters[field].name;
    field = static_cast<std::size_t>(std::find_if(law.parameters.begin(), law.parameters.end(), [&](const auto& one) {
              return one.name == name;
            }) - law.parameters.begin());
  }
  int number = cause.component;
  for (std::size_t i = 0; i < field; ++i) number += static_cast<int>(law.parameters[i].values.size());
  return number;
}

/// J d' = dN - d x (J w + h) - w x J d - w x (dJ w) - w x dh - dJ w', theta' = d - w x theta, and of states
/// dx' = d(rate), all in principal axes.
class EquationsBuilder {
 public:
  EquationsBuilder(const Scene& piece, const BodySeries& frame, const std::vector<formula::Input>& states)
      : piece_(piece), frame_(frame), states_(states), made_(make_body_system(piece, frame, states)),
        rows_(made_.outputs.size()), numbers_(static_cast<int>(formula::list_values(states).size())),
        guards_(formula::list_sided_guards(made_)), count_(guards_.forms.size()) {
    Graph& graph = made_.graph;
    const Vec<Expr, 3> r = formula::list_states<3>(graph, formula::first_rate);
    w_ = made_.rates.empty() ? r : take(graph, made_.rates, 0);
    q_ = formula::list_states<4>(graph, formula::first_attitude);
  }

  ColumnEquations build(const std::vector<ColumnCause>& causes, const std::vector<formula::Side>& sides) {
    ColumnEquations found{frame_.terms().variables, nullptr, {}, {}, {}, {}, {}, {}};
    differentiate_body(sides);
    add_terms(found);
    add_guards(causes, found);
    add_held(found);
    for (std::size_t begin = 0; begin < causes.size(); begin += 8) {
      std::vector<std::vector<Form>> forces;
      for (std::size_t c = begin; c < std::min(begin + 8, causes.size()); ++c) forces.push_back(find_forces(causes[c]));
      add_forces(forces, found);
    }
    if (count_ > 0) {
      if (formula::list_sided_guards(made_).forms != guards_.forms) refuse("switches that cannot be told apart");
      made_ = formula::make_mode(made_, sides, made_.outputs.size() - rows_).program;
    } else {
      made_ = formula::rewrite(made_);
    }
    found.table = std::make_shared<const formula::Table>(formula::Tape(made_, static_cast<int>(rows_)));
    return found;
  }

 private:
  [[noreturn]] static void refuse(const char* what) {
    throw InvalidInput("sensitivity", "left out for a formula that cannot be differentiated", what);
  }

  /// The accelerations and the rates of states, and their derivatives by w, small rotations and states.
  void differentiate_body(const std::vector<formula::Side>& sides) {
    Program plain;
    const Vec<Expr, 3> w = formula::list_states<3>(plain.graph, formula::first_rate);
    const Vec<Expr, 4> q = formula::list_states<4>(plain.graph, formula::first_attitude);
    std::vector<Form> rates;
    const Vec<Expr, 3> a = BodyLaws(plain.graph, frame_, w, q, states_).accelerate(piece_, rates);
    const Vector3d products = make_euler_products(frame_.moments());
    for (int i = 0; i < 3; ++i)
      plain.outputs.push_back((a[place(i)] + w[place((i + 1) % 3)] * w[place((i + 2) % 3)] * products[i]).form());
    plain.outputs.insert(plain.outputs.end(), rates.begin(), rates.end());
    for (const int node : formula::list_sided_guards(plain).nodes) plain.outputs.push_back(Form::of(node));
    if (plain.outputs.size() != 3 + place(numbers_) + count_) refuse("switches that cannot be told apart");
    std::vector<Form> body;
    for (const Expr& one : w_.components) body.push_back(one.form());
    for (const Expr& one : q_.components) body.push_back(one.form());
    for (int i = 0; i < numbers_; ++i) body.push_back(made_.graph.state(formula::first_extra + i));
    const HeldShares shares = replace_held(plain, made_.graph, guards_, body, sides);
    held_ = shares.guards;
    std::vector<Variable> variables;
    for (int i = 0; i < 3; ++i) variables.push_back({Variable::Kind::state, formula::first_rate + i});
    for (int i = 0; i < 3; ++i) variables.push_back({Variable::Kind::rotation, i});
    for (int i = 0; i < numbers_ + static_cast<int>(held_.size()); ++i)
      variables.push_back({Variable::Kind::state, formula::first_extra + i});
    if (!held_.empty()) variables.push_back({Variable::Kind::time, 0});
    const Program slopes = formula::differentiate(formula::rewrite(plain), variables);
    body.insert(body.end(), shares.forms.begin(), shares.forms.end());
    slopes_ = formula::embed(slopes, made_.graph, body, nullptr);
    if (!held_.empty()) eliminate(slopes, variables, body);
  }

  /// Makes the slopes those of the friction that holds.
  /// @param slopes  of the body with shares as states, by `variables`
  void eliminate(const Program& slopes, std::vector<Variable> variables, const std::vector<Form>& body) {
    const std::size_t size = place(6 + numbers_), rates = place(3 + numbers_), rows = rates + count_;
    const auto slope = [&](const std::vector<Form>& of, std::size_t row, std::size_t by) { return of[rows * (1 + by) + row]; };
    std::vector<std::size_t> guards(held_.size());   // the row of each
    for (std::size_t g = 0; g < count_; ++g)
      for (std::size_t k = 0; k < held_.size(); ++k)
        if (find_guard(slopes_[rates + g]).number == held_[k]) guards[k] = rates + g;
    Program change = change_held(slopes, guards, variables);
    variables.resize(size);
    const std::vector<Form> changes =
        formula::embed(formula::differentiate(formula::rewrite(change), variables), made_.graph, body, nullptr);
    std::vector<HeldFriction::Share> shares(held_.size());
    for (std::size_t k = 0; k < held_.size(); ++k) {
      for (std::size_t i = 0; i < rates; ++i) {
        shares[k].effect.push_back(slope(slopes_, i, size + k));
        shares[k].slope.push_back(slope(slopes_, guards[k], i < 3 ? i : i + 3));
      }
      for (std::size_t from = 0; from < size; ++from) shares[k].change.push_back(changes[held_.size() * (1 + from) + k]);
    }
    friction_.emplace(made_.graph, std::move(shares));
    std::vector<std::vector<Form>> own(rates, std::vector<Form>(size));
    for (std::size_t i = 0; i < rates; ++i)
      for (std::size_t from = 0; from < size; ++from) own[i][from] = slope(slopes_, i, from);
    friction_->add(own);
    for (std::size_t i = 0; i < rates; ++i)
      for (std::size_t from = 0; from < size; ++from) slopes_[rows * (1 + from) + i] = own[i][from];
  }

  void add_held(ColumnEquations& found) {
    for (std::size_t k = 0; k < held_.size(); ++k) {
      ColumnEquations::Held& held = found.held.emplace_back(ColumnEquations::Held{held_[k], {}});
      const std::vector<Form> response = friction_->find_response(k);
      for (std::size_t i = 0; i < response.size(); ++i)
        add_term(static_cast<int>(i < 3 ? i : i + 3), response[i], held.response);
    }
  }

  void add_terms(ColumnEquations& found) {
    const int size = 6 + numbers_;
    for (int i = 0; i < size; ++i) {
      found.first_term.push_back(static_cast<int>(found.terms.size()));
      if (i >= 3 && i < 6) {   // theta' = d - w x theta
        const int j = (i - 3 + 1) % 3, k = (i - 3 + 2) % 3;
        add_term(i - 3, Form(1.0), found.terms);
        add_term(3 + k, (-w_[place(j)]).form(), found.terms);
        add_term(3 + j, w_[place(k)].form(), found.terms);
        continue;
      }
      const int row = i < 3 ? i : i - 3;
      for (int from = 0; from < size; ++from) add_term(from, find_slope(row, from), found.terms);
    }
    found.first_term.push_back(static_cast<int>(found.terms.size()));
  }

  /// The derivative of an acceleration, a state's rate or a guard by a number of a column.
  const Form& find_slope(int row, int by) const {
    return slopes_[place((3 + numbers_ + static_cast<int>(count_)) * (1 + by) + row)];
  }

  void add_guards(const std::vector<ColumnCause>& causes, ColumnEquations& found) {
    found.guards.resize(count_);
    std::vector<double> parts(count_);
    for (std::size_t k = 0; k < count_; ++k) {
      const int row = 3 + numbers_ + static_cast<int>(k);
      const Known known = find_guard(slopes_[place(row)]);
      parts[known.number] = known.part;
      ColumnEquations::Guard& guard = found.guards[known.number];
      guard.series = find_series(slopes_[place(row)]);
      for (int from = 0; from < 6 + numbers_; ++from) add_term(from, find_slope(row, from), guard.terms);
    }
    for (std::size_t c = 0; c < causes.size() && count_ > 0; ++c) {
      if (!causes[c].torque) continue;
      Program law = make_law(to_any(*causes[c].torque), piece_.inertia_B().matrix());
      const formula::Guards own = formula::list_sided_guards(law);
      const std::size_t outputs = law.outputs.size(), count = own.nodes.size();
      for (const int node : own.nodes) law.outputs.push_back(Form::of(node));
      const std::vector<Form> slopes = differentiate_law(law, causes[c]);
      for (std::size_t i = 0; i < count; ++i) {
        std::vector<LinearTerm> term;
        add_term(static_cast<int>(c), slopes[2 * outputs + count + i], term);
        if (term.empty()) continue;
        const Form& guard = slopes[outputs + i];
        const Known known = find_guard(guard);
        if (guards_.holds[known.number] && term[0].series >= 0)
          refuse("a parameter that the rate of a friction does not have as a summand");
        found.guards[known.number].forces.push_back({term[0], find_series(guard), known.part / parts[known.number]});
      }
    }
  }

  /// The number of a guard, and its factor to that of the list. Guards are known up to a factor.
  struct Known {
    std::size_t number;
    double part;
  };
  Known find_guard(const Form& given) const {
    const Graph& graph = made_.graph;
    const auto expand = [&](const Form& form) {
      const bool is_node = form.terms.size() == 1 && form.constant == 0.0;
      const int node = is_node ? form.terms[0].node : 0;
      return is_node && graph[node].op == formula::Op::linear ? graph.linear(node) : form;
    };
    const Form form = expand(given);
    for (std::size_t g = 0; g < count_; ++g) {
      const Form other = expand(Form::of(guards_.nodes[g]));
      if (form.terms.size() != other.terms.size()) continue;
      const double part = other.terms[0].factor / form.terms[0].factor;
      const auto is_near = [&](double a, double b) { return std::abs(a * part - b) <= 1e-12 * std::abs(b); };
      bool same = is_near(form.constant, other.constant);
      for (std::size_t i = 0; i < form.terms.size(); ++i)
        same = same && form.terms[i].node == other.terms[i].node &&
               is_near(form.terms[i].factor, other.terms[i].factor);
      if (same) return {g, part};
    }
    refuse("switches that cannot be told apart");
  }

  /// The outputs of a law, and their derivatives by the number of a torque that a column changes.
  std::vector<Form> differentiate_law(const Program& law, const ColumnCause& cause) {
    const Variable by{Variable::Kind::parameter, find_number(law, cause, *cause.torque)};
    return BodyLaws(made_.graph, frame_, w_, q_, states_)
        .add(formula::bind_parameters(formula::differentiate(law, {by}), formula::list_values(law.parameters)));
  }

  void add_term(int from, const Form& form, std::vector<LinearTerm>& terms) {
    if (form.is_zero()) return;
    terms.push_back(form.is_constant() ? LinearTerm{from, -1, form.constant}
                                             : LinearTerm{from, find_series(form), 0.0});
  }

  /// Where a form stands among the extras.
  std::ptrdiff_t find_series(const Form& form) {
    const auto begin = made_.outputs.begin() + static_cast<std::ptrdiff_t>(rows_);
    const auto same = std::find(begin, made_.outputs.end(), form);
    const std::ptrdiff_t series = same - begin;
    if (same == made_.outputs.end()) made_.outputs.push_back(form);
    return series;
  }

  Vec<Expr, 3> divide(const Vec<Expr, 3>& L) const {
    const Vector3d& I = frame_.moments();
    return {{L[0] / I[0], L[1] / I[1], L[2] / I[2]}};
  }

  /// What forces each number of a column.
  std::vector<Form> find_forces(const ColumnCause& cause) {
    Graph& graph = made_.graph;
    BodyLaws laws(graph, frame_, w_, q_, states_);
    const Matrix3d& R = frame_.axes();
    std::vector<Form> forces(place(6 + numbers_));
    Vec<Expr, 3> rate;
    if (!cause.inertia.isZero(0.0)) {
      const Matrix3d dJ = frame_.is_rotated() ? Matrix3d(R.transpose() * cause.inertia * R) : cause.inertia;
      const Vec<Expr, 3> w_dot = take(graph, slopes_, 0);
      rate = rate - divide(cross(w_, formula::apply_matrix(dJ, w_)) + formula::apply_matrix(dJ, w_dot));
      for (const AnyTorque& torque : piece_.torques()) {
        if (!uses_inertia(torque)) continue;
        const Program slope = make_inertia_slope(torque, piece_.inertia_B().matrix(), cause.inertia);
        const std::vector<Form> outputs = laws.add(slope);
        rate = rate + laws.accelerate(take(graph, outputs, 0));
        std::size_t next = 3;
        for (const formula::Input& state : slope.states) {
          const formula::Place own = formula::find_place(states_, state.name);
          for (int i = 0; i < own.count; ++i) {
            Form& force = forces[place(6 + own.first + i)];
            force = force + outputs[next++];
          }
        }
      }
    }
    if (!cause.rotor_momentum.isZero(0.0)) {
      const Vector3d dh = frame_.is_rotated() ? Vector3d(R.transpose() * cause.rotor_momentum) : cause.rotor_momentum;
      rate = rate + divide(cross(formula::make_vector<Expr>(dh), w_));
    }
    if (cause.torque) {
      const Program law = make_law(to_any(*cause.torque), piece_.inertia_B().matrix());
      const std::vector<Form> outputs = differentiate_law(law, cause);
      std::size_t next = law.outputs.size();
      rate = rate + laws.accelerate(take(graph, outputs, next));
      next += 3;
      for (const formula::Input& state : law.states) {
        const formula::Place own = formula::find_place(states_, state.name);
        for (int i = 0; i < own.count; ++i, ++next)
          forces[place(6 + own.first + i)] = forces[place(6 + own.first + i)] + outputs[next];
      }
    }
    for (std::size_t i = 0; i < 3; ++i) forces[i] = rate[i].form();
    if (!friction_) return forces;
    const auto rotation = forces.begin() + 3;   // nothing forces it
    std::vector<Form> rates(forces.begin(), rotation);
    rates.insert(rates.end(), rotation + 3, forces.end());
    friction_->project(rates);
    std::copy_n(rates.begin(), 3, forces.begin());
    std::copy(rates.begin() + 3, rates.end(), rotation + 3);
    return forces;
  }

  /// @param columns  up to eight, number by number
  void add_forces(const std::vector<std::vector<Form>>& columns, ColumnEquations& found) {
    std::vector<LinearForce> forces;
    std::vector<int> first;
    for (std::size_t i = 0; i < place(6 + numbers_); ++i) {
      const auto begin = static_cast<std::ptrdiff_t>(forces.size());
      first.push_back(static_cast<int>(begin));
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const Form& form = columns[c][i];
        if (form.is_zero()) continue;
        const std::ptrdiff_t series = form.is_constant() ? -1 : find_series(form);
        auto own = std::find_if(forces.begin() + begin, forces.end(),
                                [&](const LinearForce& force) { return force.series == series; });
        if (own == forces.end()) own = forces.insert(own, LinearForce{{}, series});
        own->parts[c] = form.is_constant() ? form.constant : 1.0;
      }
    }
    first.push_back(static_cast<int>(forces.size()));
    found.forces.push_back(std::move(forces)), found.first_force.push_back(std::move(first));
  }

  const Scene& piece_;
  const BodySeries& frame_;
  const std::vector<formula::Input>& states_;
  Program made_;
  std::size_t rows_;
  int numbers_;   ///< of states
  formula::Guards guards_;
  std::size_t count_;   ///< of guards
  Vec<Expr, 3> w_;
  Vec<Expr, 4> q_;
  std::vector<Form> slopes_;
  std::vector<std::size_t> held_;   ///< guards of friction that holds
  std::optional<HeldFriction> friction_;
};

}  // namespace

void ColumnEquations::expand(const ColumnKernels& kernels, const double* extras, int order, double unit,
                             ColumnLanes& columns) const {
  columns.begin(order);
  for (std::size_t g = 0; g < columns.groups(); ++g) {
    kernels.expand_linear({static_cast<int>(columns.size()), terms.data(), first_term.data(), forces[g].data(),
                           first_force[g].data(), extras, table->extra_width()},
                          order, unit, columns.rows(g));
  }
}

std::shared_ptr<const ColumnEquations> find_equations(const Scene& piece, const std::vector<ColumnCause>& causes,
                                                      const std::vector<formula::Side>& sides, ModeEquations& known) {
  const BodySeries frame(drop_torques(piece), true);
  std::shared_ptr<const ColumnEquations>& found = known[sides];
  if (found && found->variables == frame.terms().variables) return found;
  thread_local RecentEquations<ColumnEquations> recent;
  EquationsKey key(piece, frame);
  for (const ColumnCause& cause : causes) {
    key.add(cause.inertia.data(), 9), key.add(cause.rotor_momentum.data(), 3);
    key.add(cause.torque ? 1.0 : 0.0), key.add(cause.field), key.add(cause.component);
    if (cause.torque) key.add(*cause.torque);
  }
  for (const formula::Side side : sides) key.add(static_cast<double>(side));
  const auto make = [&] {
    return std::make_shared<const ColumnEquations>(
        EquationsBuilder(piece, frame, list_states(piece.torques())).build(causes, sides));
  };
  return found = recent.find(std::move(key), make, [](const ColumnEquations& made) { return is_small(*made.table); });
}

}  // namespace polhode
