#include "solve/effect/free_table.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/free_sensitivity.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/math/elliptic.hpp"
#include "solve/effect/norms.hpp"

namespace polhode::effect {
namespace {

constexpr int fewest_cells = 24, most_cells = 64;
constexpr double usual_growth = 0.15;   // of a norm across a cell, as an exponent
constexpr double single_growth = 0.25;  // up to which a whole span stays one table, without its period
constexpr double most_growth = 0.7;
/// Of changes of J w a cell counts the mean growth from its middle, so that thin bodies may have longer cells.
constexpr double momentum_share = 1.0 / 3.0;

/// A matrix from rows of three columns.
Matrix3d read(const double* rows) {
  Matrix3d A;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) A(i, k) = rows[3 * i + k];
  return A;
}

/// v x
Matrix3d make_cross(const Vector3d& v) {
  Matrix3d A;
  A << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return A;
}

}  // namespace

FreeBody::FreeBody(const Vector3d& moments, const Vector3d& omega) : J(moments), w(omega) {
  least = J[0], greatest = J[2];
  const Vector3d m = J.cwiseProduct(w);
  const double twice_T = m.dot(w);
  Y = std::sqrt(twice_T), L = m.norm();
  x = std::clamp(L / Y * (L / Y), least, greatest);
  const double product = std::sqrt(J[0]) * std::sqrt(J[1]) * std::sqrt(J[2]);
  c = 0.5 * (greatest - least) / product;
  period = find_period(x, Y);
  most_rate = std::min(Y / std::sqrt(least), L / least);
  growth = c * Y;
  momentum_growth = 0.5 * L * (greatest - least) / (least * greatest);
  // Entries w_k e_k / 2 beside the diagonal of the symmetric part. A symmetric matrix without trace whose squares sum
  // to 2 q has no eigenvalue above sqrt(4 q / 3).
  double most = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double a = J[(k + 1) % 3], b = J[(k + 2) % 3];
    most = std::max(most, std::abs((b - a) / a * ((a + b - J[k]) / b)) / (2.0 * std::sqrt(J[k])));
  }
  rate_growth = std::sqrt(4.0 / 3.0) * most * Y;
}

double FreeBody::find_period(double at_x, double length) const {
  // Landau and Lifshitz 1976, Mechanics, sec. 37: p is the rate of the elliptic functions' argument.
  const bool upper = at_x > J[1];
  const double near = upper ? greatest - at_x : at_x - least, far = upper ? at_x - least : greatest - at_x;
  const double near_gap = upper ? J[1] - least : greatest - J[1], far_gap = upper ? greatest - J[1] : J[1] - least;
  const double p = length * std::sqrt(far_gap * far) / (std::sqrt(J[0]) * std::sqrt(J[1]) * std::sqrt(J[2]));
  const double m = near_gap * near / (far_gap * far);
  if (!(p > 0.0 && m < 1.0)) return HUGE_VAL;
  return 4.0 * elliptic::K(m, 1.0 - m) / p;
}

double FreeBody::bound_period_change(double rho) const {
  if (!(rho < 0.5 * Y)) return HUGE_VAL;
  // |dx/dy| = 2 |J y - x y| / |y|^2, at most (Jmax - Jmin) / |y|
  const double step = (greatest - least) * rho / (Y - rho);
  const double low = std::max(least, x - step), high = std::min(greatest, x + step);
  if ((low > J[1]) != (high > J[1])) return HUGE_VAL;
  constexpr double rounding = 16 * 0x1p-52;
  double change = 0.0;
  for (const double at_x : {low, high})
    for (const double length : {Y - rho, Y + rho})
      change = std::max(change, std::abs(find_period(at_x, length) - period));
  return change + rounding * period;
}

FreeTable::FreeTable(const FreeBody& body, double span) : body_(body), span_(span) {
  if (choose_cells()) fill();
}

bool FreeTable::choose_cells() {
  const double rate = std::max({body_.growth, body_.rate_growth, momentum_share * body_.momentum_growth});
  const auto count = [&](double length) {
    return static_cast<int>(std::clamp(rate * length / usual_growth, 1.0 * fewest_cells, 1.0 * most_cells));
  };
  const double single = rate * span_ / most_cells;
  if (single <= single_growth || (span_ <= body_.period && single <= most_growth)) {
    cells_ = all_cells_ = count(span_);
    width_ = span_ / cells_;
    return true;
  }
  if (!(span_ > body_.period) || rate * body_.period / most_cells > most_growth) {
    refusal_ = "the motion stays too long near the separatrix, or the body is too thin";
    return false;
  }
  periodic_ = true;
  cells_ = count(body_.period);
  width_ = body_.period / cells_;
  constexpr double most = 1e9;   // of all cells, for their numbers
  if (!(span_ / width_ < most)) {
    refusal_ = "the span is too long";
    return false;
  }
  all_cells_ = static_cast<int>(std::ceil(span_ / width_));
  return true;
}

