#pragma once

#include <string>
#include <vector>

#include "polhode/core/quat.hpp"

// How a free body passes changes on: norms of its columns over pairs of times.
namespace polhode::effect {

/// A free body in principal axes. Its state is y = J^1/2 w, of the constant length Y, with y' = B(y, y) and
/// |B(d, d)| <= c |d|^2.
struct FreeBody {
  FreeBody(const Vector3d& moments, const Vector3d& omega);

  /// The period of omega at x = L^2 / 2T and |y|; infinite on the separatrix. It rises with the distance of x from its
  /// end of the range, and falls with |y|.
  double find_period(double x, double length) const;
  /// The largest change of the period within a distance rho of the motion [s]; infinite where the separatrix is near.
  double bound_period_change(double rho) const;

  Vector3d J, w;                 ///< moments ascending, rates at the start
  double least, greatest;        ///< moments
  double Y, L, x;                ///< |y|, |J w|, L^2 / 2T
  double c;                      ///< (Jmax - Jmin) / (2 sqrt(J1 J2 J3))
  double period;                 ///< of omega [s]; of small changes of a steady rotation
  double most_rate;              ///< bound on |w| at any time
  double growth;                 ///< c Y, of changes of y: a bound on the logarithmic norm [1/s]
  double momentum_growth;        ///< the same of J w
  double rate_growth;            ///< the same of w
};

/// What a change becomes: of which quantity at s, in which quantity at t.
enum Passage {
  rate_of_momentum,      ///< w of J w: |J^-1/2 S J^-1/2|
  state_of_momentum,     ///< y of J w: |S J^-1/2|
  rotation_of_momentum,  ///< the small rotation in space of J w: |Psi|
  rate_of_state,         ///< |J^-1/2 S|
  state_of_state,        ///< |S|
  rotation_of_state,     ///< |Psi J^1/2|
  passages
};

/// Norms between the middles of cells of time. Of a long span one period is kept: over k periods and a remainder r the
/// columns are linear in k up to a rotation, S = S_r (1 + k N), N = S_P - 1, and Psi = Psi_r' + k slope with
/// |Psi_r'| <= |Psi_r| + 2/L.
class FreeTable {
 public:
  FreeTable(const FreeBody& body, double span);

  const FreeBody& body() const { return body_; }
  /// Why the span cannot be covered; empty if it can.
  const std::string& refusal() const { return refusal_; }
  bool is_periodic() const { return periodic_; }
  int cells() const { return cells_; }           ///< of the table: of a period, or of the span
  int all_cells() const { return all_cells_; }   ///< of the span
  double width() const { return width_; }        ///< of a cell [s]
  double span() const { return span_; }
  const Vector3d& rates(int phase) const { return rates_[static_cast<std::size_t>(phase)]; }   ///< principal axes

  /// |S_r| or |Psi_r| from the middle of a cell, r = `later` cells, and its slope per period.
  const double* norms(Passage of, int phase) const { return row(norms_[of], phase); }
  const double* slopes(Passage of, int phase) const { return row(slopes_[of], phase); }

  double most_state = 1.0;       ///< bound on |S_r| from any time over at most a period or the span
  double most_rotation = 0.0;    ///< the same of |Psi_r J^1/2|
  double most_return = 0.0;      ///< of |N|, and of the slope of Psi J^1/2 at r = 0
  double most_slope = 0.0;

 private:
  const double* row(const std::vector<double>& of, int phase) const {
    return of.data() + static_cast<std::size_t>(phase) * static_cast<std::size_t>(cells_);
  }
  bool choose_cells();
  void fill();

  const FreeBody& body_;
  double span_, width_ = 0.0;
  int cells_ = 0, all_cells_ = 0;
  bool periodic_ = false;
  std::string refusal_;
  std::vector<Vector3d> rates_;
  std::vector<double> norms_[passages], slopes_[passages];
};

}  // namespace polhode::effect
