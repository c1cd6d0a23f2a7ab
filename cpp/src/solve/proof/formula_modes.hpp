#pragma once

#include <map>
#include <memory>
#include <vector>

#include "polhode/formula/sides.hpp"
#include "solve/proof/formula_step.hpp"
#include "solve/proof/formula_system.hpp"

namespace polhode::proof {

/// Equations with switches: a step for each mode that occurs. In a mode each switch is replaced by its branch, which is
/// continued beyond the surface where its guard is 0. So all series stay those of analytic equations.
class FormulaModes {
 public:
  using Sides = std::vector<formula::Side>;   ///< of all guards; those that a mode does not need may have any

  struct Mode {
    std::vector<int> guards;      ///< their numbers, in the order of the step's
    FormulaStep step;
    formula::Program surface;     ///< see FormulaSystem; f alone where there is no guard
  };
  /// What a mode gives over a set of times and variables.
  struct Values {
    std::vector<Interval> rates;                  ///< f
    std::vector<Interval> guards;
    std::vector<std::vector<Interval>> slopes;    ///< of each guard by the variables
    std::vector<Interval> speeds;                 ///< of each guard along the motion
  };

  FormulaModes(FormulaEquations equations, const StepSettings& settings);

  std::size_t count_guards() const { return guards_.forms.size(); }
  Mode& find(const Sides& sides);
  /// @param time  since the start, in the units of the equations
  Values evaluate(const Mode& mode, const Interval& time, const std::vector<Interval>& variables) const;

  /// The sides at a point; a guard that may be 0 there gets that of the middle.
  Sides find_sides(const Interval& time, const std::vector<Interval>& variables);
  /// Sets the sides of a mode's guards that have a sign over a set. The guards `open` keep theirs.
  /// @return the numbers of other guards that have none
  std::vector<int> settle(Sides& sides, const std::vector<int>& open, const Interval& time,
                          const std::vector<Interval>& variables);

  /// Whether all that depends on a guard's side is continuous at its surface: both branches differ by a multiple of it.
  bool is_kink(int guard) const { return kinks_[to_index(guard)]; }
  /// Whether the value of one guard depends on the side of the other.
  bool depends(int guard, int other) const { return needs_[to_index(guard)][to_index(other)]; }

 private:
  void find_kinks();
  void find_needs();

  FormulaEquations equations_;
  StepSettings settings_;
  formula::Guards guards_;
  std::vector<bool> kinks_;
  std::vector<std::vector<bool>> needs_;
  std::map<Sides, std::unique_ptr<Mode>> modes_;
};

}  // namespace polhode::proof
