#pragma once

#include "exact/sensitivity/series.hpp"
#include "exact/sensitivity/start.hpp"

// The columns where the closed form cancels: the power series in t, and the steady rotation about the unstable axis.
namespace polhode::exact {

/// Three columns each of omega(0), of the moments and of the axes, in body axes and the caller's units; the rotation in
/// space axes.
struct ShortColumns {
  Eigen::Matrix<double, 3, 9> omega, theta;
};

class ShortTimes {
 public:
  /// `longest`: the largest |p t|.
  ShortTimes(const ColumnsStart& start, double longest, bool axes);

  /// At a scaled time with |p t| <= 1/2, with the state there.
  ShortColumns at(double t, double rate, const Vector3d& omega, const Quat& attitude) const;

  /// Two components of omega are zero and the moments differ. The columns of the axes are left out.
  ShortColumns on_unstable_axis(double t, const Quat& attitude) const;

 private:
  /// The columns of the attitude from d omega by the constant momentum in space, in principal axes.
  Eigen::Matrix<double, 3, 9> find_attitudes(double t, const Vector3d& w, const Quat& attitude,
                                             const Eigen::Matrix<double, 3, 9>& d_w, const double* square) const;
  ShortColumns in_caller_frames(const Eigen::Matrix<double, 3, 9>& d_w, const Eigen::Matrix<double, 3, 9>& d_theta,
                                const Quat& attitude) const;

  const ColumnsStart& start_;
  bool axes_;
  ColumnSeries series_;
};

}  // namespace polhode::exact
