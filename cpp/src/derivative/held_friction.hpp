#pragma once

#include <vector>

#include "polhode/formula/derivative.hpp"
#include "polhode/formula/program.hpp"
#include "polhode/formula/sides.hpp"

namespace polhode {

/// The guards of the friction that holds, and the shares of their loads as forms of a whole system.
struct HeldShares {
  std::vector<std::size_t> guards;
  std::vector<formula::Form> forms;
};

/// In the place of each friction that holds puts its share, a state behind all others.
/// @param plain   a body's rates; gets the shares
/// @param whole   the graph of the system, with its `guards`, and `body`, the states of `plain` as its forms
HeldShares replace_held(formula::Program& plain, formula::Graph& whole, const formula::Guards& guards,
                        const std::vector<formula::Form>& body, const std::vector<formula::Side>& sides);

/// d/dt of held rates.
/// @param slopes     the accelerations, rates of states and guards, differentiated by `variables`
/// @param guards     the rows of the held rates
/// @param variables  the rates, small rotations, states, shares, and time
formula::Program change_held(const formula::Program& slopes, const std::vector<std::size_t>& guards,
                             const std::vector<formula::Variable>& variables);

/// What friction that holds does to the derivatives of a motion.
///
/// With rates y' = F(y, p) + B s, the shares s of the loads keep the held rates g(y, t) constant: d(g') = 0. So a change
/// of the state or of a parameter makes ds = -A^-1 d(g') of the change d(g') at constant s, with A = (dg/dy) B, and
/// dy' = dF + B ds. One share after the other is eliminated.
class HeldFriction {
 public:
  struct Share {
    std::vector<formula::Form> effect;   ///< B: of the share on the rates, which are the accelerations, then those of states
    std::vector<formula::Form> slope;    ///< dg/dy, by the rates and the states
    std::vector<formula::Form> change;   ///< of g' at constant shares, by each number of a column
  };

  /// @param graph  of the forms, which must live as long
  HeldFriction(formula::Graph& graph, std::vector<Share> shares);

  /// Adds B ds to the derivative of the rates by the numbers of a column.
  /// @param slopes  of each rate, by each number of a column
  void add(std::vector<std::vector<formula::Form>>& slopes) const;
  /// Takes from a force on the rates what the shares take up.
  void project(std::vector<formula::Form>& force) const;

  std::size_t count() const { return shares_.size(); }
  /// B / (dg B): what a change of the held rate by -1 does to the rates of the state as the friction begins to hold.
  std::vector<formula::Form> find_response(std::size_t share) const;

 private:
  formula::Form dot(const std::vector<formula::Form>& a, const std::vector<formula::Form>& b) const;
  formula::Form multiply(const formula::Form& a, const formula::Form& b) const;
  formula::Form divide(const formula::Form& a, const formula::Form& b) const;

  formula::Graph& graph_;
  std::vector<Share> shares_;
  std::vector<formula::Form> pivots_;   ///< dg B of each share
};

}  // namespace polhode
