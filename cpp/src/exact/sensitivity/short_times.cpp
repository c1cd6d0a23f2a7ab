#include "exact/sensitivity/short_times.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "exact/sensitivity/kernels.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode::exact {
namespace {

using Columns = Eigen::Matrix<double, 3, 9>;

constexpr int short_order = 20;             // enough for |p t| <= 1/4
constexpr double short_reach = 0.25, attitude_reach = 0.5;  // of |p t|; of |omega t| for the attitude's own series

/// Slot of a column in the series.
constexpr int slot(int column) { return column < 6 ? column : column + 2; }

}  // namespace

ShortTimes::ShortTimes(const ColumnsStart& start, double longest, bool axes) : start_(start), axes_(axes) {
  SeriesStart s;
  for (int a = 0; a < 3; ++a) s.I[a] = start.I[a], s.w[a] = start.w[a];
  free_columns_kernels().make_series(s, axes, longest <= short_reach ? short_order : series_order, series_);
}

ShortColumns ShortTimes::at(double t, double rate, const Vector3d& omega, const Quat& attitude) const {
  const bool attitudes = start_.w.norm() * std::abs(t) <= attitude_reach;
  SeriesSums sums;
  free_columns_kernels().sum_series(series_, t, rate * std::abs(t) <= short_reach ? short_order : series_order,
                                    attitudes, sums);
  Columns d_w = Columns::Zero(), d_theta = Columns::Zero();
  for (int c = 0; c < (axes_ ? 9 : 6); ++c)
    for (int a = 0; a < 3; ++a) {
      d_w(a, c) = sums.omega[a][slot(c)];
      if (attitudes) d_theta(a, c) = sums.theta[a][slot(c)];
    }
  if (!attitudes) d_theta = find_attitudes(t, to_principal(start_, omega), attitude, d_w, sums.square);
  return in_caller_frames(d_w, d_theta, attitude);
}

Columns ShortTimes::find_attitudes(double t, const Vector3d& w, const Quat& attitude, const Columns& d_w,
                                   const double* square) const {
  const Vector3d &I = start_.I, &w0 = start_.w, m = I.cwiseProduct(w);
  const double LL = m.squaredNorm(), L = std::sqrt(LL);
  const Matrix3d back = start_.R_BP.transpose() * to_matrix(conjugate(attitude) * start_.attitude) * start_.R_BP;
  Columns out = Columns::Zero();
  for (int column = 0; column < (axes_ ? 9 : 6); ++column) {
    const int i = column % 3, b = (i + 1) % 3, c = (i + 2) % 3;
    Vector3d dm0 = Vector3d::Zero(), dm = I.cwiseProduct(d_w.col(column));
    double psi = 0.0;
    if (column < 3) {
      dm0[i] = I[i];
      psi = t * w0[i] * I[i] / L;
    } else if (column < 6) {
      dm0[i] = w0[i], dm[i] += w[i];
      psi = 0.5 * square[i] / L;
    } else {
      const double gap = I[b] - I[c];
      dm0[b] = gap * w0[c], dm0[c] = gap * w0[b];
      dm[b] += gap * w[c], dm[c] += gap * w[b];
      psi = gap * square[3 + i] / L;
    }
    const Vector3d v = back * dm0 - dm;
    out.col(column) = m.cross(v) / LL + m / L * psi;
  }
  // The column of the largest component of the momentum would cancel near a steady rotation: the moments have no scale.
  Eigen::Index last = 0;
  I.cwiseProduct(w0).cwiseAbs().maxCoeff(&last);
  const Eigen::Index b = (last + 1) % 3, c = (last + 2) % 3;
  out.col(3 + last) = -(I[b] * out.col(3 + b) + I[c] * out.col(3 + c)) / I[last];
  return out;
}

ShortColumns ShortTimes::in_caller_frames(const Columns& d_w, const Columns& d_theta, const Quat& attitude) const {
  const Matrix3d &S = start_.R_BP, R = to_matrix(attitude) * S;
  const int e = start_.time_exponent, f = start_.moment_exponent;
  const int omega_exponents[] = {0, e - f, e}, theta_exponents[] = {-e, -f, 0};
  ShortColumns out;
  for (int group = 0; group < 3; ++group) {
    Matrix3d w = S * d_w.middleCols<3>(3 * group), theta = R * d_theta.middleCols<3>(3 * group);
    if (group != 1) w = w * S.transpose(), theta = theta * S.transpose();  // directions along the body axes
    for (int c = 0; c < 3; ++c) {
      out.omega.col(3 * group + c) = ldexp(w.col(c), omega_exponents[group]);
      out.theta.col(3 * group + c) = ldexp(theta.col(c), theta_exponents[group]);
    }
  }
  return out;
}

ShortColumns ShortTimes::on_unstable_axis(double t, const Quat& attitude) const {
  const Vector3d &I = start_.I, &w = start_.w;
  Eigen::Index a = 0;
  w.cwiseAbs().maxCoeff(&a);
  const Eigen::Index b = (a + 1) % 3, c = (a + 2) % 3;
  // d omega_b' = B d omega_c, d omega_c' = C d omega_b
  const double B = (I[c] - I[a]) / I[b] * w[a], C = (I[a] - I[b]) / I[c] * w[a], lambda = std::sqrt(B * C);
  const double grow = math::expm1(lambda * std::abs(t)), shrink = math::expm1(-(lambda * std::abs(t)));
  const double cosh = 1.0 + 0.5 * (grow + shrink), sinh = std::copysign(0.5 * (grow - shrink), t);
  Columns d_w = Columns::Zero();
  d_w(a, a) = 1.0, d_w(b, b) = cosh, d_w(c, c) = cosh;
  d_w(b, c) = B / lambda * sinh, d_w(c, b) = C / lambda * sinh;
  const double no_square[6] = {};
  Columns d_theta = find_attitudes(t, w, attitude, d_w, no_square);
  d_theta.middleCols<6>(3).setZero();  // a moment does not change a steady rotation
  return in_caller_frames(d_w, d_theta, attitude);
}

}  // namespace polhode::exact
