#include <algorithm>
#include <utility>

#include "derivative/formula_columns.hpp"
#include "method/series/body_laws.hpp"
#include "polhode/formula/derivative.hpp"
#include "polhode/formula/expression.hpp"

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

bool follows_inertia(const AnyTorque& torque) {
  return std::holds_alternative<torques::GravityGradient>(torque) ||
         std::holds_alternative<torques::AngularDamping>(torque);
}

/// J d' = dN - d x (J w + h) - w x J d - w x (dJ w) - w x dh - dJ w', turn' = d - w x turn, and of states
/// dx' = d(rate), all in principal axes.
class EquationsBuilder {
 public:
  EquationsBuilder(const Scene& piece, const BodySeries& frame, const std::vector<formula::Input>& states)
      : piece_(piece), frame_(frame), states_(states), made_(make_body_system(piece, frame, states)),
        rows_(made_.outputs.size()), numbers_(static_cast<int>(formula::list_values(states).size())) {
    Graph& graph = made_.graph;
    const Vec<Expr, 3> r = formula::list_states<3>(graph, formula::first_rate);
    w_ = made_.rates.empty() ? r : take(graph, made_.rates, 0);
    q_ = formula::list_states<4>(graph, formula::first_attitude);
  }

  ColumnEquations build(const std::vector<ColumnCause>& causes) {
    ColumnEquations found{states_, frame_.terms().variables, nullptr, {}, {}, {}, {}};
    differentiate_body();
    add_terms(found);
    for (std::size_t begin = 0; begin < causes.size(); begin += 8) {
      std::vector<std::vector<Form>> forces;
      for (std::size_t c = begin; c < std::min(begin + 8, causes.size()); ++c) forces.push_back(find_forces(causes[c]));
      add_forces(forces, found);
    }
    Program system = formula::rewrite(made_);
    found.table = std::make_shared<const formula::Table>(formula::Tape(system, static_cast<int>(rows_)));
    return found;
  }

 private:
  /// The accelerations and the rates of states, and their derivatives by w, small rotations and states.
  void differentiate_body() {
    Program plain;
    const Vec<Expr, 3> w = formula::list_states<3>(plain.graph, formula::first_rate);
    const Vec<Expr, 4> q = formula::list_states<4>(plain.graph, formula::first_attitude);
    std::vector<Form> rates;
    const Vec<Expr, 3> a = BodyLaws(plain.graph, frame_, w, q, states_).accelerate(piece_, rates);
    const Vector3d products = make_euler_products(frame_.moments());
    for (int i = 0; i < 3; ++i)
      plain.outputs.push_back((a[place(i)] + w[place((i + 1) % 3)] * w[place((i + 2) % 3)] * products[i]).form());
    plain.outputs.insert(plain.outputs.end(), rates.begin(), rates.end());
    std::vector<Variable> variables;
    for (int i = 0; i < 3; ++i) variables.push_back({Variable::Kind::state, formula::first_rate + i});
    for (int i = 0; i < 3; ++i) variables.push_back({Variable::Kind::rotation, i});
    for (int i = 0; i < numbers_; ++i) variables.push_back({Variable::Kind::state, formula::first_extra + i});
    const Program slopes = formula::differentiate(formula::rewrite(plain), variables);
    std::vector<Form> body;
    for (const Expr& one : w_.components) body.push_back(one.form());
    for (const Expr& one : q_.components) body.push_back(one.form());
    for (int i = 0; i < numbers_; ++i) body.push_back(made_.graph.state(formula::first_extra + i));
    slopes_ = formula::embed(slopes, made_.graph, body, nullptr);
  }

  void add_terms(ColumnEquations& found) {
    const int size = 6 + numbers_, outputs = 3 + numbers_;
    const auto slope = [&](int row, int by) { return slopes_[place(outputs * (1 + by) + row)]; };
    for (int i = 0; i < size; ++i) {
      found.first_term.push_back(static_cast<int>(found.terms.size()));
      if (i >= 3 && i < 6) {   // turn' = d - w x turn
        const int j = (i - 3 + 1) % 3, k = (i - 3 + 2) % 3;
        add_term(i - 3, Form(1.0), found);
        add_term(3 + k, (-w_[place(j)]).form(), found);
        add_term(3 + j, w_[place(k)].form(), found);
        continue;
      }
      const int row = i < 3 ? i : i - 3;
      for (int from = 0; from < size; ++from) add_term(from, slope(row, from), found);
    }
    found.first_term.push_back(static_cast<int>(found.terms.size()));
  }

  void add_term(int from, const Form& form, ColumnEquations& found) {
    if (form.is_zero()) return;
    found.terms.push_back(form.is_constant() ? LinearTerm{from, -1, form.constant}
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
      rate = rate - divide(cross(w_, formula::apply_matrix(dJ, w_)) + formula::apply_matrix(dJ, take(graph, slopes_, 0)));
      for (const AnyTorque& torque : piece_.torques())
        if (follows_inertia(torque))
          rate = rate + laws.accelerate(take(graph, laws.add(make_bound_law(torque, cause.inertia)), 0));
    }
    if (!cause.rotor_momentum.isZero(0.0)) {
      const Vector3d dh = frame_.is_rotated() ? Vector3d(R.transpose() * cause.rotor_momentum) : cause.rotor_momentum;
      rate = rate + divide(cross(formula::make_vector<Expr>(dh), w_));
    }
    if (cause.torque) {
      const Program law = make_law(to_any(*cause.torque), piece_.inertia_B().matrix());
      const Variable by{Variable::Kind::parameter, find_number(law, cause, *cause.torque)};
      const Program slopes = formula::bind_parameters(formula::differentiate(law, {by}),
                                                      formula::list_values(law.parameters));
      const std::vector<Form> outputs = laws.add(slopes);
      std::size_t next = law.outputs.size();
      rate = rate + laws.accelerate(take(graph, outputs, next));
      next += 3;
      for (const formula::Input& state : law.states) {
        const formula::Place own = formula::find_place(states_, state.name);
        for (int i = 0; i < own.count; ++i) forces[place(6 + own.first + i)] = outputs[next++];
      }
    }
    for (std::size_t i = 0; i < 3; ++i) forces[i] = rate[i].form();
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
        auto own = std::find_if(forces.begin() + begin, forces.end(), [&](const auto& f) { return f.series == series; });
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
  Vec<Expr, 3> w_;
  Vec<Expr, 4> q_;
  std::vector<Form> slopes_;
};

}  // namespace

std::shared_ptr<const ColumnEquations> make_column_equations(const Scene& piece,
                                                             const std::vector<ColumnCause>& causes) {
  const BodySeries frame(drop_torques(piece), true);
  return std::make_shared<const ColumnEquations>(
      EquationsBuilder(piece, frame, list_states(piece.torques())).build(causes));
}

}  // namespace polhode
