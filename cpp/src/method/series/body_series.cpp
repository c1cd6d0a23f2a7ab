#include "core/choose_level.hpp"
#include "method/series/body_series.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "method/series/lanes/levels.hpp"
#include "method/series/seen_vector.hpp"
#include "method/series/separatrix.hpp"
#include "polhode/attitude/matrix.hpp"
#include "polhode/core/simd.hpp"
#include "polhode/math/detail/coin.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

using math::DD;

/// R^T v for a unit quaternion: a vector of space axes in body axes.
Vector3d to_body(const double* q, const Vector3d& v_W) { return rotate({-q[0], -q[1], -q[2], q[3]}, v_W); }

}  // namespace

std::string compute_series_refusal(const Scene& scene) {
  std::optional<formula::KnownTorque> first;
  for (const AnyTorque& torque : scene.torques()) {
    const auto* custom = std::get_if<torques::Custom>(&torque);
    if (custom != nullptr) return "a Custom torque, which has no Taylor series (dop853 and rk45 integrate it)";
    const std::optional<formula::KnownTorque> known = find_known(torque);
    if (!known || known->kind != formula::KnownTorque::Kind::gravity_gradient) continue;
    if (first && (known->rate != first->rate || known->phase != first->phase))
      return "gravity gradients of two orbits (dop853 and rk45 integrate them)";
    first = known;
  }
  if (const std::string singular = find_singular(scene.torques(), scene.inertia_B().matrix(), scene.start(), 0.0); !singular.empty())
    return "a Formula without derivatives at the start, by " + singular + ", which is 0 (for a norm write "
           "norm(v, smooth=1e-6)" + (scene.states().empty() ? "; dop853 and rk45 integrate it)" : ")");
  return "";
}

BodySeries::BodySeries(const Scene& scene, bool attitude) {
  const InertiaTensor& inertia = scene.inertia_B();
  const Quat& q_WB = scene.attitude();
  Vector3d omega_P = scene.omega();
  I_ = inertia.moments();
  const bool triaxial = I_[0] < I_[1] && I_[1] < I_[2];
  rotated_ = !inertia.is_diagonal() || triaxial;
  if (rotated_) {
    R_BP_ = inertia.axes();
    rotated_ = R_BP_ != Matrix3d::Identity();
  } else {
    I_ = inertia.matrix().diagonal();
  }
  Quat q_WP = q_WB;
  if (rotated_) {
    const Quat q_BP = quat_from_matrix(R_BP_, "inertia.axes");
    q_PB_ = conjugate(q_BP);
    // A body at rest next to upright rotates as far as its attitude is from upright.
    q_WP = multiply_exactly(q_WB, q_BP);
    omega_P = R_BP_.transpose() * scene.omega();
  }
  // The separatrix of a body with rotors lies elsewhere. A controller may branch where a rate is exactly 0, which is a
  // difference of separatrix variables.
  if (triaxial && scene.rotor_momentum().isZero(0.0) && scene.controllers().empty()) choose_variables(omega_P);
  if (terms_.variables == RateVariables::plain) {
    for (int i = 0; i < 3; ++i) {
      const DD product = math::two_diff(I_[(i + 1) % 3], I_[(i + 2) % 3]) / DD(I_[i]);
      terms_.product[i] = product.hi, terms_.product_low[i] = product.lo;
      start_[i] = omega_P[i];
    }
  }
  add_torques(scene);
  attitude_ = attitude || terms_.gradient || terms_.fixed_vectors > 1;
  if (attitude_) {
    start_[4] = q_WP.x, start_[5] = q_WP.y, start_[6] = q_WP.z, start_[7] = q_WP.w;
  } else if (terms_.fixed_vectors == 1) {
    // Not by q_WP, which is rounded: such a rounding of the vertical would rotate an upright body.
    const std::array<DD, 3> seen_B = see_from_body(q_WB, space_[0]);
    for (int i = 0; i < 3; ++i) {
      DD seen(0.0);
      for (int j = 0; j < 3; ++j) seen = seen + seen_B[static_cast<std::size_t>(j)] * DD(R_BP_(j, i));
      start_[4 + i] = seen.hi, start_carry_[4 + i] = seen.lo;
    }
  }
  free_ = terms_.variables == RateVariables::separatrix && scene.torques().empty();
  find_invariants(scene);
  kernel_ = find_series_kernel(terms_, attitude_);
}

