#include "polhode/torque/magnetic_field.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "polhode/core/error.hpp"

namespace polhode {

using formula::Expr;
using formula::Vec;

namespace {

void require_number(const char* name, double value) {
  if (!std::isfinite(value)) throw InvalidInput(std::string("MagneticField.") + name, "finite", to_text(value));
}

/// sqrt(2 (n - m)! / (n + m)!) of m > 0, and 1 of m = 0: Schmidt's norm of P_n^m.
double compute_norm(int n, int m) {
  double square = m == 0 ? 1.0 : 2.0;
  for (int k = n - m + 1; k <= n + m; ++k) square /= k;
  return std::sqrt(square);
}

/// T_n,m, C_m and S_m for all n up to a degree: x^2 + y^2 enters by r^2, so that nothing is divided by cos(latitude).
/// C_m + i S_m = (x + i y)^m, T_m,m = (2m - 1)!!, (n - m) T_n,m = (2n - 1) z T_n-1,m - (n + m - 1) r^2 T_n-2,m.
/// Cunningham 1970, Celestial Mechanics 2, 207; Pines 1973, AIAA Journal 11, 1508.
template <class T>
class SolidHarmonics {
 public:
  SolidHarmonics(const Vec<T, 3>& r, int degree) : degree_(degree) {
    const T r2 = dot(r, r);
    c_.emplace_back(1.0), s_.emplace_back(0.0);
    for (int m = 1; m <= degree + 1; ++m) {
      const T c = c_.back(), s = s_.back();
      c_.push_back(r[0] * c - r[1] * s), s_.push_back(r[0] * s + r[1] * c);
    }
    t_.assign(at(degree + 2, 0), T(0.0));
    double diagonal = 1.0;
    for (int m = 0; m <= degree; ++m) {
      if (m > 0) diagonal *= 2 * m - 1;
      t_[at(m, m)] = T(diagonal);
      for (int n = m + 1; n <= degree; ++n) {
        const T low = n - 2 >= m ? t_[at(n - 2, m)] : T(0.0);
        t_[at(n, m)] = (T(2.0 * n - 1.0) * r[2] * t_[at(n - 1, m)] - T(n + m - 1.0) * r2 * low) * T(1.0 / (n - m));
      }
    }
  }
  /// 0 where m > n.
  T polynomial(int n, int m) const { return m > n || n < 0 ? T(0.0) : t_[at(n, m)]; }
  const T& c(int m) const { return c_[static_cast<std::size_t>(m)]; }
  const T& s(int m) const { return s_[static_cast<std::size_t>(m)]; }

