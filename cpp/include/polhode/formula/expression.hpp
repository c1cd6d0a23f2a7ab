#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "polhode/core/quat.hpp"
#include "polhode/formula/detail/functions.hpp"
#include "polhode/formula/graph.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/number.hpp"

namespace polhode::formula {

/// A number under construction: a form of a graph's nodes. Generic code that runs on `double` runs on it: a trace.
class Expr {
 public:
  Expr(double value = 0.0) : form_(value) {}   // NOLINT(google-explicit-constructor)
  Expr(Graph& graph, Form form) : graph_(&graph), form_(std::move(form)) {}

  const Form& form() const { return form_; }
  Graph* graph() const { return graph_; }   ///< null for a number

 private:
  Graph* graph_ = nullptr;
  Form form_;
};

/// guard > 0, or its negation.
struct Condition {
  Expr guard;
  bool negated = false;
};

Expr operator+(const Expr& a, const Expr& b);
Expr operator-(const Expr& a, const Expr& b);
Expr operator*(const Expr& a, const Expr& b);
Expr operator/(const Expr& a, const Expr& b);
Expr operator-(const Expr& a);
Condition operator<(const Expr& a, const Expr& b);
Condition operator>(const Expr& a, const Expr& b);
Condition operator<=(const Expr& a, const Expr& b);
Condition operator>=(const Expr& a, const Expr& b);

Expr sqrt(const Expr& a);
Expr pow(const Expr& a, double exponent);
Expr exp(const Expr& a);
Expr log(const Expr& a);
Expr sin(const Expr& a);
Expr cos(const Expr& a);
Expr tan(const Expr& a);
Expr tanh(const Expr& a);
Expr atan2(const Expr& y, const Expr& x);
/// `yes` where the condition holds, else `no`. Both are computed.
Expr where(const Condition& condition, const Expr& yes, const Expr& no);

// The same names on numbers.
inline double sqrt(double a) { return math::sqrt(a); }
inline double pow(double a, double exponent) { return math::pow(a, exponent); }
inline double exp(double a) { return math::exp(a); }
inline double log(double a) { return math::log(a); }
inline double sin(double a) { return math::sin(a); }
inline double cos(double a) { return math::cos(a); }
inline double tan(double a) { return math::sin(a) / math::cos(a); }
inline double tanh(double a) { return compute_tanh(a).value; }
inline double atan2(double y, double x) { return math::atan2(y, x); }
inline double where(bool condition, double yes, double no) { return condition ? yes : no; }

// Switches of either number type T. At 0, sign is -1.
template <class T>
T abs(const T& a) { return where(a > T(0.0), a, -a); }
template <class T>
T sign(const T& a) { return where(a > T(0.0), T(1.0), T(-1.0)); }
template <class T>
T min(const T& a, const T& b) { return where(a > b, b, a); }
template <class T>
T max(const T& a, const T& b) { return where(a > b, a, b); }
template <class T>
T clip(const T& a, const T& low, const T& high) { return min(max(a, low), high); }

/// Dry friction: -load times the sign of the rate, or what holds the rate at 0 where the load is enough.
Expr friction(const Expr& load, const Expr& rate);
inline double friction(double load, double rate) { return rate > 0.0 ? -load : load; }

/// Components of a vector, or of an attitude.
template <class T, std::size_t n>
struct Vec {
  std::array<T, n> components{};