void BodySeries::find_invariants(const Scene& scene) {
  using Sees = SeriesInvariants::Sees;
  vertical_ = !attitude_ && moment_P_ != Vector3d::Zero();
  const Sees sees = attitude_ ? Sees::attitude : vertical_ ? Sees::vertical : Sees::nothing;
  const Vector3d h_P = R_BP_.transpose() * scene.rotor_momentum();
  invariants_ = SeriesInvariants(scene, terms_, I_, moment_P_, h_P, gradients_, orbit_phase_, half_over_k_, sees);
  keep_invariants(scene.t0());
}

void BodySeries::keep_invariants(double t0) {
  invariants_.start(t0, start_, start_carry_);
  if (!free_) return;
  const DD u(start_[0], start_carry_[0]), v(start_[1], start_carry_[1]), w(start_[2]);
  // u' = b w2 u, v' = -b w2 v, w2' = c (v - u)(v + u): a = c / b
  balance_ = terms_.product[2] / terms_.product[0];
  kept_[0] = u * v, kept_[1] = DD(balance_) * (u * u + v * v) + w * w;
  // Squares of 1e-160 and 1e160 rad/s leave the range of float64: no correction for such rates.
  const double size = std::abs(kept_[1].hi);
  free_ = size > 1e-240 && size < 1e240;
}

BodySeries BodySeries::shifted(double t0, const double* error) const {
  BodySeries other = *this;
  for (int i = 0; i < dimension; ++i) other.start_[i] += error[i];
  other.keep_invariants(t0);
  return other;
}

void BodySeries::choose_variables(const Vector3d& w) {
  const Separatrix separatrix(I_);
  if (!separatrix.suits(w)) return;
  k_ = separatrix.k().hi;
  terms_.variables = RateVariables::separatrix;
  half_over_k_ = separatrix.half_over_k();
  terms_.to_rates[0] = half_over_k_.hi, terms_.to_rates[1] = 1.0, terms_.to_rates[2] = 0.5;
  const DD product[3] = {separatrix.rate(), -separatrix.rate(), separatrix.middle()};
  for (int i = 0; i < 3; ++i) terms_.product[i] = product[i].hi, terms_.product_low[i] = product[i].lo;
  separatrix.from_rates(w.data(), start_, start_carry_);
}

void BodySeries::set_column(double* column, const Vector3d& torque_P) const {
  add_acceleration(column, {torque_P[0] / I_[0], torque_P[1] / I_[1], torque_P[2] / I_[2]});
}

void BodySeries::add_acceleration(double* column, const Vector3d& a) const {
  if (terms_.variables == RateVariables::plain) {
    for (int i = 0; i < 3; ++i) column[i] += a[i];
  } else {
    column[0] += a[2] - k_ * a[0], column[1] += a[2] + k_ * a[0], column[2] += a[1];
  }
}

