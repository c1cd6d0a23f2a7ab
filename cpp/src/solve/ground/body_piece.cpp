#include "solve/ground/body_piece.hpp"

#include <Eigen/LU>
#include <cstddef>
#include <optional>
#include <utility>

#include "polhode/formula/expression.hpp"
#include "polhode/torque/torques.hpp"

namespace polhode {
namespace {

using formula::Expr;
using formula::Form;
using formula::Graph;
using formula::Mat;
using formula::Program;
using formula::Vec;
using Polynomial = Changing::Piece;

/// A tensor that changes, and the factor J0 J^-1, in a graph.
class TensorOfTime {
 public:
  TensorOfTime(Graph& graph, const Polynomial& piece, const Matrix3d& reduction, const Matrix3d& reference)
      : reference_(reference) {
    const Expr since = Expr(graph, graph.time()) - Expr(piece.begin);
    Expr power(1.0);
    for (std::size_t k = 0; k < piece.terms.size(); ++k) {
      const Matrix3d term = Changing::make_tensor(piece.terms[k]);
      for (std::size_t i = 0; i < 9; ++i) {
        const auto row = static_cast<int>(i / 3), column = static_cast<int>(i % 3);
        given_.entries[i] = given_.entries[i] + Expr(term(row, column)) * power;
        if (k == 0) continue;
        rate_.entries[i] = rate_.entries[i] + Expr(static_cast<double>(k) * term(row, column)) * last_;
      }
      last_ = power, power = power * since;
    }
    for (std::size_t i = 0; i < 9; ++i)
      moving_.entries[i] = given_.entries[i] - Expr(reduction(static_cast<int>(i / 3), static_cast<int>(i % 3)));
  }

  const Mat<Expr>& given() const { return given_; }     ///< rotors included
  const Mat<Expr>& moving() const { return moving_; }   ///< J, without free rotors and damper
  const Mat<Expr>& rate() const { return rate_; }       ///< J'

  /// J0 J^-1 v
  Vec<Expr, 3> scale(const Vec<Expr, 3>& v) const {
    const Mat<Expr>& J = moving_;
    const auto is_zero = [&](std::size_t i, std::size_t j) { return J(i, j).form().is_zero(); };
    Vec<Expr, 3> solved;
    if (is_zero(0, 1) && is_zero(0, 2) && is_zero(1, 2)) {
      for (std::size_t i = 0; i < 3; ++i) solved[i] = v[i] / J(i, i);
    } else {
      const auto cofactor = [&](std::size_t i, std::size_t j) {
        const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
        return J(a, c) * J(b, d) - J(a, d) * J(b, c);
      };
      Mat<Expr> adjugate;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j <= i; ++j)
          adjugate.entries[3 * i + j] = adjugate.entries[3 * j + i] = cofactor(i, j);
      const Expr det = J(0, 0) * adjugate(0, 0) + J(0, 1) * adjugate(0, 1) + J(0, 2) * adjugate(0, 2);
      solved = adjugate * v;
      for (std::size_t i = 0; i < 3; ++i) solved[i] = solved[i] / det;
    }
    return formula::apply_matrix(reference_, solved);
  }

 private:
  Mat<Expr> given_, moving_, rate_;
  Expr last_;
  Matrix3d reference_;
};

/// h and h' in a graph.
struct MomentumOfTime {
  Vec<Expr, 3> value, rate;

  MomentumOfTime(Graph& graph, const std::optional<Polynomial>& piece, const Vector3d& constant)
      : value(formula::make_vector<Expr>(constant)) {
    if (!piece) return;
    const Expr since = Expr(graph, graph.time()) - Expr(piece->is_constant() ? 0.0 : piece->begin);
    Expr power(1.0), last;
    for (std::size_t k = 0; k < piece->terms.size(); ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        value[i] = value[i] + Expr(piece->terms[k][i]) * power;
        if (k > 0) rate[i] = rate[i] + Expr(static_cast<double>(k) * piece->terms[k][i]) * last;
      }
      last = power, power = power * since;
    }
  }
};

Vec<Expr, 3> list_rates(Graph& graph) { return formula::list_states<3>(graph, formula::first_rate); }

AnyTorque make_formula(Program program, const Vec<Expr, 3>& torque) {
  program.outputs.clear();
  for (const Expr& component : torque.components) program.outputs.push_back(component.form());
  return torques::Formula(formula::rewrite(program), false);
}

AnyTorque make_momentum_torque(const BodyPiece& body) {
  Program program;
  const MomentumOfTime h(program.graph, body.momentum, Vector3d::Zero());
  const Vec<Expr, 3> torque = cross(h.value, list_rates(program.graph)) - h.rate;
  return make_formula(std::move(program), torque);
}