  T& operator[](std::size_t i) { return components[i]; }
  const T& operator[](std::size_t i) const { return components[i]; }
  const T& x() const { return components[0]; }
  const T& y() const { return components[1]; }
  const T& z() const { return components[2]; }
  const T& w() const { return components[3]; }
  Vec<T, 3> xyz() const { return {{components[0], components[1], components[2]}}; }
};

// clang-format off
#define POLHODE_ELEMENTWISE(op)                                                                       \
  template <class T, std::size_t n> Vec<T, n> operator op(const Vec<T, n>& a, const Vec<T, n>& b) {   \
    Vec<T, n> out; for (std::size_t i = 0; i < n; ++i) out[i] = a[i] op b[i]; return out; }           \
  template <class T, std::size_t n> Vec<T, n> operator op(const Vec<T, n>& a, const T& b) {           \
    Vec<T, n> out; for (std::size_t i = 0; i < n; ++i) out[i] = a[i] op b; return out; }              \
  template <class T, std::size_t n> Vec<T, n> operator op(const T& a, const Vec<T, n>& b) {           \
    Vec<T, n> out; for (std::size_t i = 0; i < n; ++i) out[i] = a op b[i]; return out; }
POLHODE_ELEMENTWISE(+) POLHODE_ELEMENTWISE(-) POLHODE_ELEMENTWISE(*) POLHODE_ELEMENTWISE(/)
#undef POLHODE_ELEMENTWISE
// clang-format on
template <std::size_t n>
Vec<Expr, n> operator*(double a, const Vec<Expr, n>& b) { return Expr(a) * b; }
template <std::size_t n>
Vec<Expr, n> operator*(const Vec<Expr, n>& a, double b) { return a * Expr(b); }
template <class T, std::size_t n>
Vec<T, n> operator-(const Vec<T, n>& a) {
  Vec<T, n> out;
  for (std::size_t i = 0; i < n; ++i) out[i] = -a[i];
  return out;
}

template <class T, std::size_t n>
T dot(const Vec<T, n>& a, const Vec<T, n>& b) {
  T sum(0.0);
  for (std::size_t i = 0; i < n; ++i) sum = sum + a[i] * b[i];
  return sum;
}

template <class T>
Vec<T, 3> cross(const Vec<T, 3>& a, const Vec<T, 3>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// sqrt(v . v + smooth^2): a norm that is analytic at 0 where smooth is not 0.
template <class T, std::size_t n>
T norm(const Vec<T, n>& v, double smooth = 0.0) { return sqrt(dot(v, v) + T(smooth * smooth)); }

/// A matrix of nine numbers, by rows.
template <class T>
struct Mat {
  std::array<T, 9> entries{};

  const T& operator()(std::size_t i, std::size_t j) const { return entries[3 * i + j]; }
};

template <class T>
Mat<T> make_matrix(const Matrix3d& M) {
  Mat<T> made;
  for (int i = 0; i < 9; ++i) made.entries[static_cast<std::size_t>(i)] = T(M(i / 3, i % 3));
  return made;
}
inline Vector3d to_eigen(const Vec<double, 3>& v) { return {v[0], v[1], v[2]}; }
inline Matrix3d to_eigen(const Mat<double>& m) {
  Matrix3d made;
  for (int i = 0; i < 9; ++i) made(i / 3, i % 3) = m.entries[static_cast<std::size_t>(i)];
  return made;
}

template <class T>
Vec<T, 3> operator*(const Mat<T>& M, const Vec<T, 3>& v) {
  Vec<T, 3> out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = M(i, 0) * v[0] + M(i, 1) * v[1] + M(i, 2) * v[2];
  return out;
}
template <class T>
Mat<T> operator*(const T& a, const Mat<T>& M) {
  Mat<T> out;
  for (std::size_t i = 0; i < 9; ++i) out.entries[i] = a * M.entries[i];
  return out;
}

template <class T>
Vec<T, 3> make_vector(const Vector3d& v) { return {{T(v[0]), T(v[1]), T(v[2])}}; }

/// M v of a constant matrix.
template <class T>
Vec<T, 3> apply_matrix(const Matrix3d& M, const Vec<T, 3>& v) {
  return {{v[0] * T(M(0, 0)) + v[1] * T(M(0, 1)) + v[2] * T(M(0, 2)),
           v[0] * T(M(1, 0)) + v[1] * T(M(1, 1)) + v[2] * T(M(1, 2)),
           v[0] * T(M(2, 0)) + v[1] * T(M(2, 1)) + v[2] * T(M(2, 2))}};
}

/// R_WB^T v = v + w u + p x u, p = q.xyz, u = 2 v x p, as a polynomial of degree 2 in q: diagonal entries as
/// w^2 + x^2 - y^2 - z^2.
template <class T>
Vec<T, 3> rotate_to_body(const Vec<T, 4>& q, const Vec<T, 3>& v);
template <class T>
Vec<T, 3> rotate_to_space(const Vec<T, 4>& q, const Vec<T, 3>& v);

/// q (w, 0), the product of an attitude and a vector.
template <class T>
Vec<T, 4> multiply_pure(const Vec<T, 4>& q, const Vec<T, 3>& w) {
  return {{q[3] * w[0] + q[1] * w[2] - q[2] * w[1], q[3] * w[1] + q[2] * w[0] - q[0] * w[2],
           q[3] * w[2] + q[0] * w[1] - q[1] * w[0], -(q[0] * w[0]) - q[1] * w[1] - q[2] * w[2]}};
}

/// The rotation matrix R_WB by rows, a polynomial in q.
template <class T>
std::array<Vec<T, 3>, 3> make_rotation(const Vec<T, 4>& q) {
  const T two(2.0);
  const T xx = q[0] * q[0], yy = q[1] * q[1], zz = q[2] * q[2], ww = q[3] * q[3], xy = q[0] * q[1], xz = q[0] * q[2],
          yz = q[1] * q[2], wx = q[3] * q[0], wy = q[3] * q[1], wz = q[3] * q[2];
  return {{{{ww + xx - yy - zz, two * (xy - wz), two * (xz + wy)}},
           {{two * (xy + wz), ww - xx + yy - zz, two * (yz - wx)}},
           {{two * (xz - wy), two * (yz + wx), ww - xx - yy + zz}}}};
}

template <class T>
Vec<T, 3> rotate_to_body(const Vec<T, 4>& q, const Vec<T, 3>& v) {
  const std::array<Vec<T, 3>, 3> R = make_rotation(q);
  return R[0] * v[0] + R[1] * v[1] + R[2] * v[2];
}

template <class T>
Vec<T, 3> rotate_to_space(const Vec<T, 4>& q, const Vec<T, 3>& v) {
  const std::array<Vec<T, 3>, 3> R = make_rotation(q);
  return {{dot(R[0], v), dot(R[1], v), dot(R[2], v)}};
}

/// R_WB^T v as the tape knows it: one node a component, which a series may carry from row to row.
Vec<Expr, 3> to_body(const Vec<Expr, 4>& attitude, const Vec<Expr, 3>& v);
inline Vec<double, 3> to_body(const Vec<double, 4>& attitude, const Vec<double, 3>& v) {
  return rotate_to_body(attitude, v);
}
template <class T>
Vec<T, 3> to_space(const Vec<T, 4>& attitude, const Vec<T, 3>& v) { return rotate_to_space(attitude, v); }

/// An ephemeris at a time: position, velocity, distance and 1 / distance.
template <class T>
struct Seen {
  Vec<T, 3> r, v;
  T distance, inverse_distance;
};
inline Seen<double> see(const Ephemeris& ephemeris, double t) {
  const auto n = ephemeris.at(t);
  return {{{n[0], n[1], n[2]}}, {{n[3], n[4], n[5]}}, n[6], n[7]};
}
/// @param t  the time itself. @throws InvalidInput for another expression
Seen<Expr> see(const Ephemeris& ephemeris, const Expr& t);

/// The states from a number on.
template <std::size_t n>
Vec<Expr, n> list_states(Graph& graph, int first) {
  Vec<Expr, n> found;
  for (std::size_t i = 0; i < n; ++i) found[i] = Expr(graph, graph.state(first + static_cast<int>(i)));
  return found;
}

}  // namespace polhode::formula