void BodySeries::add_torques(const Scene& scene) {
  using Kind = formula::KnownTorque::Kind;
  const Matrix3d R_PB = R_BP_.transpose();
  Vector3d moment = Vector3d::Zero(), space = Vector3d::Zero();
  for (const AnyTorque& torque : scene.torques()) {
    const std::optional<formula::KnownTorque> known = find_known(torque);
    if (!known) continue;   // FormulaSeries expands it
    switch (known->kind) {
      case Kind::constant_in_body: set_column(terms_.torque, R_PB * known->vector); break;
      case Kind::constant_in_space: space += known->vector; break;
      case Kind::gravity: moment += known->vector; break;
      case Kind::damping: {
        const Matrix3d C_P = R_PB * known->matrix * R_BP_;
        for (int j = 0; j < 3; ++j) set_column(terms_.damping[j], -C_P.col(j));
        terms_.damped = true;
        break;
      }
      case Kind::angular_damping:
        for (int j = 0; j < 3; ++j) add_acceleration(terms_.damping[j], -known->rate * Vector3d::Unit(j));
        terms_.damped = true;
        break;
      case Kind::rotors:
        for (int j = 0; j < 3; ++j) set_column(terms_.damping[j], (R_PB * known->vector).cross(Vector3d::Unit(j)));
        terms_.damped = true;
        break;
      case Kind::gravity_gradient:
        ++gradients_;
        orbit_rate_ = known->rate, orbit_phase_ = known->phase;
        break;
    }
  }
  if (const Vector3d h_P = R_PB * scene.rotor_momentum(); !h_P.isZero(0.0)) {
    for (int j = 0; j < 3; ++j) set_column(terms_.damping[j], h_P.cross(Vector3d::Unit(j)));
    terms_.damped = true;
  }
  // Gravity's torque is -moment x (R^T e_z), a space torque is R^T tau. Each is linear in one vector.
  moment_P_ = R_PB * moment;
  if (moment_P_ != Vector3d::Zero()) {
    space_[terms_.fixed_vectors] = {0, 0, 1};
    for (int j = 0; j < 3; ++j) set_column(terms_.pull[terms_.fixed_vectors][j], -moment_P_.cross(Vector3d::Unit(j)));
    ++terms_.fixed_vectors;
  }
  if (const double size = space.cwiseAbs().maxCoeff(); size > 0.0) {
    space_[terms_.fixed_vectors] = space / size;
    for (int j = 0; j < 3; ++j) set_column(terms_.pull[terms_.fixed_vectors][j], size * Vector3d::Unit(j));
    ++terms_.fixed_vectors;
  }
  if (gradients_ > 0) {
    // With an orbit there are kernels for none or two.
    if (few_kernels || terms_.fixed_vectors == 1) terms_.fixed_vectors = 2;
    terms_.gradient = true;
    terms_.orbit_rate = orbit_rate_;
    const double strength = 3.0 * gradients_ * orbit_rate_ * orbit_rate_;
    double a[3];
    for (int i = 0; i < 3; ++i) a[i] = strength * ((I_[(i + 2) % 3] - I_[(i + 1) % 3]) / I_[i]);
    double *first = terms_.tidal[0], *second = terms_.tidal[1];
    if (terms_.variables == RateVariables::plain) {
      std::copy_n(a, 3, first);
    } else {
      first[0] = first[1] = a[2], first[2] = a[1];
      second[0] = -k_ * a[0], second[1] = k_ * a[0];
    }
  }
}

std::string BodySeries::describe_state() const {
  std::string state = terms_.variables == RateVariables::plain ? "omega" : "separatrix variables";
  if (attitude_) return state + ", attitude";
  return terms_.fixed_vectors == 1 ? state + ", vertical" : state;
}

void BodySeries::unpack(const double* rows, std::size_t n, double* omega, double* attitude) const {
  for (const double* y = rows; y != rows + dimension * n; y += dimension, omega += 3, attitude += 4) {
    double w[3];
    compute_rates(y, rotated_ ? w : omega);
    if (rotated_) {
      for (int i = 0; i < 3; ++i) omega[i] = R_BP_(i, 0) * w[0] + R_BP_(i, 1) * w[1] + R_BP_(i, 2) * w[2];
    }
    if (!attitude_) continue;
    const double size = y[4] * y[4] + y[5] * y[5] + y[6] * y[6] + y[7] * y[7];
    const double s = std::abs(size - 1.0) < 1e-8 ? 1.5 - 0.5 * size : 1.0 / std::sqrt(size);
    Quat q{s * y[4], s * y[5], s * y[6], s * y[7]};
    if (rotated_) q = q * q_PB_;
    attitude[0] = q.x, attitude[1] = q.y, attitude[2] = q.z, attitude[3] = q.w;
  }
}

void BodySeries::pack_error(double* error) const {
  Vector3d w(error[0], error[1], error[2]);
  Quat q{error[4], error[5], error[6], error[7]};
  if (rotated_) w = R_BP_.transpose() * w, q = q * conjugate(q_PB_);
  if (terms_.variables == RateVariables::separatrix) w = {w[2] - k_ * w[0], w[2] + k_ * w[0], w[1]};
  std::copy_n(w.data(), 3, error);
  error[4] = q.x, error[5] = q.y, error[6] = q.z, error[7] = q.w;
}