 private:
  static std::size_t at(int n, int m) { return static_cast<std::size_t>(n * (n + 1) / 2 + m); }
  int degree_;
  std::vector<T> c_, s_, t_;
};

}  // namespace

MagneticField::MagneticField(formula::Ephemeris orbit, double spin, double phase)
    : orbit_(std::move(orbit)), spin_(spin), phase_(phase) {
  require_number("spin", spin), require_number("phase", phase);
}

MagneticField MagneticField::dipole(formula::Ephemeris orbit, double strength, double tilt, double spin, double phase) {
  MagneticField field(std::move(orbit), spin, phase);
  require_number("strength", strength), require_number("tilt", tilt);
  field.strength_ = strength;
  field.sine_tilt_ = formula::sin(tilt), field.cosine_tilt_ = formula::cos(tilt);
  return field;
}

MagneticField MagneticField::gauss(formula::Ephemeris orbit, double radius, const Coefficients& g,
                                   const Coefficients& h, double spin, double phase) {
  MagneticField field(std::move(orbit), spin, phase);
  if (!(radius > 0.0 && std::isfinite(radius)))
    throw InvalidInput("MagneticField.radius", "positive and finite", to_text(radius));
  if (g.size() < 2 || static_cast<int>(g.size()) > most_degree + 1)
    throw InvalidInput("MagneticField.g", "rows of the degrees 0 to n, n from 1 to 13", std::to_string(g.size()) + " rows");
  if (h.size() != g.size())
    throw InvalidInput("MagneticField.h", "as many rows as g, " + std::to_string(g.size()), std::to_string(h.size()));
  field.radius_ = radius;
  for (std::size_t n = 0; n < g.size(); ++n) {
    const auto place = [&](const char* name, std::size_t m) {
      return std::string(name) + "[" + std::to_string(n) + "][" + std::to_string(m) + "]";
    };
    for (const auto& [name, rows] : {std::pair{"g", &g}, std::pair{"h", &h}})
      if ((*rows)[n].size() != n + 1)
        throw InvalidInput("MagneticField." + std::string(name) + "[" + std::to_string(n) + "]",
                           std::to_string(n + 1) + " numbers", std::to_string((*rows)[n].size()));
    for (std::size_t m = 0; m <= n; ++m) {
      require_number(place("g", m).c_str(), g[n][m]), require_number(place("h", m).c_str(), h[n][m]);
      if (m == 0 && h[n][0] != 0.0)
        throw InvalidInput("MagneticField." + place("h", 0), "0: it has no meaning", to_text(h[n][0]));
      if (n == 0 && g[0][0] != 0.0)
        throw InvalidInput("MagneticField.g[0][0]", "0: there is no magnetic charge", to_text(g[0][0]));
      const double norm = compute_norm(static_cast<int>(n), static_cast<int>(m));
      if (n > 0) field.terms_.push_back({static_cast<int>(n), static_cast<int>(m), norm * g[n][m], norm * h[n][m]});
    }
  }
  return field;
}

template <class T>
Vec<T, 3> MagneticField::compute_dipole(const T& sine, const T& cosine, const Vec<T, 3>& r, const T& u) const {
  const Vec<T, 3> m{{cosine * T(sine_tilt_), sine * T(sine_tilt_), T(cosine_tilt_)}};
  const T u2 = u * u;
  return (T(strength_) * (u2 * u)) * ((T(3.0) * (u2 * dot(m, r))) * r - m);
}

/// B = sum_n u^(2n+1) ((2n + 1) u^2 A_n r - D_n) in units of the radius, u = 1/r, A_n = sum_m (g C_m + h S_m) T_n,m and
/// D_n its gradient, by dC_m/dx = m C_m-1, dC_m/dy = -m S_m-1, dT_n,m/dx = -x T_n-1,m+1, dT_n,m/dz = (n + m) T_n-1,m.
template <class T>
Vec<T, 3> MagneticField::compute_harmonics(const Vec<T, 3>& r, const T& u) const {
  const int degree = terms_.back().n;
  const SolidHarmonics<T> solid(r, degree);
  const T u2 = u * u;
  T power = u * u2;
  Vec<T, 3> B;
  std::size_t next = 0;
  for (int n = 1; n <= degree; ++n) {
    T A(0.0);
    Vec<T, 3> D;
    for (int m = 0; m <= n; ++m) {
      const Term& term = terms_[next++];
      if (term.g == 0.0 && term.h == 0.0) continue;
      const T g(term.g), h(term.h), wave = g * solid.c(m) + h * solid.s(m), poly = solid.polynomial(n, m);
      const T fall = wave * solid.polynomial(n - 1, m + 1);
      A = A + wave * poly;
      D[0] = D[0] - r[0] * fall, D[1] = D[1] - r[1] * fall;
      D[2] = D[2] + T(static_cast<double>(n + m)) * (wave * solid.polynomial(n - 1, m));
      if (m == 0) continue;
      const T c = T(m * term.g) * solid.c(m - 1) + T(m * term.h) * solid.s(m - 1);
      const T s = T(m * term.h) * solid.c(m - 1) - T(m * term.g) * solid.s(m - 1);
      D[0] = D[0] + c * poly, D[1] = D[1] + s * poly;
    }
    B = B + power * ((T(2.0 * n + 1.0) * u2 * A) * r - D);
    power = power * u2;
  }
  return B;
}

template <class T>
Vec<T, 3> MagneticField::compute(const T& t, const Vec<T, 3>& r, const T& inverse_distance) const {
  using formula::cos, formula::sin;
  const T angle = T(spin_) * t + T(phase_), sine = sin(angle), cosine = cos(angle);
  if (terms_.empty()) return compute_dipole(sine, cosine, r, inverse_distance);
  // In the planet's axes, in units of the radius.
  const T by(1.0 / radius_);
  const Vec<T, 3> own{{by * (cosine * r[0] + sine * r[1]), by * (cosine * r[1] - sine * r[0]), by * r[2]}};
  const Vec<T, 3> B = compute_harmonics(own, T(radius_) * inverse_distance);
  return {{cosine * B[0] - sine * B[1], cosine * B[1] + sine * B[0], B[2]}};
}

Vector3d MagneticField::at(double t) const {
  const formula::Seen<double> seen = formula::see(orbit_, t);
  return formula::to_eigen(compute(t, seen.r, seen.inverse_distance));
}

Vector3d MagneticField::at(double t, const Vector3d& r) const {
  require_number("at.t", t);
  const double distance = r.norm();
  if (!(distance > 0.0 && std::isfinite(distance)))
    throw InvalidInput("MagneticField.at.r", "finite and not the centre", to_text(distance));
  return formula::to_eigen(compute(t, formula::make_vector<double>(r), 1.0 / distance));
}

Vec<Expr, 3> MagneticField::see(const Expr& t) const {
  const formula::Seen<Expr> seen = formula::see(orbit_, t);
  return compute(t, seen.r, seen.inverse_distance);
}

torques::Formula torques::make_dipole(const Vector3d& moment, const MagneticField& field) {
  return Formula::from(
      [&](const auto& in) { return cross(in.template p<3>("moment"), to_body(in.attitude, field.see(in.t))); },
      {{"moment", {moment[0], moment[1], moment[2]}}});
}

}  // namespace polhode