void FreeTable::fill() {
  const auto n = static_cast<std::size_t>(cells_);
  for (int of = 0; of < passages; ++of) {
    norms_[of].assign(n * n, 0.0);
    if (periodic_) slopes_[of].assign(n * n, 0.0);
  }
  const FreeMotion motion(body_.J, body_.w);
  std::vector<double> middles(n), start(3 * n), t(n + 1), d_omega(9 * (n + 1)), d_theta(9 * (n + 1));
  std::vector<double> attitude(4 * (n + 1)), omega(3 * (n + 1));
  for (std::size_t i = 0; i < n; ++i) middles[i] = (static_cast<double>(i) + 0.5) * width_;
  for (std::size_t j = 0; j <= n; ++j) t[j] = static_cast<double>(j) * width_;
  motion.at(middles.data(), n, start.data(), nullptr);
  const Vector3d root = body_.J.cwiseSqrt(), by_root = root.cwiseInverse(), by_J = body_.J.cwiseInverse();
  const Matrix3d one = Matrix3d::Identity();
  rates_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3d w(start[3 * i], start[3 * i + 1], start[3 * i + 2]);
    rates_[i] = w;
    const FreeSensitivity columns(FreeMotion(body_.J, w), {SensitivityTo::omega}, RotationSide::space);
    const std::size_t times = periodic_ ? n + 1 : n - i;   // later than the span: not needed
    columns.at(t.data(), times, omega.data(), attitude.data(), d_omega.data(), d_theta.data());
    Matrix3d N = Matrix3d::Zero(), slope = Matrix3d::Zero();   // S_P - 1 and the slope of Psi at r = 0, both per y
    if (periodic_) {
      const double* q = attitude.data() + 4 * n;
      const Matrix3d E = to_matrix(Quat{q[0], q[1], q[2], q[3]});
      const Vector3d l = body_.J.cwiseProduct(w) / body_.L;
      N = root.asDiagonal() * read(&d_omega[9 * n]) * by_root.asDiagonal() - one;
      slope = E.transpose() * (read(&d_theta[9 * n]) * by_root.asDiagonal() -
                              (one - E) * make_cross(l) * root.asDiagonal() / body_.L);
      most_return = std::max(most_return, bound_norm(N));
      most_slope = std::max(most_slope, bound_norm(slope));
    }
    for (std::size_t j = 0; j < std::min(times, n); ++j) {
      const Matrix3d W = read(&d_omega[9 * j]), Psi = read(&d_theta[9 * j]);
      const Matrix3d S = root.asDiagonal() * W * by_root.asDiagonal();
      const std::size_t at = n * i + j;
      norms_[rate_of_momentum][at] = bound_norm(W * by_J.asDiagonal());
      norms_[state_of_momentum][at] = bound_norm(S * by_root.asDiagonal());
      norms_[rotation_of_momentum][at] = bound_norm(Psi * by_J.asDiagonal());
      norms_[rate_of_state][at] = bound_norm(by_root.asDiagonal() * S);
      norms_[state_of_state][at] = bound_norm(S);
      norms_[rotation_of_state][at] = bound_norm(Psi * by_root.asDiagonal());
      if (!periodic_) continue;
      const Matrix3d returned = S * N, repeated = slope + Psi * by_root.asDiagonal() * N;
      // S N has rank 1, so that its Frobenius norm is its norm.
      slopes_[rate_of_momentum][at] = (by_root.asDiagonal() * returned * by_root.asDiagonal()).norm();
      slopes_[state_of_momentum][at] = (returned * by_root.asDiagonal()).norm();
      slopes_[rotation_of_momentum][at] = bound_norm(repeated * by_root.asDiagonal());
      slopes_[rate_of_state][at] = (by_root.asDiagonal() * returned).norm();
      slopes_[state_of_state][at] = returned.norm();
      slopes_[rotation_of_state][at] = bound_norm(repeated);
    }
  }
  // From a cell's middle to its ends on both sides.
  const double state_ends = math::exp(body_.growth * width_);
  const auto largest = [](const std::vector<double>& of) { return *std::max_element(of.begin(), of.end()); };
  most_state = state_ends * largest(norms_[state_of_state]);
  most_rotation = math::exp(0.5 * body_.growth * width_) * largest(norms_[rotation_of_state]) +
                  width_ * most_state / std::sqrt(body_.least);
  const double half = math::exp(body_.growth * 0.5 * width_);
  // N and the slope at other phases: N(s) = S^-1 N S along the motion.
  most_return *= half * half, most_slope = half * (most_slope + width_ * most_return * half / std::sqrt(body_.least));
}

}  // namespace polhode::effect