void BodySeries::unpack_error(double* error) const {
  Vector3d w;
  compute_rates(error, w.data());
  Quat q{error[4], error[5], error[6], error[7]};
  if (rotated_) w = R_BP_ * w, q = q * q_PB_;
  std::copy_n(w.data(), 3, error);
  error[4] = q.x, error[5] = q.y, error[6] = q.z, error[7] = q.w;
}

BodySeries BodySeries::perturbed(double part, int choice) const {
  BodySeries other = *this;
  math::Coin coin(2025 + static_cast<std::uint64_t>(choice));
  const auto change = [&](double& x, double size) { x += coin.toss() ? part * size : -part * size; };
  SeriesTerms& terms = other.terms_;
  const bool rounded = rotated_ && R_BP_.cwiseAbs().maxCoeff() < 1.0;
  for (int i = 0; i < 3; ++i) {
    const double own = 2.0 * std::abs(terms.product[i]);
    change(terms.product[i], rounded ? std::max(own, I_.maxCoeff() / I_[i]) : own);
  }
  // A product or a difference and a division round each entry.
  // Changes of u and v by the same size would leave w1 or w3 as they are. A needle's two are of unlike sizes.
  const double unlike = terms.variables == RateVariables::separatrix ? 2.0 : 1.0;
  const auto change_column = [&](double* column) {
    for (int i = 0; i < 3; ++i) change(column[i], (i == 1 ? unlike : 1.0) * 2.0 * column[i]);
  };
  change_column(terms.torque);
  // Products and a division round each entry, and in a direction without damping all of it is rounding.
  // The entries of a rotated matrix are rounded relative to the largest one of their row.
  for (int i = 0; i < 3; ++i) {
    double largest = 0.0;
    for (const auto& column : terms.damping) largest = std::max(largest, std::abs(column[i]));
    for (auto& column : terms.damping) change(column[i], 8.0 * (rounded ? largest : column[i]));
  }
  // So are those of a weight and its arm: next to upright such a rounding rotates the body.
  for (auto& vector : terms.pull) {
    double largest[3] = {};
    for (int i = 0; i < 3; ++i)
      for (const auto& column : vector) largest[i] = std::max(largest[i], std::abs(column[i]));
    for (auto& column : vector) {
      if (!rounded) change_column(column);
      else for (int i = 0; i < 3; ++i) change(column[i], (i == 1 ? unlike : 1.0) * 4.0 * largest[i]);
    }
  }
  for (auto& column : terms.tidal) change_column(column);
  change(terms.orbit_rate, terms.orbit_rate);
  change(other.orbit_rate_, other.orbit_rate_);
  change(other.orbit_phase_, other.orbit_phase_);
  return other;
}

void BodySeries::measure_error(const double* y, const double* error, double* out) const {
  double w[3], e[3];
  compute_rates(y, w);
  compute_rates(error, e);
  out[0] = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  out[1] = std::sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
  const double* q = error + 4;
  out[2] = attitude_ ? 2 * std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]) : 0.0;
  out[3] = 0.0;
}

std::array<Vector3d, 2> BodySeries::compute_orbit_axes(DD t, const double* y) const {
  // n t in double-double, because the error of a rounded angle would grow with the number of orbits.
  const DD product = math::two_prod(orbit_rate_, t.hi), angle = math::two_sum(product.hi, orbit_phase_);
  const double low = angle.lo + product.lo + orbit_rate_ * t.lo;
  const auto [s0, c0] = math::sincos(angle.hi);
  const double s = s0 + c0 * low, c = c0 - s0 * low;
  return {to_body(y + 4, {c, s, 0}), to_body(y + 4, {-s, c, 0})};
}