/// What the change of the body adds to Euler's equations of a body with the inertia J0.
AnyTorque make_change_torque(const BodyPiece& body, const Matrix3d& reduction, const Matrix3d& reference,
                             const Vector3d& rotors, bool leaving) {
  Program program;
  Graph& graph = program.graph;
  const TensorOfTime J(graph, *body.inertia, reduction, reference);
  const MomentumOfTime h(graph, body.momentum, rotors);
  const Vec<Expr, 3> w = list_rates(graph);
  Vec<Expr, 3> moment = cross(J.moving() * w + h.value, w) - h.rate;
  if (!leaving) moment = moment - J.rate() * w;
  const Vec<Expr, 3> torque = J.scale(moment) - cross(formula::apply_matrix(reference, w), w);
  return make_formula(std::move(program), torque);
}

/// J0 J^-1 tau of a torque whose law may have the inertia, which is then that of the time.
AnyTorque scale_torque(const AnyTorque& torque, const BodyPiece& body, const Matrix3d& reduction,
                       const Matrix3d& reference) {
  if (const auto* custom = std::get_if<torques::Custom>(&torque)) {
    const auto call = [own = *custom, piece = *body.inertia, reduction, reference](
                          double t, const double* omega, const double* attitude, double* tau) {
      const Matrix3d given = Changing::compute_tensor(piece, t);
      Vector3d sum = Vector3d::Zero();
      own.add({t, omega, attitude, given}, sum.data());
      const Vector3d scaled = reference * (given - reduction).inverse().eval() * sum;
      for (int i = 0; i < 3; ++i) tau[i] = scaled[i];
    };
    const TorqueTraits traits = custom->traits();
    return torques::Custom::from(call, {.uses_time = true, .uses_attitude = traits.uses_attitude,
                                        .uses_rates = traits.uses_rates});
  }
  const Program law = make_open_law(torque, reference);
  Program made;
  Graph& graph = made.graph;
  const TensorOfTime J(graph, *body.inertia, reduction, reference);
  std::size_t own = formula::list_values(law.parameters).size();
  made.parameters = law.parameters, made.states = law.states;
  if (!made.parameters.empty() && made.parameters.back().name == torques::inertia_input)
    made.parameters.pop_back(), own -= 9;
  formula::Rewriter rewriter(law.graph, graph, [&](int node, Graph&) -> std::optional<Form> {
    const formula::Node& n = law.graph[node];
    if (n.op != formula::Op::parameter || static_cast<std::size_t>(n.index) < own) return std::nullopt;
    return J.given().entries[static_cast<std::size_t>(n.index) - own].form();
  });
  std::vector<Form> outputs;
  for (const Form& output : law.outputs) outputs.push_back(rewriter(output));
  Vec<Expr, 3> tau;
  for (std::size_t i = 0; i < 3; ++i) tau[i] = Expr(graph, outputs[i]);
  tau = J.scale(tau);
  for (std::size_t i = 0; i < 3; ++i) outputs[i] = tau[i].form();
  made.outputs = std::move(outputs);
  return torques::Formula(formula::rewrite(made), false);
}

/// Rotors about the body axes that are held, with the momentum h exactly.
void add_held(const Vector3d& h, std::vector<Rotor>& rotors) {
  for (int i = 0; i < 3; ++i)
    if (h[i] != 0.0) rotors.emplace_back(RotorParts{.axis = Vector3d::Unit(i), .momentum = h[i]});
}

}  // namespace

ConstantBody make_constant(const Scene& scene, const BodyPiece& body, double reference,
                           std::vector<AnyTorque> torques, std::vector<Rotor> rotors) {
  const bool physical = scene.given_inertia_B().physical();
  if (!body.inertia || body.inertia->is_constant()) {
    const Matrix3d J = body.inertia ? Changing::make_tensor(body.inertia->terms.front())
                                    : scene.given_inertia_B().matrix();
    if (body.momentum && !body.momentum->is_constant()) torques.push_back(make_momentum_torque(body));
    else if (body.momentum) add_held(Changing::compute_vector(*body.momentum, reference), rotors);
    return {InertiaTensor::from_trusted(J, physical), std::move(torques), std::move(rotors)};
  }
  const Matrix3d& reduction = scene.inertia_reduction();
  const Matrix3d J0 = Changing::compute_tensor(*body.inertia, reference) - reduction;
  for (AnyTorque& torque : torques)
    if (!traits(torque).vanishes) torque = scale_torque(torque, body, reduction, J0);
  torques.push_back(make_change_torque(body, reduction, J0, sum_momenta(rotors, scene.omega()), scene.leaving()));
  return {InertiaTensor::from_trusted(J0, false), std::move(torques), {}, false};
}

}  // namespace polhode
