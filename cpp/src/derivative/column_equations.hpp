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
    };
    std::vector<Force> forces;
  };
  std::vector<Guard> guards;

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
