#pragma once

#include <memory>
#include <vector>

#include "derivative/column_terms.hpp"
#include "derivative/mode_equations.hpp"
#include "polhode/ode/problem.hpp"
#include "polhode/ode/stepper.hpp"

namespace polhode {

/// A body's motion through one piece, step by step, with the columns of its variational equations.
class ColumnMotion {
 public:
  virtual ~ColumnMotion() = default;

  virtual double t() const = 0;
  virtual ode::StepResult advance(double t_end) = 0;
  /// w_B (n, 3), q_WB (n, 4) and the columns (n, numbers, columns) in body axes, at times within the last step.
  virtual void sample(const double* times, std::size_t n, double* omega, double* attitude, double* columns) = 0;
  /// The same at the end of the last step.
  virtual void end(State& state, std::vector<double>& columns) const = 0;
  /// Changes omega by a jump, and writes the numbers of states and the columns, between two steps.
  virtual void change(const Vector3d& jump, const std::vector<double>& states, const std::vector<double>& columns) = 0;
};

/// @param columns    at the start, (numbers of a column, columns)
/// @param equations  of formulas: those of the last run through the same piece; left for the next run
std::unique_ptr<ColumnMotion> make_column_motion(const Scene& piece, const std::vector<ColumnCause>& causes,
                                                 const std::vector<double>& columns, double t_end,
                                                 const ode::Tolerances& tolerances,
                                                 ModeEquations& equations);

}  // namespace polhode
