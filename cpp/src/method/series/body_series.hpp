#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "method/series/series_invariants.hpp"
#include "method/series/series_terms.hpp"
#include "polhode/math/detail/double_double.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

struct SeriesStart;

/// The reason why a scene has no Taylor recurrences, or "".
std::string compute_series_refusal(const Scene& scene);

/// A body and its torques as an ode::SeriesProblem in principal axes P. The state is the rate variables (r0, r1, r2, 0)
/// and, if the scene needs it, the quaternion q_WP, or the components in P of a vector fixed in space.
class BodySeries {
 public:
  static constexpr int dimension = 8;
  static constexpr int blocks = 2;
  static constexpr int heads[blocks] = {3, 1};

  /// @param attitude  integrate the quaternion even if no torque depends on it
  BodySeries(const Scene& scene, bool attitude);

  bool has_attitude() const { return attitude_; }
  const SeriesTerms& terms() const { return terms_; }
  const double* start() const { return start_; }
  /// A fixed vector in space axes, numbered as in terms().
  const Vector3d& fixed_vector(int i) const { return space_[i]; }
  double orbit_phase() const { return orbit_phase_; }
  const Matrix3d& axes() const { return R_BP_; }
  const Quat& from_axes() const { return q_PB_; }  ///< q_WB = q_WP q_PB
  bool is_rotated() const { return rotated_; }     ///< axes() is not the identity
  const Vector3d& moments() const { return I_; }   ///< about the axes P
  /// True for a free body in separatrix variables, which conserves u v and balance (u^2 + v^2) + w2^2.
  bool keeps_balance() const { return free_; }
  double balance() const { return balance_; }
  const math::DD& kept(int i) const { return kept_[i]; }
  std::string describe_state() const;   ///< the integrated variables, for the plan

  /// w_B and, if it is integrated, q_WB of n states.
  void unpack(const double* rows, std::size_t n, double* omega, double* attitude) const;

  /// Converts a small error of (omega_B, 0, q_WB) to one of the state, and back.
  void pack_error(double* error) const;
  void unpack_error(double* error) const;

  /// A copy with all constants changed by twice this part of each, up or down by a fixed rule for each choice; those of
  /// damping by eight times it. The axes of a full tensor are rounded: its constants change by this part of the largest
  /// moment, its damping by eight times this part of the largest entry of a row.
  BodySeries perturbed(double part, int choice) const;
  /// A copy that keeps the invariants of another start: this one plus an error of the state.
  BodySeries shifted(double t0, const double* error) const;
  /// For a state and its small error: |w|, the error of w, that of the attitude as an angle, and 0 for further states.
  void measure_error(const double* y, const double* error, double* out) const;

  /// The rates in P of a state, or their part in one row of a series.
  void compute_rates(const double* r, double* omega_P) const {
    const bool plain = terms_.variables == RateVariables::plain;
    const double w1 = plain ? r[0] : (r[1] - r[0]) * terms_.to_rates[0], w2 = plain ? r[1] : r[2];
    omega_P[2] = plain ? r[2] : (r[0] + r[1]) * 0.5;
    omega_P[0] = w1, omega_P[1] = w2;
  }
  /// The radial direction of the orbit and its tangent in P, for a state with the quaternion.
  std::array<Vector3d, 2> compute_orbit_axes(math::DD t, const double* y) const;
  void compute_series(math::DD t, double unit, const double* y, const double* carry, int order, double* rows) const;
  void compute_sizes(const double* row, double* sizes) const {
    double w[3];
    compute_rates(row, w);
    const auto largest = [](double a, double b, double c) {
      return std::max(std::max(std::abs(a), std::abs(b)), std::abs(c));
    };
    // The sum is NaN if a component is, which comparisons may hide.
    sizes[0] = largest(w[0], w[1], w[2]) + 0.0 * (w[0] + w[1] + w[2]);
    sizes[1] = std::max(largest(row[4], row[5], row[6]), std::abs(row[7])) + 0.0 * (row[4] + row[5] + row[6] + row[7]);
  }
  double compute_time_scale(math::DD t, const double* y) const;
  void start_carry(double* carry) const;
  void correct(math::DD t, long step, double* y, double* carry) const;
  /// Restores |q| = 1, or the length of the vertical, of numbers 4 to 7.
  static void keep_unit(double* y, double* carry);

 private:
  void choose_variables(const Vector3d& omega_P);
  void add_torques(const Scene& scene);
  void find_invariants(const Scene& scene);
  void keep_invariants(double t0);   ///< those of the start
  void set_column(double* column, const Vector3d& torque_P) const;   ///< adds torque / inertia
  void add_acceleration(double* column, const Vector3d& a) const;
  void correct_rates(double* y, double* carry) const;
  Matrix3d R_BP_ = Matrix3d::Identity();
  Quat q_PB_ = {};
  bool rotated_ = false, attitude_ = true;
  Vector3d I_ = Vector3d::Zero();
  double k_ = 0.0;
  math::DD half_over_k_;                   ///< 1 / 2k in double-double; 0: plain rates
  bool free_ = false;                      ///< no torque and separatrix variables: `kept_` is conserved
  double balance_ = 0.0;
  math::DD kept_[2];
  SeriesTerms terms_;
  Vector3d moment_P_ = Vector3d::Zero();   ///< weight times arm
  int gradients_ = 0;
  bool vertical_ = false;                  ///< the vertical is integrated in place of the attitude
  SeriesInvariants invariants_;
  double start_[8] = {}, start_carry_[8] = {};
  Vector3d space_[2] = {Vector3d::Zero(), Vector3d::Zero()};   ///< the fixed vectors, space axes
  double orbit_rate_ = 0.0, orbit_phase_ = 0.0;
  void (*kernel_)(const SeriesTerms&, const SeriesStart&, int, double*) = nullptr;
};

}  // namespace polhode