void BodySeries::compute_series(DD t, double unit, const double* y, const double*, int order, double* rows) const {
  alignas(64) double vectors[16] = {};
  int n = 0;
  if (!attitude_) {
    std::copy_n(y + 4, 3, vectors);
  } else {
    for (; n < terms_.fixed_vectors; ++n) {
      const Vector3d seen = to_body(y + 4, space_[n]);
      std::copy_n(seen.data(), 3, vectors + 4 * n);
    }
  }
  if (terms_.gradient) {
    const auto [radius, tangent] = compute_orbit_axes(t, y);
    std::copy_n(radius.data(), 3, vectors + 4 * n);
    std::copy_n(tangent.data(), 3, vectors + 4 * (n + 1));
  }
  kernel_(terms_, {y, vectors, unit}, order, rows);
}

double BodySeries::compute_time_scale(DD, const double* y) const {
  double rate = std::max({std::abs(y[0]), std::abs(y[1]), std::abs(y[2]), orbit_rate_});
  const auto grow = [&](const double* column, bool root) {
    for (int i = 0; i < 3; ++i) rate = std::max(rate, root ? std::sqrt(std::abs(column[i])) : std::abs(column[i]));
  };
  grow(terms_.torque, true);
  for (const auto& column : terms_.damping) grow(column, false);
  for (const auto& vector : terms_.pull)
    for (const auto& column : vector) grow(column, true);
  for (const auto& column : terms_.tidal) grow(column, true);
  return rate > 0.0 ? 1.0 / rate : 0x1p900;
}

void BodySeries::start_carry(double* carry) const { std::copy_n(start_carry_, 8, carry); }

/// A free body conserves u v and a (u^2 + v^2) + w2^2, which are combinations of its energy and |L|^2. One Newton step
/// restores them, with residuals in double-double. Its directions preserve the relative accuracy of u and v.
void BodySeries::correct_rates(double* y, double* carry) const {
  const DD u(y[0], carry[0]), v(y[1], carry[1]), w(y[2], carry[2]);
  const double uu = y[0] * y[0], vv = y[1] * y[1], ww = y[2] * y[2], uv = y[0] * y[1], sum = uu + vv;
  const double split = sum > 0.0 ? (uu - vv) / sum : 0.0;
  double ratio = 0.0;   // relative change of u and v
  if (std::abs(uv) > 1e-250) {
    ratio = -0.5 * (u * v - kept_[0]).hi / uv;
    if (!(std::abs(ratio) < 0.1)) return;
  }
  const double residual = (DD(balance_) * (u * u + v * v) + w * w - kept_[1]).hi + 2.0 * balance_ * sum * ratio;
  const double slope = 2.0 * (balance_ * (uu - vv) * split + ww);
  // No step where the energy is extreme for this u v, because the slope vanishes.
  const double step = slope > 1e-3 * (balance_ * sum + ww) ? -residual / slope : 0.0;
  const double apart = step * split;
  const double change[3] = {y[0] * (ratio + apart), y[1] * (ratio - apart), y[2] * step};
  for (int i = 0; i < 3; ++i) {
    const DD restored = math::two_sum(y[i], carry[i] + change[i]);
    y[i] = restored.hi, carry[i] = restored.lo;
  }
}

void BodySeries::correct(DD t, long step, double* y, double* carry) const {
  if (free_) correct_rates(y, carry);
  if (attitude_ || vertical_) keep_unit(y, carry);
  // The drift over a few steps is small, and the correction costs a fifth of a step.
  if (invariants_.any() && step % 8 == 7) invariants_.restore(t, y, carry);
}

void BodySeries::keep_unit(double* y, double* carry) {
  // Restores |q| = 1, or the length of the vertical. The carry must stay as small as rounding, because it does not
  // rotate with q, and a larger one would grow.
  double norm = 0.0, cross = 0.0;
  for (int i = 4; i < 8; ++i) norm += y[i] * y[i], cross += y[i] * carry[i];
  const double residual = 0.5 * (1.0 - norm) - cross;
  for (int i = 4; i < 8; ++i) {
    const DD sum = math::two_sum(y[i], carry[i] + residual * y[i]);
    y[i] = sum.hi, carry[i] = sum.lo;
  }
}

SeriesKernel find_series_kernel(const SeriesTerms& terms, bool attitude) {
  return choose_level(simd_level(), baseline_series_kernel, avx2_series_kernel, avx512_series_kernel, terms, attitude);
}

}  // namespace polhode
