#include "derivative/column_series.hpp"

#include <algorithm>
#include <cmath>

#include "core/choose_level.hpp"

namespace polhode {
namespace {

using math::DD;
using Source = ForceSource;

/// Row by row (v2, v3, v1), or (v3, v1, v2).
void permute_rows(const VectorRows& v, int by, int order, VectorRows& out) {
  for (int k = 0; k <= order; ++k) {
    for (int i = 0; i < 3; ++i) out[k][i] = v[k][(i + by) % 3];
    out[k][3] = 0.0;
  }
}

}  // namespace

ColumnSeries::ColumnSeries(const Scene& piece, const std::vector<ColumnCause>& causes,
                           const std::vector<double>& columns)
    : body_(piece, true),
      terms_(make_column_terms(piece, body_.axes(), body_.moments(), causes)),
      kernels_(*choose_level(simd_level(), baseline_column_kernels, avx2_column_kernels, avx512_column_kernels)),
      columns_(6, causes.size(), body_.axes(), body_.is_rotated(), columns) {
  const Source axes[3] = {Source::space_x, Source::space_y, Source::space_z};
  for (int c = 0; c < 3; ++c) sees_space_[c] = terms_.space[c] != 0.0 || terms_.uses(axes[c]);
  sees_space_[2] = sees_space_[2] || !terms_.moment.isZero(0.0);
  sees_orbit_ = terms_.orbit_rate != 0.0;
  forces_.resize(columns_.groups());
  for (const ColumnTerms::Force& force : terms_.forces) {
    auto& own = forces_[static_cast<std::size_t>(force.column) / 8];
    const double* first = &source(force.source)[0][force.part];
    auto found = std::find_if(own.begin(), own.end(), [&](const ColumnForce& other) {
      return other.first == first && other.component == force.component;
    });
    if (found == own.end()) found = own.insert(own.end(), ColumnForce{{}, first, force.component});
    found->parts[force.column % 8] += force.factor;
  }
}

void ColumnSeries::compute_series(DD t, double unit, const double* y, const double* carry, int order,
                                  double* rows) const {
  body_.compute_series(t, unit, y, carry, order, rows);
  rows_ = rows;
  VectorRows& w = source(Source::rates);
  for (int k = 0; k <= order; ++k) body_.compute_rates(rows + dimension * k, w[k]);
  rate_ = std::max({std::abs(w[0][0]), std::abs(w[0][1]), std::abs(w[0][2]), 1.0 / unit});
  see_vectors(t, unit, y, order);
  find_products(t, unit, order);
  fill_matrix(order);
  columns_.begin(order);
  for (std::size_t g = 0; g < columns_.groups(); ++g) {
    kernels_.expand_columns(matrix_, terms_.linear, terms_.pulled, forces_[g].data(),
                            static_cast<int>(forces_[g].size()), order, unit, columns_.rows(g));
  }
}

/// The axes of space that torques need, and the radial direction and the tangent of an orbit.
void ColumnSeries::see_vectors(DD t, double unit, const double* y, int order) const {
  VectorRows seen[5];
  int n = 0;
  const Quat back{-y[4], -y[5], -y[6], y[7]};
  for (int c = 0; c < 3; ++c)
    if (sees_space_[c]) std::copy_n(rotate(back, Vector3d(Vector3d::Unit(c))).data(), 3, seen[n++][0]);
  if (sees_orbit_) {
    const std::array<Vector3d, 2> orbit = body_.compute_orbit_axes(t, y);
    for (const Vector3d& v : orbit) std::copy_n(v.data(), 3, seen[n++][0]);
  }
  if (n == 0) return;
  for (int i = 0; i < n; ++i) seen[i][0][3] = 0.0;
  kernels_.expand_vectors(source(Source::rates), order, unit, sees_orbit_ ? terms_.orbit_rate : 0.0, n, seen);
  n = 0;
  const auto copy = [&](VectorRows& to) { std::copy_n(seen[n++][0], 4 * (order + 1), to[0]); };
  const Source axes[3] = {Source::space_x, Source::space_y, Source::space_z};
  for (int c = 0; c < 3; ++c)
    if (sees_space_[c]) copy(source(axes[c]));
  if (sees_orbit_) copy(radius_), copy(tangent_);
}

/// The other series that force columns, each only where it is needed.
void ColumnSeries::find_products(DD t, double unit, int order) const {
  VectorRows first, second, third, fourth;
  const VectorRows& w = source(Source::rates);
  source(Source::one)[0][0] = 1.0;
  if (sees_orbit_) {
    const VectorRows& u = radius_;
    permute_rows(u, 1, order, first), permute_rows(u, 2, order, second);
    kernels_.multiply(first, second, order, source(Source::radius_pairs));
    kernels_.multiply(u, u, order, source(Source::radius_squares));
    if (terms_.uses(Source::tangent_pairs) || terms_.uses(Source::timed_pairs)) {
      permute_rows(tangent_, 1, order, third), permute_rows(tangent_, 2, order, fourth);
      VectorRows& pairs = source(Source::tangent_pairs);
      VectorRows other;
      kernels_.multiply(first, fourth, order, pairs), kernels_.multiply(second, third, order, other);
      VectorRows& timed = source(Source::timed_pairs);
      for (int k = 0; k <= order; ++k)
        for (int i = 0; i < 3; ++i) pairs[k][i] += other[k][i];
      // In loops of their own: where row 0 is an exception within one, GCC 14 splits, vectorises and reads old rows.
      for (int i = 0; i < 3; ++i) timed[0][i] = t.hi * pairs[0][i];
      for (int k = 1; k <= order; ++k)
        for (int i = 0; i < 3; ++i) timed[k][i] = t.hi * pairs[k][i] + unit * pairs[k - 1][i];
    }
  }
  if (!terms_.uses(Source::derivatives) && !terms_.uses(Source::rate_pairs)) return;
  permute_rows(w, 1, order, first), permute_rows(w, 2, order, second);
  kernels_.multiply(first, second, order, source(Source::rate_pairs));
  kernels_.multiply(w, w, order, source(Source::rate_squares));
  VectorRows& derivatives = source(Source::derivatives);
  for (int k = 0; k < order; ++k)
    for (int i = 0; i < 3; ++i) derivatives[k][i] = (k + 1) * w[k + 1][i] / unit;
}

/// The matrix of the equations. The small rotation changes a vector v that is fixed in space by v x theta. So the torque
/// -m x g gives (m.g) theta - g (m.theta), a torque f that is constant in space gives f x theta, and a gradient with the
/// torque c1 u2 u3 gives c1 ((u3^2 - u2^2) theta1 + u1 u2 theta2 - u1 u3 theta3), and so on.
void ColumnSeries::fill_matrix(int order) const {
  const double* p = terms_.product;
  const VectorRows& w = source(Source::rates);
  for (int n = 0; n <= order; ++n) {
    const double a = w[n][0], b = w[n][1], c = w[n][2];
    matrix_[n] = {{p[0] * c, p[0] * b, p[1] * a, p[1] * c, p[2] * b, p[2] * a}, {c, -b, a, -c, b, -a}, {}};
    if (!terms_.pulled) continue;
    double M[3][3] = {};
    if (!terms_.moment.isZero(0.0)) {
      const double* g = source(Source::space_z)[n];
      const Vector3d& m = terms_.moment;
      const double along = m[0] * g[0] + m[1] * g[1] + m[2] * g[2];
      for (int i = 0; i < 3; ++i) {
        M[i][i] += along;
        for (int j = 0; j < 3; ++j) M[i][j] -= g[i] * m[j];
      }
    }
    const Source axes[3] = {Source::space_x, Source::space_y, Source::space_z};
    for (int s = 0; s < 3; ++s) {
      if (terms_.space[s] == 0.0) continue;
      for (int i = 0; i < 3; ++i) {
        const double f = terms_.space[s] * source(axes[s])[n][i];
        const int j = next_axis(i), k = next_axis(j);
        M[k][j] += f, M[j][k] -= f;
      }
    }
    if (sees_orbit_) {
      const double *squares = source(Source::radius_squares)[n], *pairs = source(Source::radius_pairs)[n];
      for (int i = 0; i < 3; ++i) {
        const int j = next_axis(i), k = next_axis(j);
        M[i][i] += terms_.tidal[i] * (squares[k] - squares[j]);
        M[i][j] += terms_.tidal[i] * pairs[k], M[i][k] -= terms_.tidal[i] * pairs[j];
      }
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) matrix_[n].pull[3 * i + j] = M[i][j] * terms_.inverse[i];
  }
}

void ColumnSeries::compute_sizes(const double* row, double* sizes) const {
  body_.compute_sizes(row, sizes);
  const auto k = static_cast<int>((row - rows_) / dimension);
  sizes[2] = k < 3 ? 1.0 : columns_.measure(k, rate_);
}

}  // namespace polhode
