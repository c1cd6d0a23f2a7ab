#pragma once

#include <vector>

#include "method/series/body_series.hpp"
#include "polhode/formula/expression.hpp"
#include "polhode/formula/program.hpp"

namespace polhode {

/// The laws of torques seen from a body's principal axes P: forms of w_P, q_WP and the states of the torques.
class BodyLaws {
 public:
  /// @param states  of all torques; their numbers are states of the graph from first_extra on
  BodyLaws(formula::Graph& graph, const BodySeries& frame, const formula::Vec<formula::Expr, 3>& w_P,
           const formula::Vec<formula::Expr, 4>& q_WP, const std::vector<formula::Input>& states);

  /// The outputs of a law without parameters: its torque in body axes, then more.
  std::vector<formula::Form> add(const formula::Program& law);
  /// The accelerations I^-1 tau in P of a torque in body axes.
  formula::Vec<formula::Expr, 3> accelerate(const formula::Vec<formula::Expr, 3>& tau_B) const;
  /// The accelerations of all torques and rotors of a scene. The rates of all states go to `rates`.
  formula::Vec<formula::Expr, 3> accelerate(const Scene& scene, std::vector<formula::Form>& rates);

 private:
  formula::Graph& graph_;
  const BodySeries& frame_;
  formula::Vec<formula::Expr, 3> w_P_;
  const std::vector<formula::Input>& states_;
  std::vector<formula::Form> body_;   ///< w_B and q_WB
};

/// (I_j - I_k) / I_i of the principal axes.
Vector3d make_euler_products(const Vector3d& I);

}  // namespace polhode
