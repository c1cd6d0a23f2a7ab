#pragma once

#include <cmath>

#include "polhode/formula/expression.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/sincos_unfused.hpp"
#include "polhode/torque/formulas.hpp"
#include "polhode/torque/record.hpp"

namespace polhode::torques {

/// The parameter of an open law that the scene gives: nine numbers, row by row. No user can write this name.
inline constexpr std::string_view inertia_input = "the inertia";

/// What a law sees of one state. One class serves numbers, one serves formulas; both have the same names.
template <class T>
class LawArguments;

template <>
class LawArguments<double> {
 public:
  using Number = double;
  using Vector = formula::Vec<double, 3>;

  double t;        ///< [s]
  Vector omega;    ///< w_B [rad/s]

  explicit LawArguments(const TorqueInput& in)
      : t(in.t), omega{{in.omega[0], in.omega[1], in.omega[2]}}, q_(in.attitude), I_(in.inertia_B.data()),
        principal_(in.principal) {}

  static Vector vector(double x, double y, double z) { return {{x, y, z}}; }

  /// An orbit at the time, in space axes.
  formula::Seen<double> see(const formula::Ephemeris& orbit) const { return formula::see(orbit, t); }
  /// q_WB, unit length.
  formula::Vec<double, 4> attitude() const {
    const double d = q_[0] * q_[0] + q_[1] * q_[1] + q_[2] * q_[2] + q_[3] * q_[3];
    const double s = d == 1.0 ? 1.0 : 1.0 / std::sqrt(d);
    return {{s * q_[0], s * q_[1], s * q_[2], s * q_[3]}};
  }
  /// R_WB^T v: a vector of space axes, seen from the body.
  Vector to_body(const Vector& v) const {
    Vector seen;
    polhode::to_body(q_, v.components.data(), seen.components.data());
    return seen;
  }
  /// R_WB v
  Vector to_space(const Vector& v) const { return formula::to_space(attitude(), v); }
  /// The space vertical e_z, seen from the body.
  Vector vertical() const {
    Vector seen;
    compute_vertical(q_, seen.components.data());
    return seen;
  }
  /// (cos a, sin a, 0) of space, seen from the body: the radial direction of an orbit about space z.
  Vector radial(double angle) const {
    double sine, cosine;
    if (std::abs(angle) <= math::most_unfused_angle) {
      math::sincos_unfused(angle, sine, cosine);   // the same bits for bodies in lanes
    } else {
      const math::SinCosPair far = math::sincos(angle);
      sine = far.sin, cosine = far.cos;
    }
    Vector seen;
    compute_radial(cosine, sine, q_, seen.components.data());
    return seen;
  }
  /// I_B [kg m^2]
  formula::Mat<double> inertia() const {
    return {{I_[0], I_[3], I_[6], I_[1], I_[4], I_[7], I_[2], I_[5], I_[8]}};
  }
  /// strength u x (I u)
  Vector cross_inertia(double strength, const Vector& u) const {
    Vector tau;
    if (principal_) {
      add_gradient<true>(strength, I_, u.components.data(), tau.components.data());
    } else {
      add_gradient<false>(strength, I_, u.components.data(), tau.components.data());
    }
    return tau;
  }

 private:
  const double* q_;
  const double* I_;
  bool principal_;
};

template <>
class LawArguments<formula::Expr> {
 public:
  using Number = formula::Expr;
  using Vector = formula::Vec<formula::Expr, 3>;

  Number t;
  Vector omega;

  LawArguments(const Number& time, const Vector& w, const formula::Vec<Number, 4>& q, const formula::Mat<Number>& I)
      : t(time), omega(w), q_(q), I_(I) {}

  static Vector vector(double x, double y, double z) { return {{x, y, z}}; }

  formula::Seen<Number> see(const formula::Ephemeris& orbit) const { return formula::see(orbit, t); }
  const formula::Vec<Number, 4>& attitude() const { return q_; }
  Vector to_body(const Vector& v) const { return formula::to_body(q_, v); }
  Vector to_space(const Vector& v) const { return formula::to_space(q_, v); }
  Vector vertical() const { return to_body(vector(0.0, 0.0, 1.0)); }
  Vector radial(const Number& angle) const { return to_body({{cos(angle), sin(angle), 0.0}}); }
  const formula::Mat<Number>& inertia() const { return I_; }
  /// From the products of two components of u. So a body with principal axes needs three.
  Vector cross_inertia(const Number& strength, const Vector& u) const {
    Vector tau;
    for (std::size_t i = 0; i < 3; ++i) {   // u_j (I u)_k - u_k (I u)_j
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      tau[i] = strength * ((I_(k, k) - I_(j, j)) * (u[j] * u[k]) + I_(k, j) * (u[j] * u[j] - u[k] * u[k]) +
                           I_(k, i) * (u[i] * u[j]) - I_(j, i) * (u[i] * u[k]));
    }
    return tau;
  }

 private:
  formula::Vec<Number, 4> q_;
  formula::Mat<Number> I_;
};

/// What a law with states of its own returns: tau_B, and the rates of its states.
template <class T, template <class> class States>
struct LawResult {
  formula::Vec<T, 3> torque;
  States<T> rates;
};

namespace detail {
inline LawArguments<double> see_numbers(const TorqueInput& in) { return LawArguments<double>(in); }
}  // namespace detail

}  // namespace polhode::torques
