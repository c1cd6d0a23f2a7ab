#pragma once

#include <memory>
#include <vector>

#include "derivative/column_rows.hpp"
#include "derivative/column_terms.hpp"
#include "derivative/mode_equations.hpp"
#include "method/series/series_terms.hpp"
#include "polhode/formula/sides.hpp"
#include "polhode/formula/table.hpp"

namespace polhode {

class ColumnLanes;

/// The variational equations of a body under formulas, differentiated by symbols: a table of the state, whose extras
/// are the series that multiply columns and force them. It depends on the torques, not on the start.
struct ColumnEquations {
  RateVariables variables;                      ///< of the body's rates
  std::shared_ptr<const formula::Table> table;
  std::vector<LinearTerm> terms;
  std::vector<int> first_term;
  std::vector<std::vector<LinearForce>> forces;   ///< of each eight columns
  std::vector<std::vector<int>> first_force;

  /// The derivative of a switch's guard by the numbers of a column, and by what a column changes. Each comes with the
  /// guard as a series, because guards are known up to a factor.
  struct Guard {
    std::vector<LinearTerm> terms;
    std::ptrdiff_t series = 0;
    struct Force {
      LinearTerm term;        ///< `from` is the column
      std::ptrdiff_t series;
      double part;            ///< of the guard above in this one
    };
    std::vector<Force> forces;
  };
  std::vector<Guard> guards;

  /// Friction that holds in this mode: its guard, and how a column changes for each unit of the guard's change that it
  /// has as the friction begins to hold. One after the other.
  struct Held {
    std::size_t guard;
    std::vector<LinearTerm> response;   ///< `from` is the number of a column that changes
  };
  std::vector<Held> held;

  /// Fills rows 1 to `order` of the columns.
  /// @param extras  rows of the table's extras
  void expand(const ColumnKernels& kernels, const double* extras, int order, double unit, ColumnLanes& columns) const;
};

/// @param piece  a scene whose torques and rotors have no windows
/// @param sides  of the switches of its formulas
/// @param known  where they are kept
std::shared_ptr<const ColumnEquations> find_equations(const Scene& piece, const std::vector<ColumnCause>& causes,
                                                      const std::vector<formula::Side>& sides, ModeEquations& known);

}  // namespace polhode
